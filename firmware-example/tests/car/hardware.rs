//! The world around the program: what its pins and its bus are connected to.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use controller_core::observation::BEAMS;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::i2c::{self, ErrorKind, I2c, NoAcknowledgeSource, Operation};
use embedded_hal::pwm::{self, SetDutyCycle};
use firmware_example::app::{Car, Parts};
use firmware_example::arming::HOLD;
use firmware_example::calibration::{Calibration, Checked};
use firmware_example::clock::{Clock, Micros, Watchdog};
use firmware_example::drivers::target_beacon::Receivers;
use firmware_example::drivers::tof_array::{DEFAULT_ADDRESS, TofArray};
use firmware_example::hardware::Hardware;
use firmware_example::journal::{Event, Journal};

/// Everything outside the program. One microsecond of pulse is one step of duty.
#[derive(Default)]
pub(crate) struct Outside {
    pub(crate) sensors: [Sensor; BEAMS],
    /// A sensor that is cut from the supply for a moment when another one wakes up.
    pub(crate) brown_out: Option<BrownOut>,
    /// Every access fails with this while it is set.
    pub(crate) bus_fault: Option<ErrorKind>,
    pub(crate) accesses: u64,
    /// Whether each beam's receiver sees the beacon.
    pub(crate) beacon: [bool; BEAMS],
    pub(crate) pressed: bool,
    pub(crate) button_broken: bool,
    pub(crate) servo: Channel,
    pub(crate) motor: Channel,
    /// Pulses in the order in which they were set.
    pub(crate) pulses: Vec<(&'static str, u16)>,
    pub(crate) lamp: bool,
    pub(crate) watchdog: Option<u64>,
    pub(crate) feeds: u32,
    pub(crate) events: Vec<Event>,
    /// How many pulses had been set when the first event was noted.
    pub(crate) first_event: Option<usize>,
    pub(crate) now: u64,
}

/// Which sensor takes down which.
#[derive(Clone, Copy)]
pub(crate) struct BrownOut {
    pub(crate) waking: usize,
    pub(crate) victim: usize,
}

/// A PWM channel: its pulse, and whether it obeys.
#[derive(Default)]
pub(crate) struct Channel {
    pub(crate) pulse: Option<u16>,
    pub(crate) broken: bool,
}

/// A VL53L0X as far as its registers are used.
pub(crate) struct Sensor {
    /// Soldered in.
    pub(crate) present: bool,
    /// Its shutdown line is connected.
    pub(crate) line_connected: bool,
    pub(crate) identity: u8,
    /// A register that reads the same whatever was written to it, and what.
    pub(crate) stuck: Option<(u8, u8)>,
    awake: bool,
    address: u8,
    registers: [u8; 256],
    pointer: u8,
    pub(crate) ranging: bool,
    waiting: bool,
}

impl Default for Sensor {
    fn default() -> Self {
        Self {
            present: true,
            line_connected: true,
            identity: 0xee,
            stuck: None,
            awake: true,
            address: DEFAULT_ADDRESS,
            registers: [0; 256],
            pointer: 0,
            ranging: false,
            waiting: false,
        }
    }
}

impl Sensor {
    pub(crate) fn address(&self) -> u8 {
        self.address
    }

    /// Finishes a measurement with this device status.
    pub(crate) fn measure(&mut self, status: u8, millimetres: u16) {
        if self.ranging {
            self.registers[0x14] = status << 3;
            [self.registers[0x1e], self.registers[0x1f]] = millimetres.to_be_bytes();
            self.waiting = true;
        }
    }

    /// Holds it in reset or lets it wake up; its registers do not survive.
    pub(crate) fn reset(&mut self, hold: bool) {
        if self.line_connected {
            let Self { present, identity, stuck, .. } = *self;
            *self = Self { present, identity, stuck, awake: !hold, ..Self::default() };
        }
    }

    fn write(&mut self, bytes: &[u8]) {
        let Some((pointer, values)) = bytes.split_first() else { return };
        self.pointer = *pointer;
        for value in values {
            // Registers mean this only on page 0.
            match (self.registers[0xff], self.pointer) {
                (0, 0x8a) => self.address = *value,
                (0, 0x00) if *value == 0x02 => self.ranging = true,
                (0, 0x0b) => self.waiting = false,
                _ => {}
            }
            self.registers[usize::from(self.pointer)] = *value;
            self.pointer = self.pointer.wrapping_add(1);
        }
    }

    fn read(&mut self, bytes: &mut [u8]) {
        for byte in bytes {
            *byte = match self.pointer {
                register if self.stuck.is_some_and(|stuck| stuck.0 == register) => {
                    self.stuck.map_or(0, |stuck| stuck.1)
                }
                0xc0 => self.identity,
                // Calibration has always just ended.
                0x13 => u8::from(self.waiting || !self.ranging),
                0x83 => 1,
                other => self.registers[usize::from(other)],
            };
            self.pointer = self.pointer.wrapping_add(1);
        }
    }
}

/// A handle to the world; every pin is one.
#[derive(Clone, Default)]
pub(crate) struct World(Rc<RefCell<Outside>>);

impl World {
    pub(crate) fn with<T>(&self, look: impl FnOnce(&mut Outside) -> T) -> T {
        look(&mut self.0.borrow_mut())
    }

    pub(crate) fn tof_array(&self) -> TofArray<Bus, Shutdown, Sleep> {
        let lines = core::array::from_fn(|beam| Shutdown(self.clone(), beam));
        TofArray::new(Bus(self.clone()), lines, Sleep(self.clone()))
    }

    pub(crate) fn parts(&self) -> Parts<Simulated> {
        Parts {
            sensors: self.tof_array(),
            beacon: Receivers(core::array::from_fn(|beam| Receiver(self.clone(), beam))),
            servo: Pwm(self.clone(), "servo"),
            motor: Pwm(self.clone(), "motor"),
            button: Button(self.clone()),
            lamp: Lamp(self.clone()),
            watchdog: Dog(self.clone()),
            journal: Log(self.clone()),
        }
    }

    pub(crate) fn boot<'w>(&self, region: &'w [u8]) -> TestCar<'w> {
        Car::boot(self.parts(), &calibration(), region, &mut Time(self.clone()))
    }

    pub(crate) fn pulses(&self) -> [Option<u16>; 2] {
        self.with(|outside| [outside.servo.pulse, outside.motor.pulse])
    }

    pub(crate) fn events(&self) -> Vec<Event> {
        self.with(|outside| std::mem::take(&mut outside.events))
    }

    pub(crate) fn feeds(&self) -> u32 {
        self.with(|outside| std::mem::take(&mut outside.feeds))
    }
}

/// Wheels straight and motor stopped, as [`calibration`] has them.
pub(crate) const STOPPED: [Option<u16>; 2] = [Some(1500), Some(1500)];

/// The control period of [`crate::blobs`], microseconds.
pub(crate) const PERIOD: u64 = 50_000;

pub(crate) fn calibration() -> Checked {
    Calibration::UNFITTED.check().expect("the calibration is good")
}

/// The types of the simulated car's parts.
pub(crate) enum Simulated {}

impl Hardware for Simulated {
    type Sensors = TofArray<Bus, Shutdown, Sleep>;
    type Beacon = Receivers<Receiver>;
    type Servo = Pwm;
    type Motor = Pwm;
    type Button = Button;
    type Lamp = Lamp;
    type Watchdog = Dog;
    type Journal = Log;
}

pub(crate) type TestCar<'w> = Car<'w, Simulated, 12, 1>;

/// Runs one control period when it is due; every sensor that ranges measures `distances` before.
pub(crate) fn step(world: &World, car: &mut TestCar<'_>, distances: [u16; BEAMS]) {
    world.with(|outside| {
        for (sensor, millimetres) in outside.sensors.iter_mut().zip(distances) {
            sensor.measure(11, millimetres);
        }
    });
    step_silent(world, car);
}

/// Runs one control period when it is due, without new measurements.
pub(crate) fn step_silent(world: &World, car: &mut TestCar<'_>) {
    let now = car.due();
    world.with(|outside| outside.now = now.0);
    car.period(now);
}

/// Holds the button for two seconds and lets it go: armed, and driving if it can.
pub(crate) fn arm(world: &World, car: &mut TestCar<'_>, distances: [u16; BEAMS]) {
    step(world, car, distances);
    world.with(|outside| outside.pressed = true);
    for _ in 0..=HOLD / PERIOD {
        step(world, car, distances);
    }
    world.with(|outside| outside.pressed = false);
    step(world, car, distances);
}

pub(crate) struct Bus(World);

impl i2c::ErrorType for Bus {
    type Error = ErrorKind;
}

impl I2c for Bus {
    fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        self.0.with(|outside| {
            outside.accesses += 1;
            if let Some(fault) = outside.bus_fault {
                return Err(fault);
            }
            let mut addressed: Vec<&mut Sensor> = outside
                .sensors
                .iter_mut()
                .filter(|sensor| sensor.present && sensor.awake && sensor.address == address)
                .collect();
            if addressed.is_empty() {
                return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
            }
            for operation in operations {
                for sensor in &mut addressed {
                    match operation {
                        Operation::Write(bytes) => sensor.write(bytes),
                        Operation::Read(bytes) => sensor.read(bytes),
                    }
                }
            }
            Ok(())
        })
    }
}

pub(crate) struct Shutdown(World, usize);

impl digital::ErrorType for Shutdown {
    type Error = Infallible;
}

impl OutputPin for Shutdown {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.with(|outside| outside.sensors[self.1].reset(true));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.with(|outside| {
            outside.sensors[self.1].reset(false);
            if let Some(BrownOut { waking, victim }) = outside.brown_out
                && waking == self.1
            {
                outside.sensors[victim].reset(false);
            }
        });
        Ok(())
    }
}

pub(crate) struct Sleep(World);

impl DelayNs for Sleep {
    fn delay_ns(&mut self, ns: u32) {
        self.0.with(|outside| outside.now += u64::from(ns).div_ceil(1000));
    }
}

pub(crate) struct Receiver(World, usize);

impl digital::ErrorType for Receiver {
    type Error = Infallible;
}

impl InputPin for Receiver {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        self.is_low().map(|low| !low)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.with(|outside| outside.beacon[self.1]))
    }
}

/// A hardware error without a name.
#[derive(Debug)]
pub(crate) struct Broken;

impl digital::Error for Broken {
    fn kind(&self) -> digital::ErrorKind {
        digital::ErrorKind::Other
    }
}

impl pwm::Error for Broken {
    fn kind(&self) -> pwm::ErrorKind {
        pwm::ErrorKind::Other
    }
}

pub(crate) struct Pwm(World, &'static str);

impl pwm::ErrorType for Pwm {
    type Error = Broken;
}

impl SetDutyCycle for Pwm {
    fn max_duty_cycle(&self) -> u16 {
        20_000
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Broken> {
        self.0.with(|outside| {
            let channel = match self.1 {
                "servo" => &mut outside.servo,
                _ => &mut outside.motor,
            };
            if channel.broken {
                return Err(Broken);
            }
            channel.pulse = Some(duty);
            outside.pulses.push((self.1, duty));
            Ok(())
        })
    }
}

pub(crate) struct Button(World);

impl digital::ErrorType for Button {
    type Error = Broken;
}

impl InputPin for Button {
    fn is_high(&mut self) -> Result<bool, Broken> {
        self.is_low().map(|low| !low)
    }

    fn is_low(&mut self) -> Result<bool, Broken> {
        self.0.with(|outside| if outside.button_broken { Err(Broken) } else { Ok(outside.pressed) })
    }
}

pub(crate) struct Lamp(World);

impl digital::ErrorType for Lamp {
    type Error = Infallible;
}

impl OutputPin for Lamp {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.with(|outside| outside.lamp = false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.with(|outside| outside.lamp = true);
        Ok(())
    }
}

pub(crate) struct Dog(World);

impl Watchdog for Dog {
    fn start(&mut self, timeout: u64) {
        self.0.with(|outside| outside.watchdog = Some(timeout));
    }

    fn feed(&mut self) {
        self.0.with(|outside| outside.feeds += 1);
    }
}

pub(crate) struct Log(World);

impl Journal for Log {
    fn note(&mut self, event: Event) {
        self.0.with(|outside| {
            outside.first_event.get_or_insert(outside.pulses.len());
            outside.events.push(event);
        });
    }
}

pub(crate) struct Time(World);

impl Clock for Time {
    fn now(&mut self) -> Micros {
        Micros(self.0.with(|outside| outside.now))
    }

    fn wait_until(&mut self, due: Micros) -> Micros {
        self.0.with(|outside| outside.now = outside.now.max(due.0));
        self.now()
    }
}
