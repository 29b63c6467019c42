//! QEMU `microbit`: a Cortex-M0 without FPU, hardware division or much memory, that replays the recorded drives.
#![no_std]
#![no_main]

use firmware_example::emulated;

#[cortex_m_rt::entry]
fn main() -> ! {
    emulated::run()
}
