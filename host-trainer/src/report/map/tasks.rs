//! The world with start/goal pairs in it: what a controller is asked to do.

use super::frame::Frame;
use super::world;
use crate::report::data::{BodyShape, Scene, Task};
use crate::report::map::drive;
use crate::report::palette::{GOAL, MUTED, PAPER, START};
use crate::report::svg::{Num, escape};

/// Pixels of the room's longer side: larger than a drive's, for worlds with fine detail.
const LONG_SIDE: f64 = 860.0;

/// Length of a start's arrow, pixels.
const ARROW: f64 = 26.0;

/// The world, and each pair as a car with an arrow, a dotted line and the target disc.
pub fn tasks_svg(scene: &Scene, body: &BodyShape, tasks: &[Task]) -> String {
    let frame = Frame::sized(scene.bounds, LONG_SIDE);
    let radius = f64::from(scene.target_radius) * frame.scale;
    let discs: String =
        tasks.iter().map(|task| drive::disc(frame.place(task.goal), radius)).collect();
    let marks: String = tasks.iter().map(|task| mark(&frame, body, task)).collect();
    let content = discs + &world::elements(scene, &frame) + &marks;
    frame.svg(&scene.name, &scene.name, &content)
}

fn mark(frame: &Frame, body: &BodyShape, task: &Task) -> String {
    let [x, y, heading] = task.start;
    let [start, goal] = [frame.place([x, y]), frame.place(task.goal)];
    let way = format!(
        "<path d=\"M{} {}L{} {}\" stroke=\"{MUTED}\" stroke-dasharray=\"1 5\" \
         stroke-linecap=\"round\"/>\n",
        Num(start[0]),
        Num(start[1]),
        Num(goal[0]),
        Num(goal[1])
    );
    let car = drive::car(frame, body, task.start);
    let label = escape(&task.label);
    way + &car
        + &arrow(start, f64::from(heading))
        + &text([start[0] - 8.0, start[1] - 8.0], START, &label)
        + &drive::square(goal)
        + &text([goal[0] + 8.0, goal[1] - 8.0], GOAL, &label)
}

/// Long enough to be seen where the car is a dot.
fn arrow([x, y]: [f64; 2], heading: f64) -> String {
    let degrees = Num(-heading.to_degrees());
    format!(
        "<path d=\"M0 0H{ARROW}m-7-4.5l7 4.5l-7 4.5\" fill=\"none\" stroke=\"{START}\" \
         stroke-width=\"2\" stroke-linecap=\"round\" stroke-linejoin=\"round\" \
         transform=\"translate({} {}) rotate({degrees})\"/>\n",
        Num(x),
        Num(y)
    )
}

/// A number that stays readable on a wall.
fn text([x, y]: [f64; 2], colour: &str, text: &str) -> String {
    let (x, y) = (Num(x), Num(y));
    let place = format!("x=\"{x}\" y=\"{y}\" text-anchor=\"middle\" font-weight=\"700\"");
    format!(
        "<text {place} fill=\"none\" stroke=\"{PAPER}\" stroke-width=\"3\">{text}</text>\
         <text {place} fill=\"{colour}\">{text}</text>\n"
    )
}
