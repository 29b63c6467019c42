//! Five sensors with one address: who is missing, who is there twice, what they report.

use controller_core::observation::BEAMS;
use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::Mock as Pin;
use embedded_hal_mock::eh1::i2c::{Mock as Bus, Transaction};
use firmware_example::drivers::rangefinder::{
    BusFault, Range, RangeFinders, SensorFault, StartError,
};
use firmware_example::drivers::tof_array::{ADDRESSES, TofArray};

use crate::hardware::{BrownOut, World};

#[test]
fn every_sensor_gets_its_own_address_and_ranges() {
    let world = World::default();
    assert_eq!(world.tof_array().start(), Ok(()));
    world.with(|outside| {
        assert_eq!(outside.sensors.each_ref().map(|sensor| sensor.address()), ADDRESSES);
        assert!(outside.sensors.iter().all(|sensor| sensor.ranging));
    });
}

#[test]
fn a_second_start_finds_sensors_that_still_have_their_addresses() {
    let world = World::default();
    assert_eq!(world.tof_array().start(), Ok(()));
    assert_eq!(world.tof_array().start(), Ok(()), "after a reset of the board without power-off");
}

#[test]
fn a_missing_sensor_is_named() {
    for beam in 0..BEAMS {
        let world = World::default();
        world.with(|outside| outside.sensors[beam].present = false);
        let error = world.tof_array().start().expect_err("one is missing");
        let fault = SensorFault::Bus(BusFault::NoAnswer);
        assert_eq!(error, StartError::Sensor { beam, fault });
        assert_eq!(error.to_string(), format!("beam {beam} of 0 to 4: it does not answer"));
    }
}

#[test]
fn another_device_in_a_sensors_place_is_named_with_its_identity() {
    let world = World::default();
    world.with(|outside| outside.sensors[3].identity = 0xea);
    let fault = SensorFault::OtherDevice { found: 0xea, expected: 0xee };
    assert_eq!(world.tof_array().start(), Err(StartError::Sensor { beam: 3, fault }));
}

#[test]
fn a_line_that_hangs_high_while_a_sensor_is_set_up_is_a_fault_and_no_division_by_zero() {
    for register in [0x50, 0x70] {
        let world = World::default();
        world.with(|outside| outside.sensors[1].stuck = Some((register, 0xff)));
        let fault = SensorFault::Implausible { register, found: 0xff };
        assert_eq!(world.tof_array().start(), Err(StartError::Sensor { beam: 1, fault }));
    }
}

#[test]
fn a_shutdown_line_that_is_not_connected_is_noticed_before_addresses_are_given() {
    let world = World::default();
    world.with(|outside| outside.sensors[2].line_connected = false);
    assert_eq!(world.tof_array().start(), Err(StartError::NotInReset { address: 0x29 }));
}

#[test]
fn a_sensor_that_loses_its_address_while_another_wakes_is_named() {
    let world = World::default();
    world.with(|outside| outside.brown_out = Some(BrownOut { waking: 4, victim: 0 }));
    let error = world.tof_array().start().expect_err("the first one is lost again");
    let fault = SensorFault::Bus(BusFault::NoAnswer);
    assert_eq!(error, StartError::Sensor { beam: 0, fault });
}

#[test]
fn a_bus_without_pull_ups_is_not_taken_for_a_missing_sensor() {
    let world = World::default();
    world.with(|outside| outside.bus_fault = Some(ErrorKind::Bus));
    let error = world.tof_array().start().expect_err("nothing works");
    let fault = SensorFault::Bus(BusFault::Wiring);
    assert_eq!(error, StartError::Sensor { beam: 0, fault });
    assert!(error.to_string().contains("pull-ups"), "{error}");
}

/// What a sensor says when its registers hold this status and distance.
fn said(status: u8, millimetres: u16) -> Result<Option<Range>, SensorFault> {
    let world = World::default();
    let mut array = world.tof_array();
    array.start().expect("all there");
    world.with(|outside| outside.sensors[1].measure(status, millimetres));
    let said = array.take(1);
    assert_eq!(array.take(1), Ok(None), "a measurement is taken once");
    said
}

#[test]
fn every_status_of_a_measurement_has_a_meaning() {
    let meanings: Vec<_> = (0..16).map(|status| said(status, 612)).collect();
    let hardware = |status| Err(SensorFault::Hardware { status });
    let nothing = Ok(Some(Range::Nothing));
    let touching = Ok(Some(Range::At(0)));
    let valid = Ok(Some(Range::At(612)));
    // ST's driver, VL53L0X_get_pal_range_status, in the order of the device's codes.
    let expected = [
        Ok(None),
        hardware(1),
        hardware(2),
        hardware(3),
        nothing,
        Ok(None),
        nothing,
        Ok(None),
        touching,
        nothing,
        touching,
        valid,
        Ok(None),
        Ok(None),
        Ok(None),
        Ok(None),
    ];
    assert_eq!(meanings, expected);
}

#[test]
fn the_codes_for_out_of_range_are_no_distances() {
    assert_eq!(said(11, 8189), Ok(Some(Range::At(8189))));
    assert_eq!(said(11, 8190), Ok(Some(Range::Nothing)));
    assert_eq!(said(11, 8191), Ok(Some(Range::Nothing)));
}

#[test]
fn a_reading_is_three_transfers_and_a_beam_without_news_one() {
    let mut result = vec![0; 12];
    [result[0], result[10], result[11]] = [11 << 3, 0x01, 0x2c];
    let address = ADDRESSES[4];
    let mut bus = Bus::new(&[
        Transaction::write_read(address, vec![0x13], vec![0x44]),
        Transaction::write_read(address, vec![0x14], result),
        Transaction::write(address, vec![0x0b, 1]),
        Transaction::write_read(address, vec![0x13], vec![0x40]),
    ]);
    let mut lines: [Pin; BEAMS] = core::array::from_fn(|_| Pin::new(&[]));
    let mut array = TofArray::new(bus.clone(), lines.clone(), NoopDelay::new());
    assert_eq!(array.take(4), Ok(Some(Range::At(300))));
    assert_eq!(array.take(4), Ok(None));
    assert_eq!(array.take(5), Err(SensorFault::NoSuchBeam));
    bus.done();
    lines.iter_mut().for_each(Pin::done);
}
