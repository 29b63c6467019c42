//! What keeps a car from doing exactly what its controller decides on exact readings.

use crate::scenario::{RandomiseSpec, Scenario};

/// The settings of a scenario that make its car imperfect, and nothing else of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbances {
    /// Standard deviation of a distance, metres.
    pub noise: f32,
    /// Probability that a beam sees nothing.
    pub dropout: f32,
    /// How fast the wheels turn, radians per second; none means at once.
    pub servo_rate: Option<f32>,
    /// Control periods between deciding and acting.
    pub delay_periods: u8,
    /// Largest random shift of a start, metres in x and in y.
    pub start_offset: f32,
    /// Largest random turn of a start, radians.
    pub start_turn: f32,
    /// How far a car may differ from the described one.
    pub randomise: RandomiseSpec,
}

impl Disturbances {
    /// Those of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        let Scenario { vehicle, sensors, episode, .. } = scenario;
        Self {
            noise: sensors.noise,
            dropout: sensors.dropout,
            servo_rate: vehicle.servo_rate,
            delay_periods: vehicle.delay_periods,
            start_offset: episode.start_offset,
            start_turn: episode.start_turn,
            randomise: episode.randomise,
        }
    }

    /// The same car as it was described: servo and dead time stay, nothing is left to chance.
    #[must_use]
    pub fn without_chance(self) -> Self {
        Self {
            noise: 0.0,
            dropout: 0.0,
            start_offset: 0.0,
            start_turn: 0.0,
            randomise: RandomiseSpec::default(),
            ..self
        }
    }

    /// Puts these in the place of a scenario's own.
    pub(crate) fn put_into(self, scenario: &mut Scenario) {
        let Scenario { vehicle, sensors, episode, .. } = scenario;
        sensors.noise = self.noise;
        sensors.dropout = self.dropout;
        vehicle.servo_rate = self.servo_rate;
        vehicle.delay_periods = self.delay_periods;
        episode.start_offset = self.start_offset;
        episode.start_turn = self.start_turn;
        episode.randomise = self.randomise;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Preset, find, load};

    #[test]
    fn what_is_put_into_a_scenario_is_what_it_then_has_and_the_only_thing_that_changed() {
        let small_car = load(&find("small-car").unwrap(), None, &[]).unwrap();
        let mut scenario = Preset::Paper.scenario();
        let exact = Disturbances::of(&scenario);
        Disturbances::of(&small_car).put_into(&mut scenario);
        assert_ne!(scenario, Preset::Paper.scenario());
        assert_eq!(Disturbances::of(&scenario), Disturbances::of(&small_car));
        exact.put_into(&mut scenario);
        assert_eq!(scenario, Preset::Paper.scenario());
    }

    #[test]
    fn without_chance_a_car_keeps_the_dead_time_it_was_described_with() {
        let small_car = load(&find("small-car").unwrap(), None, &[]).unwrap();
        let calm = Disturbances::of(&small_car).without_chance();
        let paper = Disturbances::of(&Preset::Paper.scenario());
        assert_eq!(calm, Disturbances { delay_periods: 1, ..paper });
    }
}
