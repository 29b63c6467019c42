//! Broken pipes, full disks and folders of other people: no panic, nothing half written.

use std::fs::{self, File, Permissions};
use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};

use super::bench::{Bench, Done, TINY, neutral, not_run, unfinished};

const FULL: &str = "/dev/full";

fn train(bench: &Bench, folder: &str) -> Command {
    bench.program(["train", "open", "--out", folder].iter().chain(TINY))
}

#[test]
fn a_full_standard_output_is_named_and_the_run_is_whole() {
    let bench = Bench::new();
    bench.train("open", "whole", &[]).ends_in(0);
    let full = || File::options().write(true).open(FULL).unwrap();
    let done = Done::from(train(&bench, "run").stdout(full()).output().unwrap()).ends_in(3);
    let last = done.stderr.lines().last().unwrap();
    let expected = "error: cannot write to standard output: No space left on device (os error 28)";
    assert_eq!(last, expected);
    assert!(bench.results("whole") == bench.results("run"));
    for line in [
        "--help",
        "inspect run",
        "evaluate run open --pairs 3 --json",
        "export run --format rs --out -",
    ] {
        let output = bench.program(line.split(' ')).stdout(full()).output().unwrap();
        let done = Done::from(output).ends_in(3);
        assert_eq!(done.stderr.lines().last(), Some(expected), "{line}");
    }
}

#[test]
fn a_full_standard_error_changes_nothing() {
    let bench = Bench::new();
    bench.train("open", "whole", &[]).ends_in(0);
    let full = File::options().write(true).open(FULL).unwrap();
    Done::from(train(&bench, "run").stderr(full).output().unwrap()).ends_in(0);
    assert!(bench.results("whole") == bench.results("run"));
}

#[test]
fn a_reader_that_leaves_early_changes_nothing() {
    let bench = Bench::new();
    bench.train("open", "whole", &[]).ends_in(0);
    let mut child =
        train(&bench, "run").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Like `| head -1`, on both streams.
    drop(child.stdout.take());
    let mut first = [0];
    child.stderr.take().unwrap().read_exact(&mut first).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert!(bench.results("whole") == bench.results("run"));
}

#[test]
fn a_file_size_limit_is_an_input_output_failure() {
    let bench = Bench::new();
    let script = "ulimit -f 8; exec \"$0\" \"$@\"";
    let mut command = Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_evosteer"), "train", "open", "--out", "run"]);
    command.args(TINY).current_dir(bench.path(""));
    neutral(&mut command);
    let done = Done::from(command.output().unwrap()).ends_in(3);
    assert!(done.stderr.contains("File too large"), "{}", done.stderr);
    assert_eq!(unfinished(&bench.all_files("run")), [""; 0]);
    bench.train("open", "whole", &[]).ends_in(0);
    bench.say("train --resume run").ends_in(0);
    assert!(bench.results("whole") == bench.results("run"));
}

/// The disk is a small tmpfs of this test's own; it grows before the run is gone on with.
#[test]
fn a_full_disk_ends_the_run_and_space_lets_it_go_on() {
    let bench = Bench::new();
    let probe = Command::new("unshare").args(["--mount", "--map-root-user", "true"]).output();
    if !probe.is_ok_and(|probe| probe.status.success()) {
        return not_run("no private mounts here (unshare --mount --map-root-user)");
    }
    bench.train("open", "whole", &[]).ends_in(0);
    fs::create_dir(bench.path("disk")).unwrap();
    let script = r#"
        size=$1; shift
        mount -t tmpfs -o size=${size}k tmpfs disk || exit 99
        "$0" train open --out disk/run "$@" >said 2>&1
        echo "exit $?"
        find disk -name '.evosteer-unfinished-*'
        mount -o remount,size=10m disk || exit 99
        if test -e disk/run/manifest.toml; then set -- train --resume disk/run
        else set -- train open --out disk/run "$@"; fi
        "$0" "$@" >>said 2>&1
        echo "then $?"
        cp -r disk/run "full-at-$size"
    "#;
    for size in ["4", "8", "12", "16", "20", "28", "36", "44", "60", "80", "100"] {
        let mut command = Command::new("unshare");
        command.args(["--mount", "--map-root-user", "sh", "-c", script]);
        command.args([env!("CARGO_BIN_EXE_evosteer"), size]).args(TINY);
        neutral(&mut command);
        let done = Done::from(command.current_dir(bench.path("")).output().unwrap());
        let said = fs::read_to_string(bench.path("said")).unwrap_or_default();
        assert_eq!(done.stdout, "exit 3\nthen 0\n", "{size} kB\n{}{said}", done.stderr);
        assert!(said.contains("No space left on device (os error 28)"), "{said}");
        assert!(!said.contains("panicked"), "{said}");
        assert!(bench.results("whole") == bench.results(&format!("full-at-{size}")), "{size} kB");
    }
}

#[test]
fn a_folder_that_may_not_be_written_is_refused_before_training() {
    let bench = Bench::new();
    bench.train("open", "done", &[]).ends_in(0);
    let allow = |name: &str, mode| {
        fs::set_permissions(bench.path(name), Permissions::from_mode(mode)).unwrap();
    };
    fs::create_dir(bench.path("locked")).unwrap();
    allow("", 0o755);
    allow("locked", 0o555);
    // Root may write everywhere; as nobody the program may not.
    let as_root = fs::write(bench.path("locked/probe"), "").is_ok();
    let _ = fs::remove_file(bench.path("locked/probe"));
    let run = |words: &[&str]| {
        let program = env!("CARGO_BIN_EXE_evosteer");
        let mut command = if as_root {
            let mut command = Command::new("setpriv");
            command.args(["--reuid=65534", "--regid=65534", "--clear-groups", program]);
            command
        } else {
            Command::new(program)
        };
        neutral(&mut command);
        command.args(words).current_dir(bench.path("locked")).output().ok()
    };
    match run(&["--version"]) {
        Some(output) if output.status.success() => {}
        _ => return not_run("root, and setpriv cannot start the program as somebody else"),
    }
    let cases: [&[&str]; 4] = [
        &["train", "open"],
        &["train", "open", "--out", "."],
        &["train", "open", "--out", "new"],
        &["replay", "../done", "open", "--pairs", "1"],
    ];
    for words in cases {
        let done = Done::from(run(words).unwrap()).ends_in(3);
        assert!(done.stderr.contains("Permission denied"), "{words:?}\n{}", done.stderr);
        assert!(!done.stderr.contains("generation 1/"), "{words:?}\n{}", done.stderr);
    }
    if as_root {
        let done = Done::from(run(&["train", "--resume", "../done"]).unwrap()).ends_in(3);
        assert!(done.stderr.contains("Permission denied"), "{}", done.stderr);
    }
    assert_eq!(fs::read_dir(bench.path("locked")).unwrap().count(), 0);
    allow("locked", 0o755);
}
