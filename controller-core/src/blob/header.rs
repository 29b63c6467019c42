//! The 176 bytes before the weights.

use super::read::{Reader, Writer};
use super::{CHECK_BYTES, HEADER_BYTES, MAGIC, SUMMATION_ORDER, VERSION};
use crate::activation::ActivationKind;
use crate::controller::Scaling;
use crate::network::{RecurrenceKind, Topology};
use crate::observation::{BEAMS, BeamMount, DistanceLaw, Encoding, INPUTS, TypeCode};
use core::f32::consts::{FRAC_PI_2, PI};

/// Longest scenario name that fits, bytes of UTF-8.
pub const NAME_BYTES: usize = 32;

/// What a blob says about itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Header {
    /// Sizes and kind of the network.
    pub topology: Topology,
    /// The tanh it was trained with.
    pub activation: ActivationKind,
    /// How inputs and outputs relate to the car.
    pub scaling: Scaling,
    /// Control period in seconds, above 0.
    pub period: f32,
    /// Wheelbase of the simulated car in metres, above 0.
    pub wheelbase: f32,
    /// Beam mounts of the simulated car, rightmost first.
    pub beams: [BeamMount; BEAMS],
    /// Self-test triples after the weights.
    pub self_tests: u8,
    /// Where the weights come from.
    pub provenance: Provenance,
}

/// Where weights come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Provenance {
    /// Seed of the run.
    pub seed: u64,
    /// Generation the champion was found in.
    pub generation: u32,
    /// First eight bytes of the SHA-256 of the run's resolved scenario.
    pub scenario_hash: [u8; 8],
    /// Version of the program that wrote the blob: major, minor, patch.
    pub tool: [u16; 3],
    /// Name of the scenario, UTF-8, padded with zeros.
    pub scenario: [u8; NAME_BYTES],
}

impl Provenance {
    /// The scenario's name as text.
    pub fn scenario_name(&self) -> &str {
        let name = match self.scenario.iter().position(|byte| *byte == 0) {
            Some(end) => self.scenario.get(..end).unwrap_or_default(),
            None => &self.scenario,
        };
        core::str::from_utf8(name).unwrap_or_default()
    }

    /// A name as it is stored, cut to [`NAME_BYTES`] at a character's boundary.
    pub fn stored_name(name: &str) -> [u8; NAME_BYTES] {
        let mut stored = [0; NAME_BYTES];
        let end = name.floor_char_boundary(NAME_BYTES);
        for (slot, byte) in stored.iter_mut().zip(name.as_bytes().iter().take(end)) {
            *slot = *byte;
        }
        stored
    }
}

/// A header field that no writer of this version stores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeaderError {
    /// A code without a meaning.
    Code {
        /// The field.
        field: &'static str,
        /// Its value.
        value: u8,
    },
    /// A number outside the field's range.
    Number {
        /// The field.
        field: &'static str,
        /// Its value.
        value: f32,
    },
    /// The header's own length.
    HeaderLength {
        /// What it says.
        found: u16,
    },
    /// Padding that is not zero.
    Padding,
    /// The scenario's name is not UTF-8 padded with zeros.
    Name,
}

crate::sentences! { HeaderError {
    Self::Code { field, value } => "unknown {} {} in the header", field, value;
    Self::Number { field, value } => "{} in the header is {}, outside its range", field, value;
    Self::HeaderLength { found } => "a header of {} bytes, {} expected", found, HEADER_BYTES;
    Self::Padding => "padding in the header is not zero";
    Self::Name => "the scenario's name in the header is not padded UTF-8";
} }

impl core::error::Error for HeaderError {}

/// Tables from code to meaning; the position is the code.
const RECURRENCES: [RecurrenceKind; 3] =
    [RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman];
const ACTIVATIONS: [ActivationKind; 3] =
    [ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath];
const TYPE_CODES: [TypeCode; 5] = [
    TypeCode::Any,
    TypeCode::Nearest,
    TypeCode::Share,
    TypeCode::NearestWallAnyTarget,
    TypeCode::Bearing,
];

fn code_of<T: PartialEq>(table: &[T], value: &T) -> u8 {
    table.iter().position(|entry| entry == value).map_or(u8::MAX, |code| code as u8)
}

fn meaning_of<T: Copy>(table: &[T], field: &'static str, value: u8) -> Result<T, HeaderError> {
    table.get(usize::from(value)).copied().ok_or(HeaderError::Code { field, value })
}

fn number(
    field: &'static str,
    value: f32,
    holds: impl FnOnce(f32) -> bool,
) -> Result<f32, HeaderError> {
    if value.is_finite() && holds(value) {
        Ok(value)
    } else {
        Err(HeaderError::Number { field, value })
    }
}

impl Header {
    /// Words of one self-test triple: inputs, both hidden layers before, outputs.
    pub fn self_test_words(&self) -> usize {
        let Topology { inputs, hidden, outputs, .. } = self.topology;
        usize::from(inputs) + 2 * usize::from(hidden) + usize::from(outputs)
    }

    /// Bytes of the whole blob.
    pub fn blob_len(&self) -> usize {
        let words = self.topology.weights() + usize::from(self.self_tests) * self.self_test_words();
        HEADER_BYTES + 4 * words + CHECK_BYTES
    }

    pub(super) fn encode(&self, out: &mut [u8; HEADER_BYTES]) {
        let Topology { inputs, hidden, outputs, recurrence, biases } = self.topology;
        let Scaling { encoding, range, steer_limit, step_lower, step_upper } = self.scaling;
        let (law, half) = match encoding.distance {
            DistanceLaw::Linear => (0, 0.0),
            DistanceLaw::Saturating { half } => (1, half),
        };
        let mut w = Writer::new(out);
        w.put(&MAGIC);
        w.put(&VERSION.to_le_bytes());
        w.put(&(HEADER_BYTES as u16).to_le_bytes());
        w.put(&(self.blob_len() as u32).to_le_bytes());
        w.put(&[inputs, hidden, outputs, code_of(&RECURRENCES, &recurrence)]);
        let activation = code_of(&ACTIVATIONS, &self.activation);
        w.put(&[u8::from(biases), activation, SUMMATION_ORDER, BEAMS as u8]);
        w.put(&[law, code_of(&TYPE_CODES, &encoding.types), self.self_tests, 0]);
        for value in [half, range, steer_limit, step_lower, step_upper, self.period, self.wheelbase]
        {
            w.put(&value.to_le_bytes());
        }
        for BeamMount { x, y, angle } in self.beams {
            for value in [x, y, angle] {
                w.put(&value.to_le_bytes());
            }
        }
        let Provenance { seed, generation, scenario_hash, tool, scenario } = &self.provenance;
        w.put(&generation.to_le_bytes());
        w.put(&seed.to_le_bytes());
        w.put(scenario_hash);
        for part in tool {
            w.put(&part.to_le_bytes());
        }
        w.put(&[0, 0]);
        w.put(scenario);
    }

    pub(super) fn decode(bytes: &[u8; HEADER_BYTES]) -> Result<Self, HeaderError> {
        // The reader cannot run out: the fields add up to HEADER_BYTES.
        Self::fields(&mut Reader::new(bytes)).unwrap_or(Err(HeaderError::Padding))
    }

    fn fields(r: &mut Reader<'_>) -> Option<Result<Self, HeaderError>> {
        r.array::<8>()?;
        r.u16()?;
        let header_length = r.u16()?;
        r.u32()?;
        let [inputs, hidden, outputs, recurrence] = r.array()?;
        let [biases, activation, summation, beam_count] = r.array()?;
        let [law, types, self_tests, padding] = r.array()?;
        let [half, range, steer_limit, step_lower, step_upper, period, wheelbase] =
            [r.f32()?, r.f32()?, r.f32()?, r.f32()?, r.f32()?, r.f32()?, r.f32()?];
        let mut beams = [BeamMount::default(); BEAMS];
        for beam in &mut beams {
            *beam = BeamMount { x: r.f32()?, y: r.f32()?, angle: r.f32()? };
        }
        let generation = r.u32()?;
        let seed = r.u64()?;
        let scenario_hash = r.array()?;
        let tool = [r.u16()?, r.u16()?, r.u16()?];
        let more_padding = r.u16()?;
        let scenario = r.array()?;
        Some((|| {
            if usize::from(header_length) != HEADER_BYTES {
                return Err(HeaderError::HeaderLength { found: header_length });
            }
            exactly("number of inputs", inputs, INPUTS as u8)?;
            exactly("number of beams", beam_count, BEAMS as u8)?;
            exactly("summation order", summation, SUMMATION_ORDER)?;
            one_of("hidden layer width", hidden, 1..=u8::MAX)?;
            one_of("number of outputs", outputs, 1..=2)?;
            one_of("biases flag", biases, 0..=1)?;
            if padding != 0 || more_padding != 0 {
                return Err(HeaderError::Padding);
            }
            let topology = Topology {
                inputs,
                hidden,
                outputs,
                recurrence: meaning_of(&RECURRENCES, "recurrence", recurrence)?,
                biases: biases == 1,
            };
            let distance = match law {
                0 => {
                    number("half distance", half, |v| v.to_bits() == 0)?;
                    DistanceLaw::Linear
                }
                1 => DistanceLaw::Saturating { half: number("half distance", half, |v| v > 0.0)? },
                value => return Err(HeaderError::Code { field: "distance law", value }),
            };
            let encoding =
                Encoding { distance, types: meaning_of(&TYPE_CODES, "type code", types)? };
            let scaling = Scaling {
                encoding,
                range: number("beam range", range, |v| v > 0.0)?,
                steer_limit: number("steer limit", steer_limit, |v| v > 0.0 && v <= FRAC_PI_2)?,
                step_lower: number("lower step", step_lower, |v| v >= 0.0)?,
                step_upper: number("upper step", step_upper, |v| v > 0.0 && v >= step_lower)?,
            };
            for beam in &beams {
                number("beam mount x", beam.x, |_| true)?;
                number("beam mount y", beam.y, |_| true)?;
                number("beam angle", beam.angle, |v| (-PI..=PI).contains(&v))?;
            }
            let provenance = Provenance { seed, generation, scenario_hash, tool, scenario };
            let name = provenance.scenario_name();
            if Provenance::stored_name(name) != scenario {
                return Err(HeaderError::Name);
            }
            Ok(Self {
                topology,
                activation: meaning_of(&ACTIVATIONS, "activation", activation)?,
                scaling,
                period: number("control period", period, |v| v > 0.0)?,
                wheelbase: number("wheelbase", wheelbase, |v| v > 0.0)?,
                beams,
                self_tests,
                provenance,
            })
        })())
    }
}

fn exactly(field: &'static str, value: u8, expected: u8) -> Result<(), HeaderError> {
    one_of(field, value, expected..=expected)
}

fn one_of(
    field: &'static str,
    value: u8,
    allowed: core::ops::RangeInclusive<u8>,
) -> Result<(), HeaderError> {
    if allowed.contains(&value) { Ok(()) } else { Err(HeaderError::Code { field, value }) }
}
