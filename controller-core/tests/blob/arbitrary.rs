//! Headers, weights and readings nobody thought of.

use crate::buffer::Buffer;
use crate::cases::{Case, all, named};
use controller_core::activation::ActivationKind;
use controller_core::blob::{Blob, Header, Provenance};
use controller_core::control_loop::Decide;
use controller_core::controller::{Command, Controller, Scaling};
use controller_core::network::{
    Elman, Feedforward, Recurrence, RecurrenceKind, SelfLoop, Topology,
};
use controller_core::observation::{BeamMount, DistanceLaw, Echo, Encoding, Reading, TypeCode};
use proptest::prelude::*;
use proptest::sample::select;

fn positive() -> impl Strategy<Value = f32> {
    prop_oneof![0.001f32..100.0, Just(f32::MIN_POSITIVE), Just(f32::MAX), Just(f32::from_bits(1))]
}

fn topologies() -> impl Strategy<Value = Topology> {
    let recurrences =
        select(vec![RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman]);
    (1u8..=40, 1u8..=2, recurrences, any::<bool>()).prop_map(
        |(hidden, outputs, recurrence, biases)| Topology {
            inputs: 7,
            hidden,
            outputs,
            recurrence,
            biases,
        },
    )
}

fn scalings() -> impl Strategy<Value = Scaling> {
    let law = prop_oneof![
        Just(DistanceLaw::Linear),
        positive().prop_map(|half| DistanceLaw::Saturating { half })
    ];
    let types = select(vec![
        TypeCode::Any,
        TypeCode::Nearest,
        TypeCode::Share,
        TypeCode::NearestWallAnyTarget,
        TypeCode::Bearing,
    ]);
    (law, types, positive(), 0.001f32..=std::f32::consts::FRAC_PI_2, positive(), 0.0f32..=1.0)
        .prop_map(|(distance, types, range, steer_limit, step_upper, share)| Scaling {
            encoding: Encoding { distance, types },
            range,
            steer_limit,
            step_lower: step_upper * share,
            step_upper,
        })
}

fn headers() -> impl Strategy<Value = Header> {
    let kinds =
        select(vec![ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath]);
    let mount = (-1.0e3f32..1.0e3, -1.0f32..1.0, -3.1f32..3.1)
        .prop_map(|(x, y, angle)| BeamMount { x, y, angle });
    let provenance = (any::<u64>(), any::<u32>(), any::<[u8; 8]>(), any::<[u16; 3]>(), ".{0,40}");
    (
        topologies(),
        kinds,
        scalings(),
        positive(),
        positive(),
        [mount.clone(), mount.clone(), mount.clone(), mount.clone(), mount],
        0u8..4,
        provenance,
    )
        .prop_map(
            |(topology, activation, scaling, period, wheelbase, beams, self_tests, p)| {
                let (seed, generation, scenario_hash, tool, name) = p;
                let scenario = Provenance::stored_name(&name.replace('\0', "0"));
                Header {
                    topology,
                    activation,
                    scaling,
                    period,
                    wheelbase,
                    beams,
                    self_tests,
                    provenance: Provenance { seed, generation, scenario_hash, tool, scenario },
                }
            },
        )
}

/// Weights of a header: mostly ordinary, some at the limit, some tiny.
fn weights(header: &Header, salt: u32) -> Vec<f32> {
    (0..header.topology.weights() as u32)
        .map(|i| {
            let mixed =
                (i ^ salt).wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b);
            let ordinary = (mixed >> 8) as f32 / 8_388_608.0 - 1.0;
            match mixed % 16 {
                0 => 1.0e6f32.copysign(ordinary),
                1 => ordinary * 1.0e-42,
                2 => ordinary * 100.0,
                _ => ordinary,
            }
        })
        .collect()
}

proptest! {
    #[test]
    fn any_valid_header_survives_the_round_trip(header in headers(), salt: u32) {
        let weights = weights(&header, salt);
        let triples = vec![0.5; usize::from(header.self_tests) * header.self_test_words()];
        let bytes = Buffer::encoded(&header, &weights, &triples);
        let blob = Blob::parse(&bytes).unwrap();
        prop_assert_eq!(blob.header(), &header);
        prop_assert_eq!(blob.weights(), &weights[..]);
    }

    #[test]
    fn random_bytes_are_refused_without_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        let mut bytes = Buffer::from_bytes(&bytes);
        prop_assert!(Blob::parse(&bytes).is_err());
        if bytes.len() >= 24 {
            let len = bytes.len() as u32;
            bytes[..12].copy_from_slice(b"EVOSTEER\x01\0\xb0\0");
            bytes[12..16].copy_from_slice(&len.to_le_bytes());
            bytes.repair();
            // Whatever it says: no panic.
            let _ = Blob::parse(&bytes);
        }
    }
}

/// What a fuzzer would write into a header field.
fn mutations() -> impl Strategy<Value = Vec<(usize, Vec<u8>)>> {
    let byte = (8usize..176, any::<u8>()).prop_map(|(at, value)| (at, vec![value]));
    let code = (16usize..28, 0u8..26).prop_map(|(at, value)| (at, vec![value]));
    let word = (7usize..29, any::<u32>()).prop_map(|(at, v)| (4 * at, v.to_le_bytes().to_vec()));
    let number = (7usize..29, prop_oneof![positive(), -4.0f32..4.0])
        .prop_map(|(at, v)| (4 * at, v.to_le_bytes().to_vec()));
    prop::collection::vec(prop_oneof![byte, code, word, number], 1..4)
}

/// Re-encodes an accepted blob.
fn encoded_again(blob: &Blob<'_>, bytes: &[u8]) -> Buffer {
    let header = blob.header();
    let start = 176 + 4 * blob.weights().len();
    let triples: Vec<f32> = bytes[start..bytes.len() - 8]
        .chunks_exact(4)
        .map(|word| f32::from_le_bytes(word.try_into().unwrap()))
        .collect();
    Buffer::encoded(header, blob.weights(), &triples)
}

#[test]
fn an_accepted_header_re_encodes_to_the_same_bytes_and_drives_safely() {
    let cases = all();
    let config = ProptestConfig { cases: 20_000, failure_persistence: None, ..Default::default() };
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let accepted = std::cell::Cell::new(0);
    runner
        .run(&(0..cases.len(), mutations(), any::<u32>()), |(case, mutations, salt)| {
            let mut bytes = cases[case].encoded();
            for (at, value) in &mutations {
                let end = (at + value.len()).min(176);
                bytes[*at..end].copy_from_slice(&value[..end - at]);
            }
            bytes.repair();
            if let Ok(blob) = Blob::parse(&bytes) {
                accepted.set(accepted.get() + 1);
                prop_assert!(encoded_again(&blob, &bytes) == bytes);
                drives_safely_as_itself(&blob, salt)?;
            }
            Ok(())
        })
        .unwrap();
    println!("{} of 20000 mutated headers accepted", accepted.get());
    assert!(accepted.get() > 2_000, "only {} accepted: the test tests refusals", accepted.get());
}

#[test]
fn accepted_weights_of_any_size_drive_safely() {
    let cases = ["feedforward", "self", "elman", "two-outputs", "wide-micromath"].map(named);
    let config = ProptestConfig { cases: 2_000, failure_persistence: None, ..Default::default() };
    let mut runner = proptest::test_runner::TestRunner::new(config);
    runner
        .run(&(0..cases.len(), scalings(), any::<u32>()), |(case, scaling, salt)| {
            let Case { header, self_tests, .. } = &cases[case];
            let header = Header { scaling, ..*header };
            let bytes = Buffer::encoded(&header, &weights(&header, salt), self_tests);
            drives_safely_as_itself(&Blob::parse(&bytes).unwrap(), salt)
        })
        .unwrap();
}

fn drives_safely_as_itself(blob: &Blob<'_>, salt: u32) -> Result<(), TestCaseError> {
    let topology = blob.header().topology;
    match (topology.recurrence, topology.hidden, topology.outputs) {
        (RecurrenceKind::Feedforward, 12, 1) => drives_safely::<Feedforward, 12, 1>(blob, salt),
        (RecurrenceKind::SelfLoop, 12, 1) => drives_safely::<SelfLoop, 12, 1>(blob, salt),
        (RecurrenceKind::Elman, 12, 1) => drives_safely::<Elman, 12, 1>(blob, salt),
        (RecurrenceKind::Feedforward, 12, 2) => drives_safely::<Feedforward, 12, 2>(blob, salt),
        (RecurrenceKind::Feedforward, 24, 1) => drives_safely::<Feedforward, 24, 1>(blob, salt),
        _ => Ok(()),
    }
}

fn drives_safely<R: Recurrence, const H: usize, const O: usize>(
    blob: &Blob<'_>,
    salt: u32,
) -> Result<(), TestCaseError> {
    let header = blob.header();
    let network = blob.network::<R, H, O>().unwrap();
    let mut controller = Controller::new(network, header.activation, blob.scaling());
    let range = header.scaling.range;
    let mut mixed = salt | 1;
    for _ in 0..20 {
        let echoes = std::array::from_fn(|_| {
            mixed = mixed.wrapping_mul(0x9e37_79b9).rotate_left(7) ^ 0x5bd1_e995;
            let distance = range * ((mixed >> 8) as f32 / 16_777_216.0);
            Some(match mixed % 5 {
                0 => Echo::Nothing,
                1 => Echo::Target(distance),
                2 => Echo::Wall(0.0),
                3 => Echo::Wall(range),
                _ => Echo::Wall(distance),
            })
        });
        let reading = Reading::new(echoes, mixed % 4, range).unwrap();
        let inputs = header.scaling.encoding.inputs(&reading.sight(), range);
        let [distances_and_side @ .., target] = inputs;
        let [distances @ .., side] = distances_and_side;
        prop_assert!(distances.iter().all(|input| (0.0..=1.0).contains(input)), "{inputs:?}");
        prop_assert!((-1.0..=1.0).contains(&side) && (0.0..=1.0).contains(&target), "{inputs:?}");
        let Command { steer, step } = controller.decide(Ok(&reading));
        let scaling = header.scaling;
        prop_assert!(steer.radians().abs() <= scaling.steer_limit);
        prop_assert!(step.metres() >= scaling.step_lower && step.metres() <= scaling.step_upper);
        let state = controller.state();
        let within = |values: &[f32]| values.iter().all(|value| value.abs() <= 1.0);
        prop_assert!(within(&state.first) && within(&state.second), "{state:?}");
    }
    Ok(())
}
