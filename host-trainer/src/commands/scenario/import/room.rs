//! Which part of a map is the room.
//!
//! A map has free cells outside of the building too: what a sensor saw through windows, or all
//! that nobody saw, where `free_thresh` lies above the grey of unknown cells. Starts must not
//! be drawn there, so the room is cut to the free space that walls enclose, if there is some.

use super::fit;
use crate::car::body_of;
use crate::failure::Failure;
use crate::map::OccupancyMap;
use crate::problem::Problem;
use crate::scenario::{Bounds, Pair};
use crate::seed::RunSeed;
use crate::world::World;
use crate::world::free_space::{FreeSpace, Part};

/// An enclosed part below this share of the largest part is a courtyard, not the building.
const BUILDING: f32 = 0.25;

/// A room above this share of the map is not worth cutting.
const NEARLY_ALL: f32 = 0.9;

/// What a person may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Choice {
    /// The largest free space that walls enclose, if it matters, or the whole map
    Auto,
    /// The whole map
    Whole,
    /// The largest free space that walls enclose
    Enclosed,
}

/// The room and why it is this one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Room {
    /// None is the whole map.
    pub(super) bounds: Option<Bounds>,
    /// `whole map` or `enclosed`.
    pub(super) kind: &'static str,
    /// A sentence for people.
    pub(super) why: &'static str,
    /// Something about it that may surprise.
    pub(super) warning: Option<String>,
}

impl Room {
    /// Chooses a room in the scenario of a whole map.
    ///
    /// # Errors
    ///
    /// Bad input for [`Choice::Enclosed`] where nothing is.
    pub(super) fn choose(
        whole: &Problem,
        map: &OccupancyMap,
        choice: Choice,
    ) -> Result<Self, Failure> {
        let all = |why| Ok(Self { bounds: None, kind: "whole map", why, warning: None });
        if choice == Choice::Whole {
            return all("the whole map, as asked for");
        }
        let mut scenario = whole.scenario.clone();
        scenario.world.outer_wall = false;
        let world = World::new(&scenario)?;
        let radius = body_of(&scenario.vehicle).half_width;
        // Off a map that lies askew everything is free, and none of it is a place to drive.
        let on_map = |place| map.origin[2] == 0.0 || map.cell_at(place).is_some();
        let parts = FreeSpace::new(&world, radius).parts_on(&world, on_map);
        let largest = parts.first().map_or(0.0, |part| part.share);
        let Some(part) = parts.iter().find(|part| !part.at_edge) else {
            return match choice {
                Choice::Enclosed => Err(Failure::bad_input(
                    "--room enclosed: no free space on the map is enclosed by walls; expected \
                     some, or --room whole",
                )),
                _ => all("the whole map, since its free space goes on to its edge"),
            };
        };
        if choice == Choice::Auto && part.share < BUILDING * largest {
            return all("the whole map, since most of its free space goes on to its edge");
        }
        let bounds = around(part, map, radius);
        let area = |bounds: Bounds| bounds.size()[0] * bounds.size()[1];
        if choice == Choice::Auto && area(bounds) >= NEARLY_ALL * area(map.bounds()) {
            return all("the whole map");
        }
        let mut room = Self {
            bounds: Some(bounds),
            kind: "enclosed",
            why: "the part of the map whose free space is enclosed by walls",
            warning: None,
        };
        scenario.world.bounds = bounds;
        room.warning =
            larger_part(&World::new(&scenario)?, radius, part.share * area(map.bounds()));
        Ok(room)
    }
}

/// A warning if some of the pairs that evaluation draws start off the map.
pub(super) fn starts_off_map(problem: &Problem, map: &OccupancyMap) -> Option<String> {
    let sampler = problem.sampler();
    let pairs = sampler.unseen(RunSeed(1), fit::PROOF).ok()?;
    let off = |pair: &&Pair| map.cell_at([pair.start[0], pair.start[1]]).is_none();
    let count = pairs.iter().filter(off).count();
    (count > 0).then(|| {
        format!(
            "{count} of {} starts lie off the map, which lies askew in its room; narrow \
             `world.min_m` and `world.max_m`",
            pairs.len()
        )
    })
}

/// The rectangle of whole centimetres around a part and the walls that enclose it.
fn around(part: &Part, map: &OccupancyMap, radius: f32) -> Bounds {
    let margin = radius + 2.0 * map.resolution as f32;
    let limit = map.bounds();
    let axis = |axis: usize| {
        let low = ((part.around.min[axis] - margin) * 100.0).floor() / 100.0;
        let high = ((part.around.max[axis] + margin) * 100.0).ceil() / 100.0;
        [low.max(limit.min[axis]), high.min(limit.max[axis])]
    };
    let [[x0, x1], [y0, y1]] = [axis(0), axis(1)];
    Bounds { min: [x0, y0], max: [x1, y1] }
}

/// A warning if the room holds more free space outside of the enclosed part than in it.
fn larger_part(world: &World, radius: f32, enclosed: f32) -> Option<String> {
    let parts = FreeSpace::new(world, radius).parts(world);
    let [width, height] = world.bounds.size();
    let main = parts.first()?.share * width * height;
    (main > 1.1 * enclosed).then(|| {
        format!(
            "in this room {main:.0} m² of free space lie outside of the walls and {enclosed:.0} m² \
             within, so that starts and goals are drawn outside; narrow `world.min_m` and \
             `world.max_m`, or fill the outside of the map"
        )
    })
}
