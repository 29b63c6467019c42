//! One step of the networks of all cars, of sizes that are known only at run time.

use super::SLOTS;
use crate::brain::with_sizes;
use crate::vector::{Part, Slots, Vector, Weight};
use controller_core::activation::{Activation, ActivationKind};
use controller_core::network::{
    Elman, Feedforward, Network, Recurrence, RecurrenceKind, SelfLoop, State, Topology,
};
use controller_core::observation::INPUTS;
use std::marker::PhantomData;
use std::ops::Range;

/// Most outputs of a network: steering and speed.
pub(super) const OUTPUTS: usize = 2;

/// One number of every car.
type All<V> = Slots<V, SLOTS>;

/// Most bytes of weights of a block whose cars are separate: what a core's second cache holds. By
/// measurement 620 KB still pay and 1.1 MB do not.
const MOST_BYTES: usize = 768 << 10;

/// Networks of one topology, with a memory per car. All cars of a lane have the weights of one
/// individual until they are [separated](Networks::separate).
pub(super) struct Networks<V> {
    weights: Weights<V>,
    memory: Box<dyn Memory<V>>,
    /// What the networks are asked; to be written before [`Self::step`].
    pub(super) inputs: [All<V>; INPUTS],
    /// What they answered; zero where there is no such output.
    pub(super) outputs: [All<V>; OUTPUTS],
}

impl<V: Vector> Networks<V> {
    /// Networks whose weights are all zero.
    pub(super) fn new(topology: Topology, activation: ActivationKind) -> Self {
        let zero = All::<V>::from(0.0);
        let memory = match topology.recurrence {
            RecurrenceKind::Feedforward => memory::<V, Feedforward>(topology, activation),
            RecurrenceKind::SelfLoop => memory::<V, SelfLoop>(topology, activation),
            RecurrenceKind::Elman => memory::<V, Elman>(topology, activation),
        };
        Self {
            weights: Weights::OfLanes(vec![Weight([V::from(0.0)]); topology.weights()]),
            memory,
            inputs: [zero; INPUTS],
            outputs: [zero; OUTPUTS],
        }
    }

    /// Gives a car, and all that [share](Self::sharing) its weights, to another individual.
    pub(super) fn load(&mut self, slot: usize, lane: usize, genome: &[f32]) {
        match &mut self.weights {
            Weights::OfLanes(weights) => load(weights, 0, lane, genome),
            Weights::OfCars(weights) => load(weights, slot, lane, genome),
        }
    }

    /// The slots of a lane whose cars have the same weights as the one in this slot.
    pub(super) fn sharing(&self, slot: usize) -> Range<usize> {
        match self.weights {
            Weights::OfLanes(_) => 0..SLOTS,
            Weights::OfCars(_) => slot..slot + 1,
        }
    }

    /// Whether cars share weights and are faster once [separated](Self::separate) than if they wait for
    /// each other.
    pub(super) fn may_separate(&self) -> bool {
        match &self.weights {
            Weights::OfLanes(weights) => SLOTS * size_of_val(&weights[..]) <= MOST_BYTES,
            Weights::OfCars(_) => false,
        }
    }

    /// From now on each car has weights of its own, at first those that it has now. Others to load
    /// for each car then, but a car need not wait for the rest of its lane.
    pub(super) fn separate(&mut self) {
        if let Weights::OfLanes(weights) = &self.weights {
            let own = weights.iter().map(|Weight([weight])| Weight([*weight; SLOTS]));
            self.weights = Weights::OfCars(own.collect());
        }
    }

    /// Moves a car's network from one slot and lane to another. Cars must be
    /// [separate](Self::separate).
    pub(super) fn shift(
        &mut self,
        (slot, lane): (usize, usize),
        (to_slot, to_lane): (usize, usize),
    ) {
        debug_assert_eq!(self.sharing(slot).len(), 1, "others would lose their weights");
        if let Weights::OfCars(weights) = &mut self.weights {
            for Weight(weight) in weights {
                weight[to_slot].lanes_mut()[to_lane] = weight[slot].lanes()[lane];
            }
        }
        self.memory.visit(&mut |output| {
            output.0[to_slot].lanes_mut()[to_lane] = output.0[slot].lanes()[lane];
        });
    }

    /// Forgets what one car's network remembers.
    pub(super) fn forget(&mut self, slot: usize, lane: usize) {
        self.memory.forget(slot * V::WIDTH + lane);
    }

    /// All hidden outputs of one car's network, first layer then second.
    #[cfg(test)]
    pub(super) fn hidden(&mut self, slot: usize, lane: usize) -> Vec<f32> {
        let mut hidden = Vec::new();
        self.memory.visit(&mut |output| hidden.push(output.0[slot].lanes()[lane]));
        hidden
    }

    /// One step of the networks of the first so many slots, at least; of the others, outputs and memory
    /// are anything afterwards.
    #[inline(always)]
    pub(super) fn step(&mut self, slots: usize) {
        self.memory.step(slots, &self.weights, &self.inputs, &mut self.outputs);
    }
}

/// The weights of all cars' networks, in the genome's order.
enum Weights<V> {
    /// One individual in each lane.
    OfLanes(Vec<Weight<V, 1>>),
    /// One in each slot of each lane.
    OfCars(Vec<Weight<V, SLOTS>>),
}

fn load<V: Vector, const SETS: usize>(
    weights: &mut [Weight<V, SETS>],
    set: usize,
    lane: usize,
    genome: &[f32],
) {
    for (weight, gene) in weights.iter_mut().zip(genome) {
        weight.0[set].lanes_mut()[lane] = *gene;
    }
}

/// The hidden outputs of all cars' networks, whatever their sizes.
trait Memory<V> {
    /// One step of the networks of the first so many slots, at least; of the others, outputs and memory are
    /// anything afterwards.
    fn step(
        &mut self,
        slots: usize,
        weights: &Weights<V>,
        inputs: &[All<V>; INPUTS],
        outputs: &mut [All<V>],
    );

    /// Forgets the hidden outputs of one car, of all slots' cars in a row.
    fn forget(&mut self, car: usize);

    /// Shows every hidden output, first layer then second.
    fn visit(&mut self, look: &mut dyn FnMut(&mut All<V>));
}

fn memory<V: Vector, R: Recurrence + 'static>(
    topology: Topology,
    activation: ActivationKind,
) -> Box<dyn Memory<V>> {
    with_sizes!(topology, |H, O| {
        let [memory, next] = [(); 2].map(|()| Box::new(State::<All<V>, H>::reset()));
        let biases = topology.biases;
        Box::new(Sized::<V, R, H, O> { memory, next, biases, activation, recurrence: PhantomData })
    }, else unreachable!("the scenario's network is built in"))
}

/// The memory of networks whose hidden layers have `H` neurons and that have `O` outputs.
struct Sized<V, R, const H: usize, const O: usize> {
    memory: Box<State<All<V>, H>>,
    /// Where that of the next step is written.
    next: Box<State<All<V>, H>>,
    biases: bool,
    activation: ActivationKind,
    recurrence: PhantomData<R>,
}

impl<V: Vector, R: Recurrence, const H: usize, const O: usize> Memory<V> for Sized<V, R, H, O> {
    fn step(
        &mut self,
        slots: usize,
        weights: &Weights<V>,
        inputs: &[All<V>; INPUTS],
        outputs: &mut [All<V>],
    ) {
        match (weights, slots) {
            (Weights::OfLanes(weights), _) => self.step_with::<1, SLOTS>(weights, inputs, outputs),
            (Weights::OfCars(weights), 0..=1) => {
                self.step_with::<SLOTS, 1>(weights, inputs, outputs)
            }
            (Weights::OfCars(weights), 2) => self.step_with::<SLOTS, 2>(weights, inputs, outputs),
            (Weights::OfCars(weights), _) => {
                self.step_with::<SLOTS, SLOTS>(weights, inputs, outputs);
            }
        }
    }

    fn forget(&mut self, car: usize) {
        let State { first, second } = &mut *self.memory;
        for output in first.iter_mut().chain(second) {
            output.numbers_mut()[car] = 0.0;
        }
    }

    fn visit(&mut self, look: &mut dyn FnMut(&mut All<V>)) {
        let State { first, second } = &mut *self.memory;
        first.iter_mut().chain(second).for_each(look);
    }
}

impl<V: Vector, R: Recurrence, const H: usize, const O: usize> Sized<V, R, H, O> {
    fn step_with<const SETS: usize, const K: usize>(
        &mut self,
        weights: &[Weight<V, SETS>],
        inputs: &[All<V>; INPUTS],
        outputs: &mut [All<V>],
    ) {
        let network = Network::<R, Weight<V, SETS>, INPUTS, H, O>::new(weights, self.biases);
        let network = network.expect("as many weights as the topology has");
        let (activation, before, after) = (self.activation, &*self.memory, &mut *self.next);
        V::apart(Step::<V, R, SETS, K, H, O> {
            network,
            activation,
            before,
            after,
            inputs,
            outputs,
        });
        std::mem::swap(&mut self.memory, &mut self.next);
    }
}

/// One step of the networks in the first `K` slots, to be compiled for the vectors' instructions.
struct Step<
    'a,
    V: Vector,
    R: Recurrence,
    const SETS: usize,
    const K: usize,
    const H: usize,
    const O: usize,
> {
    network: Network<'a, R, Weight<V, SETS>, INPUTS, H, O>,
    activation: ActivationKind,
    before: &'a State<All<V>, H>,
    after: &'a mut State<All<V>, H>,
    inputs: &'a [All<V>; INPUTS],
    outputs: &'a mut [All<V>],
}

/// One step of the networks of all slots.
///
/// How many neurons at a time is by measurement. Alone, one takes 131 ns for a car and four 84 (AMD Zen 3). On Zen 4, where
/// weights are shared, with vectors of sixteen four take 15.6 ns if all sums are done before the first tanh, two 16.1, and
/// two whose tanh comes at once 17.2; with vectors of eight two take 19.6 and one whose tanh comes at once 20.9; with
/// vectors of four two take 38.1 and 39.5. Wide weights of each car's own come from the second cache, and the tanh of one
/// neuron fills the time that those of the next one take: with vectors of sixteen one takes 24 ns, two or sums first 26 or
/// more; with vectors of eight it matters little, and with vectors of four two are the fastest, sums first 47 and else 48.
/// A group has to fill the time that its sums wait for each other, and to fit the registers; the larger it is, the less
/// often inputs are loaded.
#[inline(always)]
pub(crate) fn step_of_slots<
    V: Vector,
    R: Recurrence,
    const SETS: usize,
    const H: usize,
    const O: usize,
>(
    network: &Network<'_, R, Weight<V, SETS>, INPUTS, H, O>,
    activation: impl Activation,
    before: &State<All<V>, H>,
    after: &mut State<All<V>, H>,
    inputs: &[All<V>; INPUTS],
) -> [All<V>; O] {
    match (V::WIDTH, SETS) {
        (1, _) => network.step_between::<4, false, _>(activation, before, after, inputs),
        (4, _) | (8, 1) => network.step_between::<2, true, _>(activation, before, after, inputs),
        (16, 1) => network.step_between::<4, true, _>(activation, before, after, inputs),
        _ => network.step_between::<1, false, _>(activation, before, after, inputs),
    }
}

/// Neurons worked on at a time, of few slots: what one of them waits for, the others' sums fill.
const OF_FEW: usize = 4;

impl<V: Vector, R: Recurrence, const SETS: usize, const K: usize, const H: usize, const O: usize>
    Part<V> for Step<'_, V, R, SETS, K, H, O>
{
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { network, activation, before, after, inputs, outputs } = self;
        if K == SLOTS {
            let answer = step_of_slots(&network, activation, before, after, inputs);
            for (output, answer) in outputs.iter_mut().zip(answer) {
                *output = answer;
            }
            return;
        }
        let few_of = |all: &All<V>| Slots(*all.0.first_chunk::<K>().expect("no more than all"));
        let State { first, second } = before;
        let mut few =
            State { first: first.each_ref().map(few_of), second: second.each_ref().map(few_of) };
        let inputs = inputs.each_ref().map(few_of);
        let answer = network.step_by::<OF_FEW, _>(activation, &mut few, &inputs);
        let all = after.first.iter_mut().chain(&mut after.second).chain(outputs);
        for (all, few) in all.zip(few.first.iter().chain(&few.second).chain(&answer)) {
            all.0[..K].copy_from_slice(&few.0);
        }
    }
}
