//! Room and obstacles as SVG elements.

use super::frame::Frame;
use crate::report::data::Scene;
use crate::report::palette::{MUTED, WALL};
use crate::report::svg::{Num, PathText, escape};

/// Room and obstacles, placed in a picture.
pub(super) fn elements(scene: &Scene, frame: &Frame) -> String {
    format!(
        "{}<g {} {CLIPPED}>{}</g>\n{}",
        clip(scene),
        frame.transform(),
        shapes(scene, frame, false),
        room(scene, frame)
    )
}

/// The obstacles once, invisibly, for every picture on a page to point at, and for its
/// script to read: elements `world`, `world-map`, `world-solid` and `world-lines`, in metres.
pub(in crate::report) fn shared_world(scene: &Scene) -> String {
    let frame = Frame::new(scene.bounds);
    let shapes = shapes(scene, &frame, true);
    format!(
        "<svg width=\"0\" height=\"0\" aria-hidden=\"true\" class=\"shared\">\
         <title>{}</title><defs>{}<g id=\"world\">{shapes}</g></defs></svg>\n",
        escape(&scene.name),
        clip(scene),
    )
}

/// A reference to [`shared_world`], placed in a picture.
pub(super) fn reference(scene: &Scene, frame: &Frame) -> String {
    format!("<g {} {CLIPPED}><use href=\"#world\"/></g>\n{}", frame.transform(), room(scene, frame))
}

/// Draws only what lies in the room: a map, or a box, may go on beyond it.
const CLIPPED: &str = "clip-path=\"url(#room)\"";

/// The room in metres, for [`CLIPPED`].
fn clip(scene: &Scene) -> String {
    let [[x0, y0], [x1, y1]] = scene.bounds.map(|corner| corner.map(f64::from));
    // Obstacles often stand on the room's edge, with half of their line outside.
    let margin = 0.004 * (x1 - x0).max(y1 - y0);
    let side = |low: f64, high: f64| Num((high - low + 2.0 * margin).max(0.0));
    format!(
        "<clipPath id=\"room\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
        Num(x0 - margin),
        Num(y0 - margin),
        side(x0, x1),
        side(y0, y1),
    )
}

fn shapes(scene: &Scene, frame: &Frame, named: bool) -> String {
    let id = |name: &str| if named { format!(" id=\"{name}\"") } else { String::new() };
    let (solid, lines) = (solid_path(scene), line_path(scene));
    // As wide as 1.6 pixels wherever the room is drawn at its usual size.
    let width = 1.6 / frame.scale;
    let map = if named || !scene.outlines.is_empty() {
        // The line keeps a wall of one cell visible in a picture of a large hall.
        format!(
            "<path{} d=\"{}\" fill=\"{WALL}\" fill-rule=\"evenodd\" stroke=\"{WALL}\" \
             stroke-width=\"{}\"/>",
            id("world-map"),
            map_path(scene),
            Num((0.7 / frame.scale).max(0.001)),
        )
    } else {
        String::new()
    };
    format!(
        "{map}<path{} d=\"{solid}\" fill=\"{WALL}\"/>\
         <path{} d=\"{lines}\" fill=\"none\" stroke=\"{WALL}\" stroke-width=\"{}\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\"/>",
        id("world-solid"),
        id("world-lines"),
        Num(width.max(0.001)),
    )
}

/// Outline of everything solid, metres. All parts run counter-clockwise, so that one does
/// not cut a hole where it overlaps another.
pub(super) fn solid_path(scene: &Scene) -> String {
    let mut path = PathText::default();
    for polygon in &scene.polygons {
        let mut corners: Vec<[f64; 2]> = polygon.iter().map(|p| p.map(f64::from)).collect();
        if doubled_area(&corners) < 0.0 {
            corners.reverse();
            // Keep the first corner first, so that orientation alone changes the text.
            corners.rotate_right(1);
        }
        let Some((first, rest)) = corners.split_first() else { continue };
        path.move_to(*first);
        for corner in rest {
            path.line_to(*corner);
        }
        path.close();
    }
    for &[x, y, radius] in &scene.circles {
        path.circle([f64::from(x), f64::from(y)], f64::from(radius));
    }
    path.finish()
}

/// Outline of a map's solid cells, metres; to be filled by the even-odd rule.
pub(super) fn map_path(scene: &Scene) -> String {
    let mut path = PathText::default();
    for corners in &scene.outlines {
        let Some((first, rest)) = corners.split_first() else { continue };
        path.move_to(first.map(f64::from));
        for corner in rest {
            path.line_to(corner.map(f64::from));
        }
        path.close();
    }
    path.finish()
}

/// Walls without thickness, metres.
pub(super) fn line_path(scene: &Scene) -> String {
    let mut path = PathText::default();
    for &[x0, y0, x1, y1] in &scene.segments {
        path.move_to([f64::from(x0), f64::from(y0)]);
        path.line_to([f64::from(x1), f64::from(y1)]);
    }
    path.finish()
}

/// Positive where the corners run counter-clockwise.
fn doubled_area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
}

fn room(scene: &Scene, frame: &Frame) -> String {
    let stroke = if scene.outer_wall {
        format!("stroke=\"{WALL}\" stroke-width=\"3\"")
    } else {
        format!("stroke=\"{MUTED}\" stroke-dasharray=\"2 4\"")
    };
    format!("<rect {} fill=\"none\" {stroke}/>\n", frame.room())
}
