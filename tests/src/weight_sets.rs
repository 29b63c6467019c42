//! Weights to drive with: generated, or from a file.

use controller_core::activation::{Activation, ActivationKind};
use controller_core::blob::{self, Blob, BlobError, Header, Provenance};
use controller_core::controller::Scaling;
use controller_core::network::{
    Elman, Feedforward, Network, Recurrence, RecurrenceKind, SelfLoop, State, Topology, WrongLength,
};
use controller_core::observation::{DistanceLaw, Encoding, INPUTS, TypeCode};

use crate::closed_loop::{HIDDEN, OUTPUTS};
use crate::files::BLOB_WORDS;
use crate::random::Random;
use crate::room;

/// Every recurrence, in the order of the generated sets.
pub const RECURRENCES: [RecurrenceKind; 3] =
    [RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman];

/// Every tanh, in the order of the generated sets.
pub const ACTIVATIONS: [ActivationKind; 3] =
    [ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath];

/// Generated sets of each recurrence and tanh: enough for all lanes of a wide drive.
pub const PER_KIND: u32 = 16;

/// Seed of the first generated set.
///
/// Chosen so that in the first set of each recurrence no change of a weight drowns in rounding for good, which
/// about one seed in twenty does: to a sum that is coarser than the product of a small weight and a flag, the flag
/// adds the same rounded value whatever the weight's last bit.
pub const FIRST_SEED: u32 = 324_000;

/// Inputs of a self-test and both hidden layers before its step.
pub type SelfTest = ([f32; INPUTS], State<f32, HIDDEN>);

/// A weight blob that every machine of a proof has code and memory for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WeightSet {
    name: String,
    words: Vec<u32>,
}

/// Why weights cannot take part in a proof.
#[derive(Clone, Debug, PartialEq)]
pub enum Unfit {
    /// They are no blob.
    Blob(BlobError),
    /// Their network is another one.
    Topology(Topology),
    /// The blob is longer than the smallest board has memory for, bytes.
    TooLong(usize),
}

impl std::fmt::Display for Unfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Blob(error) => error.fmt(f),
            Self::Topology(found) => {
                write!(f, "its network is {found}; the boards' programs have code for 7-12-12-1")
            }
            Self::TooLong(bytes) => {
                write!(
                    f,
                    "{bytes} bytes; the smallest board has memory for {} in a proof",
                    4 * BLOB_WORDS
                )
            }
        }
    }
}

impl std::error::Error for Unfit {}

impl WeightSet {
    /// Checks the bytes of a blob; `name` is what reports call it.
    ///
    /// # Errors
    ///
    /// No blob, another network than 7-12-12-1, or more than [`BLOB_WORDS`].
    pub fn new(name: impl Into<String>, bytes: &[u8]) -> Result<Self, Unfit> {
        let mut words = vec![0u32; bytes.len().div_ceil(4)];
        let room: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
        room[..bytes.len()].copy_from_slice(bytes);
        let blob =
            Blob::parse(&bytemuck::cast_slice(&words)[..bytes.len()]).map_err(Unfit::Blob)?;
        let topology = blob.header().topology;
        if (usize::from(topology.hidden), usize::from(topology.outputs)) != (HIDDEN, OUTPUTS) {
            return Err(Unfit::Topology(topology));
        }
        if words.len() > BLOB_WORDS {
            return Err(Unfit::TooLong(bytes.len()));
        }
        Ok(Self { name: name.into(), words })
    }

    /// What reports call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The blob as words.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// The blob.
    pub fn blob(&self) -> Blob<'_> {
        Blob::parse(bytemuck::cast_slice(&self.words)).expect("checked when it was made")
    }

    /// The same blob with one weight replaced; its self-test expects nothing then, so that driving alone tells the
    /// two apart.
    ///
    /// # Panics
    ///
    /// If there is no such weight, or a blob may not hold this value.
    pub fn with_weight(&self, index: usize, value: f32) -> Self {
        let blob = self.blob();
        let mut weights = blob.weights().to_vec();
        weights[index] = value;
        let header = Header { self_tests: 0, ..*blob.header() };
        let words = encode(&header, &weights, &[]);
        Self { name: format!("{}, weight {index}", self.name), words }
    }
}

/// [`PER_KIND`] sets of every recurrence and every tanh, kind by kind; the kinds take turns with encodings, and
/// some have no biases.
pub fn generated() -> Vec<WeightSet> {
    let kinds = RECURRENCES
        .into_iter()
        .flat_map(|recurrence| ACTIVATIONS.map(|activation| (recurrence, activation)));
    let encodings = [
        (DistanceLaw::Linear, TypeCode::Any),
        (DistanceLaw::Linear, TypeCode::NearestWallAnyTarget),
        (DistanceLaw::Saturating { half: 0.7 }, TypeCode::Bearing),
        (DistanceLaw::Saturating { half: 1.0 }, TypeCode::Nearest),
        (DistanceLaw::Saturating { half: 0.5 }, TypeCode::Share),
    ];
    kinds
        .zip(encodings.into_iter().cycle())
        .zip(0..)
        .flat_map(|(((recurrence, activation), (distance, types)), kind)| {
            let encoding = Encoding { distance, types };
            // Every other kind of each recurrence goes without biases: 1, 4 and 7 of nine.
            let biases = kind % 3 != 1;
            (0..PER_KIND).map(move |number| {
                // From neurons that hardly bend to neurons that often saturate.
                let limit = 0.5 + 0.1 * number as f32;
                let seed = FIRST_SEED + kind * PER_KIND + number;
                of_kind(recurrence, activation, encoding, biases, limit, seed)
            })
        })
        .collect()
}

/// One generated set; its weights are uniform within `limit`.
pub fn of_kind(
    recurrence: RecurrenceKind,
    activation: ActivationKind,
    encoding: Encoding,
    biases: bool,
    limit: f32,
    seed: u32,
) -> WeightSet {
    let mut random = Random(0x5eed_0000_0000 + u64::from(seed));
    let topology = Topology {
        inputs: INPUTS as u8,
        hidden: HIDDEN as u8,
        outputs: OUTPUTS as u8,
        recurrence,
        biases,
    };
    let header = header(topology, activation, encoding, u64::from(seed));
    let weights: Vec<f32> = (0..topology.weights()).map(|_| limit * random.within_one()).collect();
    let self_tests = [(); 3].map(|()| self_test(&mut random));
    let words = build(&header, &weights, &self_tests);
    WeightSet { name: format!("weights of seed {seed} ({recurrence}, {activation})"), words }
}

/// Inputs and hidden layers drawn at random.
pub fn self_test(random: &mut Random) -> SelfTest {
    let inputs = [(); INPUTS].map(|()| 0.5 + 0.5 * random.within_one());
    let mut layer = || [(); HIDDEN].map(|()| random.within_one());
    (inputs, State { first: layer(), second: layer() })
}

/// The header of weights for the car in the room.
pub fn header(
    topology: Topology,
    activation: ActivationKind,
    encoding: Encoding,
    seed: u64,
) -> Header {
    Header {
        topology,
        activation,
        scaling: Scaling {
            encoding,
            range: room::RANGE,
            steer_limit: 0.5,
            step_lower: 0.02,
            step_upper: 0.1,
        },
        period: 0.05,
        wheelbase: room::WHEELBASE,
        beams: room::mounts(),
        self_tests: 3,
        provenance: Provenance {
            seed,
            generation: 0,
            scenario_hash: [0; 8],
            tool: [0, 1, 0],
            scenario: Provenance::stored_name("equivalence-tests room"),
        },
    }
}

/// A blob as words, its self-tests answered by this machine.
///
/// # Panics
///
/// If the header does not describe these weights: what is generated is fixed, so a test fails.
pub fn build(header: &Header, weights: &[f32], self_tests: &[SelfTest]) -> Vec<u32> {
    let biases = header.topology.biases;
    let triples = match header.topology.recurrence {
        RecurrenceKind::Feedforward => answers::<Feedforward>(header, weights, biases, self_tests),
        RecurrenceKind::SelfLoop => answers::<SelfLoop>(header, weights, biases, self_tests),
        RecurrenceKind::Elman => answers::<Elman>(header, weights, biases, self_tests),
    };
    encode(header, weights, &triples.expect("weights fit the network"))
}

fn answers<R: Recurrence>(
    header: &Header,
    weights: &[f32],
    biases: bool,
    self_tests: &[SelfTest],
) -> Result<Vec<f32>, WrongLength> {
    let network = Network::<R, f32, INPUTS, HIDDEN, OUTPUTS>::new(weights, biases)?;
    let activation: ActivationKind = header.activation;
    debug_assert_eq!(activation.kind(), activation);
    let mut triples = Vec::new();
    for (inputs, state) in self_tests {
        triples.extend(inputs.iter().chain(&state.first).chain(&state.second));
        triples.extend(network.step(activation, &mut state.clone(), inputs));
    }
    Ok(triples)
}

fn encode(header: &Header, weights: &[f32], triples: &[f32]) -> Vec<u32> {
    let mut words = vec![0u32; header.blob_len() / 4];
    blob::encode(header, weights, triples, bytemuck::cast_slice_mut(&mut words))
        .expect("a valid blob");
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_sets_are_of_every_kind_and_no_two_are_equal() {
        let sets = generated();
        assert_eq!(sets.len(), 144);
        for recurrence in RECURRENCES {
            for activation in ACTIVATIONS {
                let count = sets
                    .iter()
                    .map(|set| *set.blob().header())
                    .filter(|header| header.topology.recurrence == recurrence)
                    .filter(|header| header.activation == activation)
                    .count();
                assert_eq!(count, 16, "{recurrence} {activation}");
            }
        }
        let mut checks: Vec<u64> = sets.iter().map(|set| set.blob().check()).collect();
        checks.sort_unstable();
        checks.dedup();
        assert_eq!(checks.len(), 144);
        let lengths: Vec<usize> = sets.iter().map(|set| set.blob().weights().len()).collect();
        for length in [240, 264, 528, 265, 289, 553] {
            assert!(lengths.contains(&length), "no set of {length} weights");
        }
    }

    #[test]
    fn a_blob_of_another_network_is_refused_with_its_name() {
        let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/../controller-core/tests/golden/v1/");
        let read = |name: &str| std::fs::read(format!("{golden}{name}.blob")).expect("golden");
        let said = WeightSet::new("wide", &read("two-outputs")).expect_err("refused").to_string();
        assert!(said.starts_with("its network is 7-12-12-2 "), "{said}");
        let mut damaged = read("elman");
        damaged[300] ^= 1;
        assert!(matches!(WeightSet::new("", &damaged), Err(Unfit::Blob(BlobError::Check { .. }))));
        assert!(WeightSet::new("elman", &read("elman")).is_ok());
    }
}
