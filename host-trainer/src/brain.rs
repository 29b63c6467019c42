//! A controller whose sizes are known only at run time.
//!
//! The car's program knows its network while compiling; the trainer learns it from a scenario
//! or a blob. [`build`] picks the compiled controller that fits.

use crate::scenario::NetworkSpec;
use controller_core::activation::ActivationKind;
use controller_core::control_loop::Decide;
use controller_core::controller::{Controller, Scaling};
use controller_core::network::{
    Elman, Feedforward, Network, Recurrence, RecurrenceKind, SelfLoop, State, Topology,
};
use controller_core::observation::INPUTS;
use std::fmt;

/// Evaluates an expression with a topology's hidden width and outputs as constants, or another
/// expression for sizes that are not built in. The one list of sizes that are.
macro_rules! with_sizes {
    ($topology:expr, |$hidden:ident, $outputs:ident| $body:expr, else $none:expr) => {
        with_sizes!(
            @ $topology, $hidden, $outputs, $body, $none;
            (12, 1), (12, 2), (16, 1), (16, 2), (24, 1), (24, 2), (32, 1), (32, 2)
        )
    };
    (
        @ $topology:expr, $hidden:ident, $outputs:ident, $body:expr, $none:expr;
        $(($h:literal, $o:literal)),*
    ) => {
        match ($topology.hidden, $topology.outputs) {
            $(($h, $o) => {
                const $hidden: usize = $h;
                const $outputs: usize = $o;
                $body
            })*
            _ => $none,
        }
    };
}
pub(crate) use with_sizes;

/// A controller of any size.
pub trait Brain: Decide {
    /// Forgets everything: the start of another drive.
    fn reset(&mut self);

    /// All hidden outputs of the last step, first layer then second.
    fn hidden(&self) -> Vec<f32>;

    /// The network's outputs for any inputs and hidden outputs of the step before, in the order
    /// of [`Self::hidden`]; none if there are not as many. The brain itself does not change.
    fn outputs(&self, inputs: &[f32; INPUTS], hidden: &[f32]) -> Option<Vec<f32>>;
}

impl<R: Recurrence, const H: usize, const O: usize> Brain
    for Controller<'_, R, ActivationKind, H, O>
{
    fn reset(&mut self) {
        Controller::reset(self);
    }

    fn hidden(&self) -> Vec<f32> {
        let state = self.state();
        [state.first, state.second].concat()
    }

    fn outputs(&self, inputs: &[f32; INPUTS], hidden: &[f32]) -> Option<Vec<f32>> {
        let (first, second) = hidden.split_first_chunk()?;
        let state = State { first: *first, second: *second.as_array()? };
        Some(self.outputs_for(inputs, state).to_vec())
    }
}

/// This program has no such network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotBuiltIn {
    /// What was asked for.
    pub topology: Topology,
}

impl fmt::Display for NotBuiltIn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no {} network is built into this program; hidden layers of {:?} neurons are",
            self.topology,
            NetworkSpec::HIDDEN
        )
    }
}

impl std::error::Error for NotBuiltIn {}

/// The controller of this topology over a genome.
///
/// # Errors
///
/// A hidden width that is not among [`NetworkSpec::HIDDEN`], or a genome of another length.
pub fn build<'a>(
    topology: Topology,
    activation: ActivationKind,
    scaling: Scaling,
    genome: &'a [f32],
) -> Result<Box<dyn Brain + 'a>, NotBuiltIn> {
    match topology.recurrence {
        RecurrenceKind::Feedforward => sized::<Feedforward>(topology, activation, scaling, genome),
        RecurrenceKind::SelfLoop => sized::<SelfLoop>(topology, activation, scaling, genome),
        RecurrenceKind::Elman => sized::<Elman>(topology, activation, scaling, genome),
    }
    .ok_or(NotBuiltIn { topology })
}

fn sized<'a, R: Recurrence + 'a>(
    topology: Topology,
    activation: ActivationKind,
    scaling: Scaling,
    genome: &'a [f32],
) -> Option<Box<dyn Brain + 'a>> {
    with_sizes!(topology, |H, O| {
        let network = Network::<R, f32, 7, H, O>::new(genome, topology.biases);
        Some(Box::new(Controller::new(network.ok()?, activation, scaling)))
    }, else None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_core::observation::{Echo, Encoding, Reading};

    #[test]
    fn every_size_that_a_scenario_may_ask_for_is_built_in() {
        let scaling = Scaling {
            encoding: Encoding::default(),
            range: 10.0,
            steer_limit: 1.0,
            step_lower: 0.1,
            step_upper: 0.1,
        };
        let reading = Reading::new([Some(Echo::Wall(3.0)); 5], 0, 10.0).unwrap();
        for hidden in NetworkSpec::HIDDEN {
            for outputs in [1, 2] {
                for recurrence in
                    [RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman]
                {
                    let topology =
                        Topology { inputs: 7, hidden, outputs, recurrence, biases: true };
                    let genome = vec![0.1; topology.weights()];
                    let mut brain =
                        build(topology, ActivationKind::Rational, scaling, &genome).unwrap();
                    assert!(brain.decide(Ok(&reading)).steer.radians() > 0.0, "{topology}");
                    assert_eq!(brain.hidden().len(), 2 * usize::from(hidden));
                }
            }
        }
    }

    #[test]
    fn another_size_is_refused_with_the_sizes_that_exist() {
        let topology = Topology {
            inputs: 7,
            hidden: 13,
            outputs: 1,
            recurrence: RecurrenceKind::Feedforward,
            biases: false,
        };
        let scaling = Scaling {
            encoding: Encoding::default(),
            range: 1.0,
            steer_limit: 1.0,
            step_lower: 0.1,
            step_upper: 0.1,
        };
        let refused = build(topology, ActivationKind::Libm, scaling, &[]).map(|_| ()).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "no 7-13-13-1 feedforward, no biases network is built into this program; \
             hidden layers of [12, 16, 24, 32] neurons are"
        );
    }
}
