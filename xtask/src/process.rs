//! Running other programs: announced, checked, and found on the path.

use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::failure::Failure;

/// The repository's top folder.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository")
}

/// The cargo that started this task, in the repository's top folder.
pub(crate) fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root());
    command
}

/// Prints the command line, runs it, and fails unless it succeeds.
pub(crate) fn run(command: &mut Command) -> Result<(), Failure> {
    let line = line(command);
    eprintln!("     $ {line}");
    let status = command.status().map_err(|error| not_started(command, &error))?;
    if status.success() {
        Ok(())
    } else {
        Err(Failure::failed(format!("`{line}` ended with {status}")))
    }
}

/// Like [`run`], but ends the command after `limit`: a download without a network may hang.
pub(crate) fn run_within(command: &mut Command, limit: Duration) -> Result<(), Failure> {
    let line = line(command);
    eprintln!("     $ {line}");
    let mut child = command.spawn().map_err(|error| not_started(command, &error))?;
    match wait_until(&mut child, Instant::now() + limit)? {
        Some(status) if status.success() => Ok(()),
        Some(status) => Err(Failure::failed(format!("`{line}` ended with {status}"))),
        None => Err(Failure::failed(format!("`{line}` did not end within {} s", limit.as_secs()))),
    }
}

/// Waits for `child` until `deadline`, then kills it and returns `None`.
pub(crate) fn wait_until(
    child: &mut Child,
    deadline: Instant,
) -> Result<Option<std::process::ExitStatus>, Failure> {
    let id = child.id();
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(Some(status)),
            Ok(None) if Instant::now() < deadline => std::thread::sleep(Duration::from_millis(10)),
            Ok(None) => {
                // It may have ended in between; either way it is gone afterwards.
                let _ = child.kill();
                let _ = child.wait();
                return Ok(None);
            }
            Err(error) => {
                return Err(Failure::failed(format!("cannot wait for process {id}: {error}")));
            }
        }
    }
}

/// What a command prints, without the final line break; `None` unless it succeeds.
pub(crate) fn output(command: &mut Command) -> Option<String> {
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
    let mut text = String::new();
    child.stdout.take()?.read_to_string(&mut text).ok()?;
    child.wait().ok()?.success().then(|| text.trim_end().to_owned())
}

/// Full path of a program on the search path.
pub(crate) fn which(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(program)).find(|file| file.is_file())
}

/// A command as a person would type it.
fn line(command: &Command) -> String {
    let mut words: Vec<String> = command
        .get_envs()
        .filter_map(|(name, value)| Some(format!("{}={}", name.display(), value?.display())))
        .collect();
    words.push(Path::new(command.get_program()).display().to_string());
    words.extend(command.get_args().map(|word| word.display().to_string()));
    words.join(" ")
}

fn not_started(command: &Command, error: &std::io::Error) -> Failure {
    let program = command.get_program().display();
    match error.kind() {
        ErrorKind::NotFound => Failure::missing(&program.to_string(), "cargo xtask doctor"),
        _ => Failure::failed(format!("cannot start {program}: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_that_hangs_is_ended_and_said_so() {
        let started = Instant::now();
        let failure = run_within(Command::new("sleep").arg("60"), Duration::from_millis(200))
            .expect_err("sleeps longer than allowed");
        assert!(failure.to_string().contains("did not end within"), "{failure}");
        assert!(started.elapsed() < Duration::from_secs(10));
    }

    #[test]
    fn a_program_that_is_not_there_is_missing_rather_than_failed() {
        let failure = run(&mut Command::new("no-such-program-at-all")).expect_err("not there");
        assert_eq!(failure.exit_code(), 3);
    }
}
