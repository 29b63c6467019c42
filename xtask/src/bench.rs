//! `cargo xtask bench`: how fast the simulation is on this machine.

use crate::failure::Failure;
use crate::options::Options;
use crate::process;

/// Prints what a beam costs against the number of obstacles, parry2d beside it.
pub(crate) fn run(_: &Options) -> Result<(), Failure> {
    process::run(process::cargo().args(["bench", "-p", "host-trainer", "--bench", "beams"]))
}
