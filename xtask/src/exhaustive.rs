//! `cargo xtask exhaustive`: the tanh at every input there is, in every environment it runs in.

mod environment;

use std::path::PathBuf;
use std::time::Instant;

use crate::failure::Failure;
use crate::options::Options;
use crate::process;
use environment::Environment;

/// The three tanh; a board knows them by their place here.
const TANH: [&str; 3] = ["rational", "libm", "micromath"];

/// Which inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Inputs {
    /// All 2³².
    All,
    /// 2²⁴, a stride apart.
    Sample,
}

/// Every input of every tanh, or of those named: one hash everywhere, then error bounds on this host.
/// With `sample` before them it is a stride of the inputs, and the hashes only.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if let Some((first, names)) = options.operands.split_first()
        && first == "sample"
    {
        return same_everywhere(&chosen(names)?, Inputs::Sample, options);
    }
    let tanh = chosen(&options.operands)?;
    same_everywhere(&tanh, Inputs::All, options)?;
    process::run(
        process::cargo()
            .args(["run", "--quiet", "--release", "--package", "controller-core"])
            .args(["--example", "exhaustive", "--"])
            .args(&tanh),
    )
}

/// A stride of the inputs in the same environments: seconds.
pub(crate) fn sample(options: &Options) -> Result<(), Failure> {
    same_everywhere(&TANH, Inputs::Sample, options)
}

fn chosen(operands: &[String]) -> Result<Vec<&'static str>, Failure> {
    if operands.is_empty() {
        return Ok(TANH.to_vec());
    }
    let known = |name: &String| {
        TANH.into_iter().find(|tanh| tanh == name).ok_or_else(|| {
            Failure::usage(format!(
                "no tanh `{name}`; expected `sample` first or not, then any of: {}",
                TANH.join(", ")
            ))
        })
    };
    operands.iter().map(known).collect()
}

/// Prints each environment's hash and time, and fails where two differ.
fn same_everywhere(tanh: &[&str], inputs: Inputs, options: &Options) -> Result<(), Failure> {
    let ready: Vec<(Environment, PathBuf)> = Environment::ALL
        .into_iter()
        .map(|environment| Ok((environment, environment.build(options)?)))
        .collect::<Result<_, Failure>>()?;
    let count = if inputs == Inputs::All { "2^32" } else { "2^24" };
    let mut hashes = Vec::new();
    for tanh in tanh {
        for (environment, program) in &ready {
            let started = Instant::now();
            let hash = environment.hash(program, tanh, inputs)?;
            let seconds = started.elapsed().as_secs_f64();
            println!(
                "{tanh:9}  {count} inputs  {hash:016x}  {seconds:6.1} s  {}",
                environment.name()
            );
            hashes.push((*tanh, environment.name(), hash));
        }
    }
    match first_difference(&hashes) {
        None => Ok(()),
        Some(difference) => Err(Failure::failed(difference)),
    }
}

/// The first hash that is not that of the first environment with the same tanh.
fn first_difference(hashes: &[(&str, &str, u64)]) -> Option<String> {
    hashes.iter().find_map(|(tanh, name, hash)| {
        let (_, first, expected) = hashes.iter().find(|(other, ..)| other == tanh)?;
        let differs = || format!("{tanh} on {name}: hash {hash:016x}, on {first}: {expected:016x}");
        (hash != expected).then(differs)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_that_differs_in_one_environment_is_named() {
        let mut hashes = vec![
            ("libm", "host", 1),
            ("libm", "board", 1),
            ("rational", "host", 2),
            ("rational", "board", 2),
        ];
        assert_eq!(first_difference(&hashes), None);
        hashes[3].2 = 3;
        assert_eq!(
            first_difference(&hashes).as_deref(),
            Some("rational on board: hash 0000000000000003, on host: 0000000000000002")
        );
    }

    #[test]
    fn an_unknown_tanh_is_refused_with_the_names_there_are() {
        assert_eq!(chosen(&[]).expect("all"), TANH);
        let refusal = chosen(&["tahn".into()]).expect_err("unknown").to_string();
        assert_eq!(
            refusal,
            "no tanh `tahn`; expected `sample` first or not, then any of: rational, libm, micromath"
        );
    }
}
