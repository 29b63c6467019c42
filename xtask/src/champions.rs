//! `cargo xtask champions`: trains the shipped champions again, and compares every byte.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;
use crate::options::Options;
use crate::process;

/// Trains the named champions, or all, by the commands in their provenance, and fails unless the
/// blobs come out as they are shipped. With `EVOSTEER_BLESS` set, writes the blobs instead.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let folder = process::root().join("champions");
    let all = names(&folder)?;
    if let Some(unknown) = options.operands.iter().find(|name| !all.contains(name)) {
        return Err(Failure::usage(format!(
            "champions: found `{unknown}`, expected one of: {}",
            all.join(", ")
        )));
    }
    let chosen = if options.operands.is_empty() { &all } else { &options.operands };
    process::run(process::cargo().args(["build", "--release", "--package", "host-trainer"]))?;
    let mut different = Vec::new();
    for champion in chosen {
        let stage = first_stage(champion, |name| provenance(&folder, name))?;
        let stage = stage.as_deref();
        for name in stage.into_iter().chain([champion.as_str()]) {
            let trained = train(&provenance(&folder, name)?, name)?;
            let shipped = folder.join(format!("{name}.blob"));
            if std::env::var_os("EVOSTEER_BLESS").is_some() {
                fs::write(&shipped, &trained).map_err(|error| failed("write", &shipped, &error))?;
                println!("{name}: written, {} bytes", trained.len());
            } else if read(&shipped)? == trained {
                println!("{name}: the same {} bytes", trained.len());
            } else {
                println!("{name}: not the {} bytes that are shipped", trained.len());
                different.push(champion.as_str());
                break;
            }
        }
    }
    if different.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(format!(
        "trained anew, these are not what is shipped: {}\n\
         if the change is meant: EVOSTEER_BLESS=1 cargo xtask champions {}",
        different.join(", "),
        different.join(" ")
    )))
}

/// Every champion of the folder: a file of provenance.
fn names(folder: &Path) -> Result<Vec<String>, Failure> {
    let entries = fs::read_dir(folder).map_err(|error| failed("read", folder, &error))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let provenance = paths.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let mut names: Vec<String> =
        provenance.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    Ok(names)
}

/// The first stage that a training begins with, below the folder, without its ending.
fn stage<'a>(words: &[&'a str]) -> Result<Option<&'a str>, Failure> {
    let Some(option) = words.iter().position(|word| word.starts_with("--from")) else {
        return Ok(None);
    };
    let named = words.get(option + 1).and_then(|word| word.strip_prefix("champions/"));
    let stage = named.and_then(|name| name.strip_suffix(".blob"));
    match stage.filter(|name| words[option] == "--from" && name.starts_with("stages/")) {
        Some(stage) => Ok(Some(stage)),
        None => Err(Failure::failed(format!(
            "found {}, expected --from champions/stages/….blob",
            words[option..].join(" ")
        ))),
    }
}

/// The first stage of a champion, if it has one, which has none itself.
fn first_stage(
    champion: &str,
    provenance: impl Fn(&str) -> Result<String, Failure>,
) -> Result<Option<String>, Failure> {
    let text = provenance(champion)?;
    let Some(name) = stage(&arguments(&text, champion)?)? else { return Ok(None) };
    let text = provenance(name)?;
    if stage(&arguments(&text, name)?)?.is_some() {
        return Err(Failure::failed(format!(
            "champions/{name}.toml: found --from, expected a training that begins with random networks"
        )));
    }
    Ok(Some(name.to_owned()))
}

fn provenance(folder: &Path, name: &str) -> Result<String, Failure> {
    Ok(String::from_utf8_lossy(&read(&folder.join(format!("{name}.toml")))?).into_owned())
}

/// Trains as a provenance says, and returns the champion's bytes.
fn train(provenance: &str, name: &str) -> Result<Vec<u8>, Failure> {
    let words = arguments(provenance, name)?;
    let run = process::root().join("target/champions").join(name);
    match fs::remove_dir_all(&run) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(failed("remove", &run, &error));
        }
        _ => {}
    }
    let program: PathBuf = process::root().join("target/release/evosteer");
    let mut command = Command::new(program);
    command.current_dir(process::root()).args(words).arg("--out").arg(&run);
    process::run(&mut command)?;
    read(&run.join("champion.blob"))
}

/// The words after `evosteer` in the line that says how a champion was made.
fn arguments<'a>(provenance: &'a str, name: &str) -> Result<Vec<&'a str>, Failure> {
    let line = provenance.lines().find_map(|line| line.strip_prefix("command = \"evosteer "));
    let line = line.and_then(|line| line.strip_suffix('"')).ok_or_else(|| {
        Failure::failed(format!(
            "champions/{name}.toml: expected a line command = \"evosteer train …\""
        ))
    })?;
    Ok(line.split_whitespace().collect())
}

fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    fs::read(path).map_err(|error| failed("read", path, &error))
}

fn failed(what: &str, path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed(format!("cannot {what} {}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_of_every_shipped_champion_is_a_training() {
        let folder = process::root().join("champions");
        let names = names(&folder).expect("a folder");
        assert!(!names.is_empty());
        for name in names {
            let of = |name: &str| provenance(&folder, name);
            let stage = first_stage(&name, of).expect(&name);
            for name in stage.iter().chain([&name]) {
                let text = of(name).expect(name);
                let words = arguments(&text, name).expect(name);
                assert_eq!(words[0], "train", "{name}");
                assert!(!words.contains(&"--out"), "{name}: the folder is chosen by the task");
            }
        }
    }

    #[test]
    fn a_first_stage_has_none_itself() {
        let of = |name: &str| {
            let options = match name {
                "b" => "--from champions/stages/a.blob --seed 2",
                "c" => "--from champions/stages/b.blob",
                "stages/b" => "--from champions/stages/a.blob",
                _ => "--seed 1",
            };
            Ok(format!("command = \"evosteer train open {options}\"\n"))
        };
        assert_eq!(first_stage("a", of).expect("a"), None);
        assert_eq!(first_stage("b", of).expect("b").as_deref(), Some("stages/a"));
        let said = first_stage("c", of).expect_err("two stages").to_string();
        assert!(said.starts_with("champions/stages/b.toml: found --from"), "{said}");
    }

    #[test]
    fn a_training_begins_with_a_stage_or_with_nothing() {
        let of = |line: &str| {
            let words: Vec<&str> = line.split_whitespace().collect();
            stage(&words).map(|stage| stage.map(str::to_owned)).map_err(|error| error.to_string())
        };
        assert_eq!(of("train open --seed 1"), Ok(None));
        let begun = "train open --from champions/stages/a-1.blob --seed 2";
        assert_eq!(of(begun), Ok(Some("stages/a-1".to_owned())));
        for other in ["--from champions/open.blob", "--from runs/a", "--from", "--from=a.blob"] {
            let said = format!("found {other}, expected --from champions/stages/….blob");
            assert_eq!(of(&format!("train open {other}")), Err(said));
        }
    }

    #[test]
    fn a_file_without_a_command_is_not_guessed_at() {
        let words = |text| arguments(text, "a").ok();
        assert_eq!(words("command = \"evosteer train a\""), Some(vec!["train", "a"]));
        assert_eq!(words("seed = 1\ncommand = \"rm x\"\n"), None);
        assert_eq!(words("command = \"evosteer train a"), None);
    }
}
