//! Varied inputs from an integer generator: the same on every machine and in every release.

use controller_core::observation::{BEAMS, Echo, INPUTS};

/// A linear congruential generator (Numerical Recipes); its upper half is used.
pub(crate) struct Inputs(u32);

impl Inputs {
    /// Always the same series.
    pub(crate) fn new() -> Self {
        Self(12_345)
    }

    fn upper_half(&mut self) -> u16 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) as u16
    }

    /// In `-1.0..1.0`, a multiple of 2⁻¹⁵.
    pub(crate) fn within_one(&mut self) -> f32 {
        f32::from(self.upper_half().cast_signed()) / 32_768.0
    }

    /// Inputs of one step of a network.
    pub(crate) fn network(&mut self) -> [f32; INPUTS] {
        [(); INPUTS].map(|()| self.within_one())
    }

    /// What the beams report in one control period, up to `range` metres.
    pub(crate) fn echoes(&mut self, range: f32) -> [Option<Echo>; BEAMS] {
        [(); BEAMS].map(|()| {
            let distance = self.within_one().abs() * range;
            Some(match self.upper_half() % 4 {
                0 => Echo::Nothing,
                1 => Echo::Target(distance),
                _ => Echo::Wall(distance),
            })
        })
    }
}
