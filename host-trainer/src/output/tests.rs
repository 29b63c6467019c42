use std::io;

use super::*;

fn say_everything(output: &mut Output) {
    output.line("trained");
    output.warning("slow");
    output.status("generation 1");
    output.json(&serde_json::json!({ "reached": 0.5, "mean": f64::NAN }));
}

#[test]
fn without_json_the_result_is_lines_on_standard_output() {
    let (stdout, stderr) = (Page::default(), Page::default());
    let mut output = Output::to(false, stdout.clone(), stderr.clone());
    say_everything(&mut output);
    output.finish().unwrap();
    assert_eq!(stdout.text(), "trained\n");
    assert_eq!(stderr.text(), "warning: slow\ngeneration 1\n");
}

#[test]
fn with_json_standard_output_holds_one_object_and_nothing_else() {
    let (stdout, stderr) = (Page::default(), Page::default());
    let mut output = Output::to(true, stdout.clone(), stderr.clone());
    say_everything(&mut output);
    output.finish().unwrap();
    let object: serde_json::Value = serde_json::from_str(&stdout.text()).unwrap();
    assert_eq!(object["reached"], 0.5);
    assert!(object["mean"].is_null());
    assert_eq!(stderr.text(), "trained\nwarning: slow\ngeneration 1\n");
}

#[test]
fn a_note_is_told_once_however_often_there_is_reason_for_it() {
    let stderr = Page::default();
    let mut output = Output::to(false, Page::default(), stderr.clone());
    for note in ["short", "long", "short", "short", "long"] {
        output.note(note);
    }
    assert_eq!(stderr.text(), "note: short\nnote: long\n");
}

#[test]
fn a_reader_that_leaves_is_no_failure() {
    let (reader, writer) = io::pipe().unwrap();
    drop(reader);
    let stderr = Page::default();
    let mut output = Output::to(false, writer, stderr.clone());
    say_everything(&mut output);
    say_everything(&mut output);
    output.finish().unwrap();
    assert_eq!(stderr.text(), "warning: slow\ngeneration 1\n".repeat(2));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_under_standard_output_is_reported_at_the_end() {
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let stderr = Page::default();
    let mut output = Output::to(false, full, stderr.clone());
    say_everything(&mut output);
    let failure = output.finish().unwrap_err();
    assert_eq!(failure.exit_code(), 3);
    assert_eq!(
        failure.to_string(),
        "cannot write to standard output: No space left on device (os error 28)"
    );
    assert!(stderr.text().ends_with("generation 1\n"), "the rest went on");
}

#[test]
#[cfg(target_os = "linux")]
fn trouble_with_standard_error_is_ignored() {
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let stdout = Page::default();
    let mut output = Output::to(false, stdout.clone(), full);
    say_everything(&mut output);
    output.finish().unwrap();
    assert_eq!(stdout.text(), "trained\n");
}
