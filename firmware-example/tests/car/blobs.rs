//! Weights for the car of [`crate::hardware::calibration`].

use controller_core::activation::ActivationKind;
use controller_core::blob::{self, Header, Provenance};
use controller_core::controller::Scaling;
use controller_core::network::{Network, Recurrence, Topology};
use controller_core::observation::{Encoding, INPUTS};
use firmware_example::calibration::Calibration;

/// Bytes at a multiple of 4, as flash has them, longer than any blob here.
pub(crate) type Region = Box<blob::Aligned<[u8; 8192]>>;

/// How far the weights see, metres.
pub(crate) const RANGE: f32 = 1.0;

/// Erased flash.
pub(crate) fn erased() -> Region {
    Box::new(blob::Aligned([0xff; 8192]))
}

/// The topology of a network with this recurrence.
pub(crate) fn topology<R: Recurrence>() -> Topology {
    Network::<R, f32, INPUTS, 12, 1>::topology(true)
}

/// A header that fits the car: 0.05 s, 1 m/s, 0.5 rad, [`RANGE`].
pub(crate) fn header(topology: Topology) -> Header {
    let car = Calibration::UNFITTED;
    Header {
        topology,
        activation: ActivationKind::Rational,
        scaling: Scaling {
            encoding: Encoding::default(),
            range: RANGE,
            steer_limit: 0.5,
            step_lower: 0.02,
            step_upper: 0.05,
        },
        period: 0.05,
        wheelbase: car.wheelbase,
        beams: car.beams,
        self_tests: 0,
        provenance: Provenance {
            seed: 1,
            generation: 0,
            scenario_hash: [0; 8],
            tool: [0, 1, 0],
            scenario: Provenance::stored_name("test bench"),
        },
    }
}

/// A region that begins with a blob of made-up weights and is erased behind it.
pub(crate) fn region(header: &Header) -> Region {
    let mut random = 12_345u32;
    let weights: Vec<f32> = (0..header.topology.weights())
        .map(|_| {
            // Numerical Recipes' generator; its upper half as a number within ±1.
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f32::from((random >> 16) as u16) / 32_768.0 - 1.0
        })
        .collect();
    let mut region = erased();
    blob::encode(header, &weights, &[], &mut region.0).expect("a good blob");
    region
}
