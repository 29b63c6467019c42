//! Where two machines first disagree.

/// A value of one step, by its place in the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The commanded steer angle.
    Steer,
    /// The commanded step length.
    StepLength,
    /// A neuron of the output layer.
    Output(usize),
    /// A neuron of the first hidden layer.
    First(usize),
    /// A neuron of the second hidden layer.
    Second(usize),
}

impl Place {
    /// The place of a step's value by its position among [`values`](super::values).
    pub(super) const fn of_value<const H: usize, const O: usize>(index: usize) -> Self {
        const COMMAND: usize = 2;
        if index == 0 {
            Self::Steer
        } else if index < COMMAND {
            Self::StepLength
        } else if index < COMMAND + O {
            Self::Output(index - COMMAND)
        } else if index < COMMAND + O + H {
            Self::First(index - COMMAND - O)
        } else {
            Self::Second(index - COMMAND - O - H)
        }
    }
}

crate::sentences! { Place {
    Self::Steer => "steer angle";
    Self::StepLength => "step length";
    Self::Output(neuron) => "output neuron {}", neuron;
    Self::First(neuron) => "neuron {} of the first hidden layer", neuron;
    Self::Second(neuron) => "neuron {} of the second hidden layer", neuron;
} }

/// One value with other bits than recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Which value.
    pub place: Place,
    /// Bits computed here.
    pub found: u32,
    /// Bits recorded.
    pub expected: u32,
}

crate::sentences! { Difference {
    Self { place, found, expected } => "{}: {:08x} computed, {:08x} recorded", place, found, expected;
} }
