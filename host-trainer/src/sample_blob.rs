//! A small champion for tests, of any topology, with self-test triples that hold.

use controller_core::activation::ActivationKind;
use controller_core::blob::{Header, Provenance, encode};
use controller_core::controller::Scaling;
use controller_core::network::{Network, Recurrence, State};
use controller_core::observation::{BEAMS, BeamMount, Encoding, INPUTS};

/// What goes into a blob, free to be changed before it is encoded.
#[derive(Clone, Debug)]
pub(crate) struct SampleBlob {
    pub(crate) header: Header,
    pub(crate) weights: Vec<f32>,
    pub(crate) self_tests: Vec<f32>,
}

impl SampleBlob {
    /// Weights that step from −1.5 to 1.5 in a pattern, and two triples.
    pub(crate) fn new<R: Recurrence, const H: usize, const O: usize>(biases: bool) -> Self {
        let topology = Network::<R, f32, INPUTS, H, O>::topology(biases);
        let weights: Vec<f32> =
            (0..topology.weights()).map(|index| (index * 7 % 13) as f32 / 4.0 - 1.5).collect();
        let network = Network::<R, f32, INPUTS, H, O>::new(&weights, biases).unwrap();
        let mut self_tests = Vec::new();
        for inputs in [[0.25; INPUTS], [1.0, 0.5, 0.125, 0.5, 1.0, 1.0, 0.0]] {
            let mut state = State { first: [0.5; H], second: [-0.25; H] };
            self_tests.extend(inputs.iter().chain(&state.first).chain(&state.second));
            self_tests.extend(network.step(ActivationKind::Rational, &mut state, &inputs));
        }
        let angles = [-30.0, -15.0, 0.0, 15.0, 30.0_f32].map(f32::to_radians);
        let mut beams = [BeamMount::default(); BEAMS];
        for (beam, angle) in beams.iter_mut().zip(angles) {
            beam.angle = angle;
        }
        let header = Header {
            topology,
            activation: ActivationKind::Rational,
            scaling: Scaling {
                encoding: Encoding::default(),
                range: 10.0,
                steer_limit: 0.5,
                step_lower: 0.1,
                step_upper: 0.1,
            },
            period: 0.1,
            wheelbase: 0.3,
            beams,
            self_tests: 2,
            provenance: Provenance {
                seed: 42,
                generation: 59,
                scenario_hash: [0xa0, 0xa1, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7],
                tool: [0, 1, 0],
                scenario: Provenance::stored_name("obstacles"),
            },
        };
        Self { header, weights, self_tests }
    }

    /// The blob's bytes.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut words = vec![0_u32; self.header.blob_len().div_ceil(4)];
        let room: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
        let length = encode(&self.header, &self.weights, &self.self_tests, room).unwrap();
        room[..length].to_vec()
    }
}
