//! `cargo xtask bench`: how fast the simulation is on this machine.

use std::process::Command;

use crate::failure::Failure;
use crate::options::Options;
use crate::process;

/// Vector instructions that the simulator knows, narrowest first.
const SETS: [&str; 4] = ["scalar", "sse2", "avx2", "avx512"];

/// What one call of `evosteer bench` says.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Speed {
    /// Million control periods per second, all cars side by side.
    together: f64,
    /// The same with each car alone, on one thread.
    alone: f64,
    /// Seconds of a paper-size run, where it was asked for.
    run: Option<f64>,
}

/// Measures every width this CPU has on one thread and on two, a paper-size run on all cores, and
/// what a beam costs against the number of obstacles, parry2d beside it.
pub(crate) fn run(_: &Options) -> Result<(), Failure> {
    process::run(process::cargo().args(["build", "--release", "--package", "host-trainer"]))?;
    let mut rows =
        vec![["instructions", "threads", "million steps/s", "to one by one"].map(String::from)];
    for set in SETS {
        for threads in ["1", "2"] {
            let options = ["--short", "--instructions", set, "--threads", threads];
            let Some(speed) = measure(&options)? else {
                rows.push([set.into(), threads.into(), "not on this CPU".into(), String::new()]);
                continue;
            };
            let ratio = format!("{:.1}", speed.together / speed.alone);
            rows.push([set.into(), threads.into(), format!("{:.2}", speed.together), ratio]);
        }
    }
    print!("{}", table(&rows));
    if let Some(Speed { run: Some(seconds), together, .. }) = measure(&[])? {
        println!("all cores: {together:.2} million steps/s, a paper-size run in {seconds:.2} s");
    }
    process::run(process::cargo().args(["bench", "-p", "host-trainer", "--bench", "beams"]))
}

/// Calls `evosteer bench`; none if this CPU lacks the instructions.
fn measure(options: &[&str]) -> Result<Option<Speed>, Failure> {
    let program = process::root().join("target/release/evosteer");
    let mut command = Command::new(program);
    command.current_dir(process::root()).args(["bench", "--json"]).args(options);
    let output = command
        .output()
        .map_err(|error| Failure::failed(format!("evosteer bench did not start: {error}")))?;
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(2) && said.contains("expected what this CPU has") {
        return Ok(None);
    }
    if !output.status.success() {
        return Err(Failure::failed(format!(
            "evosteer bench ended with {}: {said}",
            output.status
        )));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let number = |key: &str| {
        number(&text, key)
            .ok_or_else(|| Failure::failed(format!("evosteer bench printed no `{key}`: {text}")))
    };
    Ok(Some(Speed {
        together: number("steps_per_second")? * 1e-6,
        alone: number("steps_per_second_alone")? * 1e-6,
        run: self::number(&text, "paper_run_seconds"),
    }))
}

/// The number of a key in a flat JSON object with a line per key; none if it is `null`.
fn number(json: &str, key: &str) -> Option<f64> {
    let quoted = format!("\"{key}\":");
    let value = json.lines().find_map(|line| line.trim().strip_prefix(&quoted))?;
    value.trim().trim_end_matches(',').parse().ok()
}

/// Rows under a header, as a Markdown table.
fn table(rows: &[[String; 4]]) -> String {
    let mut text = String::new();
    for (index, row) in rows.iter().enumerate() {
        text += &format!("| {} |\n", row.join(" | "));
        if index == 0 {
            text += "| --- | ---: | ---: | ---: |\n";
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_read_by_its_whole_key() {
        let json = "{\n  \"steps_per_second\": 1500000.5,\n  \"paper_run_seconds\": null\n}";
        assert_eq!(number(json, "steps_per_second"), Some(1_500_000.5));
        assert_eq!(number(json, "paper_run_seconds"), None);
        assert_eq!(number(json, "per_second"), None);
    }

    #[test]
    fn a_table_has_a_line_under_its_header() {
        let row = |first: &str| [first, "a", "b", "c"].map(String::from);
        let text = table(&[row("head"), row("one")]);
        assert_eq!(
            text,
            "| head | a | b | c |\n| --- | ---: | ---: | ---: |\n| one | a | b | c |\n"
        );
    }
}
