//! A test of this binary run once more as a process of its own, to be raced, killed or limited.

use std::env;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Stdio};

const FOLDER: &str = "EVOSTEER_TEST_FOLDER";

/// In the child: the folder it is to work in. In the parent: none.
pub(crate) fn folder() -> Option<PathBuf> {
    env::var_os(FOLDER).map(PathBuf::from)
}

/// The child's command: this binary, only the test of that full name, in `folder`.
pub(crate) fn command(test: &str, folder: &std::path::Path) -> Command {
    let mut command = Command::new(env::current_exe().unwrap());
    arguments(&mut command, test, folder);
    command
}

/// The same, started by a shell that runs `prelude` first.
#[cfg(unix)]
pub(crate) fn under_shell(prelude: &str, test: &str, folder: &std::path::Path) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("{prelude}; exec \"$0\" \"$@\"")]);
    command.arg(env::current_exe().unwrap());
    arguments(&mut command, test, folder);
    command
}

fn arguments(command: &mut Command, test: &str, folder: &std::path::Path) {
    command.args([test, "--exact", "--nocapture", "--test-threads=1"]).env(FOLDER, folder);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
}

/// Waits for the child's line `said <text>`, past what the test harness prints.
pub(crate) fn hear(child: &mut Child) -> String {
    read_said(&mut BufReader::new(child.stdout.as_mut().unwrap()))
}

fn read_said(lines: &mut BufReader<&mut ChildStdout>) -> String {
    let mut line = String::new();
    while lines.read_line(&mut line).unwrap() > 0 {
        // The harness's own line may come before ours without a line feed.
        if let Some((_, said)) = line.split_once("said ") {
            return said.trim_end().to_owned();
        }
        line.clear();
    }
    panic!("the child ended without a word");
}

/// In the child: says one line to the parent.
pub(crate) fn say(text: impl std::fmt::Display) {
    println!("said {text}");
}

/// In the child: waits until the parent writes a line or closes the pipe.
pub(crate) fn wait_for_parent() {
    let _ = std::io::stdin().read_line(&mut String::new());
}
