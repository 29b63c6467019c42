//! Where two machines first disagree.

use core::fmt;

/// A value of one step, by its place in the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steer => f.write_str("steer angle"),
            Self::StepLength => f.write_str("step length"),
            Self::Output(neuron) => write!(f, "output neuron {neuron}"),
            Self::First(neuron) => write!(f, "neuron {neuron} of the first hidden layer"),
            Self::Second(neuron) => write!(f, "neuron {neuron} of the second hidden layer"),
        }
    }
}

/// One value with other bits than recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Difference {
    /// Which value.
    pub place: Place,
    /// Bits computed here.
    pub found: u32,
    /// Bits recorded.
    pub expected: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, found, expected } = self;
        write!(f, "{place}: {found:08x} computed, {expected:08x} recorded")
    }
}
