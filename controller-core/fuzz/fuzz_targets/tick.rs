//! Whatever the beams report, every command is in range and every fault stops the car at once.
//!
//! Each beam takes five bytes: its kind, and the bits of its distance. After five beams comes
//! the reading's age.
#![no_main]

use controller_core::blob::{Aligned, Blob};
use controller_core::control_loop::{Actuate, Sense, TickError, tick};
use controller_core::controller::{Command, Controller, RECOVERY};
use controller_core::network::Elman;
use controller_core::observation::{Echo, Reading, ReadingError};
use libfuzzer_sys::fuzz_target;

static CHAMPION: Aligned<[u8; 2780]> = Aligned(*include_bytes!("../../tests/golden/v1/elman.blob"));

/// A car whose sensor reads the fuzzer's bytes.
struct Car<'a> {
    bytes: &'a [u8],
    range: f32,
    last: Option<Command>,
}

impl Sense for Car<'_> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        let Some((frame, rest)) = self.bytes.split_first_chunk::<26>() else {
            self.bytes = &[];
            return Err(ReadingError::Missing { beam: 0 });
        };
        self.bytes = rest;
        let echoes = std::array::from_fn(|beam| {
            let [kind, bits @ ..] = std::array::from_fn::<u8, 5, _>(|i| frame[5 * beam + i]);
            let distance = match kind % 8 {
                // Mostly plausible, or no drive would last.
                0..4 => self.range * (f32::from(bits[0]) / 255.0),
                _ => f32::from_le_bytes(bits),
            };
            match kind / 8 % 8 {
                0 => None,
                1 | 2 => Some(Echo::Nothing),
                3 | 4 => Some(Echo::Target(distance)),
                _ => Some(Echo::Wall(distance)),
            }
        });
        Reading::new(echoes, u32::from(frame[25] % 5), self.range)
    }
}

impl Actuate for Car<'_> {
    type Error = core::convert::Infallible;
    fn actuate(&mut self, command: Command) -> Result<(), Self::Error> {
        self.last = Some(command);
        Ok(())
    }
}

fuzz_target!(|data: &[u8]| {
    let blob = Blob::parse(&CHAMPION.0).expect("the golden blob");
    let scaling = blob.scaling();
    let network = blob.network::<Elman, 12, 1>().expect("the golden network");
    let mut controller = Controller::new(network, blob.header().activation, scaling);
    let mut car = Car { bytes: data, range: scaling.range, last: None };
    let mut good = RECOVERY;
    while !car.bytes.is_empty() {
        let before = *controller.state();
        let result = tick(&mut car, &mut controller);
        let command = car.last.take().expect("every period has a command");
        assert!(command.steer.radians().abs() <= scaling.steer_limit);
        assert!((0.0..=scaling.step_upper).contains(&command.step.metres()));
        match result {
            Ok(returned) => {
                assert_eq!(returned, command);
                good += 1;
            }
            Err(TickError::Sense(_)) => good = 0,
            Err(TickError::Actuate(never)) => match never {},
        }
        if good < RECOVERY {
            assert_eq!(command, Command::STOP);
            assert_eq!(*controller.state(), before);
        } else {
            assert_eq!(command.step.metres(), scaling.step_upper);
        }
        let state = controller.state();
        assert!(state.first.iter().chain(&state.second).all(|value| value.abs() <= 1.0));
    }
});
