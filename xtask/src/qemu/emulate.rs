//! One run of QEMU, from start to exit code.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::decode::Log;
use crate::boards::Board;
use crate::failure::Failure;
use crate::options::Options;
use crate::process;

/// Runs the program for at most `--timeout`, on a clock as `--icount` says and with the files of `--prove`, and ends as it ended.
pub(super) fn run(
    board: &Board,
    elf: &Path,
    flash: Option<&str>,
    options: &Options,
) -> Result<(), Failure> {
    let bytes = std::fs::read(elf)
        .map_err(|error| Failure::usage(format!("cannot read {}: {error}", elf.display())))?;
    let log = Log::of(&bytes).map_err(|error| {
        Failure::failed(format!("{}: its log cannot be decoded: {error:#}", elf.display()))
    })?;
    let timeout = options.timeout;
    let mut child = start(board, elf, flash, options)?;
    let ended = follow(&mut child, &log, Instant::now() + timeout)?;
    match ended.and_then(|status| status.code()) {
        Some(0) => Ok(()),
        Some(code) => {
            let shown = u8::try_from(code).unwrap_or(u8::MAX).max(1);
            Err(Failure::board(format!("{} ended with exit code {code}", board.name), shown))
        }
        None if ended.is_some() => {
            Err(Failure::failed(format!("{} was ended by a signal", board.emulator.program)))
        }
        None => {
            let seconds = timeout.as_secs();
            Err(Failure::board(
                format!("{} did not end within {seconds} s; stopped", board.name),
                124,
            ))
        }
    }
}

fn start(
    board: &Board,
    elf: &Path,
    flash: Option<&str>,
    options: &Options,
) -> Result<Child, Failure> {
    let clock = options.icount.map(|shift| format!("shift={shift},align=off"));
    let mut semihosting = String::from("enable=on,target=native");
    let mut command = Command::new(board.emulator.program);
    if let Some(folder) = &options.prove {
        // The program opens its files in the folder it runs in, so no path has to fit its command line.
        semihosting += ",arg=prove";
        command.current_dir(folder);
    }
    command
        .args([
            "-machine",
            board.emulator.machine,
            "-nographic",
            "-monitor",
            "none",
            "-serial",
            "none",
        ])
        .args(board.emulator.options)
        .args(flash.into_iter().flat_map(|loader| ["-device", loader]))
        .args(clock.iter().flat_map(|clock| ["-icount", clock]))
        .args(["-semihosting-config", &semihosting, "-kernel"])
        .arg(elf)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| {
            Failure::failed(format!("cannot start {}: {error}", board.emulator.program))
        })
}

/// Prints the log as it comes; returns the exit status, or `None` past the deadline.
fn follow(
    child: &mut Child,
    log: &Log,
    deadline: Instant,
) -> Result<Option<std::process::ExitStatus>, Failure> {
    let mut pipe = child.stdout.take().expect("stdout is piped");
    let (sender, receiver) = mpsc::channel::<Vec<u8>>();
    // A read blocks for as long as the board is silent, so it cannot also watch the clock.
    let reader = std::thread::spawn(move || {
        let mut buffer = [0; 4096];
        while let Ok(count @ 1..) = pipe.read(&mut buffer) {
            if sender.send(buffer[..count].to_vec()).is_err() {
                break;
            }
        }
    });
    let mut decoder = log.decoder();
    let mut output = std::io::stdout().lock();
    let mut late = false;
    loop {
        match receiver.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
            Ok(bytes) => {
                let text = decoder.text(&bytes);
                output
                    .write_all(&text)
                    .and_then(|()| output.flush())
                    .map_err(|error| Failure::failed(format!("cannot print the log: {error}")))?;
            }
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
            Err(mpsc::RecvTimeoutError::Timeout) => {
                late = true;
                break;
            }
        }
    }
    // The pipe is closed: QEMU is about to end, unless it is late already.
    let grace = if late { Duration::ZERO } else { Duration::from_secs(5) };
    let status = process::wait_until(child, Instant::now() + grace);
    let _ = reader.join();
    status
}
