//! Commands that a message proposes: they work as they are printed.

use std::ffi::OsStr;
use std::path::Path;

/// How the program that runs now was started: by cargo, or by its own name.
pub(super) fn this_program() -> String {
    // Cargo tells the programs it starts which package they are of.
    if std::env::var_os("CARGO_PKG_NAME").is_some_and(|name| name == env!("CARGO_PKG_NAME")) {
        let release = if cfg!(debug_assertions) { "" } else { " --release" };
        return format!("cargo run{release} --");
    }
    let typed = std::env::args_os().next();
    let typed = typed.as_deref().map(Path::new);
    match typed {
        Some(path) if path.file_stem() == Some(OsStr::new("evosteer")) => in_shell(path),
        _ => "evosteer".to_owned(),
    }
}

/// A path as one word of a POSIX shell.
pub(super) fn in_shell(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |byte: u8| {
        let separator = cfg!(windows) && byte == b'\\';
        byte.is_ascii_alphanumeric() || b"_-./+,:=@%".contains(&byte) || separator
    };
    match text.as_bytes() {
        [first, rest @ ..]
            if *first != b'-' && is_plain(*first) && rest.iter().all(|b| is_plain(*b)) =>
        {
            text
        }
        [b'-', ..] => format!("'./{}'", text.replace('\'', r"'\''")),
        _ => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

/// A number of things: `1 pair`, `5 pairs`.
pub(super) fn counted(number: impl Into<u64>, thing: &str) -> String {
    let number = number.into();
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{ending}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_thing_has_no_ending() {
        let numbers = [0_u32, 1, 2].map(|number| counted(number, "pair"));
        assert_eq!(numbers, ["0 pairs", "1 pair", "2 pairs"]);
    }

    /// Expected: what `printf '%s\n' WORD` shows in dash and bash.
    #[test]
    #[cfg(unix)]
    fn a_path_stays_one_word() {
        let words = ["runs/a-1", "my run", "it's", "", "-x", "a;b", "größe", "a\\b"];
        let seen = words.map(|word| {
            let script = format!("printf '%s' {}", in_shell(Path::new(word)));
            let shell = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
            String::from_utf8(shell.stdout).unwrap()
        });
        assert_eq!(seen, words.map(|word| word.replace("-x", "./-x")));
    }
}
