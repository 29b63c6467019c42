//! QEMU `mps2-an385`: a Cortex-M3, all floats in software, that replays the recorded drives.
#![no_std]
#![no_main]

use firmware_example::emulated;

#[cortex_m_rt::entry]
fn main() -> ! {
    emulated::run()
}
