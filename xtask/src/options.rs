//! The command line: one command, its operands, and the options all commands share.

use std::path::PathBuf;
use std::time::Duration;

use crate::failure::Failure;

/// Where the compiler for the boards comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TargetSource {
    /// rustup where it has, or can download, the target; else Debian.
    Auto,
    /// rustup's precompiled `core`.
    Rustup,
    /// Debian's compiler, which builds `core` from Debian's source package.
    Debian,
}

impl TargetSource {
    /// Its name on the command line and in `XTASK_TARGETS`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Rustup => "rustup",
            Self::Debian => "debian",
        }
    }

    fn from_name(name: &str, option: &str) -> Result<Self, Failure> {
        let all = [Self::Auto, Self::Rustup, Self::Debian];
        all.into_iter().find(|source| source.name() == name).ok_or_else(|| {
            Failure::usage(format!("{option}: found `{name}`, expected auto, rustup or debian"))
        })
    }
}

/// What was asked for on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Options {
    /// First word; none asks for help.
    pub(crate) command: Option<String>,
    /// The words after it.
    pub(crate) operands: Vec<String>,
    /// Names of the options given, but `targets`, which every command takes.
    pub(crate) given: Vec<&'static str>,
    /// `--targets`, else `XTASK_TARGETS`, else auto.
    pub(crate) targets: TargetSource,
    /// `--board`: which board a program is for, where its file name does not say so.
    pub(crate) board: Option<String>,
    /// `--sabotage`: build a program that has to fail, in this way: with the feature `sabotage-<way>`.
    pub(crate) sabotage: Option<String>,
    /// `--weights`: the blob in the board's flash; without it that flash is erased.
    pub(crate) weights: Option<PathBuf>,
    /// `--icount`: 2 to the power of this is how many nanoseconds an instruction takes on the board's
    /// clock; without it that clock is this machine's.
    pub(crate) icount: Option<u8>,
    /// `--prove`: the folder with the cases that the board drives instead, and for its results.
    pub(crate) prove: Option<PathBuf>,
    /// `--json`: print the result as JSON.
    pub(crate) json: bool,
    /// `--counted`: count instructions instead of taking times.
    pub(crate) counted: bool,
    /// `--timeout`: wall-clock time a board may take, 60 s unless said otherwise.
    pub(crate) timeout: Duration,
}

/// Every option that takes a value.
const VALUED: [&str; 7] = ["targets", "board", "sabotage", "weights", "icount", "prove", "timeout"];

/// Every option that takes none.
const FLAGS: [&str; 2] = ["json", "counted"];

impl Options {
    /// Reads the words after `cargo xtask`.
    pub(crate) fn parse(arguments: Vec<String>) -> Result<Self, Failure> {
        let targets = match std::env::var("XTASK_TARGETS") {
            Ok(name) => TargetSource::from_name(&name, "XTASK_TARGETS")?,
            Err(_) => TargetSource::Auto,
        };
        let timeout = Duration::from_secs(60);
        let mut options = Self {
            command: None,
            operands: Vec::new(),
            given: Vec::new(),
            targets,
            board: None,
            sabotage: None,
            weights: None,
            icount: None,
            prove: None,
            json: false,
            counted: false,
            timeout,
        };
        let mut words = arguments.into_iter();
        while let Some(word) = words.next() {
            let Some(option) = word.strip_prefix("--") else {
                match options.command {
                    None => options.command = Some(word),
                    Some(_) => options.operands.push(word),
                }
                continue;
            };
            if option == "help" {
                options.command = None;
                return Ok(options);
            }
            if let Some(flag) = FLAGS.into_iter().find(|flag| *flag == option) {
                options.raise(flag);
                continue;
            }
            let (name, value) = match option.split_once('=') {
                Some((name, value)) => (name, Some(value.to_owned())),
                None => (option, words.next()),
            };
            options.set(name, value)?;
        }
        Ok(options)
    }

    fn raise(&mut self, flag: &'static str) {
        self.given.push(flag);
        match flag {
            "json" => self.json = true,
            _ => self.counted = true,
        }
    }

    fn set(&mut self, name: &str, value: Option<String>) -> Result<(), Failure> {
        let Some(known) = VALUED.into_iter().find(|known| *known == name) else {
            let known = VALUED.iter().chain(&FLAGS).map(|name| format!("--{name}"));
            let known = known.collect::<Vec<_>>().join(", ");
            return Err(Failure::usage(format!("no option `--{name}`; expected one of: {known}")));
        };
        if known != "targets" {
            self.given.push(known);
        }
        let value = value.ok_or_else(|| Failure::usage(format!("--{name} needs a value")))?;
        match name {
            "targets" => self.targets = TargetSource::from_name(&value, "--targets")?,
            "board" => self.board = Some(value),
            "weights" => self.weights = Some(value.into()),
            "prove" => self.prove = Some(value.into()),
            "icount" => {
                let shift = value.parse().ok().filter(|shift| *shift <= 10);
                self.icount = Some(shift.ok_or_else(|| {
                    Failure::usage(format!("--icount: found `{value}`, expected 0 to 10"))
                })?);
            }
            "sabotage" => self.sabotage = Some(value),
            _ => {
                let seconds = value.parse().ok().filter(|seconds| (1..=86_400).contains(seconds));
                let seconds = seconds.ok_or_else(|| {
                    Failure::usage(format!(
                        "--timeout: found `{value}`, expected 1 to 86400 seconds"
                    ))
                })?;
                self.timeout = Duration::from_secs(seconds);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Options, Failure> {
        Options::parse(line.split_whitespace().map(str::to_owned).collect())
    }

    #[test]
    fn options_may_stand_anywhere_and_take_their_value_either_way() {
        let options = parse("qemu --timeout=5 program.elf --board mps2-an386 --targets debian")
            .expect("valid");
        assert_eq!(options.command.as_deref(), Some("qemu"));
        assert_eq!(options.operands, ["program.elf"]);
        assert_eq!(options.timeout, Duration::from_secs(5));
        assert_eq!(options.board.as_deref(), Some("mps2-an386"));
        assert_eq!(options.targets, TargetSource::Debian);
    }

    #[test]
    fn an_option_without_a_value_leaves_the_next_word_alone() {
        let options = parse("bench --json extra --counted").expect("valid");
        assert!(options.json && options.counted);
        assert_eq!(options.operands, ["extra"]);
        assert_eq!(options.given, ["json", "counted"]);
    }

    #[test]
    fn a_wrong_option_names_itself_and_what_was_expected() {
        let message = |line| parse(line).expect_err(line).to_string();
        assert_eq!(
            message("test --target x"),
            "no option `--target`; expected one of: --targets, --board, --sabotage, --weights, --icount, --prove, --timeout, --json, --counted"
        );
        assert_eq!(
            message("test --targets brew"),
            "--targets: found `brew`, expected auto, rustup or debian"
        );
        assert_eq!(
            message("qemu a --timeout 0"),
            "--timeout: found `0`, expected 1 to 86400 seconds"
        );
        assert_eq!(message("qemu a --icount 11"), "--icount: found `11`, expected 0 to 10");
        assert_eq!(message("qemu a --board"), "--board needs a value");
    }
}
