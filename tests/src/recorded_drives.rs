//! The drives in `firmware-example/recorded`, made anew from seeds.

use controller_core::activation::ActivationKind::{self, Libm, Micromath, Rational};
use controller_core::network::{Elman, Feedforward, Network, Recurrence, SelfLoop};
use controller_core::observation::{DistanceLaw, Encoding, INPUTS, TypeCode};

use crate::closed_loop::{HIDDEN, OUTPUTS};
use crate::drive::{Recorded, record};
use crate::random::Random;
use crate::weight_sets;

/// Every recorded drive under the name of its files.
pub fn all() -> [(&'static str, Recorded); 5] {
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
        ("self-rational", case::<SelfLoop>(5, Rational, saturating, TypeCode::Bearing, true)),
    ]
}

fn case<R: Recurrence>(
    seed: u64,
    activation: ActivationKind,
    distance: DistanceLaw,
    types: TypeCode,
    biases: bool,
) -> Recorded {
    let mut random = Random(seed);
    let topology = Network::<R, f32, INPUTS, HIDDEN, OUTPUTS>::topology(biases);
    let weights: Vec<f32> = (0..topology.weights()).map(|_| 1.5 * random.within_one()).collect();
    let self_tests = [(); 3].map(|()| weight_sets::self_test(&mut random));
    let encoding = Encoding { distance, types };
    let header = weight_sets::header(topology, activation, encoding, seed);
    record::<R>(&header, &weights, &self_tests)
}
