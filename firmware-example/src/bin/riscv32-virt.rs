//! QEMU `virt`: a 32-bit RISC-V with single-precision FPU that replays the recorded drives.
#![no_std]
#![no_main]

use firmware_example::emulated;

#[riscv_rt::entry]
fn main() -> ! {
    emulated::run()
}
