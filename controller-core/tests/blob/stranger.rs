//! A decoder written from `docs/weight-blob.md` alone agrees with this one.

use crate::cases::all;
use crate::golden::folder;
use controller_core::activation::ActivationKind;
use std::process::Command;

/// Runs the Python decoder over one golden blob; `None` where there is no Python 3.
fn decoded(name: &str) -> Option<String> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/decode_blob.py");
    let run =
        Command::new("python3").arg(script).arg(folder().join(format!("{name}.blob"))).output();
    match run {
        Ok(run) => {
            let errors = String::from_utf8_lossy(&run.stderr);
            assert!(run.status.success(), "{name}: {}\n{errors}", run.status);
            Some(String::from_utf8(run.stdout).unwrap())
        }
        Err(error) => {
            assert!(
                std::env::var_os("EVOSTEER_REQUIRE_ALL").is_none(),
                "python3 is required here and does not start: {error}"
            );
            println!("NOT RUN: python3 does not start: {error}");
            None
        }
    }
}

/// Reads the value after `key: ` in the script's report.
fn field<'a>(report: &'a str, key: &str) -> &'a str {
    let line = report.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
    line.unwrap_or_else(|| panic!("no {key} in\n{report}"))
}

#[test]
fn a_strangers_decoder_reads_every_golden_blob() {
    for case in all() {
        let Some(report) = decoded(case.name) else { return };
        let header = case.header;
        assert_eq!(field(&report, "topology"), header.topology.to_string());
        assert_eq!(field(&report, "tanh"), header.activation.to_string());
        assert_eq!(field(&report, "scenario"), "golden");
        assert_eq!(field(&report, "seed"), header.provenance.seed.to_string());
        assert_eq!(field(&report, "steer limit"), header.scaling.steer_limit.to_string());
        let words: Vec<String> =
            case.weights.iter().map(|weight| format!("{:08x}", weight.to_bits())).collect();
        assert_eq!(field(&report, "weights"), words.join(" "));
        let self_test = match header.activation {
            ActivationKind::Rational => "3 of 3 triples agree bit for bit",
            _ => "not run, this script knows the rational tanh only",
        };
        assert_eq!(field(&report, "self-test"), self_test);
    }
}
