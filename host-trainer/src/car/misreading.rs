//! How imperfect sensors misread what the beams end on.
//!
//! What they misread in a control period is drawn for every beam, whether or not it sees anything,
//! so that it depends on the drive's random numbers alone and not on where the car has got to.
//! All individuals that drive a pair share it.

use super::model::{CarModel, Hit};
use crate::seed::Stream;
use controller_core::lane::Lane;
use controller_core::observation::BEAMS;

/// What the beams misread in one control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Misreading<L> {
    /// What is added to each beam's distance, rightmost first, metres; [`DROPPED`] for a beam that
    /// sees nothing.
    pub(crate) error: [L; BEAMS],
}

/// The error of a beam that is dropped.
pub(crate) const DROPPED: f32 = f32::INFINITY;

impl CarModel {
    /// The next control period's. Draws as often in every period.
    pub(crate) fn misreading(&self, random: &mut Stream) -> Misreading<f32> {
        let mut error = [0.0; BEAMS];
        for error in &mut error {
            if self.noise != 0.0 {
                *error = self.noise * random.normal();
            }
            if self.dropout > 0.0 && random.chance(self.dropout) {
                *error = DROPPED;
            }
        }
        Misreading { error }
    }

    /// What a beam reports that ends there.
    #[inline(always)]
    pub(crate) fn misread<L: Lane>(&self, hit: Hit<L>, error: L) -> Hit<L> {
        let range = L::from(self.range());
        let kept = error.lt(L::from(DROPPED));
        let (target, wall) = (hit.target & kept, hit.wall & kept);
        let distance = (hit.distance + error).max(L::from(0.0)).min(range);
        Hit { target, wall, distance: L::select(target | wall, distance, range) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Preset, Scenario};
    use crate::seed::{Purpose, RunSeed};

    fn model(noise: f32, dropout: f32) -> CarModel {
        let mut scenario: Scenario = Preset::Paper.scenario();
        (scenario.sensors.noise, scenario.sensors.dropout) = (noise, dropout);
        CarModel::new(&scenario)
    }

    fn stream() -> Stream {
        RunSeed(5).stream(Purpose::Episode, 0, 0)
    }

    /// What a beam of 10 m reports: on the target, on a wall, metres.
    fn reported(wall: f32, target: f32, error: f32) -> (bool, bool, f32) {
        let model = model(0.1, 0.1);
        let hit = model.misread(model.hit(wall, target), error);
        (hit.target, hit.wall, hit.distance)
    }

    #[test]
    fn a_dropped_beam_sees_nothing() {
        for (wall, target) in [(2.0, f32::INFINITY), (2.0, 1.0), (f32::INFINITY, f32::INFINITY)] {
            assert_eq!(reported(wall, target, DROPPED), (false, false, 10.0));
        }
    }

    #[test]
    fn an_error_moves_a_distance_within_the_range_and_not_what_is_seen() {
        assert_eq!(reported(2.0, f32::INFINITY, 0.25), (false, true, 2.25));
        assert_eq!(reported(2.0, 1.0, -0.25), (true, false, 0.75));
        assert_eq!(reported(2.0, f32::INFINITY, -3.0), (false, true, 0.0));
        assert_eq!(reported(9.5, f32::INFINITY, 3.0), (false, true, 10.0));
        for error in [-3.0, 0.0, 3.0] {
            assert_eq!(reported(f32::INFINITY, 11.0, error), (false, false, 10.0));
        }
    }

    #[test]
    fn each_beam_draws_its_error_and_then_whether_it_is_dropped() {
        let (sigma, dropout) = (0.02, 0.4);
        let [mut both, mut noise, mut drops] = [stream(), stream(), stream()];
        let mut by_hand = stream();
        for _ in 0..100 {
            let found = model(sigma, dropout).misreading(&mut both);
            let expected = [(); BEAMS].map(|()| {
                let error = sigma * by_hand.normal();
                if by_hand.unit() < dropout { DROPPED } else { error }
            });
            assert_eq!(found.error, expected);
        }
        let found = model(sigma, 0.0).misreading(&mut noise);
        let mut by_hand = stream();
        assert_eq!(found.error, [(); BEAMS].map(|()| sigma * by_hand.normal()));
        let found = model(0.0, dropout).misreading(&mut drops);
        let mut by_hand = stream();
        let dropped = [(); BEAMS].map(|()| by_hand.unit() < dropout);
        assert_eq!(found.error, dropped.map(|dropped| if dropped { DROPPED } else { 0.0 }));
    }
}
