//! Where a closed loop puts the car, and which of its readings go wrong.

use core::f32::consts::PI;

use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, Echo, STALE_AFTER};
use controller_core::trig::sin_cos;

use crate::random::Random;
use crate::room;

/// Purposes of random numbers.
const PLACE: u8 = 1;
const FAULT: u8 = 2;

/// One reading in so many has something the matter with it.
const STEPS_PER_FAULT: u64 = 32;

/// A drive's surroundings: the same for every machine that drives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// A few known places in turn, every reading good.
    Tour,
    /// Anywhere in the room, its boxes included, or in sight of the target; and readings that are missing, out of
    /// range, or old.
    Seeded(u32),
}

impl Course {
    /// Where the car is put before this step, if it is put anywhere.
    pub fn start(self, step: u32) -> Option<Pose<f32>> {
        let Self::Seeded(seed) = self else { return room::start(step) };
        if !step.is_multiple_of(room::STEPS_PER_START) {
            return None;
        }
        let mut random = Random::at(seed, PLACE, step);
        let heading = PI * random.within_one();
        let towards_target = random.next_bits().is_multiple_of(2);
        let [a, b] = [(); 2].map(|()| random.within_one());
        Some(if towards_target {
            let (sin, cos) = sin_cos(heading);
            let away = 1.6 + 1.1 * a;
            let (x, y) = room::TARGET.centre;
            Pose::new(x - away * cos, y - away * sin, heading + 0.5 * b)
        } else {
            Pose::new(5.0 + 4.5 * a, 5.0 + 4.5 * b, heading)
        })
    }

    /// What the sensors report in this step where they should report `echoes`, and how many control periods
    /// ago.
    pub fn faults(
        self,
        step: u32,
        mut echoes: [Option<Echo>; BEAMS],
        range: f32,
    ) -> ([Option<Echo>; BEAMS], u32) {
        let Self::Seeded(seed) = self else { return (echoes, 0) };
        let mut random = Random::at(seed, FAULT, step);
        if !random.next_bits().is_multiple_of(STEPS_PER_FAULT) {
            return (echoes, 0);
        }
        let bits = random.next_bits();
        let beam = echoes.get_mut((bits >> 32) as usize % BEAMS);
        let broken = match bits % 8 {
            0 | 1 => None,
            2 => Some(Echo::Wall(f32::NAN)),
            3 => Some(Echo::Target(range * 1.001)),
            4 => Some(Echo::Wall(-0.1)),
            5 => return (echoes, STALE_AFTER + 1),
            age => return (echoes, age as u32 - 5),
        };
        if let Some(beam) = beam {
            *beam = broken;
        }
        (echoes, 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_core::observation::{Reading, ReadingError};

    #[test]
    fn a_seeded_course_has_every_kind_of_fault_and_mostly_good_readings() {
        let (mut good, mut old) = (0, 0);
        let mut found = [0; 5];
        for step in 0..10_000 {
            let sight = [Some(Echo::Wall(2.0)); BEAMS];
            let (echoes, age) = Course::Seeded(3).faults(step, sight, room::RANGE);
            match Reading::new(echoes, age, room::RANGE) {
                Ok(_) if age == 0 => good += 1,
                Ok(_) => old += 1,
                Err(ReadingError::Missing { .. }) => found[0] += 1,
                Err(ReadingError::OutOfRange { distance, .. }) if distance.is_nan() => {
                    found[1] += 1;
                }
                Err(ReadingError::OutOfRange { distance, .. }) if distance < 0.0 => found[2] += 1,
                Err(ReadingError::OutOfRange { .. }) => found[3] += 1,
                Err(ReadingError::Stale { .. }) => found[4] += 1,
            }
        }
        // 10 000 / 32 faults over eight kinds: about 39 of each, two of them a missing beam, two harmless.
        assert!((9_600..9_780).contains(&good), "{good}");
        assert!((50..110).contains(&old), "{old}");
        assert!(found.iter().all(|count| (20..110).contains(count)), "{found:?}");
    }

    #[test]
    fn a_seeded_course_goes_all_over_the_room_and_differs_from_seed_to_seed() {
        let places = |seed| {
            (0..400 * room::STEPS_PER_START)
                .filter_map(move |step| Course::Seeded(seed).start(step))
        };
        assert_eq!(places(1).count(), 400);
        let quadrants: Vec<_> =
            places(1).map(|pose| (pose.x > 5.0, pose.y > 5.0, pose.heading > 0.0)).collect();
        for corner in 0..8 {
            let wanted = (corner & 1 != 0, corner & 2 != 0, corner & 4 != 0);
            let share = quadrants.iter().filter(|found| **found == wanted).count();
            assert!((20..100).contains(&share), "{wanted:?}: {share}");
        }
        let seen = places(1).filter(|pose| {
            let echoes = room::look(pose, &room::mounts(), room::RANGE);
            echoes.iter().any(|echo| matches!(echo, Some(Echo::Target(_))))
        });
        assert!((150..300).contains(&seen.count()));
        assert!(places(1).zip(places(2)).all(|(one, other)| one != other));
    }
}
