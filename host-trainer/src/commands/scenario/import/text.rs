//! The scenario file of an imported map, short enough to be read and changed.

use super::fit::Fit;
use crate::scenario::Bounds;

/// Everything the file says.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    /// Path of the YAML file, relative to the scenario file.
    pub(super) yaml: String,
    /// The map's name for people.
    pub(super) source: String,
    pub(super) unknown_is_obstacle: bool,
    /// Percent.
    pub(super) lethal: u8,
    /// Columns and rows.
    pub(super) cells: [u32; 2],
    /// Edge of a cell, metres.
    pub(super) resolution: f64,
    /// None is the whole map.
    pub(super) room: Option<Bounds>,
    pub(super) fit: Fit,
}

impl Draft {
    /// The file.
    pub(super) fn text(&self, name: &str) -> String {
        let [columns, rows] = self.cells;
        let side = |cells: u32| {
            let metres = format!("{:.1}", f64::from(cells) * self.resolution);
            metres.trim_end_matches(".0").to_owned()
        };
        let (width, height) = (side(columns), side(rows));
        let source =
            toml_string(&format!("ROS map {}, {width} x {height} m", printable(&self.source)));
        format!(
            "# Made by: evosteer scenario import {}\n\
             # What is not said here is as in the preset; `scenario show --toml` prints it all.\n\n\
             name = {}\ndescription = {source}\n\n{}",
            printable(&self.source),
            toml_string(name),
            self.settings()
        )
    }

    /// The file from its first table on.
    pub(super) fn settings(&self) -> String {
        let Fit { target_radius, min_distance, step_limit } = self.fit;
        let room = match self.room {
            None => "# Without `min_m` and `max_m` the room is the whole map.\n".to_owned(),
            Some(Bounds { min: [x0, y0], max: [x1, y1] }) => format!(
                "# The free space that walls enclose; without these the room is the whole map.\n\
                 min_m = [{x0}, {y0}]\nmax_m = [{x1}, {y1}]\n"
            ),
        };
        let lethal = match self.lethal {
            100 => String::new(),
            lethal => format!("lethal = {lethal}\n"),
        };
        format!(
            "[world]\n{room}outer_wall = true\ntarget_radius_m = {target_radius}\n\n\
             [world.map]\nyaml = {}    # relative to this file\nunknown_is_obstacle = {}\n{lethal}\n\
             [episode]\nstep_limit = {step_limit}\n\n\
             [pairs]\ncount = 5\nmin_distance_m = {min_distance}\n",
            toml_string(&self.yaml),
            self.unknown_is_obstacle,
        )
    }
}

fn toml_string(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Text that stays on its line, and short.
fn printable(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(80).collect()
}
