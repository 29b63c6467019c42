//! Every command of a page, run as a reader would run it, prints what the page says.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, ExitStatus};

use super::console::{self, agree, cut_like};
use super::pages;

/// How a page may call the program: by cargo, or by its own name.
const BY_CARGO: &str = "cargo run --release -- ";
const BY_NAME: &str = "evosteer ";

/// The program as this line calls it; none if it calls something else.
fn program(line: &str) -> Option<Command> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_evosteer"));
    if let Some(arguments) = line.strip_prefix(BY_CARGO) {
        command.env("CARGO_PKG_NAME", env!("CARGO_PKG_NAME")).args(arguments.split_whitespace());
    } else {
        command.env_remove("CARGO_PKG_NAME").args(line.strip_prefix(BY_NAME)?.split_whitespace());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::arg0(&mut command, BY_NAME.trim());
    }
    Some(command)
}

/// Runs a command in `folder`; both its streams, as a terminal would mix them.
fn run(mut command: Command, folder: &Path) -> (String, ExitStatus) {
    let (mut output, input) = std::io::pipe().unwrap();
    command.current_dir(folder);
    command.stdout(input.try_clone().unwrap()).stderr(input);
    let mut child = command.spawn().unwrap();
    // The command keeps ends of the pipe; reading would never end.
    drop(command);
    let mut text = String::new();
    output.read_to_string(&mut text).unwrap();
    // Tests build the program without `--release`.
    (text.replace("cargo run -- ", BY_CARGO), child.wait().unwrap())
}

/// The repository as far as the commands of a page use it.
fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["scenarios", "champions"] {
        copy(&pages::root().join(name), &folder.path().join(name));
    }
    folder
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to);
        } else {
            fs::copy(&path, &to).unwrap();
        }
    }
}

/// Runs a page's commands in order, in one folder, which is returned.
fn check(page: &str) -> tempfile::TempDir {
    let text = pages::read(page);
    let folder = workplace();
    let mut lines: Vec<&str> = text.lines().collect();
    let mut changes = Vec::new();
    let ran = console::commands(&text);
    for command in &ran {
        let program = program(command.line).unwrap_or_else(|| {
            panic!("{page}: `{}` is no call of the program: fence it as ```sh", command.line)
        });
        let (printed, status) = run(program, folder.path());
        let refused = printed.lines().any(|line| line.starts_with("error: "));
        assert_eq!(status.success(), !refused, "{page}: `{}`: {status}\n{printed}", command.line);
        let printed_lines: Vec<&str> = printed.lines().map(str::trim_end).collect();
        if !agree(&command.output, &printed_lines) {
            let new: Vec<String> =
                cut_like(&command.output, &printed_lines).into_iter().map(str::to_owned).collect();
            changes.push((command.place.clone(), new));
        }
    }
    for (place, new) in changes.iter().rev() {
        lines.splice(place.clone(), new.iter().map(String::as_str));
    }
    pages::expect(page, &(lines.join("\n") + "\n"));
    folder
}

#[test]
fn the_readme_prints_what_it_says() {
    let folder = check("README.md");
    let drive = folder.path().join("runs/obstacles-1/plots/trajectory-5.svg");
    pages::expect("docs/pictures/drive.svg", &fs::read_to_string(drive).unwrap());
}

#[test]
fn the_other_pages_print_what_they_say() {
    let others = pages::all();
    let others = others.iter().filter(|page| *page != "README.md");
    others.for_each(|page| drop(check(page)));
}

/// Commands that a test cannot run inside a test: they must at least exist.
#[test]
fn every_task_that_a_page_names_exists() {
    let tasks = pages::read("xtask/src/main.rs");
    for page in pages::all() {
        for call in pages::read(&page).split("cargo xtask ").skip(1) {
            let of_a_name = |c: &char| c.is_ascii_alphanumeric() || *c == '-';
            let name: String = call.chars().take_while(of_a_name).collect();
            let exists = name.is_empty() || tasks.contains(&format!("name: \"{name}\""));
            assert!(exists, "{page}: there is no `cargo xtask {name}`");
        }
    }
}
