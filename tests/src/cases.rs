//! The drives in `firmware-example/recorded`, made anew from seeds.

use controller_core::activation::{Activation, Libm, Micromath, Rational};
use controller_core::blob::{Header, Provenance};
use controller_core::controller::Scaling;
use controller_core::network::{Elman, Feedforward, Network, Recurrence, SelfLoop, State};
use controller_core::observation::{DistanceLaw, Encoding, INPUTS, TypeCode};
use firmware_example::brain::{HIDDEN, OUTPUTS};
use firmware_example::room;

use crate::drive::{Recorded, record};

/// Every recorded drive under the name of its files.
pub fn all() -> [(&'static str, Recorded); 4] {
    let linear = DistanceLaw::Linear;
    let saturating = DistanceLaw::Saturating { half: 1.0 };
    [
        ("feedforward-rational", case::<Feedforward>(1, Rational, linear, TypeCode::Any, true)),
        ("self-libm", case::<SelfLoop>(2, Libm, saturating, TypeCode::Nearest, true)),
        ("elman-rational", case::<Elman>(3, Rational, saturating, TypeCode::Share, true)),
        (
            "elman-micromath",
            case::<Elman>(4, Micromath, linear, TypeCode::NearestWallAnyTarget, false),
        ),
    ]
}

fn case<R: Recurrence>(
    seed: u64,
    activation: impl Activation,
    distance: DistanceLaw,
    types: TypeCode,
    biases: bool,
) -> Recorded {
    let mut random = Random(seed);
    let topology = Network::<R, f32, INPUTS, HIDDEN, OUTPUTS>::topology(biases);
    let weights: Vec<f32> = (0..topology.weights()).map(|_| 1.5 * random.within_one()).collect();
    let self_tests = [(); 3].map(|()| {
        let inputs = [(); INPUTS].map(|()| 0.5 + 0.5 * random.within_one());
        let mut layer = || [(); HIDDEN].map(|()| random.within_one());
        (inputs, State { first: layer(), second: layer() })
    });
    let header = Header {
        topology,
        activation: activation.kind(),
        scaling: Scaling {
            encoding: Encoding { distance, types },
            range: room::RANGE,
            steer_limit: 0.5,
            step_lower: 0.02,
            step_upper: 0.1,
        },
        period: 0.05,
        wheelbase: room::WHEELBASE,
        beams: room::mounts(),
        self_tests: self_tests.len() as u8,
        provenance: Provenance {
            seed,
            generation: 0,
            scenario_hash: [0; 8],
            tool: [0, 1, 0],
            scenario: Provenance::stored_name("equivalence-tests room"),
        },
    };
    record::<R>(&header, activation, &weights, &self_tests)
}

/// SplitMix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    /// Uniform in `-1.0..1.0`, a multiple of 2⁻²³.
    fn within_one(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let bits = (mixed ^ (mixed >> 31)) >> 40;
        bits as f32 * (1.0 / 8_388_608.0) - 1.0
    }
}
