//! The latest of five range sensors, filtered: a median of three per beam, and its age.

use crate::clock::Micros;
use crate::drivers::rangefinder::{Range, RangeFinders, SensorFault};
use controller_core::observation::BEAMS;
use heapless::Deque;

/// A beam that reported nothing for this long is missing, microseconds.
pub const SILENT: u64 = 100_000;

/// Measurements of five beams.
#[derive(Clone, Debug, Default)]
pub struct Fan {
    beams: [Beam; BEAMS],
}

#[derive(Clone, Debug, Default)]
struct Beam {
    recent: Deque<Range, 3>,
    heard: Option<Micros>,
    fault: Option<SensorFault>,
}

impl Fan {
    /// Takes what every sensor has finished. All five are asked even if one fails.
    pub fn update(&mut self, sensors: &mut impl RangeFinders, now: Micros) {
        for (index, beam) in self.beams.iter_mut().enumerate() {
            beam.take(sensors.take(index), now);
        }
    }

    /// What each beam reports now, rightmost first; none where its sensor failed when last
    /// asked, or has been silent for longer than [`SILENT`].
    pub fn ranges(&self, now: Micros) -> [Option<Range>; BEAMS] {
        self.beams.each_ref().map(|beam| {
            beam.heard.filter(|heard| now.since(*heard) <= SILENT)?;
            beam.median()
        })
    }

    /// Microseconds since the measurement that is oldest among those in [`Self::ranges`].
    pub fn age(&self, now: Micros) -> u64 {
        self.beams
            .iter()
            .filter_map(|beam| beam.heard)
            .map(|heard| now.since(heard))
            .max()
            .unwrap_or(0)
    }

    /// What was wrong with each sensor when it was last asked, rightmost first.
    pub fn faults(&self) -> [Option<SensorFault>; BEAMS] {
        self.beams.each_ref().map(|beam| beam.fault)
    }
}

impl Beam {
    fn take(&mut self, taken: Result<Option<Range>, SensorFault>, now: Micros) {
        // What was measured before a fault or a silence says nothing about what comes after it.
        if taken.is_err() || self.heard.is_some_and(|heard| now.since(heard) > SILENT) {
            *self = Self::default();
        }
        self.fault = taken.err();
        if let Ok(Some(range)) = taken {
            if self.recent.is_full() {
                self.recent.pop_front();
            }
            // There is room now.
            let _ = self.recent.push_back(range);
            self.heard = Some(now);
        }
    }

    /// The median of three; until there are three, the nearest, which is the safe side.
    fn median(&self) -> Option<Range> {
        let mut recent = self.recent.iter().copied();
        match (recent.next(), recent.next(), recent.next()) {
            (Some(a), Some(b), Some(c)) => Some(a.min(b).max(a.max(b).min(c))),
            (a, b, _) => a.into_iter().chain(b).min(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drivers::rangefinder::{BusFault, StartError};

    /// Every sensor answers the same, but the one at `lost` fails.
    struct Scripted {
        answer: Option<Range>,
        lost: Option<usize>,
    }

    impl RangeFinders for Scripted {
        fn start(&mut self) -> Result<(), StartError> {
            Ok(())
        }

        fn take(&mut self, beam: usize) -> Result<Option<Range>, SensorFault> {
            if self.lost == Some(beam) {
                Err(SensorFault::Bus(BusFault::NoAnswer))
            } else {
                Ok(self.answer)
            }
        }
    }

    fn fed(ranges: &[Range]) -> Fan {
        let mut fan = Fan::default();
        for range in ranges {
            fan.update(&mut Scripted { answer: Some(*range), lost: None }, Micros(0));
        }
        fan
    }

    fn first(fan: &Fan) -> Option<Range> {
        fan.ranges(Micros(0))[0]
    }

    #[test]
    fn the_median_of_every_order_of_three_is_the_middle_one() {
        let [near, middle, far] = [Range::At(100), Range::At(700), Range::Nothing];
        for order in [
            [near, middle, far],
            [near, far, middle],
            [middle, near, far],
            [middle, far, near],
            [far, near, middle],
            [far, middle, near],
        ] {
            assert_eq!(first(&fed(&order)), Some(middle), "{order:?}");
        }
    }

    #[test]
    fn one_wild_measurement_among_steady_ones_does_not_show() {
        let steady = Range::At(500);
        for wild in [Range::At(0), Range::At(20), Range::Nothing] {
            assert_eq!(first(&fed(&[steady, steady, wild])), Some(steady));
            assert_eq!(first(&fed(&[steady, steady, wild, steady])), Some(steady));
        }
    }

    #[test]
    fn the_nearest_counts_until_there_are_three() {
        assert_eq!(first(&fed(&[])), None);
        assert_eq!(first(&fed(&[Range::Nothing])), Some(Range::Nothing));
        assert_eq!(first(&fed(&[Range::Nothing, Range::At(900)])), Some(Range::At(900)));
    }

    #[test]
    fn a_failing_sensor_is_missing_at_once_and_comes_back_without_its_past() {
        let mut fan = fed(&[Range::At(300); 3]);
        let mut sensors = Scripted { answer: Some(Range::At(300)), lost: Some(2) };
        fan.update(&mut sensors, Micros(1));
        let seen = fan.ranges(Micros(1)).map(|range| range.is_some());
        assert_eq!(seen, [true, true, false, true, true]);
        assert_eq!(fan.faults()[2], Some(SensorFault::Bus(BusFault::NoAnswer)));

        sensors = Scripted { answer: Some(Range::At(1000)), lost: None };
        fan.update(&mut sensors, Micros(2));
        assert_eq!(fan.ranges(Micros(2))[2], Some(Range::At(1000)));
        assert_eq!(fan.ranges(Micros(2))[1], Some(Range::At(300)), "one new against two old");
        assert_eq!(fan.faults(), [None; BEAMS]);
    }

    #[test]
    fn a_silent_sensor_grows_old_and_is_then_missing() {
        let mut fan = fed(&[Range::At(300); 3]);
        let mut silent = Scripted { answer: None, lost: None };
        fan.update(&mut silent, Micros(SILENT));
        assert_eq!(fan.age(Micros(SILENT)), SILENT);
        assert_eq!(fan.ranges(Micros(SILENT)), [Some(Range::At(300)); BEAMS]);
        assert_eq!(fan.ranges(Micros(SILENT + 1)), [None; BEAMS]);
    }
}
