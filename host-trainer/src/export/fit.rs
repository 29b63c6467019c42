//! Whether the car as shipped would drive with a champion.

use std::fmt::{self, Display};

use controller_core::blob::Header;

use super::board::ShippedCar;

/// Limits are compared with this allowance for rounding, as the car does.
const ROUNDING: f32 = 1.001;

/// Why the car as shipped refuses a champion: every reason, where the car stops at the first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfits {
    takes: Vec<String>,
    found: Vec<String>,
    settings: Vec<String>,
}

impl Misfits {
    /// Compares the car in a blob's header with `car`; `None` if they fit.
    pub fn of(header: &Header, car: &ShippedCar) -> Option<Self> {
        let mut misfits = Self { takes: Vec::new(), found: Vec::new(), settings: Vec::new() };
        misfits.network(header, car);
        misfits.limits(header, car);
        misfits.beams(header, car);
        (!misfits.takes.is_empty()).then_some(misfits)
    }

    fn network(&mut self, header: &Header, car: &ShippedCar) {
        let topology = header.topology;
        let hidden = usize::from(topology.hidden);
        if hidden != car.hidden {
            self.push(
                format!("{} hidden neurons a layer", car.hidden),
                hidden,
                format!("network.hidden={}", car.hidden),
            );
        }
        let outputs = usize::from(topology.outputs);
        if outputs != car.outputs {
            let step = format!("vehicle.step_m={}", car.step(header.period));
            self.push("one output, with constant speed", format!("{outputs} outputs"), step);
        }
    }

    fn limits(&mut self, header: &Header, car: &ShippedCar) {
        let (shortest, longest) = car.periods;
        if !(shortest..=longest).contains(&header.period) {
            self.push(
                format!("control periods of {shortest} to {longest} s"),
                format!("{} s", header.period),
                format!("episode.period_s={}", car.period(header.period)),
            );
        }
        let scaling = header.scaling;
        if scaling.steer_limit > car.steer_limit * ROUNDING {
            let degrees = car.steer_limit.to_degrees();
            self.push(
                format!("steer angles up to {degrees:.1}°"),
                format!("{:.1}°", scaling.steer_limit.to_degrees()),
                format!("vehicle.steer_limit_deg={}", degrees.floor()),
            );
        }
        let speed = scaling.step_upper / header.period;
        if speed > car.speed_limit * ROUNDING {
            self.push(
                format!("speeds up to {} m/s", car.speed_limit),
                format!("{speed} m/s"),
                format!("vehicle.step_m={}", car.step(header.period)),
            );
        }
        if scaling.range > car.range * ROUNDING {
            self.push(
                format!("beams up to {} m", car.range),
                format!("{} m", scaling.range),
                format!("sensors.range_m={}", car.range),
            );
        }
        let apart = (header.wheelbase - car.wheelbase).abs();
        if apart > car.wheelbase * car.wheelbase_tolerance {
            self.push(
                format!("a wheelbase of {} m", car.wheelbase),
                format!("{} m", header.wheelbase),
                format!("vehicle.wheelbase_m={}", car.wheelbase),
            );
        }
    }

    fn beams(&mut self, header: &Header, car: &ShippedCar) {
        let fit = header.beams.iter().zip(&car.beam_degrees).all(|(beam, degrees)| {
            beam.x.abs().max(beam.y.abs()) <= car.mount_tolerance
                && (beam.angle - degrees.to_radians()).abs() <= car.angle_tolerance
        });
        if !fit {
            let degrees = car.beam_degrees.map(|angle| angle.to_string()).join(", ");
            self.push(
                format!("beams that point to [{degrees}]° from the front axle"),
                "others",
                format!("'sensors.beams=[{degrees}]'"),
            );
        }
    }

    fn push(&mut self, takes: impl Display, found: impl Display, setting: String) {
        self.takes.push(takes.to_string());
        self.found.push(found.to_string());
        if !self.settings.contains(&setting) {
            self.settings.push(setting);
        }
    }
}

impl Display for Misfits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let settings: Vec<_> =
            self.settings.iter().map(|setting| format!("--set {setting}")).collect();
        write!(
            f,
            "the car as shipped takes {}; this champion has {}, so the car will refuse it: train \
             with {}",
            listed(&self.takes),
            listed(&self.found),
            settings.join(" ")
        )
    }
}

/// `a`, `a and b` or `a, b and c`.
fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use controller_core::network::Feedforward;

    use super::*;
    use crate::sample_blob::SampleBlob;

    const CAR: &ShippedCar = &ShippedCar::PICO_2;

    fn fitting() -> Header {
        let mut header = SampleBlob::new::<Feedforward, 12, 1>(true).header;
        header.scaling.range = 1.2;
        header
    }

    #[test]
    fn a_champion_that_fits_has_no_misfit() {
        assert_eq!(Misfits::of(&fitting(), CAR), None);
    }

    #[test]
    fn what_the_presets_train_is_named_with_the_settings_that_help() {
        let mut header = fitting();
        header.scaling.range = 10.0;
        header.scaling.steer_limit = std::f32::consts::FRAC_PI_2;
        assert_eq!(
            Misfits::of(&header, CAR).unwrap().to_string(),
            "the car as shipped takes steer angles up to 28.6° and beams up to 1.2 m; this \
             champion has 90.0° and 10 m, so the car will refuse it: train with --set \
             vehicle.steer_limit_deg=28 --set sensors.range_m=1.2"
        );
    }

    #[test]
    fn every_misfit_is_named_at_once() {
        let mut header = SampleBlob::new::<Feedforward, 16, 2>(true).header;
        header.period = 0.5;
        header.scaling.step_upper = 1.0;
        header.wheelbase = 0.5;
        header.beams[1].angle = 1.0;
        assert_eq!(
            Misfits::of(&header, CAR).unwrap().to_string(),
            "the car as shipped takes 12 hidden neurons a layer, one output, with constant speed, \
             control periods of 0.02 to 0.2 s, speeds up to 1 m/s, beams up to 1.2 m, a wheelbase \
             of 0.3 m and beams that point to [-30, -15, 0, 15, 30]° from the front axle; this \
             champion has 16, 2 outputs, 0.5 s, 2 m/s, 10 m, 0.5 m and others, so the car will \
             refuse it: train with --set network.hidden=12 --set vehicle.step_m=0.1 --set \
             episode.period_s=0.1 --set sensors.range_m=1.2 --set vehicle.wheelbase_m=0.3 --set \
             'sensors.beams=[-30, -15, 0, 15, 30]'"
        );
    }
}
