//! Project tasks: `cargo xtask <command>`; without a command it prints the list.
//!
//! | exit code | meaning |
//! | --- | --- |
//! | 0 | done |
//! | 1 | a check, a build or a board failed |
//! | 2 | the command line makes no sense |
//! | 3 | a tool is missing, and the message names the command that gets it |
//! | 124 | a board did not end within its time |

mod apt;
mod bench;
mod boards;
mod call_graph;
mod champions;
mod command;
mod doctor;
mod elf;
mod exhaustive;
mod failure;
mod firmware;
mod lint;
mod machine;
mod options;
mod page;
mod panic_free;
mod panics;
mod process;
mod qemu;
mod size;
mod speed;
mod stack;
mod targets;
mod test;
mod tools;
mod uf2;

use std::process::ExitCode;

use command::Command;
use failure::Failure;
use options::Options;

const COMMANDS: &[Command] = &[
    Command {
        name: "test",
        arguments: "",
        summary: "everything that must hold: lint, host tests, emulated boards; fetches what it needs",
        run: test::run,
    },
    Command {
        name: "lint",
        arguments: "",
        summary: "formatting, clippy and documentation, warnings refused",
        run: lint::run,
    },
    Command {
        name: "doctor",
        arguments: "",
        summary: "what is here, what is missing, and the command that gets it",
        run: doctor::run,
    },
    Command {
        name: "fetch",
        arguments: "",
        summary: "installs QEMU and the bare-metal targets where they are missing",
        run: tools::fetch_all,
    },
    Command {
        name: "build",
        arguments: "[BOARD]… [--sabotage panic|fault|hang|reordered-sum|fused-sum]",
        summary: "builds the boards and prints the path of each program",
        run: firmware::run,
    },
    Command {
        name: "uf2",
        arguments: "[BOARD]…",
        summary: "builds a real board's program as a file for the drive of its boot loader, and prints its path",
        run: uf2::run,
    },
    Command {
        name: "qemu",
        arguments: "ELF [--board BOARD] [--weights BLOB] [--icount SHIFT] [--prove FOLDER] [--timeout SECONDS]",
        summary: "runs a board's program in QEMU, decodes its log, passes its exit code on",
        run: qemu::run,
    },
    Command {
        name: "exhaustive",
        arguments: "[sample] [rational|libm|micromath]…",
        summary: "every f32 there is through every tanh, on host and board; minutes, not part of test",
        run: exhaustive::run,
    },
    Command {
        name: "panic-free",
        arguments: "[--sabotage index]",
        summary: "links the driving program so that it fails if anything in it can panic, and says what can",
        run: panic_free::run,
    },
    Command {
        name: "panics",
        arguments: "[BOARD]…",
        summary: "which functions of each board's program can panic",
        run: panics::run,
    },
    Command {
        name: "stack",
        arguments: "[BOARD]…",
        summary: "the most stack each board's program can take, and on which path",
        run: stack::run,
    },
    Command {
        name: "speed",
        arguments: "",
        summary: "instructions, flash and stack of a step on a Cortex-M4F; fails above the goals",
        run: speed::run,
    },
    Command {
        name: "bench",
        arguments: "[--json] [--counted]",
        summary: "the simulator's speed in one table, parry2d beside it; counted: instructions per step, held to bounds",
        run: bench::run,
    },
    Command {
        name: "champions",
        arguments: "[SCENE]…",
        summary: "trains the shipped champions again, and compares every byte",
        run: champions::run,
    },
    Command {
        name: "size",
        arguments: "",
        summary: "flash, RAM and stack of every board, held to bounds and to the table in the README",
        run: size::run,
    },
];

fn main() -> ExitCode {
    match dispatch(std::env::args().skip(1).collect()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("xtask: {failure}");
            ExitCode::from(failure.exit_code())
        }
    }
}

fn dispatch(arguments: Vec<String>) -> Result<(), Failure> {
    let options = Options::parse(arguments)?;
    let Some(name) = &options.command else {
        println!("{}", help());
        return Ok(());
    };
    let known = COMMANDS.iter().find(|command| command.name == name);
    let command =
        known.ok_or_else(|| Failure::usage(format!("no command `{name}`\n\n{}", help())))?;
    command.start(&options)
}

fn help() -> String {
    let mut text = String::from("cargo xtask <command> [--targets auto|rustup|debian]\n\n");
    for Command { name, arguments, summary, .. } in COMMANDS {
        text += &format!("  {name} {arguments}\n      {summary}\n");
    }
    text += "\n--targets (or XTASK_TARGETS) says where the compiler for the boards comes from; auto takes\n";
    text += "rustup's where it can be downloaded, else Debian's.";
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_command_is_refused_and_the_list_is_shown() {
        let failure = dispatch(vec!["tset".into()]).expect_err("no such command");
        assert_eq!(failure.exit_code(), 2);
        let message = failure.to_string();
        assert!(
            message.contains("no command `tset`") && message.contains("cargo xtask"),
            "{message}"
        );
    }

    #[test]
    fn the_workflow_and_the_local_run_call_only_commands_that_exist() {
        for file in [".github/workflows/ci.yml", ".ci/run"] {
            let text = std::fs::read_to_string(process::root().join(file)).expect(file);
            let called: Vec<&str> = text
                .split("cargo xtask ")
                .skip(1)
                .filter_map(|rest| rest.split_whitespace().next())
                .collect();
            assert!(!called.is_empty(), "{file} calls no xtask command");
            for name in called {
                assert!(
                    COMMANDS.iter().any(|command| command.name == name),
                    "{file} calls `{name}`"
                );
            }
        }
    }
}
