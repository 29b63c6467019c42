//! The multilayer perceptron: two hidden layers, tanh everywhere, three recurrences.
//!
//! A [`Network`] borrows its weights: from a genome while training, from flash on the car.
//! The genome's order is also the blob's: for each layer the matrix input by input (`w[input]
//! [neuron]`), then its recurrent weights, then its biases. Input-major order lets a compiler
//! work on any number of a layer's neurons at once without changing any neuron's order of
//! addition.
//!
//! The arithmetic contract: each neuron's sum starts from its bias, adds `weight · input`
//! input by input, then `weight · previous output` neuron by neuron. Without biases the sum
//! starts from `+0.0`.

mod layer;
mod recurrence;

pub use recurrence::{Elman, Feedforward, Recurrence, SelfLoop};

use crate::activation::Activation;
use crate::lane::Lane;
use core::fmt;
use layer::Layer;
use recurrence::{take_matrix, take_row};
use serde::{Deserialize, Serialize};

/// What a hidden neuron remembers of the step before; recorded in the weight blob.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
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

crate::sentences! { RecurrenceKind {
    Self::Feedforward => "feedforward";
    Self::SelfLoop => "self";
    Self::Elman => "elman";
} }

/// Sizes and kind of a network, as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
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

crate::sentences! { Topology {
    Self { inputs, hidden, outputs, recurrence, biases: true } =>
        "{}-{}-{}-{} {}, biases", inputs, hidden, hidden, outputs, recurrence;
    Self { inputs, hidden, outputs, recurrence, biases: false } =>
        "{}-{}-{}-{} {}, no biases", inputs, hidden, hidden, outputs, recurrence;
} }

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
        self.step_by::<H, L>(activation, state, input)
    }

    /// [`Self::step`], `N` neurons of a hidden layer at a time, each from its bias to its output:
    /// as many as the machine's registers hold the sums of. No bit depends on it.
    #[inline(always)]
    pub fn step_by<const N: usize, L: Lane + From<W>>(
        &self,
        activation: impl Activation,
        State { first, second }: &mut State<L, H>,
        input: &[L; I],
    ) -> [L; O] {
        self.first.run::<N, R, L>(self.first_memory, activation, input, first);
        self.second.run::<N, R, L>(self.second_memory, activation, first, second);
        let mut output = [L::from(0.0); O];
        self.output.run::<O, Feedforward, L>((), activation, second, &mut output);
        output
    }

    /// The same from the hidden outputs `before` the step to those after it, in places of their own: those of many
    /// robots at once take long to copy. If `SUMS_FIRST` a layer's sums are all done before its first tanh: more neurons at a
    /// time then fit the registers. No bit depends on that either.
    #[inline(always)]
    pub fn step_between<const N: usize, const SUMS_FIRST: bool, L: Lane + From<W>>(
        &self,
        activation: impl Activation,
        before: &State<L, H>,
        State { first, second }: &mut State<L, H>,
        input: &[L; I],
    ) -> [L; O] {
        let (memory, previous) = (self.first_memory, &before.first);
        self.first.run_between::<N, SUMS_FIRST, R, L>(memory, activation, input, previous, first);
        let (memory, previous) = (self.second_memory, &before.second);
        self.second.run_between::<N, SUMS_FIRST, R, L>(memory, activation, first, previous, second);
        let mut output = [L::from(0.0); O];
        self.output.run::<O, Feedforward, L>((), activation, second, &mut output);
        output
    }
}

/// Hidden neurons that a microcontroller works on at a time. More do not fit the 32 registers of a Cortex-M4F
/// beside inputs, memory and the constants of the tanh; fewer load the inputs more often.
const ON_A_BOARD: usize = 3;

impl<R: Recurrence, const I: usize, const H: usize, const O: usize> Network<'_, R, f32, I, H, O> {
    /// [`Self::step`] for one robot, compiled once: a device's self-test then runs the very
    /// instructions that will drive.
    #[inline(never)]
    pub fn step_alone<A: Activation>(
        &self,
        activation: A,
        state: &mut State<f32, H>,
        input: &[f32; I],
    ) -> [f32; O] {
        // No group of neurons then has to ask whether there are biases.
        let with_biases = Self {
            first: self.first.with_bias(),
            second: self.second.with_bias(),
            output: self.output.with_bias(),
            ..*self
        };
        // A host has vector registers for a whole layer; calls of a tanh would empty the registers.
        if cfg!(target_os = "none") && A::BRANCH_FREE {
            with_biases.step_by::<ON_A_BOARD, f32>(activation, state, input)
        } else {
            with_biases.step_by::<H, f32>(activation, state, input)
        }
    }
}

fn take_bias<'a, W, const N: usize>(
    genome: &mut &'a [W],
    biases: bool,
) -> Option<Option<&'a [W; N]>> {
    if biases { take_row(genome).map(Some) } else { Some(None) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::activation::Rational;

    /// A drive of 20 steps, `N` neurons of a hidden layer at a time, as bits.
    fn drive<const N: usize, R: Recurrence>(biases: bool) -> [[u32; 26]; 20] {
        let mut genome = [0.0; 600];
        for (index, weight) in genome.iter_mut().enumerate() {
            *weight = (index * 7919 % 1009) as f32 / 504.5 - 1.0;
        }
        let genome = &genome[..Network::<R, f32, 7, 12, 2>::topology(biases).weights()];
        let network = Network::<R, f32, 7, 12, 2>::new(genome, biases).unwrap();
        let mut state = State::reset();
        core::array::from_fn(|step| {
            let input = core::array::from_fn(|index| ((step * 7 + index) * 31 % 53) as f32 / 52.0);
            let [mut after, mut apart] = [State::reset(); 2];
            let between =
                network.step_between::<N, false, f32>(Rational, &state, &mut after, &input);
            let sums_first =
                network.step_between::<N, true, f32>(Rational, &state, &mut apart, &input);
            let outputs = network.step_by::<N, f32>(Rational, &mut state, &input);
            assert_eq!((between, after), (outputs, state), "the same, in places of their own");
            assert_eq!((sums_first, apart), (outputs, state), "the same, sums first");
            let mut values = state.first.iter().chain(&state.second).chain(&outputs);
            core::array::from_fn(|_| values.next().unwrap().to_bits())
        })
    }

    fn groups_of_any_size_agree<R: Recurrence>() {
        for biases in [false, true] {
            let whole = drive::<12, R>(biases);
            assert_eq!(drive::<ON_A_BOARD, R>(biases), whole);
            assert_eq!(drive::<1, R>(biases), whole);
            // Leaves two neurons over, which are worked on alone.
            assert_eq!(drive::<5, R>(biases), whole);
        }
    }

    #[test]
    fn no_bit_depends_on_how_many_neurons_are_worked_on_at_a_time() {
        groups_of_any_size_agree::<Feedforward>();
        groups_of_any_size_agree::<SelfLoop>();
        groups_of_any_size_agree::<Elman>();
    }
}
