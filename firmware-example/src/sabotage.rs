//! A controller that computes other bits on purpose: `sabotage-reordered-sum` adds products pairwise the wrong way
//! round, `sabotage-fused-sum` rounds a product and its sum only once, as a compiler that may contract would.
//!
//! Core's own network does it, with a number type that adds differently. The blob's self-test runs on ordinary
//! numbers and passes: only the comparison of a drive can notice.

mod number;

use controller_core::activation::Activation;
use controller_core::control_loop::Decide;
use controller_core::controller::{Command, RECOVERY, Scaling};
use controller_core::network::{Network, Recurrence, State};
use controller_core::observation::{INPUTS, Reading, ReadingError};
use number::Number;

/// Stands in for [`controller_core::controller::Controller`].
#[derive(Clone, Debug)]
pub(crate) struct Controller<'a, R: Recurrence, A, const H: usize, const O: usize> {
    network: Network<'a, R, f32, INPUTS, H, O>,
    activation: A,
    scaling: Scaling,
    state: State<f32, H>,
    outputs: [f32; O],
    good_readings_owed: u32,
}

impl<'a, R: Recurrence, A: Activation, const H: usize, const O: usize> Controller<'a, R, A, H, O> {
    pub(crate) fn new(
        network: Network<'a, R, f32, INPUTS, H, O>,
        activation: A,
        scaling: Scaling,
    ) -> Self {
        let (state, outputs) = (State::reset(), [0.0; O]);
        Self { network, activation, scaling, state, outputs, good_readings_owed: 0 }
    }

    pub(crate) fn reset(&mut self) {
        *self = Self::new(self.network, self.activation, self.scaling);
    }

    pub(crate) fn state(&self) -> &State<f32, H> {
        &self.state
    }

    pub(crate) fn outputs(&self) -> &[f32; O] {
        &self.outputs
    }
}

impl<R: Recurrence, A: Activation, const H: usize, const O: usize> Decide
    for Controller<'_, R, A, H, O>
{
    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command {
        self.good_readings_owed = match reading {
            Err(_) => RECOVERY,
            Ok(_) => self.good_readings_owed.saturating_sub(1),
        };
        let (Ok(reading), 0) = (reading, self.good_readings_owed) else { return Command::STOP };
        let inputs = self.scaling.encoding.inputs(&reading.sight(), self.scaling.range);
        let mut state = State {
            first: self.state.first.map(Number::from),
            second: self.state.second.map(Number::from),
        };
        let outputs = self.network.step(self.activation, &mut state, &inputs.map(Number::from));
        self.state = State {
            first: state.first.map(Number::value),
            second: state.second.map(Number::value),
        };
        self.outputs = outputs.map(Number::value);
        self.scaling.command(&self.outputs)
    }
}
