//! Which beams see the target.
//!
//! A range sensor cannot tell the target from a wall, so the target shines: infrared LEDs around
//! it send 38 kHz light without a break. Beside each range sensor sits a receiver module for
//! light barriers (Vishay TSSP4038: fixed gain, made for a continuous carrier; the modules for
//! remote controls, TSOP38238 and the like, turn themselves down after milliseconds and do not
//! work here). Its output is low while it receives and pulled high otherwise, so a cut wire
//! reads "no target". The module by itself looks ±45° wide: a tube of black heat-shrink, 5 mm
//! wide and 25 mm long, narrows it to roughly the 15° between neighbouring beams.
//!
//! Limits: the receiver says that the beacon is in that direction, the range sensor how far
//! the next surface is; a small obstacle between the two that does not hide the beacon
//! counts as the target. A beacon that a white wall reflects shows up in that direction too.
//! Beyond the range the network was trained with, a beam reports nothing whatever its receiver
//! says, as in the simulator.

use controller_core::observation::BEAMS;
use embedded_hal::digital::InputPin;

/// Something that knows, beam by beam, whether the target is there.
pub trait Beacon {
    /// Whether each beam sees the target, rightmost first; none where the input cannot be read.
    fn seen(&mut self) -> [Option<bool>; BEAMS];
}

/// Five receivers whose outputs are low while they see the beacon, rightmost first.
#[derive(Clone, Debug)]
pub struct Receivers<P>(pub [P; BEAMS]);

impl<P: InputPin> Beacon for Receivers<P> {
    fn seen(&mut self) -> [Option<bool>; BEAMS] {
        self.0.each_mut().map(|receiver| receiver.is_low().ok())
    }
}
