//! A controller for the weights in a blob, whichever recurrence and tanh the blob names.

use controller_core::activation::{ActivationKind, Libm, Micromath, Rational};
use controller_core::blob::{Blob, BlobError, SelfTestError, WrongTopology};
use controller_core::control_loop::Decide;
#[cfg(not(any(feature = "sabotage-reordered-sum", feature = "sabotage-fused-sum")))]
use controller_core::controller::Controller;
use controller_core::controller::{Command, Scaling};
use controller_core::network::{Elman, Feedforward, Recurrence, RecurrenceKind, SelfLoop, State};
use controller_core::observation::{Reading, ReadingError};

#[cfg(any(feature = "sabotage-reordered-sum", feature = "sabotage-fused-sum"))]
use crate::sabotage::Controller;

/// Width of the hidden layers the boards' programs have code for.
pub const HIDDEN: usize = 12;

/// Outputs of the networks the boards' programs have code for.
pub const OUTPUTS: usize = 1;

/// Why weights are not used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// There is no blob, or a damaged one.
    Blob(BlobError),
    /// The blob holds a network that this program has no code for.
    Topology(WrongTopology),
    /// This machine computes something else than the one that trained the weights.
    SelfTest(SelfTestError),
}

controller_core::sentences! { Refusal {
    Self::Blob(error) => "{}", error;
    Self::Topology(error) => "{}", error;
    Self::SelfTest(error) => "{}", error;
} }

impl core::error::Error for Refusal {}

/// What drives: a network over a blob's weights with its memory, whichever recurrence and
/// tanh the blob names. `H` is the width of the hidden layers, `O` the number of outputs.
#[derive(Clone, Debug)]
pub struct Brain<'w, const H: usize, const O: usize> {
    kind: Kind<'w, H, O>,
    scaling: Scaling,
    period: u64,
    check: u64,
}

/// An enum and no trait object: the bound of the stack stays computable.
#[derive(Clone, Debug)]
enum Kind<'w, const H: usize, const O: usize> {
    Feedforward(WithTanh<'w, Feedforward, H, O>),
    SelfLoop(WithTanh<'w, SelfLoop, H, O>),
    Elman(WithTanh<'w, Elman, H, O>),
}

#[derive(Clone, Debug)]
enum WithTanh<'w, R: Recurrence, const H: usize, const O: usize> {
    Rational(Controller<'w, R, Rational, H, O>),
    Libm(Controller<'w, R, Libm, H, O>),
    Micromath(Controller<'w, R, Micromath, H, O>),
}

impl<'w, const H: usize, const O: usize> Brain<'w, H, O> {
    /// Runs the blob's self-test on this machine; then it is at the start of a drive.
    ///
    /// # Errors
    ///
    /// A network this program has no code for, or a self-test that this machine fails.
    pub fn new(blob: &Blob<'w>) -> Result<Self, Refusal> {
        let kind = match blob.header().topology.recurrence {
            RecurrenceKind::Feedforward => Kind::Feedforward(WithTanh::new(blob)?),
            RecurrenceKind::SelfLoop => Kind::SelfLoop(WithTanh::new(blob)?),
            RecurrenceKind::Elman => Kind::Elman(WithTanh::new(blob)?),
        };
        // The cast rounds down to whole microseconds.
        let period = (blob.header().period * 1e6 + 0.5) as u64;
        Ok(Self { kind, scaling: blob.scaling(), period, check: blob.check() })
    }

    /// How inputs and outputs relate to the car.
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }

    /// The control period it was trained with, microseconds.
    pub fn period(&self) -> u64 {
        self.period
    }

    /// The blob's check: a name for these exact weights.
    pub fn check(&self) -> u64 {
        self.check
    }

    /// The network's outputs in its last step, before scaling.
    pub fn outputs(&self) -> &[f32; O] {
        match &self.kind {
            Kind::Feedforward(network) => network.outputs(),
            Kind::SelfLoop(network) => network.outputs(),
            Kind::Elman(network) => network.outputs(),
        }
    }

    /// All hidden outputs of its last step.
    pub fn state(&self) -> &State<f32, H> {
        match &self.kind {
            Kind::Feedforward(network) => network.state(),
            Kind::SelfLoop(network) => network.state(),
            Kind::Elman(network) => network.state(),
        }
    }

    /// Forgets everything: the start of another drive.
    pub fn reset(&mut self) {
        match &mut self.kind {
            Kind::Feedforward(network) => network.reset(),
            Kind::SelfLoop(network) => network.reset(),
            Kind::Elman(network) => network.reset(),
        }
    }
}

impl<const H: usize, const O: usize> Decide for Brain<'_, H, O> {
    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command {
        match &mut self.kind {
            Kind::Feedforward(network) => network.decide(reading),
            Kind::SelfLoop(network) => network.decide(reading),
            Kind::Elman(network) => network.decide(reading),
        }
    }
}

impl<'w, R: Recurrence, const H: usize, const O: usize> WithTanh<'w, R, H, O> {
    fn new(blob: &Blob<'w>) -> Result<Self, Refusal> {
        let network = blob.network::<R, H, O>().map_err(Refusal::Topology)?;
        let scaling = blob.scaling();
        let tested = match blob.header().activation {
            ActivationKind::Rational => blob.self_test::<R, H, O>(Rational),
            ActivationKind::Libm => blob.self_test::<R, H, O>(Libm),
            ActivationKind::Micromath => blob.self_test::<R, H, O>(Micromath),
        };
        tested.map_err(Refusal::SelfTest)?;
        Ok(match blob.header().activation {
            ActivationKind::Rational => Self::Rational(Controller::new(network, Rational, scaling)),
            ActivationKind::Libm => Self::Libm(Controller::new(network, Libm, scaling)),
            ActivationKind::Micromath => {
                Self::Micromath(Controller::new(network, Micromath, scaling))
            }
        })
    }

    fn outputs(&self) -> &[f32; O] {
        match self {
            Self::Rational(controller) => controller.outputs(),
            Self::Libm(controller) => controller.outputs(),
            Self::Micromath(controller) => controller.outputs(),
        }
    }

    fn state(&self) -> &State<f32, H> {
        match self {
            Self::Rational(controller) => controller.state(),
            Self::Libm(controller) => controller.state(),
            Self::Micromath(controller) => controller.state(),
        }
    }

    fn reset(&mut self) {
        match self {
            Self::Rational(controller) => controller.reset(),
            Self::Libm(controller) => controller.reset(),
            Self::Micromath(controller) => controller.reset(),
        }
    }

    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command {
        match self {
            Self::Rational(controller) => controller.decide(reading),
            Self::Libm(controller) => controller.decide(reading),
            Self::Micromath(controller) => controller.decide(reading),
        }
    }
}
