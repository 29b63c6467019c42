//! QEMU `mps2-an386`: a Cortex-M4F.
#![no_std]
#![no_main]

use cortex_m as _;
use firmware_example::emulated;

#[cortex_m_rt::entry]
fn main() -> ! {
    defmt::info!("hello");
    emulated::succeed()
}
