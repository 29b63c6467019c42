//! One step of a closed loop, and every value that two machines compare after it.
//!
//! What the car does decides what it sees next, so one differing bit grows.

use core::convert::Infallible;
use core::fmt;

use controller_core::activation::Activation;
use controller_core::blob::Header;
use controller_core::control_loop::{Actuate, Decide, Sense, tick};
use controller_core::controller::{Command, Controller};
use controller_core::motion::Pose;
use controller_core::network::{Recurrence, State};
use controller_core::observation::{Reading, ReadingError};

use crate::course::Course;
use crate::room;

/// Width of the hidden layers that are compared.
pub const HIDDEN: usize = 12;

/// Outputs of the networks that are compared.
pub const OUTPUTS: usize = 1;

/// Values of one step: command, outputs, both hidden layers, and the pose after it.
pub const VALUES: usize = COMMAND + OUTPUTS + 2 * HIDDEN + POSE;

const COMMAND: usize = 2;
const POSE: usize = 3;

/// All values of one step as bits, in the order of [`Value`].
pub type Bits = [u32; VALUES];

/// A controller that can be looked into.
pub trait Inspect: Decide {
    /// The network's outputs in its last step, before scaling.
    fn outputs(&self) -> &[f32; OUTPUTS];

    /// All hidden outputs of its last step.
    fn state(&self) -> &State<f32, HIDDEN>;
}

impl<R: Recurrence, A: Activation> Inspect for Controller<'_, R, A, HIDDEN, OUTPUTS> {
    fn outputs(&self) -> &[f32; OUTPUTS] {
        self.outputs()
    }

    fn state(&self) -> &State<f32, HIDDEN> {
        self.state()
    }
}

/// A car on its course, built as a blob's header says.
#[derive(Clone, Debug)]
pub struct ClosedLoop<'a> {
    header: &'a Header,
    course: Course,
    step: u32,
    pose: Pose<f32>,
}

impl<'a> ClosedLoop<'a> {
    /// A car before its first step.
    pub fn new(header: &'a Header, course: Course) -> Self {
        Self { header, course, step: 0, pose: Pose::new(0.0, 0.0, 0.0) }
    }

    /// Senses, decides and drives once; a bad reading is a stop, as on the road.
    pub fn step(&mut self, controller: &mut impl Inspect) -> Bits {
        self.pose = self.course.start(self.step).unwrap_or(self.pose);
        // A bad reading has already become a stop, and this actuator refuses nothing.
        let command = tick(self, controller).unwrap_or(Command::STOP);
        self.step = self.step.wrapping_add(1);
        bits(command, controller.outputs(), controller.state(), &self.pose)
    }
}

impl Sense for ClosedLoop<'_> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        let range = self.header.scaling.range;
        let sight = room::look(&self.pose, &self.header.beams, range);
        let (echoes, age) = self.course.faults(self.step, sight, range);
        Reading::new(echoes, age, range)
    }
}

impl Actuate for ClosedLoop<'_> {
    type Error = Infallible;

    fn actuate(&mut self, command: Command) -> Result<(), Infallible> {
        self.pose = room::drive(&self.pose, command, self.header.wheelbase);
        Ok(())
    }
}

/// The values of one step as bits.
pub fn bits(
    command: Command,
    outputs: &[f32; OUTPUTS],
    hidden: &State<f32, HIDDEN>,
    pose: &Pose<f32>,
) -> Bits {
    let commanded = [command.steer.radians(), command.step.metres()];
    let reached = [pose.x, pose.y, pose.heading];
    let values: [&[f32]; 5] = [&commanded, outputs, &hidden.first, &hidden.second, &reached];
    let mut bits = [0; VALUES];
    for (word, value) in bits.iter_mut().zip(values.into_iter().flatten()) {
        *word = value.to_bits();
    }
    bits
}

/// A value of one step by its place among [`Bits`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Value(pub usize);

impl Value {
    /// When in the step it is computed: of several differences the one with the smallest is the cause.
    pub const fn order(self) -> usize {
        const LAYERS: usize = COMMAND + OUTPUTS;
        match self.0 {
            command if command < COMMAND => 2 * HIDDEN + OUTPUTS + command,
            output if output < LAYERS => 2 * HIDDEN + output - COMMAND,
            hidden if hidden < LAYERS + 2 * HIDDEN => hidden - LAYERS,
            pose => pose,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const FIRST: usize = COMMAND + OUTPUTS;
        const SECOND: usize = FIRST + HIDDEN;
        const AFTER: usize = SECOND + HIDDEN;
        match self.0 {
            0 => f.write_str("steer angle"),
            1 => f.write_str("step length"),
            place if place < FIRST => write!(f, "output neuron {}", place - COMMAND),
            place if place < SECOND => {
                write!(f, "neuron {} of the first hidden layer", place - FIRST)
            }
            place if place < AFTER => {
                write!(f, "neuron {} of the second hidden layer", place - SECOND)
            }
            AFTER => f.write_str("x after the step"),
            place if place == AFTER + 1 => f.write_str("y after the step"),
            _ => f.write_str("heading after the step"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_core::units::{SteerAngle, StepLength};

    #[test]
    fn hidden_layers_are_computed_before_outputs_commands_and_poses() {
        let mut values: Vec<usize> = (0..VALUES).collect();
        values.sort_by_key(|value| Value(*value).order());
        let expected: Vec<usize> = (3..27).chain([2, 0, 1]).chain(27..VALUES).collect();
        assert_eq!(values, expected);
    }

    #[test]
    fn every_value_of_a_step_stands_where_its_name_says() {
        let command =
            Command { steer: SteerAngle::from_unit(0.25, 1.0), step: StepLength::from_metres(0.5) };
        let mut state = State::reset();
        state.first[0] = 1.0;
        state.first[11] = 2.0;
        state.second[0] = 3.0;
        state.second[11] = 4.0;
        let pose = Pose { x: 5.0, y: 6.0, heading: 7.0, cos: 0.0, sin: 0.0 };
        let named: Vec<(String, f32)> = bits(command, &[0.75], &state, &pose)
            .into_iter()
            .enumerate()
            .map(|(place, bits)| (Value(place).to_string(), f32::from_bits(bits)))
            .filter(|(_, value)| *value != 0.0)
            .collect();
        let expected = [
            ("steer angle", 0.25),
            ("step length", 0.5),
            ("output neuron 0", 0.75),
            ("neuron 0 of the first hidden layer", 1.0),
            ("neuron 11 of the first hidden layer", 2.0),
            ("neuron 0 of the second hidden layer", 3.0),
            ("neuron 11 of the second hidden layer", 4.0),
            ("x after the step", 5.0),
            ("y after the step", 6.0),
            ("heading after the step", 7.0),
        ];
        assert_eq!(named, expected.map(|(name, value)| (name.to_owned(), value)));
    }
}
