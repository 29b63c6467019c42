//! What the golden blobs hold: numbers from short formulas, all of them exact in `f32`.

use crate::buffer::Buffer;
use controller_core::activation::ActivationKind;
use controller_core::blob::{Header, Provenance};
use controller_core::controller::Scaling;
use controller_core::network::{
    Elman, Feedforward, Network, Recurrence, RecurrenceKind, SelfLoop, State, Topology,
};
use controller_core::observation::{BeamMount, DistanceLaw, Encoding, TypeCode};

/// Triples in each golden blob.
const TRIPLES: usize = 3;

/// One golden blob.
pub(crate) struct Case {
    /// Its file is `golden/v1/{name}.blob`.
    pub(crate) name: &'static str,
    pub(crate) header: Header,
    pub(crate) weights: Vec<f32>,
    pub(crate) self_tests: Vec<f32>,
}

impl Case {
    pub(crate) fn encoded(&self) -> Buffer {
        Buffer::encoded(&self.header, &self.weights, &self.self_tests)
    }
}

/// Weight `i` of every golden blob, within ±0.79.
pub(crate) fn weight(i: usize) -> f32 {
    ((i * 37 % 101) as f32 - 50.0) / 64.0
}

/// The header from which all cases depart.
pub(crate) fn header(recurrence: RecurrenceKind) -> Header {
    let topology = Topology { inputs: 7, hidden: 12, outputs: 1, recurrence, biases: true };
    let mount = |degrees: f32| BeamMount { x: 0.0, y: 0.0, angle: degrees.to_radians() };
    Header {
        topology,
        activation: ActivationKind::Rational,
        scaling: Scaling {
            encoding: Encoding { distance: DistanceLaw::Linear, types: TypeCode::Any },
            range: 10.0,
            steer_limit: 0.5,
            step_lower: 0.1,
            step_upper: 0.1,
        },
        period: 0.1,
        wheelbase: 0.3,
        beams: [-30.0, -15.0, 0.0, 15.0, 30.0].map(mount),
        self_tests: TRIPLES as u8,
        provenance: Provenance {
            seed: 0x0123_4567_89ab_cdef,
            generation: 60,
            scenario_hash: *b"\x01\x23\x45\x67\x89\xab\xcd\xef",
            tool: [0, 1, 0],
            scenario: Provenance::stored_name("golden"),
        },
    }
}

fn case<R: Recurrence, const H: usize, const O: usize>(name: &'static str, header: Header) -> Case {
    let weights: Vec<f32> = (0..header.topology.weights()).map(weight).collect();
    let network = Network::<R, f32, 7, H, O>::new(&weights, header.topology.biases).unwrap();
    let mut self_tests = Vec::new();
    for triple in 0..TRIPLES {
        let input: [f32; 7] = std::array::from_fn(|i| ((29 * triple + 13 * i) % 64) as f32 / 64.0);
        let remembered = |layer: usize| {
            std::array::from_fn(|i| {
                ((41 * triple + 17 * i + 59 * layer) % 127) as f32 / 64.0 - 63.0 / 64.0
            })
        };
        let mut state: State<f32, H> = State { first: remembered(0), second: remembered(1) };
        self_tests.extend(input);
        self_tests.extend(state.first);
        self_tests.extend(state.second);
        self_tests.extend(network.step(header.activation, &mut state, &input));
    }
    Case { name, header, weights, self_tests }
}

/// Every golden blob of format version 1.
pub(crate) fn all() -> [Case; 8] {
    let plain = header(RecurrenceKind::Feedforward);
    let two_outputs = Header {
        topology: Topology { outputs: 2, ..plain.topology },
        scaling: Scaling { step_lower: 0.0625, step_upper: 0.25, ..plain.scaling },
        ..plain
    };
    let no_biases = Header {
        topology: Topology { biases: false, ..plain.topology },
        scaling: Scaling {
            encoding: Encoding { distance: DistanceLaw::Linear, types: TypeCode::Nearest },
            ..plain.scaling
        },
        ..plain
    };
    let saturating = Header {
        activation: ActivationKind::Libm,
        scaling: Scaling {
            encoding: Encoding {
                distance: DistanceLaw::Saturating { half: 1.5 },
                types: TypeCode::Share,
            },
            ..plain.scaling
        },
        ..plain
    };
    let bearing = Header {
        scaling: Scaling {
            encoding: Encoding {
                distance: DistanceLaw::Saturating { half: 0.5 },
                types: TypeCode::Bearing,
            },
            ..plain.scaling
        },
        ..header(RecurrenceKind::SelfLoop)
    };
    let wide = Header {
        topology: Topology { hidden: 24, ..plain.topology },
        activation: ActivationKind::Micromath,
        scaling: Scaling {
            encoding: Encoding {
                distance: DistanceLaw::Linear,
                types: TypeCode::NearestWallAnyTarget,
            },
            ..plain.scaling
        },
        ..plain
    };
    [
        case::<Feedforward, 12, 1>("feedforward", plain),
        case::<SelfLoop, 12, 1>("self", header(RecurrenceKind::SelfLoop)),
        case::<Elman, 12, 1>("elman", header(RecurrenceKind::Elman)),
        case::<Feedforward, 12, 2>("two-outputs", two_outputs),
        case::<Feedforward, 12, 1>("no-biases", no_biases),
        case::<Feedforward, 12, 1>("saturating-libm", saturating),
        case::<Feedforward, 24, 1>("wide-micromath", wide),
        case::<SelfLoop, 12, 1>("self-bearing", bearing),
    ]
}

/// The smallest case, for checks whose cost grows with the square of the length.
pub(crate) fn smallest() -> Case {
    all().into_iter().min_by_key(|case| case.header.blob_len()).unwrap()
}

/// One case by name.
pub(crate) fn named(name: &str) -> Case {
    all().into_iter().find(|case| case.name == name).unwrap()
}
