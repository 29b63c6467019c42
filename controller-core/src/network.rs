//! The multilayer perceptron: two hidden layers, tanh everywhere, three recurrences.
//!
//! A [`Network`] borrows its weights: from a genome while training, from flash on the car.
//! The genome's order is also the blob's: for each layer the matrix input by input (`w[input]
//! [neuron]`), then its recurrent weights, then its biases. Input-major order lets a compiler
//! work on all neurons of a layer at once without changing any neuron's order of addition.
//!
//! The arithmetic contract: each neuron's sum starts from its bias, adds `weight · input`
//! input by input, then `weight · previous output` neuron by neuron. Without biases the sum
//! starts from `+0.0`.

use crate::activation::Activation;
use crate::lane::Lane;
use core::fmt;
use serde::{Deserialize, Serialize};

/// What a hidden neuron remembers of the step before; recorded in the weight blob.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[serde(rename_all = "kebab-case")]
pub enum RecurrenceKind {
    /// Nothing.
    #[default]
    Feedforward,
    /// Its own output.
    #[serde(rename = "self")]
    SelfLoop,
    /// The outputs of its whole layer (Elman).
    Elman,
}

impl RecurrenceKind {
    /// Recurrent weights of a hidden layer of this width.
    pub const fn weights(self, hidden: usize) -> usize {
        match self {
            Self::Feedforward => 0,
            Self::SelfLoop => hidden,
            Self::Elman => hidden * hidden,
        }
    }
}

impl fmt::Display for RecurrenceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Feedforward => "feedforward",
            Self::SelfLoop => "self",
            Self::Elman => "elman",
        })
    }
}

/// Sizes and kind of a network, as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Topology {
    /// Inputs.
    pub inputs: u8,
    /// Neurons in each of the two hidden layers.
    pub hidden: u8,
    /// Output neurons.
    pub outputs: u8,
    /// What a hidden neuron remembers.
    pub recurrence: RecurrenceKind,
    /// Whether neurons have biases.
    pub biases: bool,
}

impl Topology {
    /// Number of weights: the genome's length.
    ///
    /// ```
    /// use controller_core::network::{RecurrenceKind, Topology};
    ///
    /// let paper = Topology {
    ///     inputs: 7, hidden: 12, outputs: 1, recurrence: RecurrenceKind::Feedforward, biases: false,
    /// };
    /// assert_eq!(paper.weights(), 240);
    /// let elman = Topology { recurrence: RecurrenceKind::Elman, biases: true, ..paper };
    /// assert_eq!(elman.weights(), 553);
    /// ```
    pub const fn weights(self) -> usize {
        let (i, h, o) = (self.inputs as usize, self.hidden as usize, self.outputs as usize);
        let biases = if self.biases { h + h + o } else { 0 };
        i * h + h * h + h * o + 2 * self.recurrence.weights(h) + biases
    }
}

impl fmt::Display for Topology {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { inputs, hidden, outputs, recurrence, biases } = self;
        let biases = if *biases { "biases" } else { "no biases" };
        write!(f, "{inputs}-{hidden}-{hidden}-{outputs} {recurrence}, {biases}")
    }
}

/// A recurrence as a type, so that a device carries the code of its own kind only.
pub trait Recurrence: Copy {
    /// The same as a value.
    const KIND: RecurrenceKind;

    /// The recurrent weights of one layer of width `H`.
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize>: Copy + fmt::Debug;

    /// Takes one layer's recurrent weights off the front of the genome.
    fn take<'a, W: Copy + fmt::Debug, const H: usize>(
        genome: &mut &'a [W],
    ) -> Option<Self::Weights<'a, W, H>>;

    /// Adds the recurrent part to one layer's sums.
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize>(
        sums: &mut [L; H],
        weights: Self::Weights<'_, W, H>,
        previous: &[L; H],
    );
}

/// [`RecurrenceKind::Feedforward`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Feedforward;

/// [`RecurrenceKind::SelfLoop`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct SelfLoop;

/// [`RecurrenceKind::Elman`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Elman;

impl Recurrence for Feedforward {
    const KIND: RecurrenceKind = RecurrenceKind::Feedforward;
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize> = ();

    fn take<W: Copy + fmt::Debug, const H: usize>(_: &mut &[W]) -> Option<()> {
        Some(())
    }

    #[inline(always)]
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize>(
        _: &mut [L; H],
        (): (),
        _: &[L; H],
    ) {
    }
}

impl Recurrence for SelfLoop {
    const KIND: RecurrenceKind = RecurrenceKind::SelfLoop;
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize> = &'a [W; H];

    fn take<'a, W: Copy + fmt::Debug, const H: usize>(genome: &mut &'a [W]) -> Option<&'a [W; H]> {
        take_row(genome)
    }

    #[inline(always)]
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize>(
        sums: &mut [L; H],
        weights: &[W; H],
        previous: &[L; H],
    ) {
        for ((sum, weight), output) in sums.iter_mut().zip(weights).zip(previous) {
            *sum = *sum + L::from(*weight) * *output;
        }
    }
}

impl Recurrence for Elman {
    const KIND: RecurrenceKind = RecurrenceKind::Elman;
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize> = &'a [[W; H]; H];

    fn take<'a, W: Copy + fmt::Debug, const H: usize>(
        genome: &mut &'a [W],
    ) -> Option<&'a [[W; H]; H]> {
        take_matrix(genome)
    }

    #[inline(always)]
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize>(
        sums: &mut [L; H],
        weights: &[[W; H]; H],
        previous: &[L; H],
    ) {
        add_products(sums, weights, previous);
    }
}

/// One layer's weights, borrowed.
#[derive(Clone, Copy, Debug)]
struct Layer<'a, W: Copy, const IN: usize, const OUT: usize> {
    weights: &'a [[W; OUT]; IN],
    bias: Option<&'a [W; OUT]>,
}

impl<W: Copy, const IN: usize, const OUT: usize> Layer<'_, W, IN, OUT> {
    #[inline(always)]
    fn sums<L: Lane + From<W>>(&self, input: &[L; IN]) -> [L; OUT] {
        let mut sums = match self.bias {
            Some(bias) => bias.map(L::from),
            None => [L::from(0.0f32); OUT],
        };
        add_products(&mut sums, self.weights, input);
        sums
    }
}

/// Outputs of both hidden layers: the memory of a recurrent network, and the place to look
/// for the first difference between two machines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct State<L, const H: usize> {
    /// Outputs of the first hidden layer.
    pub first: [L; H],
    /// Outputs of the second hidden layer.
    pub second: [L; H],
}

impl<L: Lane, const H: usize> State<L, H> {
    /// What every drive starts from: all outputs zero.
    #[inline(always)]
    pub fn reset() -> Self {
        Self { first: [L::from(0.0); H], second: [L::from(0.0); H] }
    }
}

/// Two hidden layers and an output layer over borrowed weights.
///
/// `W` is the weights' type: `f32`, or a lane type where each lane is another individual.
///
/// ```
/// use controller_core::activation::Rational;
/// use controller_core::network::{Feedforward, Network, State};
///
/// let genome = [0.0; 265];
/// let network = Network::<Feedforward, f32, 7, 12, 1>::new(&genome, true)?;
/// let mut state = State::reset();
/// assert_eq!(network.step(Rational, &mut state, &[1.0; 7]), [0.0]);
/// # Ok::<(), controller_core::network::WrongLength>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Network<
    'a,
    R: Recurrence,
    W: Copy + fmt::Debug + 'a,
    const I: usize,
    const H: usize,
    const O: usize,
> {
    first: Layer<'a, W, I, H>,
    first_memory: R::Weights<'a, W, H>,
    second: Layer<'a, W, H, H>,
    second_memory: R::Weights<'a, W, H>,
    output: Layer<'a, W, H, O>,
}

/// A genome has another number of weights than the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WrongLength {
    /// What was given.
    pub found: usize,
    /// What the topology needs.
    pub expected: usize,
}

impl fmt::Display for WrongLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} weights given, the network has {}", self.found, self.expected)
    }
}

impl core::error::Error for WrongLength {}

impl<'a, R: Recurrence, W: Copy + fmt::Debug, const I: usize, const H: usize, const O: usize>
    Network<'a, R, W, I, H, O>
{
    /// This network's topology.
    pub const fn topology(biases: bool) -> Topology {
        const { assert!(I <= 255 && H <= 255 && O <= 255) };
        Topology { inputs: I as u8, hidden: H as u8, outputs: O as u8, recurrence: R::KIND, biases }
    }

    /// Lays the network over a genome.
    ///
    /// # Errors
    ///
    /// [`WrongLength`] unless there are exactly [`Topology::weights`].
    pub fn new(genome: &'a [W], biases: bool) -> Result<Self, WrongLength> {
        let wrong = WrongLength { found: genome.len(), expected: Self::topology(biases).weights() };
        if wrong.found != wrong.expected {
            return Err(wrong);
        }
        Self::split(genome, biases).ok_or(wrong)
    }

    fn split(mut genome: &'a [W], biases: bool) -> Option<Self> {
        let rest = &mut genome;
        let weights = take_matrix(rest)?;
        let first_memory = R::take(rest)?;
        let first = Layer { weights, bias: take_bias(rest, biases)? };
        let weights = take_matrix(rest)?;
        let second_memory = R::take(rest)?;
        let second = Layer { weights, bias: take_bias(rest, biases)? };
        let output = Layer { weights: take_matrix(rest)?, bias: take_bias(rest, biases)? };
        Some(Self { first, first_memory, second, second_memory, output })
    }

    /// One step: inputs and the previous hidden outputs in, the outputs back, each in
    /// `-1.0..=1.0`. `state` then holds all hidden outputs of this step.
    #[inline(always)]
    pub fn step<L: Lane + From<W>>(
        &self,
        activation: impl Activation,
        state: &mut State<L, H>,
        input: &[L; I],
    ) -> [L; O] {
        let mut sums = self.first.sums(input);
        R::add(&mut sums, self.first_memory, &state.first);
        activation.apply(&mut sums);
        state.first = sums;

        let mut sums = self.second.sums(&state.first);
        R::add(&mut sums, self.second_memory, &state.second);
        activation.apply(&mut sums);
        state.second = sums;

        let mut output = self.output.sums(&state.second);
        activation.apply(&mut output);
        output
    }
}

impl<R: Recurrence, const I: usize, const H: usize, const O: usize> Network<'_, R, f32, I, H, O> {
    /// [`Self::step`] for one robot, compiled once: a device's self-test then runs the very
    /// instructions that will drive.
    #[inline(never)]
    pub fn step_alone(
        &self,
        activation: impl Activation,
        state: &mut State<f32, H>,
        input: &[f32; I],
    ) -> [f32; O] {
        self.step(activation, state, input)
    }
}

#[inline(always)]
fn add_products<L: Lane + From<W>, W: Copy, const IN: usize, const OUT: usize>(
    sums: &mut [L; OUT],
    weights: &[[W; OUT]; IN],
    input: &[L; IN],
) {
    for (row, value) in weights.iter().zip(input) {
        for (sum, weight) in sums.iter_mut().zip(row) {
            *sum = *sum + L::from(*weight) * *value;
        }
    }
}

fn take_row<'a, W, const N: usize>(genome: &mut &'a [W]) -> Option<&'a [W; N]> {
    let (row, rest) = genome.split_first_chunk()?;
    *genome = rest;
    Some(row)
}

fn take_matrix<'a, W, const IN: usize, const OUT: usize>(
    genome: &mut &'a [W],
) -> Option<&'a [[W; OUT]; IN]> {
    let (matrix, rest) = genome.split_at_checked(IN * OUT)?;
    *genome = rest;
    matrix.as_chunks().0.try_into().ok()
}

fn take_bias<'a, W, const N: usize>(
    genome: &mut &'a [W],
    biases: bool,
) -> Option<Option<&'a [W; N]>> {
    if biases { take_row(genome).map(Some) } else { Some(None) }
}
