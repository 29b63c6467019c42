//! Room and obstacles as SVG elements.

use super::frame::Frame;
use crate::report::data::Scene;
use crate::report::palette::{MUTED, WALL};
use crate::report::svg::{Num, PathText, escape};

/// Room and obstacles, placed in a picture.
pub(super) fn elements(scene: &Scene, frame: &Frame) -> String {
    format!("<g {}>{}</g>\n{}", frame.transform(), shapes(scene, frame, false), room(scene, frame))
}

/// The obstacles once, invisibly, for every picture on a page to point at, and for its
/// script to read: elements `world`, `world-solid` and `world-lines`, in metres.
pub(in crate::report) fn shared_world(scene: &Scene) -> String {
    let frame = Frame::new(scene.bounds);
    let shapes = shapes(scene, &frame, true);
    format!(
        "<svg width=\"0\" height=\"0\" aria-hidden=\"true\" class=\"shared\">\
         <title>{}</title><defs><g id=\"world\">{shapes}</g></defs></svg>\n",
        escape(&scene.name)
    )
}

/// A reference to [`shared_world`], placed in a picture.
pub(super) fn reference(scene: &Scene, frame: &Frame) -> String {
    format!("<g {}><use href=\"#world\"/></g>\n{}", frame.transform(), room(scene, frame))
}

fn shapes(scene: &Scene, frame: &Frame, named: bool) -> String {
    let id = |name: &str| if named { format!(" id=\"{name}\"") } else { String::new() };
    let (solid, lines) = (solid_path(scene), line_path(scene));
    // As wide as 1.6 pixels wherever the room is drawn at its usual size.
    let width = 1.6 / frame.scale;
    format!(
        "<path{} d=\"{solid}\" fill=\"{WALL}\"/>\
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
