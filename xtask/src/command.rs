//! One thing xtask can do, and which words and options it takes.

use crate::failure::Failure;
use crate::options::Options;

/// A command: its line in the help is also what it is held to.
pub(crate) struct Command {
    /// First word of the command line.
    pub(crate) name: &'static str,
    /// Its operands, then its options, each option as `[--name VALUE]`, or `[--name]` if it takes no value; values that are
    /// known are parted by `|`.
    pub(crate) arguments: &'static str,
    /// What it does.
    pub(crate) summary: &'static str,
    /// Does it.
    pub(crate) run: fn(&Options) -> Result<(), Failure>,
}

impl Command {
    /// Runs it, unless it was given something that it would pass over.
    pub(crate) fn start(&self, options: &Options) -> Result<(), Failure> {
        self.check(options)?;
        (self.run)(options)
    }

    fn check(&self, options: &Options) -> Result<(), Failure> {
        let Self { name, arguments, .. } = self;
        let operands = arguments.split("[--").next().unwrap_or_default();
        if let (Some(word), "") = (options.operands.first(), operands) {
            return Err(Failure::usage(format!("{name}: found `{word}`, expected no more words")));
        }
        if let Some(option) = options.given.iter().find(|option| self.values(option).is_none()) {
            return Err(Failure::usage(format!(
                "{name}: no option `--{option}`; expected: {}",
                format!("cargo xtask {name} {arguments}").trim_end()
            )));
        }
        match (&options.sabotage, self.values("sabotage")) {
            (Some(way), Some(ways)) if !ways.split('|').any(|known| known == way) => {
                let ways = ways.replace('|', ", ");
                Err(Failure::usage(format!(
                    "{name} --sabotage: found `{way}`, expected one of: {ways}"
                )))
            }
            _ => Ok(()),
        }
    }

    /// What the help says about an option's value, if this command takes the option.
    fn values(&self, option: &str) -> Option<&'static str> {
        let options = self.arguments.split("[--").skip(1).filter_map(|rest| rest.split(']').next());
        options
            .filter_map(|known| match known.split_once(' ') {
                Some((name, values)) => (name == option).then_some(values),
                None => (known == option).then_some(""),
            })
            .next()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUILD: Command = Command {
        name: "build",
        arguments: "[BOARD]… [--sabotage panic|hang]",
        summary: "",
        run: |_| Ok(()),
    };

    const BENCH: Command = Command { name: "bench", arguments: "[--json] [--counted]", ..BUILD };

    const SPEED: Command = Command { name: "speed", arguments: "", ..BUILD };

    fn start(command: &Command, line: &str) -> Result<(), String> {
        let options = Options::parse(line.split_whitespace().map(str::to_owned).collect());
        command.start(&options.expect("readable")).map_err(|failure| failure.to_string())
    }

    #[test]
    fn what_a_command_takes_starts_it() {
        assert_eq!(start(&BUILD, "build a b --sabotage hang --targets debian"), Ok(()));
        assert_eq!(start(&BUILD, "build"), Ok(()));
        assert_eq!(start(&SPEED, "speed --targets rustup"), Ok(()));
        assert_eq!(start(&BENCH, "bench --counted --json"), Ok(()));
    }

    #[test]
    fn what_a_command_would_pass_over_is_refused() {
        let refusal = |command, line| start(command, line).expect_err(line);
        assert_eq!(
            refusal(&SPEED, "speed mps2-an385"),
            "speed: found `mps2-an385`, expected no more words"
        );
        assert_eq!(
            refusal(&SPEED, "speed --json"),
            "speed: no option `--json`; expected: cargo xtask speed"
        );
        assert_eq!(refusal(&BENCH, "bench x"), "bench: found `x`, expected no more words");
        assert_eq!(
            refusal(&BUILD, "build --timeout 5"),
            "build: no option `--timeout`; expected: cargo xtask build [BOARD]… [--sabotage panic|hang]"
        );
        assert_eq!(
            refusal(&SPEED, "speed --timeout 5"),
            "speed: no option `--timeout`; expected: cargo xtask speed"
        );
        assert_eq!(
            refusal(&BUILD, "build --sabotage index"),
            "build --sabotage: found `index`, expected one of: panic, hang"
        );
    }
}
