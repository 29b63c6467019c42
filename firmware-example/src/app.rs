//! The program that drives a car.
//!
//! A board hands over its [`Parts`] and calls [`run`]; everything else is here. The motor is
//! told to stop before anything else happens, and it moves only while weights were accepted,
//! sensors deliver, and somebody has armed the car. Every error ends in [`Command::STOP`] in the
//! control period in which it is noticed.
//!
//! [`Command::STOP`]: controller_core::controller::Command::STOP

mod schedule;

use crate::arming::Arming;
use crate::brain::Brain;
use crate::calibration::Checked;
use crate::chassis::Chassis;
use crate::clock::{Clock, Micros, Watchdog};
use crate::drivers::motor::Motor;
use crate::drivers::rangefinder::{RangeFinders, SensorFault};
use crate::drivers::servo::Servo;
use crate::hardware::Hardware;
use crate::indicator::{Indicator, Signal};
use crate::journal::{Event, Journal};
use crate::odometry::Odometry;
use crate::weights::{self, Refusal};
use controller_core::control_loop::{Actuate, Decide, TickError, tick};
use controller_core::controller::Command;
use controller_core::observation::{BEAMS, Reading, ReadingError};
use controller_core::units::SteerAngle;
use embedded_hal::digital::InputPin;
use embedded_hal::pwm::SetDutyCycle;
use schedule::Schedule;

/// A decision this often while there are no weights that say how often, microseconds.
pub const IDLE_PERIOD: u64 = 50_000;

/// Without a good reading for this long, sensors count as lost, microseconds.
pub const LOST: u64 = 1_000_000;

/// The board is reset this long after the last good control period, or two periods after it if
/// that is longer, microseconds.
pub const RESET_AFTER: u64 = 200_000;

/// What the driving lines in the log are apart, microseconds.
const REPORT_EVERY: u64 = 1_000_000;

/// What a board has to bring.
pub struct Parts<H: Hardware> {
    /// The five range sensors.
    pub sensors: H::Sensors,
    /// The target's beacon, as the five receivers see it.
    pub beacon: H::Beacon,
    /// PWM channel of the steering servo.
    pub servo: H::Servo,
    /// PWM channel of the motor's speed controller.
    pub motor: H::Motor,
    /// The button; its pin is low while it is pressed.
    pub button: H::Button,
    /// The lamp; it is lit while its pin is high.
    pub lamp: H::Lamp,
    /// The watchdog, not yet started.
    pub watchdog: H::Watchdog,
    /// Where events go.
    pub journal: H::Journal,
}

/// A car between two control periods. `N` is the width of the hidden layers, `O` the number of outputs.
pub struct Car<'w, H: Hardware, const N: usize, const O: usize> {
    chassis: Chassis<H>,
    brain: Result<Brain<'w, N, O>, Refusal>,
    button: H::Button,
    lamp: Indicator<H::Lamp>,
    watchdog: H::Watchdog,
    journal: H::Journal,
    schedule: Schedule,
    arming: Arming,
    trouble: Trouble,
    last_good: Micros,
    reading: Option<ReadingError>,
    faults: [Option<SensorFault>; BEAMS],
    steps: u32,
    wheelbase: f32,
    believed: Odometry,
    reported: Micros,
}

/// What keeps the car from driving until it is restarted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    None,
    /// Sensors did not start, or went away.
    Sensors,
    /// The watchdog is no longer fed.
    Restart,
}

/// Decides nothing but to stand: drives a car that is not armed.
struct Parked;

impl Decide for Parked {
    fn decide(&mut self, _: Result<&Reading, ReadingError>) -> Command {
        Command::STOP
    }
}

impl<'w, H: Hardware, const N: usize, const O: usize> Car<'w, H, N, O> {
    /// Stops the motor, loads the weights at the start of `region`, starts the sensors, and then
    /// the watchdog. What fails is noted; the car is there in any case and says so with its lamp.
    pub fn boot(
        parts: Parts<H>,
        calibration: &Checked,
        region: &'w [u8],
        clock: &mut impl Clock,
    ) -> Self {
        let Parts { sensors, beacon, servo, motor, button, lamp, mut watchdog, mut journal } =
            parts;
        let mut motor = Motor::new(motor, calibration);
        // First of all; repeated and judged below, together with the steering.
        let _ = motor.stop();

        let brain = weights::load(region, calibration);
        let (range, period) = match &brain {
            Ok(brain) => {
                journal.note(Event::Weights { check: brain.check(), period: brain.period() });
                (brain.scaling().range, brain.period())
            }
            Err(refusal) => {
                journal.note(Event::Refused(*refusal));
                (calibration.get().range, IDLE_PERIOD)
            }
        };

        let servo = Servo::new(servo, calibration);
        let mut chassis = Chassis::<H>::new(sensors, beacon, servo, motor, range, period);
        let mut trouble = Trouble::None;
        if let Err(fault) = chassis.actuate(Command::STOP) {
            journal.note(Event::Actuator(fault));
            trouble = Trouble::Restart;
        }
        match chassis.sensors().start() {
            Ok(()) => journal.note(Event::Sensors),
            Err(error) => {
                journal.note(Event::NoSensors(error));
                if trouble == Trouble::None {
                    trouble = Trouble::Sensors;
                }
            }
        }

        watchdog.start(RESET_AFTER.max(2 * period));
        let now = clock.now();
        Self {
            chassis,
            brain,
            button,
            lamp: Indicator::new(lamp),
            watchdog,
            journal,
            schedule: Schedule::new(now, period),
            arming: Arming::default(),
            trouble,
            last_good: now,
            reading: None,
            faults: [None; BEAMS],
            steps: 0,
            wheelbase: calibration.get().wheelbase,
            believed: Odometry::default(),
            reported: now,
        }
    }

    /// When the next control period is to begin.
    pub fn due(&self) -> Micros {
        self.schedule.due()
    }

    /// Does everything that one control period takes, at this moment.
    pub fn period(&mut self, now: Micros) {
        let late = self.schedule.begin(now);
        if let Some(by) = late.noteworthy {
            self.journal.note(Event::Late { by });
        }
        self.chassis.begin(now, late.missed);
        self.look_at_button(now);

        let result = match &mut self.brain {
            Ok(brain) if self.arming == Arming::Armed => tick(&mut self.chassis, brain),
            _ => tick(&mut self.chassis, &mut Parked),
        };
        self.note_sensors();
        match result {
            Ok(command) => self.good_period(command, now),
            Err(TickError::Sense(error)) => self.bad_reading(error, now),
            Err(TickError::Actuate(fault)) => {
                self.disarm();
                if self.trouble != Trouble::Restart {
                    self.journal.note(Event::Actuator(fault));
                    self.trouble = Trouble::Restart;
                }
            }
        }

        self.lamp.show(self.signal(), now);
        if self.trouble != Trouble::Restart && self.chassis.worked() {
            self.watchdog.feed();
        }
    }

    /// What the lamp shows.
    pub fn signal(&self) -> Signal {
        match (self.trouble, self.arming) {
            (Trouble::Sensors | Trouble::Restart, _) => Signal::SensorsLost,
            _ if self.brain.is_err() => Signal::NoWeights,
            (_, Arming::Ready) => Signal::Ready,
            (_, Arming::Armed) if self.reading.is_some() => Signal::Stopped,
            (_, Arming::Armed) => Signal::Driving,
            _ => Signal::Disarmed,
        }
    }

    fn look_at_button(&mut self, now: Micros) {
        let Ok(pressed) = self.button.is_low() else {
            if self.arming != Arming::Blocked {
                self.journal.note(Event::NoButton);
            }
            self.disarm();
            return;
        };
        let before = self.arming;
        self.arming = before.next(pressed, now);
        match (before, self.arming) {
            (Arming::Ready, Arming::Armed) => self.arm(now),
            (Arming::Armed, Arming::Blocked) => {
                self.journal.note(Event::Disarmed { believed: self.believed });
            }
            _ => {}
        }
    }

    /// The button was held and let go: drive if nothing speaks against it, else say what does.
    fn arm(&mut self, now: Micros) {
        match (&mut self.brain, self.trouble) {
            (Ok(brain), Trouble::None) => {
                brain.reset();
                self.steps = 0;
                self.believed = Odometry::default();
                self.reported = now;
                self.journal.note(Event::Armed);
                return;
            }
            (_, Trouble::Sensors) => {
                self.trouble = Trouble::Restart;
                self.journal.note(Event::Restarting);
            }
            (Err(refusal), Trouble::None) => self.journal.note(Event::Refused(*refusal)),
            // Said when it happened, and over in a moment.
            (_, Trouble::Restart) => {}
        }
        self.disarm();
    }

    fn disarm(&mut self) {
        self.arming = Arming::Blocked;
    }

    fn good_period(&mut self, command: Command, now: Micros) {
        self.last_good = now;
        if self.reading.take().is_some() {
            self.journal.note(Event::Recovered);
        }
        if self.arming == Arming::Armed {
            self.steps = self.steps.saturating_add(1);
            self.believed.follow(command, self.wheelbase);
            if now.since(self.reported) >= REPORT_EVERY {
                self.reported = now;
                let (step, believed) = (self.steps, self.believed);
                self.journal.note(Event::Driving { step, command, believed });
            }
        }
    }

    fn bad_reading(&mut self, error: ReadingError, now: Micros) {
        if self.reading.is_none() {
            self.journal.note(Event::Stopped(error));
        }
        self.reading = Some(error);
        if self.trouble == Trouble::None && now.since(self.last_good) > LOST {
            self.journal.note(Event::SensorsLost);
            self.trouble = Trouble::Sensors;
            self.disarm();
        }
    }

    /// Notes every sensor whose fault is new.
    fn note_sensors(&mut self) {
        let faults = self.chassis.faults();
        for (beam, (now, before)) in faults.into_iter().zip(self.faults).enumerate() {
            if let Some(fault) = now
                && now != before
            {
                self.journal.note(Event::Sensor { beam, fault });
            }
        }
        self.faults = faults;
    }
}

/// Motor stop and wheels straight, for a program that has failed: the motor first, and neither keeps the
/// other from being told. What refuses is left to the watchdog.
pub fn fail_safe(
    servo: &mut impl SetDutyCycle,
    motor: &mut impl SetDutyCycle,
    calibration: &Checked,
) {
    let _ = Motor::new(motor, calibration).stop();
    let _ = Servo::new(servo, calibration).steer(SteerAngle::STRAIGHT);
}

/// Drives the car for ever, one control period after the other.
pub fn run<H: Hardware, const N: usize, const O: usize>(
    mut car: Car<'_, H, N, O>,
    clock: &mut impl Clock,
) -> ! {
    loop {
        let now = clock.wait_until(car.due());
        car.period(now);
    }
}
