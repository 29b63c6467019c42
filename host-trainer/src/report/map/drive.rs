//! One drive on the map: start, goal, path, collisions, and the loop it may have ended in.

use std::fmt::Write;

use super::frame::Frame;
use super::world;
use crate::report::data::{BodyShape, Drive, Moment, Scene};
use crate::report::palette::{BODY, COLLISION, GOAL, GOAL_SOFT, INK, LOOP, PAPER, PATH, START};
use crate::report::svg::Num;

/// A drive as in the paper's Figs. 3, 4 and 7: from the blue diamond to the green square.
///
/// Collisions are red crosses; a periodic loop is drawn over the path in amber; the car is
/// shown where it ended. The heading is the title and the drive's verdict.
pub fn trajectory_svg(scene: &Scene, body: &BodyShape, drive: &Drive, title: &str) -> String {
    let frame = Frame::new(scene.bounds);
    let world = world::elements(scene, &frame);
    picture(scene, &frame, &world, body, drive, title)
}

/// The same picture for a page that holds the obstacles once ([`super::shared_world`]).
pub(in crate::report) fn trajectory_on_shared_world(
    scene: &Scene,
    body: &BodyShape,
    drive: &Drive,
    title: &str,
) -> String {
    let frame = Frame::new(scene.bounds);
    let world = world::reference(scene, &frame);
    picture(scene, &frame, &world, body, drive, title)
}

fn picture(
    scene: &Scene,
    frame: &Frame,
    world: &str,
    body: &BodyShape,
    drive: &Drive,
    title: &str,
) -> String {
    let heading = format!("{title}: {}", drive.verdict());
    let radius = f64::from(scene.target_radius) * frame.scale;
    let goal = frame.place(drive.goal);
    let mut out = disc(goal, radius);
    out.push_str(world);
    out.push_str(&path(frame, &drive.moments, PATH, 2.0));
    if let Some(period) = drive.loop_period {
        let lap = drive.moments.len().saturating_sub(period + 1);
        out.push_str(&path(frame, &drive.moments[lap..], LOOP, 3.5));
    }
    if let Some(end) = drive.moments.last() {
        out.push_str(&car(frame, body, [end.x, end.y, end.heading]));
    }
    out.push_str(&crosses(frame, &drive.moments));
    out.push_str(&square(goal));
    out.push_str(&diamond(frame.place([drive.start[0], drive.start[1]])));
    frame.svg(&heading, &heading, &out)
}

/// A drive's path with its start and goal, for a picture that shows something else as well.
pub(super) fn way(frame: &Frame, drive: &Drive) -> String {
    let start = frame.place([drive.start[0], drive.start[1]]);
    path(frame, &drive.moments, PATH, 2.0) + &square(frame.place(drive.goal)) + &diamond(start)
}

fn path(frame: &Frame, moments: &[Moment], colour: &str, width: f64) -> String {
    let mut points = String::new();
    for moment in moments {
        let [x, y] = frame.place([moment.x, moment.y]);
        let _ = write!(points, "{},{} ", Num(tenth(x)), Num(tenth(y)));
    }
    format!(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\"/>\n",
        points.trim_end()
    )
}

/// A tenth of a pixel is finer than any screen shows.
fn tenth(pixels: f64) -> f64 {
    (pixels * 10.0).round() / 10.0
}

/// One red cross per place where a move touched an obstacle.
fn crosses(frame: &Frame, moments: &[Moment]) -> String {
    let mut d = String::new();
    let mut last = None;
    for moment in moments.iter().filter(|m| m.collided) {
        let [x, y] = frame.place([moment.x, moment.y]).map(tenth);
        // A car held by a wall collides on one spot for many moves.
        if last != Some([x, y]) {
            let _ = write!(d, "M{} {}l8 8m0-8l-8 8", Num(x - 4.0), Num(y - 4.0));
            last = Some([x, y]);
        }
    }
    if d.is_empty() {
        return d;
    }
    format!(
        "<path d=\"{d}\" fill=\"none\" stroke=\"{COLLISION}\" stroke-width=\"2.2\" \
         stroke-linecap=\"round\"/>\n"
    )
}

pub(super) fn car(frame: &Frame, body: &BodyShape, [x, y, heading]: [f32; 3]) -> String {
    let (sin, cos) = (libm::sinf(heading), libm::cosf(heading));
    let (front, rear) = (body.front_overhang, body.front_overhang - body.length);
    let half = body.width / 2.0;
    let corners = [(front, half), (front, -half), (rear, -half), (rear, half)].map(|(dx, dy)| {
        let [x, y] = frame.place([x + dx * cos - dy * sin, y + dx * sin + dy * cos]);
        format!("{},{}", Num(tenth(x)), Num(tenth(y)))
    });
    format!(
        "<polygon points=\"{}\" fill=\"{BODY}\" stroke=\"{INK}\" stroke-width=\"1.2\"/>\n",
        corners.join(" ")
    )
}

pub(super) fn disc([x, y]: [f64; 2], radius: f64) -> String {
    format!(
        "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{GOAL_SOFT}\" stroke=\"{GOAL}\"/>\n",
        Num(x),
        Num(y),
        Num(radius)
    )
}

pub(super) fn square([x, y]: [f64; 2]) -> String {
    format!(
        "<rect x=\"{}\" y=\"{}\" width=\"9\" height=\"9\" fill=\"{GOAL}\" stroke=\"{PAPER}\"/>\n",
        Num(x - 4.5),
        Num(y - 4.5)
    )
}

fn diamond([x, y]: [f64; 2]) -> String {
    format!(
        "<path d=\"M{} {}l7 7-7 7-7-7z\" fill=\"{START}\" stroke=\"{PAPER}\"/>\n",
        Num(x),
        Num(y - 7.0)
    )
}
