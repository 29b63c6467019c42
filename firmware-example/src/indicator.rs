//! What the car tells with one lamp.

use crate::clock::Micros;
use embedded_hal::digital::OutputPin;

/// What there is to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Signal {
    /// No weights that this car can drive with: two blinks, pause.
    NoWeights,
    /// A range sensor is missing or was lost: three blinks, pause.
    SensorsLost,
    /// Ready to be armed: one blink, long pause.
    Disarmed,
    /// Held long enough, let go to drive: fast blinking.
    Ready,
    /// Armed and driving: lit.
    Driving,
    /// Armed, stopped by a fault that may pass: slow even blinking.
    Stopped,
}

impl Signal {
    /// Every signal there is.
    pub const ALL: [Self; 6] = [
        Self::NoWeights,
        Self::SensorsLost,
        Self::Disarmed,
        Self::Ready,
        Self::Driving,
        Self::Stopped,
    ];

    /// Lit and dark in turn, one character a [`BEAT`], repeated for ever.
    pub fn pattern(self) -> &'static str {
        match self {
            Self::NoWeights => "#.#.....",
            Self::SensorsLost => "#.#.#.....",
            Self::Disarmed => "#.......",
            Self::Ready => "#.",
            Self::Driving => "#",
            Self::Stopped => "###...",
        }
    }

    /// Whether the lamp is lit at this moment.
    pub fn lit(self, now: Micros) -> bool {
        let pattern = self.pattern().as_bytes();
        let beats = usize::try_from(now.0 / BEAT).unwrap_or_default();
        beats.checked_rem(pattern.len()).and_then(|beat| pattern.get(beat)) == Some(&b'#')
    }
}

/// Shortest time the lamp is lit or dark, microseconds: longer than a control period.
pub const BEAT: u64 = 250_000;

/// A lamp that is lit while its pin is high.
#[derive(Clone, Debug)]
pub struct Indicator<P> {
    pin: P,
}

impl<P: OutputPin> Indicator<P> {
    /// The lamp on this pin.
    pub fn new(pin: P) -> Self {
        Self { pin }
    }

    /// Shows the signal as it looks at this moment; to be called in every control period.
    /// A pin that cannot be set is no reason to stop driving: whoever looks sees a dead lamp.
    pub fn show(&mut self, signal: Signal, now: Micros) {
        let _ = self.pin.set_state(signal.lit(now).into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_hal_mock::eh1::digital::{Mock, State, Transaction};

    #[test]
    fn no_two_signals_look_the_same_from_any_moment_on() {
        let look = |signal: Signal, start: u64| -> Vec<bool> {
            (start..start + 40).map(|beat| signal.lit(Micros(beat * BEAT))).collect()
        };
        for (index, signal) in Signal::ALL.into_iter().enumerate() {
            for other in Signal::ALL.into_iter().skip(index + 1) {
                for start in 0..20 {
                    assert_ne!(look(signal, 0), look(other, start), "{signal:?} and {other:?}");
                }
            }
        }
    }

    #[test]
    fn the_lamp_blinks_twice_and_pauses_where_weights_are_missing() {
        let lit = [1, 0, 1, 0, 0, 0, 0, 0, 1];
        let expected: Vec<Transaction> = lit
            .iter()
            .map(|lit| Transaction::set(if *lit == 1 { State::High } else { State::Low }))
            .collect();
        let mut pin = Mock::new(&expected);
        let mut lamp = Indicator::new(pin.clone());
        for beat in 0..lit.len() as u64 {
            lamp.show(Signal::NoWeights, Micros(BEAT * beat + 1));
        }
        pin.done();
    }
}
