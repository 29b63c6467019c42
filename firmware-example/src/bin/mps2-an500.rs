//! QEMU `mps2-an500`: a Cortex-M7 that replays the recorded drives.
#![no_std]
#![no_main]

use firmware_example::emulated;

#[cortex_m_rt::entry]
fn main() -> ! {
    emulated::run()
}
