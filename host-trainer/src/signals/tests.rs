use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::*;
use crate::test_process;

/// In a child: stops 50 ms after the flag is up, the time of "one evaluation"; in the
/// folder named `deaf`, never.
#[test]
fn child_waits_for_a_signal() {
    let Some(folder) = test_process::folder() else { return };
    let stop = StopFlag::install().unwrap();
    test_process::say("ready");
    let end = Instant::now() + Duration::from_secs(20);
    while Instant::now() < end {
        if let Some(signal) = stop.requested() {
            test_process::say(signal);
            if folder != Path::new("deaf") {
                sleep(Duration::from_millis(50));
                std::process::exit(i32::from(128 + signal));
            }
            sleep(Duration::from_secs(20));
        }
        sleep(Duration::from_millis(1));
    }
    std::process::exit(1);
}

fn child(folder: &str) -> Child {
    let test = "signals::tests::child_waits_for_a_signal";
    let mut child = test_process::command(test, Path::new(folder)).spawn().unwrap();
    assert_eq!(test_process::hear(&mut child), "ready");
    child
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn the_first_signal_is_only_noted() {
    for (signal, number) in [("-INT", 2), ("-TERM", 15)] {
        let mut child = child("");
        send(signal, &child);
        assert_eq!(test_process::hear(&mut child), number.to_string());
        let status = child.wait().unwrap();
        assert_eq!((status.code(), status.signal()), (Some(128 + number), None), "{signal}");
    }
}

#[test]
fn the_second_signal_ends_the_process_at_once() {
    for (signals, code) in
        [(["-INT", "-INT"], 130), (["-TERM", "-INT"], 130), (["-INT", "-TERM"], 143)]
    {
        let mut child = child("deaf");
        send(signals[0], &child);
        test_process::hear(&mut child);
        let sent = Instant::now();
        send(signals[1], &child);
        assert_eq!(child.wait().unwrap().code(), Some(code), "{signals:?}");
        assert!(sent.elapsed() < Duration::from_secs(5));
    }
}

#[test]
fn a_stopped_and_continued_process_goes_on() {
    let mut child = child("");
    send("-STOP", &child);
    send("-CONT", &child);
    sleep(Duration::from_millis(20));
    assert!(child.try_wait().unwrap().is_none());
    send("-INT", &child);
    assert_eq!(test_process::hear(&mut child), "2");
    assert_eq!(child.wait().unwrap().code(), Some(130));
}
