//! Between deciding and acting: dead time and a servo of finite speed.
//!
//! The simulator applies these to every command, so that a controller learns to live with
//! them; the closed-loop proofs on a board run the same code.

use crate::controller::Command;
use crate::lane::Lane;
use crate::units::SteerAngle;
use heapless::Deque;

/// Longest dead time, control periods.
pub const MAX_DELAY: usize = 8;

/// What the wheels of an [`Actuator`] do, for any number of cars: where they point one control
/// period later, radians, when they turn from `steer` towards `wanted` by at most `most`.
#[inline(always)]
pub fn turned<L: Lane>(steer: L, wanted: L, most: f32) -> L {
    SteerAngle::safe(steer + (wanted - steer).held_within(most))
}

/// Delays commands by whole control periods and limits how fast the wheels turn.
///
/// ```
/// use controller_core::actuator::Actuator;
/// use controller_core::controller::Command;
/// use controller_core::units::{SteerAngle, StepLength};
///
/// let left = Command { steer: SteerAngle::from_radians(0.4), step: StepLength::from_metres(0.1) };
/// let mut slow = Actuator::new(1, Some(0.3));
/// assert_eq!(slow.act(left), Command::STOP);
/// assert_eq!(slow.act(left).steer.radians(), 0.3);
/// assert_eq!(slow.act(left).steer.radians(), 0.4);
/// ```
#[derive(Clone, Debug)]
pub struct Actuator {
    waiting: Deque<Command, MAX_DELAY>,
    delay: usize,
    turn_per_period: Option<f32>,
    steer: SteerAngle,
}

impl Actuator {
    /// An actuator with `delay` periods of dead time (at most [`MAX_DELAY`]; more is cut) whose
    /// wheels turn by at most `turn_per_period` radians a period, or at once. A rate that is
    /// negative or NaN holds the wheels where they are.
    pub fn new(delay: usize, turn_per_period: Option<f32>) -> Self {
        Self {
            waiting: Deque::new(),
            delay: delay.min(MAX_DELAY),
            turn_per_period: turn_per_period.map(|most| most.max(0.0)),
            steer: SteerAngle::STRAIGHT,
        }
    }

    /// Takes this period's command and returns what the car does now. Until the first command
    /// has come through, the car stands with straight wheels.
    pub fn act(&mut self, command: Command) -> Command {
        let due = if self.delay == 0 {
            command
        } else {
            let due = if self.waiting.len() == self.delay {
                self.waiting.pop_front().unwrap_or(Command::STOP)
            } else {
                Command::STOP
            };
            // There is room: at most `delay - 1` commands wait here.
            let _ = self.waiting.push_back(command);
            due
        };
        self.steer = match self.turn_per_period {
            None => due.steer,
            Some(most) => {
                // `f32::clamp` would bring a panic path for a bad limit.
                let turn = (due.steer.radians() - self.steer.radians()).held_within(most);
                SteerAngle::from_radians(self.steer.radians() + turn)
            }
        };
        Command { steer: self.steer, step: due.step }
    }
}
