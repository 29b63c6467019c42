//! A controller for the weights in a blob, whichever recurrence and tanh the blob names.

use controller_core::activation::{Activation, ActivationKind, Libm, Micromath, Rational};
use controller_core::blob::{Blob, BlobError, SelfTestError, WrongTopology};
use controller_core::control_loop::Decide;
use controller_core::controller::Controller;
use controller_core::network::{Elman, Feedforward, Recurrence, RecurrenceKind, SelfLoop, State};
use core::fmt;

/// Width of the hidden layers this program has code for.
pub const HIDDEN: usize = 12;

/// Outputs of the networks this program has code for.
pub const OUTPUTS: usize = 1;

/// Why weights are not used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// They are no blob.
    Blob(BlobError),
    /// The blob holds a network that this program has no code for.
    Topology(WrongTopology),
    /// This machine fails the blob's own test.
    SelfTest(SelfTestError),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Blob(error) => write!(f, "weights refused: {error}"),
            Self::Topology(error) => write!(f, "weights refused: {error}"),
            Self::SelfTest(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Refusal {}

/// What a proof needs of a controller: its decisions and every value behind them.
pub trait AnyController: Decide {
    /// The network's outputs in its last step, before scaling.
    fn outputs(&self) -> &[f32; OUTPUTS];

    /// All hidden outputs of its last step.
    fn state(&self) -> &State<f32, HIDDEN>;
}

impl<R: Recurrence, A: Activation> AnyController for Controller<'_, R, A, HIDDEN, OUTPUTS> {
    fn outputs(&self) -> &[f32; OUTPUTS] {
        self.outputs()
    }

    fn state(&self) -> &State<f32, HIDDEN> {
        self.state()
    }
}

/// Runs the blob's self-test and lends a controller at the start of a drive.
///
/// # Errors
///
/// A network this program has no code for, or a self-test that this machine fails.
pub fn with_controller<T>(
    blob: &Blob<'_>,
    lend: impl FnOnce(&mut dyn AnyController) -> T,
) -> Result<T, Refusal> {
    match blob.header().topology.recurrence {
        RecurrenceKind::Feedforward => with_recurrence::<Feedforward, T>(blob, lend),
        RecurrenceKind::SelfLoop => with_recurrence::<SelfLoop, T>(blob, lend),
        RecurrenceKind::Elman => with_recurrence::<Elman, T>(blob, lend),
    }
}

fn with_recurrence<R: Recurrence, T>(
    blob: &Blob<'_>,
    lend: impl FnOnce(&mut dyn AnyController) -> T,
) -> Result<T, Refusal> {
    match blob.header().activation {
        ActivationKind::Rational => with_activation::<R, T>(blob, Rational, lend),
        ActivationKind::Libm => with_activation::<R, T>(blob, Libm, lend),
        ActivationKind::Micromath => with_activation::<R, T>(blob, Micromath, lend),
    }
}

fn with_activation<R: Recurrence, T>(
    blob: &Blob<'_>,
    activation: impl Activation,
    lend: impl FnOnce(&mut dyn AnyController) -> T,
) -> Result<T, Refusal> {
    let network = blob.network::<R, HIDDEN, OUTPUTS>().map_err(Refusal::Topology)?;
    blob.self_test::<R, HIDDEN, OUTPUTS>(activation).map_err(Refusal::SelfTest)?;
    Ok(lend(&mut Controller::new(network, activation, blob.scaling())))
}
