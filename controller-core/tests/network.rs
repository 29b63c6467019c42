//! The forward pass against numbers worked out elsewhere, and against itself in lanes.

use controller_core::activation::{ActivationKind, Libm, Rational};
use controller_core::lane::Lanes;
use controller_core::network::{
    Elman, Feedforward, Network, Recurrence, SelfLoop, State, Topology, WrongLength,
};

/// A simple repeatable source of numbers in -1..1: the top bits of a Weyl sequence.
fn numbers(count: usize, seed: u32) -> Vec<f32> {
    (0..count as u32)
        .map(|i| {
            let mixed = (i ^ seed.rotate_left(16)).wrapping_mul(0x9e37_79b9).rotate_left(9);
            (mixed.wrapping_mul(0x85eb_ca6b) >> 8) as f32 / 8_388_608.0 - 1.0
        })
        .collect()
}

#[test]
fn one_path_through_a_feedforward_network_is_three_nested_tanh() {
    // Input 2 feeds hidden neuron 0, which feeds second-layer neuron 0, which feeds the output.
    let mut genome = [0.0f32; 265];
    let (w1, b1, w2) = (2 * 12, 7 * 12, 7 * 12 + 12);
    let (b2, w3) = (w2 + 144, w2 + 144 + 12);
    let b3 = w3 + 12;
    genome[w1] = 0.5;
    genome[b1] = -0.25;
    genome[w2] = 1.5;
    genome[b2] = 0.125;
    genome[w3] = -2.0;
    genome[b3] = 0.75;
    let network = Network::<Feedforward, f32, 7, 12, 1>::new(&genome, true).unwrap();
    let mut state = State::reset();
    let [out] = network.step(Libm, &mut state, &[9.0, 9.0, 0.8, 9.0, 9.0, 9.0, 9.0]);
    // In 30 digits: tanh(0.15) = 0.148885033623318, tanh(0.34832755...) = 0.334894...,
    // tanh(0.75 - 2*0.334...) = 0.0800...
    let h1 = libm::tanh(0.5 * 0.8 - 0.25);
    let h2 = libm::tanh(1.5 * h1 + 0.125);
    let expected = libm::tanh(0.75 - 2.0 * h2);
    assert!((f64::from(out) - expected).abs() < 1e-6, "{out} against {expected}");
    assert!((f64::from(state.first[0]) - 0.148_885_033_623_318).abs() < 1e-7);
}

/// The network written out the slow way in `f64`, row by row, for any recurrence.
fn reference(
    topology: Topology,
    genome: &[f32],
    state: &mut (Vec<f64>, Vec<f64>),
    input: &[f64],
) -> Vec<f64> {
    fn layer(
        genome: &mut impl Iterator<Item = f64>,
        topology: Topology,
        input: &[f64],
        width: usize,
        memory: Option<&mut Vec<f64>>,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; width];
        for value in input {
            for sum in &mut sums {
                *sum += genome.next().unwrap() * value;
            }
        }
        if let Some(memory) = &memory {
            match topology.recurrence.weights(width) {
                0 => {}
                n if n == width => {
                    for (sum, previous) in sums.iter_mut().zip(memory.iter()) {
                        *sum += genome.next().unwrap() * previous;
                    }
                }
                _ => {
                    for previous in memory.iter() {
                        for sum in &mut sums {
                            *sum += genome.next().unwrap() * previous;
                        }
                    }
                }
            }
        }
        if topology.biases {
            for sum in &mut sums {
                *sum += genome.next().unwrap();
            }
        }
        let out: Vec<f64> = sums.iter().map(|sum| libm::tanh(*sum)).collect();
        if let Some(memory) = memory {
            memory.clone_from(&out);
        }
        out
    }
    let mut genes = genome.iter().map(|gene| f64::from(*gene));
    let hidden = usize::from(topology.hidden);
    let first = layer(&mut genes, topology, input, hidden, Some(&mut state.0));
    let second = layer(&mut genes, topology, &first, hidden, Some(&mut state.1));
    layer(&mut genes, topology, &second, usize::from(topology.outputs), None)
}

fn agrees_with_reference<R: Recurrence, const H: usize, const O: usize>(biases: bool) {
    let topology = Network::<R, f32, 7, H, O>::topology(biases);
    let genome: Vec<f32> =
        numbers(topology.weights(), 7).iter().map(|weight| weight * 0.6).collect();
    let network = Network::<R, f32, 7, H, O>::new(&genome, biases).unwrap();
    let mut state = State::reset();
    let mut slow = (vec![0.0; H], vec![0.0; H]);
    for step in 0..40 {
        let input: [f32; 7] = numbers(7, 100 + step).try_into().unwrap();
        let fast = network.step(Libm, &mut state, &input);
        let exact = reference(topology, &genome, &mut slow, &input.map(f64::from));
        for (fast, exact) in fast.iter().zip(exact) {
            assert!((f64::from(*fast) - exact).abs() < 2e-5, "{topology}, step {step}");
        }
    }
}

#[test]
fn every_recurrence_size_and_bias_agrees_with_the_textbook_in_double_precision() {
    for biases in [false, true] {
        agrees_with_reference::<Feedforward, 12, 1>(biases);
        agrees_with_reference::<SelfLoop, 12, 1>(biases);
        agrees_with_reference::<Elman, 12, 1>(biases);
        agrees_with_reference::<Feedforward, 12, 2>(biases);
        agrees_with_reference::<Elman, 32, 2>(biases);
        agrees_with_reference::<SelfLoop, 24, 1>(biases);
    }
}

fn lanes_equal_scalars<R: Recurrence>(activation: ActivationKind) {
    const N: usize = 8;
    let length = Network::<R, f32, 7, 12, 2>::topology(true).weights();
    let genomes: [Vec<f32>; N] = core::array::from_fn(|lane| numbers(length, lane as u32));
    let wide_genome: Vec<Lanes<N>> =
        (0..length).map(|i| Lanes(core::array::from_fn(|lane| genomes[lane][i]))).collect();
    // Lanes as individuals: weights differ per lane. Lanes as episodes: weights are shared.
    let individuals = Network::<R, Lanes<N>, 7, 12, 2>::new(&wide_genome, true).unwrap();
    let shared = Network::<R, f32, 7, 12, 2>::new(&genomes[0], true).unwrap();
    let mut wide = (State::reset(), State::reset());
    let mut scalar: [_; N] = core::array::from_fn(|_| (State::reset(), State::reset()));
    for step in 0..50 {
        let inputs: [[f32; 7]; N] =
            core::array::from_fn(|lane| numbers(7, step * 8 + lane as u32).try_into().unwrap());
        let wide_inputs: [Lanes<N>; 7] =
            core::array::from_fn(|i| Lanes(core::array::from_fn(|lane| inputs[lane][i])));
        let a = individuals.step(activation, &mut wide.0, &wide_inputs);
        let b = shared.step(activation, &mut wide.1, &wide_inputs);
        for lane in 0..N {
            let own = Network::<R, f32, 7, 12, 2>::new(&genomes[lane], true).unwrap();
            let x = own.step(activation, &mut scalar[lane].0, &inputs[lane]);
            let y = shared.step(activation, &mut scalar[lane].1, &inputs[lane]);
            for o in 0..2 {
                assert_eq!(a[o].0[lane].to_bits(), x[o].to_bits(), "individual, step {step}");
                assert_eq!(b[o].0[lane].to_bits(), y[o].to_bits(), "episode, step {step}");
            }
        }
    }
}

#[test]
fn a_lane_of_a_wide_network_is_the_scalar_network_bit_for_bit() {
    for kind in [ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath] {
        lanes_equal_scalars::<Feedforward>(kind);
        lanes_equal_scalars::<SelfLoop>(kind);
        lanes_equal_scalars::<Elman>(kind);
    }
}

#[test]
fn a_network_without_biases_is_one_with_zero_biases() {
    let bare = numbers(240, 3);
    let mut with_zeros = bare[..84].to_vec();
    with_zeros.extend([0.0; 12]);
    with_zeros.extend(&bare[84..228]);
    with_zeros.extend([0.0; 12]);
    with_zeros.extend(&bare[228..]);
    with_zeros.push(0.0);
    let input = [0.1, 0.9, 0.4, 1.0, 0.0, 1.0, 0.0];
    let a = Network::<Feedforward, f32, 7, 12, 1>::new(&bare, false).unwrap();
    let b = Network::<Feedforward, f32, 7, 12, 1>::new(&with_zeros, true).unwrap();
    let (mut s, mut t) = (State::reset(), State::reset());
    assert_eq!(a.step(Rational, &mut s, &input), b.step(Rational, &mut t, &input));
    assert_eq!(s, t);
}

#[test]
fn a_genome_of_another_length_is_refused_with_both_lengths() {
    let refused = Network::<Feedforward, f32, 7, 12, 1>::new(&[0.0; 264], true).unwrap_err();
    assert_eq!(refused, WrongLength { found: 264, expected: 265 });
    assert_eq!(refused.to_string(), "264 weights given, the network has 265");
}

#[test]
fn genome_lengths_are_the_papers_and_the_textbooks() {
    let lengths = [false, true].map(|biases| {
        [
            Network::<Feedforward, f32, 7, 12, 1>::topology(biases).weights(),
            Network::<SelfLoop, f32, 7, 12, 1>::topology(biases).weights(),
            Network::<Elman, f32, 7, 12, 1>::topology(biases).weights(),
            Network::<Feedforward, f32, 7, 12, 2>::topology(biases).weights(),
        ]
    });
    assert_eq!(lengths, [[240, 264, 528, 252], [265, 289, 553, 278]]);
}
