//! The button between standing and driving.

use crate::clock::Micros;

/// How long the button has to be held, microseconds.
pub const HOLD: u64 = 2_000_000;

/// Whether the car may drive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Arming {
    /// It stands. The button has to be seen released first: one that is stuck, or still held
    /// after a press that disarmed, never arms.
    #[default]
    Blocked,
    /// It stands, and the button is released.
    Disarmed,
    /// It stands while the button is held.
    Held {
        /// Since when.
        since: u64,
    },
    /// The button was held long enough: letting it go starts the drive, so that no hand is on
    /// the car when the motor starts.
    Ready,
    /// It drives.
    Armed,
}

impl Arming {
    /// The next state after looking at the button. Disarming takes one look; arming takes
    /// [`HOLD`] without one look at a released button, so contact bounce can only delay it.
    pub fn next(self, pressed: bool, now: Micros) -> Self {
        match (self, pressed) {
            (Self::Blocked, true) => Self::Blocked,
            (Self::Armed, true) => Self::Blocked,
            (Self::Disarmed, true) => Self::Held { since: now.0 },
            (Self::Held { since }, true) if now.since(Micros(since)) >= HOLD => Self::Ready,
            (Self::Held { .. } | Self::Ready, true) => self,
            (Self::Ready | Self::Armed, false) => Self::Armed,
            (Self::Blocked | Self::Disarmed | Self::Held { .. }, false) => Self::Disarmed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The states after each look, 100 ms apart: `#` pressed, `.` released.
    fn looks(button: &str) -> Vec<Arming> {
        let mut arming = Arming::default();
        let look = |(index, pressed): (usize, char)| {
            arming = arming.next(pressed == '#', Micros(100_000 * index as u64));
            arming
        };
        button.chars().enumerate().map(look).collect()
    }

    fn last(button: &str) -> Arming {
        looks(button).pop().expect("at least one look")
    }

    #[test]
    fn two_seconds_and_a_release_arm() {
        let held_for = |looks: usize| format!(".{}", "#".repeat(looks));
        assert_eq!(last(&held_for(20)), Arming::Held { since: 100_000 });
        assert_eq!(last(&held_for(21)), Arming::Ready);
        assert_eq!(last(&held_for(60)), Arming::Ready, "no driving while a hand is on the car");
        assert_eq!(last(&(held_for(21) + ".")), Arming::Armed);
        assert_eq!(last(&(held_for(20) + ".")), Arming::Disarmed);
    }

    #[test]
    fn a_press_disarms_at_once_and_holding_on_does_not_arm_again() {
        let armed = format!(".{}.", "#".repeat(21));
        assert_eq!(last(&(armed.clone() + "...")), Arming::Armed);
        assert_eq!(last(&(armed.clone() + "#")), Arming::Blocked);
        assert_eq!(last(&(armed.clone() + &"#".repeat(50))), Arming::Blocked);
        assert_eq!(last(&(armed + "#.")), Arming::Disarmed);
    }

    #[test]
    fn a_button_that_is_stuck_since_boot_never_arms() {
        assert!(looks(&"#".repeat(100)).iter().all(|state| *state == Arming::Blocked));
    }

    #[test]
    fn one_released_look_starts_the_two_seconds_anew() {
        let bounced = format!(".{}.{}", "#".repeat(19), "#".repeat(20));
        assert!(matches!(last(&bounced), Arming::Held { .. }));
        assert_eq!(last(&(bounced + "#")), Arming::Ready);
    }
}
