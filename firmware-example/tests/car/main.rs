//! The driving program against simulated hardware: five VL53L0X down to their registers, pulses,
//! a button, a lamp and a watchdog.

mod blobs;
mod boot;
mod calibration;
mod drive;
mod faults;
mod hardware;
mod pulses;
mod roll_call;
mod weights;
