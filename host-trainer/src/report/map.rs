//! The world, and a drive through it, to scale: what the paper's Figs. 3, 4 and 7 show.
//!
//! Written by hand rather than plotted, because metres must be square and a grid map may
//! have a hundred thousand edges, which fit into one path but not into one element each.

mod drive;
mod ends;
mod frame;
mod tasks;
mod world;

pub(super) use drive::trajectory_on_shared_world;
pub use drive::trajectory_svg;
pub use ends::ends_svg;
pub(super) use frame::FONTS;
pub use tasks::tasks_svg;
pub(super) use world::shared_world;

use super::data::Scene;
use frame::Frame;

/// The world alone: room, obstacles, and a scale in metres.
pub fn scene_svg(scene: &Scene) -> String {
    let frame = Frame::new(scene.bounds);
    let world = world::elements(scene, &frame);
    frame.svg(&scene.name, &scene.name, &world)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_polygons_of_either_orientation_stay_solid() {
        let square = vec![[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]];
        let reversed: Vec<_> = square.iter().rev().map(|p| [p[0] + 0.5, p[1]]).collect();
        let scene = Scene {
            bounds: [[0.0, 0.0], [4.0, 4.0]],
            polygons: vec![square, reversed],
            circles: vec![[3.0, 3.0, 0.5]],
            ..Scene::default()
        };
        // All three run counter-clockwise, so none cuts a hole into another.
        assert_eq!(
            world::solid_path(&scene),
            "M1 1h1v1h-1zM1.5 2v-1h1v1zM2.5 3a.5 .5 0 1 1 1 0a.5 .5 0 1 1 -1 0z"
        );
    }

    #[test]
    fn segments_that_meet_become_one_line() {
        let scene = Scene {
            segments: vec![[0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 1.0, 0.5], [3.0, 3.0, 2.0, 3.5]],
            ..Scene::default()
        };
        assert_eq!(world::line_path(&scene), "M0 0h1v.5M3 3l-1 .5");
    }
}
