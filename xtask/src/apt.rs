//! Debian packages: the one package manager xtask can call by itself.

use std::process::Command;

use crate::failure::Failure;
use crate::process;

/// Says what is going to be installed and why, then installs it by name.
pub(crate) fn install(packages: &[&str], why: &str) -> Result<(), Failure> {
    let by_hand = command_line(packages);
    if process::which("apt-get").is_none() {
        let what = format!("{} ({why})", packages.join(", "));
        return Err(Failure::missing(
            &what,
            "your system's package manager (xtask knows apt only)",
        ));
    }
    eprintln!("xtask: installing {} from Debian: {why}", packages.join(", "));
    process::run(apt_get()?.arg("update"))
        .map_err(|failure| Failure::missing(&format!("the package list ({failure})"), &by_hand))?;
    process::run(apt_get()?.args(["install", "-y", "--no-install-recommends"]).args(packages))
        .map_err(|failure| {
            Failure::missing(&format!("{} ({failure})", packages.join(", ")), &by_hand)
        })
}

/// The line that installs the same by hand.
pub(crate) fn command_line(packages: &[&str]) -> String {
    format!("sudo apt-get install {}", packages.join(" "))
}

fn apt_get() -> Result<Command, Failure> {
    let is_root = process::output(Command::new("id").arg("-u")).is_some_and(|id| id == "0");
    let mut command = if is_root {
        Command::new("apt-get")
    } else if process::which("sudo").is_some() {
        let mut sudo = Command::new("sudo");
        // Asking for a password would stop an unattended run for ever.
        if !std::io::IsTerminal::is_terminal(&std::io::stdin()) {
            sudo.arg("-n");
        }
        sudo.arg("apt-get");
        sudo
    } else {
        return Err(Failure::missing(
            "the right to install packages",
            "running this as root, or sudo",
        ));
    };
    // Another installation may be under way; and nobody is there to answer its questions.
    command.args(["-o", "DPkg::Lock::Timeout=600"]).env("DEBIAN_FRONTEND", "noninteractive");
    Ok(command)
}
