//! One decision per control period: encode, run the network, scale, or stop.

use crate::activation::Activation;
use crate::control_loop::Decide;
use crate::lane::Lane;
use crate::network::{Network, Recurrence, State};
use crate::observation::{Encoding, INPUTS, Reading, ReadingError};
use crate::units::{SteerAngle, StepLength};

/// What the car does until the next control period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command {
    /// Where the front wheels point.
    pub steer: SteerAngle,
    /// How far to drive.
    pub step: StepLength,
}

impl Command {
    /// The fail-safe: wheels straight, motor stopped.
    pub const STOP: Self = Self { steer: SteerAngle::STRAIGHT, step: StepLength::STOP };
}

/// How network inputs and outputs relate to the car; recorded in the weight blob.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Scaling {
    /// How readings become inputs.
    pub encoding: Encoding,
    /// Longest distance a beam reports, metres.
    pub range: f32,
    /// Steer angle at output 1, radians, above 0 and at most π/2.
    pub steer_limit: f32,
    /// Metres per control period at speed output −1.
    pub step_lower: f32,
    /// Metres per control period at speed output +1, and of a network without speed output.
    pub step_upper: f32,
}

impl Scaling {
    /// The command that the network's outputs mean: the first is the steer angle, a second, if
    /// any, the speed. Outputs that are NaN, or none at all, mean [`Command::STOP`].
    #[inline]
    pub fn command(&self, outputs: &[f32]) -> Command {
        let steer = outputs.first().copied().unwrap_or(f32::NAN);
        if steer.is_nan() || outputs.get(1).is_some_and(|speed| speed.is_nan()) {
            return Command::STOP;
        }
        let step = match outputs.get(1) {
            Some(speed) => StepLength::from_unit(*speed, self.step_lower, self.step_upper),
            None => StepLength::from_metres(self.step_upper),
        };
        Command { steer: SteerAngle::from_unit(steer, self.steer_limit), step }
    }

    /// [`Self::command`] for any number of cars: steer angles in radians, and step lengths in
    /// metres.
    #[inline(always)]
    pub fn commands<L: Lane, const O: usize>(&self, outputs: &[L; O]) -> (L, L) {
        let zero = L::from(0.0);
        let Some(&steer) = outputs.first() else { return (zero, zero) };
        let angle = SteerAngle::safe_from_unit(steer, self.steer_limit);
        let (known, length) = match outputs.get(1) {
            Some(&speed) => (
                steer.le(steer) & speed.le(speed),
                StepLength::safe_from_unit(speed, self.step_lower, self.step_upper),
            ),
            None => (steer.le(steer), StepLength::safe(L::from(self.step_upper))),
        };
        (L::select(known, angle, zero), L::select(known, length, zero))
    }
}

/// Good readings in a row after a bad one that the car needs: it moves again on the last.
pub const RECOVERY: u32 = 3;

/// A network with its memory and its fail-safe.
///
/// **State rule.** The network steps only on readings it acts on. A bad reading, and the good
/// ones after it up to the one before the [`RECOVERY`]-th in a row, give [`Command::STOP`] and
/// leave the recurrent state as it was: a fault never enters the memory.
#[derive(Clone, Debug)]
pub struct Controller<'a, R: Recurrence, A, const H: usize, const O: usize> {
    network: Network<'a, R, f32, INPUTS, H, O>,
    activation: A,
    scaling: Scaling,
    state: State<f32, H>,
    outputs: [f32; O],
    good_readings_owed: u32,
}

impl<'a, R: Recurrence, A: Activation, const H: usize, const O: usize> Controller<'a, R, A, H, O> {
    /// A controller at the start of a drive.
    pub fn new(
        network: Network<'a, R, f32, INPUTS, H, O>,
        activation: A,
        scaling: Scaling,
    ) -> Self {
        Self {
            network,
            activation,
            scaling,
            state: State::reset(),
            outputs: [0.0; O],
            good_readings_owed: 0,
        }
    }

    /// Forgets everything: the start of another drive.
    pub fn reset(&mut self) {
        self.state = State::reset();
        self.outputs = [0.0; O];
        self.good_readings_owed = 0;
    }

    /// All hidden outputs of the last step that the network made.
    pub fn state(&self) -> &State<f32, H> {
        &self.state
    }

    /// The network's outputs in the last step that it made, before scaling.
    pub fn outputs(&self) -> &[f32; O] {
        &self.outputs
    }

    /// The network's outputs for any inputs and memory, without a step of the controller.
    pub fn outputs_for(&self, inputs: &[f32; INPUTS], mut state: State<f32, H>) -> [f32; O] {
        self.network.step(self.activation, &mut state, inputs)
    }

    /// How inputs and outputs relate to the car.
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }
}

impl<R: Recurrence, A: Activation, const H: usize, const O: usize> Decide
    for Controller<'_, R, A, H, O>
{
    #[inline]
    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command {
        match reading {
            Err(_) => {
                self.good_readings_owed = RECOVERY;
                Command::STOP
            }
            Ok(_) if self.good_readings_owed > 1 => {
                self.good_readings_owed -= 1;
                Command::STOP
            }
            Ok(reading) => {
                self.good_readings_owed = 0;
                let inputs = self.scaling.encoding.inputs(&reading.sight(), self.scaling.range);
                self.outputs = self.network.step_alone(self.activation, &mut self.state, &inputs);
                self.scaling.command(&self.outputs)
            }
        }
    }
}
