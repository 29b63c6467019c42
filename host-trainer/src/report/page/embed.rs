//! The drives as compact JSON for the replay.

use serde::Serialize;

use super::outcomes::Kind;
use crate::report::data::{Drive, Echo, Moment, ReportData};

/// What one in a column of whole numbers stands for: a tenth of a millimetre, or 0.006°.
const UNIT: f64 = 1e-4;

/// Everything the script knows, besides the obstacles.
#[derive(Serialize)]
struct Packed {
    unit: f64,
    bounds: [[f64; 2]; 2],
    outer_wall: bool,
    /// Radius of the target, metres.
    target: f64,
    body: PackedBody,
    /// `[x, y, angle]` of each mount.
    beams: Vec<[f64; 3]>,
    range: f64,
    period: f64,
    drives: Vec<PackedDrive>,
}

#[derive(Serialize)]
struct PackedBody {
    length: f64,
    width: f64,
    front_overhang: f64,
    wheelbase: f64,
}

/// A drive in columns of whole numbers, in [`UNIT`].
#[derive(Serialize)]
struct PackedDrive {
    start: Vec<i64>,
    goal: Vec<i64>,
    verdict: String,
    kind: &'static str,
    lap: Option<usize>,
    x: Vec<i64>,
    y: Vec<i64>,
    heading: Vec<i64>,
    steer: Vec<i64>,
    step: Vec<i64>,
    /// Distances of all beams, moment by moment; the range where there is nothing.
    beams: Vec<i64>,
    /// What they hit, one digit each: 0 nothing, 1 wall, 2 target.
    hits: String,
    /// Moments that a move into an obstacle led to.
    collided: Vec<usize>,
}

/// JSON that can stand in a `script` element.
pub(super) fn json(data: &ReportData) -> String {
    let body = data.body;
    let packed = Packed {
        unit: UNIT,
        bounds: data.scene.bounds.map(|corner| corner.map(rounded)),
        outer_wall: data.scene.outer_wall,
        target: rounded(data.scene.target_radius),
        body: PackedBody {
            length: rounded(body.length),
            width: rounded(body.width),
            front_overhang: rounded(body.front_overhang),
            wheelbase: rounded(body.wheelbase),
        },
        beams: data.beams.iter().map(|b| [b.x, b.y, b.angle].map(rounded)).collect(),
        range: rounded(data.beam_range),
        // A period of 0 would make the replay end before it began.
        period: if data.period > 0.0 { f64::from(data.period) } else { 0.1 },
        drives: data.drives.iter().map(|drive| pack(drive, data.beam_range)).collect(),
    };
    let json = serde_json::to_string(&packed).unwrap_or_default();
    // In JSON `<` occurs inside strings only, and there this is the same character.
    json.replace('<', "\\u003c")
}

fn pack(drive: &Drive, range: f32) -> PackedDrive {
    let moments = &drive.moments;
    let column = |value: fn(&Moment) -> f32| moments.iter().map(|m| units(value(m))).collect();
    let readings = || moments.iter().flat_map(|m| m.beams);
    let distance = |echo| match echo {
        Echo::Nothing => range,
        Echo::Wall(distance) | Echo::Target(distance) => distance.min(range),
    };
    let digit = |echo| match echo {
        Echo::Nothing => '0',
        Echo::Wall(_) => '1',
        Echo::Target(_) => '2',
    };
    let collided = moments.iter().enumerate().filter(|(_, m)| m.collided);
    PackedDrive {
        start: drive.start.map(units).to_vec(),
        goal: drive.goal.map(units).to_vec(),
        verdict: drive.verdict(),
        kind: Kind::of(drive).class(),
        lap: drive.loop_period,
        x: column(|m| m.x),
        y: column(|m| m.y),
        heading: column(|m| m.heading),
        steer: column(|m| m.steer),
        step: column(|m| m.step),
        beams: readings().map(|echo| units(distance(echo))).collect(),
        hits: readings().map(digit).collect(),
        collided: collided.map(|(index, _)| index).collect(),
    }
}

/// In [`UNIT`]; what is not a number becomes 0.
fn units(value: f32) -> i64 {
    // The cast saturates and sends NaN to 0.
    (f64::from(value) / UNIT).round() as i64
}

/// To the same precision, as a decimal fraction.
fn rounded(value: f32) -> f64 {
    units(value) as f64 / 1e4
}
