//! Where drives ended: the picture that novelty search is known by.

use super::drive;
use super::frame::Frame;
use super::world;
use crate::report::data::{Drive, Scene};
use crate::report::palette::LOOP;
use crate::report::svg::PathText;

/// Diameter of a point, pixels.
const DOT: f64 = 2.6;

/// A point where each drive of a search ended, and over them the drive that reached the goal, or
/// came nearest.
pub fn ends_svg(scene: &Scene, ends: &[[f32; 2]], drive: Option<&Drive>, heading: &str) -> String {
    let frame = Frame::new(scene.bounds);
    let mut dots = PathText::default();
    for end in ends {
        // A line without length, whose round ends are the point.
        dots.move_to(frame.place(*end));
        dots.line_to(frame.place(*end));
    }
    let dots = format!(
        "<path d=\"{}\" fill=\"none\" stroke=\"{LOOP}\" stroke-opacity=\".6\" \
         stroke-width=\"{DOT}\" stroke-linecap=\"round\"/>\n",
        dots.finish()
    );
    let radius = f64::from(scene.target_radius) * frame.scale;
    let goal = drive.map(|drive| drive::disc(frame.place(drive.goal), radius));
    let way = drive.map(|drive| drive::way(&frame, drive));
    let content = goal.unwrap_or_default()
        + &dots
        + &world::elements(scene, &frame)
        + &way.unwrap_or_default();
    frame.svg(heading, heading, &content)
}
