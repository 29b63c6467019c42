//! A good blob, as a table and as JSON.

use controller_core::blob::{Header, SUMMATION_ORDER, VERSION};
use controller_core::observation::{BeamMount, DistanceLaw, TypeCode};
use serde::Serialize;

use super::layers::{Part, parts};
use super::self_test::SelfTest;
use crate::blob_file::BlobFile;
use crate::commands::blob_summary::BlobSummary;
use crate::output::Output;

/// Everything a blob says, in SI units; with `--json`, what is printed.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    file: String,
    accepted: bool,
    version: u16,
    #[serde(flatten)]
    summary: BlobSummary,
    /// First eight bytes of the SHA-256 of the resolved scenario, hexadecimal.
    scenario_hash: String,
    /// Version of the program that wrote the blob.
    tool: String,
    recurrence: String,
    biases: bool,
    activation: String,
    summation_order: u8,
    /// How distances become inputs.
    distance_law: DistanceLaw,
    /// How hit types become inputs.
    type_code: TypeCode,
    range: f32,
    steer_limit: f32,
    step_lower: f32,
    step_upper: f32,
    period: f32,
    wheelbase: f32,
    beams: Vec<BeamMount>,
    parts: Vec<Part>,
    self_tests: u8,
    self_test: &'static str,
    #[serde(skip)]
    self_test_sentence: String,
}

impl Report {
    pub(super) fn new(file: &BlobFile, self_test: &SelfTest) -> Self {
        let blob = file.blob();
        let Header { topology, activation, scaling, period, wheelbase, beams, .. } = *blob.header();
        let provenance = &blob.header().provenance;
        let [major, minor, patch] = provenance.tool;
        Self {
            file: file.path().display().to_string(),
            accepted: true,
            version: VERSION,
            summary: BlobSummary::of(file),
            scenario_hash: hexadecimal(&provenance.scenario_hash),
            tool: format!("{major}.{minor}.{patch}"),
            recurrence: topology.recurrence.to_string(),
            biases: topology.biases,
            activation: activation.to_string(),
            summation_order: SUMMATION_ORDER,
            distance_law: scaling.encoding.distance,
            type_code: scaling.encoding.types,
            range: scaling.range,
            steer_limit: scaling.steer_limit,
            step_lower: scaling.step_lower,
            step_upper: scaling.step_upper,
            period,
            wheelbase,
            beams: beams.to_vec(),
            parts: parts(topology, blob.weights()),
            self_tests: blob.header().self_tests,
            self_test: self_test.word(),
            self_test_sentence: self_test.to_string(),
        }
    }

    pub(super) fn print(&self, output: &mut Output) {
        let Self { summary, .. } = self;
        output.line(&self.file);
        let rows = [
            ("format", format!("version {}, {} bytes", self.version, summary.bytes)),
            ("check", summary.check.clone()),
            ("sha256", summary.sha256.clone()),
            ("network", summary.network().to_string()),
            (
                "activation",
                format!("{} tanh, summation order {}", self.activation, self.summation_order),
            ),
            ("trained", format!("{}, by evosteer {}", summary.origin(), self.tool)),
            ("scenario", format!("SHA-256 begins with {}", self.scenario_hash)),
            ("distances", self.distances()),
            ("hit types", type_code_in_words(self.type_code).to_owned()),
            ("steering", format!("±{} rad ({:.1}°)", self.steer_limit, degrees(self.steer_limit))),
            ("speed", self.speed()),
            ("wheelbase", format!("{} m", self.wheelbase)),
            ("self-test", format!("{} recorded; {}", self.self_tests, self.self_test_sentence)),
        ];
        for (label, value) in rows {
            output.line(format_args!("  {label:<10}  {value}"));
        }
        output.line("");
        output.line(format_args!("  {:<10} {:>8} {:>8} {:>8}", "beam", "x, m", "y, m", "angle, °"));
        for (number, BeamMount { x, y, angle }) in self.beams.iter().enumerate() {
            let angle = degrees(*angle);
            output.line(format_args!("  {number:<10} {x:>8.3} {y:>8.3} {angle:>8.1}"));
        }
        output.line("");
        output.line(format_args!(
            "  {:<32} {:>6} {:>11} {:>11} {:>11}",
            "weights", "count", "min", "max", "mean |w|"
        ));
        for Part { part, count, min, max, mean_abs } in &self.parts {
            output.line(format_args!(
                "  {part:<32} {count:>6} {min:>11.4} {max:>11.4} {mean_abs:>11.4}"
            ));
        }
        output.json(self);
    }

    fn distances(&self) -> String {
        match self.distance_law {
            DistanceLaw::Linear => format!("linear, up to {} m", self.range),
            DistanceLaw::Saturating { half } => {
                format!("saturating, one half at {half} m, up to {} m", self.range)
            }
        }
    }

    fn speed(&self) -> String {
        let Self { step_lower, step_upper, period, .. } = self;
        if step_lower.to_bits() == step_upper.to_bits() {
            format!("{step_upper} m every {period} s")
        } else {
            format!("{step_lower} to {step_upper} m every {period} s")
        }
    }
}

fn type_code_in_words(code: TypeCode) -> &'static str {
    match code {
        TypeCode::Any => "any: 1 if a beam ends on one",
        TypeCode::Nearest => "nearest: 1 for what the shortest beam ends on",
        TypeCode::Share => "share: the share of beams that end on one",
        TypeCode::NearestWallAnyTarget => "nearest-wall-any-target: wall as nearest, target as any",
        TypeCode::Bearing => {
            "bearing: side of the target, and 1 if a beam ends on it; the way there is free"
        }
    }
}

fn degrees(radians: f32) -> f64 {
    f64::from(radians).to_degrees()
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
