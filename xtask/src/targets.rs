//! The compiler for the boards: rustup's targets, or Debian's Rust where those cannot be downloaded.
//!
//! No `rust-toolchain.toml` asks for the targets: rustup would then try to download them before *any* cargo
//! command, and a machine without its servers could not even run the host tests.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use crate::apt;
use crate::failure::Failure;
use crate::options::TargetSource;
use crate::process;

/// Debian's Rust for building `core` from source: compiler, cargo, source and linker of one version.
const DEBIAN_PACKAGES: [&str; 5] =
    ["rustc-web", "cargo-web", "rust-web-src", "rust-web-clippy", "lld"];
const DEBIAN_RUSTC: &str = "/usr/bin/rustc";
const DEBIAN_CARGO: &str = "/usr/bin/cargo";
const DEBIAN_CLIPPY: &str = "/usr/bin/cargo-clippy";
const DEBIAN_LINKER: &str = "/usr/bin/ld.lld";

/// How long rustup may try before we take Debian's way.
const RUSTUP_PATIENCE: Duration = Duration::from_secs(300);

/// A compiler that is here and can build for a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Toolchain {
    /// The cargo that runs us, with the target's precompiled `core`.
    Rustup,
    /// Debian's, building `core` as it goes.
    Debian,
}

impl Toolchain {
    /// What is here for `triple`; nothing is installed.
    pub(crate) fn find(source: TargetSource, triple: &str) -> Result<Self, Failure> {
        let rustup = || has_core(triple).then_some(Self::Rustup);
        let debian = || debian_complaint().is_none().then_some(Self::Debian);
        let found = match source {
            TargetSource::Rustup => rustup(),
            TargetSource::Debian => debian(),
            TargetSource::Auto => rustup().or_else(debian),
        };
        found.ok_or_else(|| match (source, debian_complaint()) {
            (TargetSource::Debian, Some(complaint)) => {
                Failure::missing(&complaint, &apt::command_line(&DEBIAN_PACKAGES))
            }
            _ => Failure::missing(&format!("the target {triple}"), "cargo xtask fetch"),
        })
    }

    /// Finds a compiler for `triple`, downloading what is missing.
    pub(crate) fn fetch(source: TargetSource, triple: &str) -> Result<Self, Failure> {
        if let Ok(found) = Self::find(source, triple) {
            return Ok(found);
        }
        match source {
            TargetSource::Rustup => add_with_rustup(triple),
            TargetSource::Debian => install_debian(),
            TargetSource::Auto => add_with_rustup(triple).or_else(|failure| {
                eprintln!("xtask: {failure}; taking Debian's Rust instead");
                install_debian()
            }),
        }?;
        Self::find(source, triple)
    }

    /// `cargo <verb>` for `triple`, up to and including the folder for its output.
    pub(crate) fn cargo(self, verb: &str, triple: &str) -> Command {
        let mut command = process::cargo();
        match self {
            Self::Rustup => {
                command.arg(verb);
            }
            Self::Debian => {
                let program = if verb == "clippy" { DEBIAN_CLIPPY } else { DEBIAN_CARGO };
                let linker = setting(triple, "linker", &format!("{DEBIAN_LINKER:?}"));
                command = Command::new(program);
                command
                    .current_dir(process::root())
                    // `cargo-clippy` starts `$CARGO`, and rustup's would look for rustup's compiler.
                    .env("CARGO", DEBIAN_CARGO)
                    .env("RUSTC", DEBIAN_RUSTC)
                    .env("RUSTC_BOOTSTRAP", "1")
                    .env_remove("RUSTUP_TOOLCHAIN")
                    .args([verb, "-Zbuild-std=core", "--config", &linker]);
            }
        }
        command.args(["--target", triple, "--target-dir"]).arg(self.target_dir());
        command
    }

    /// Cargo's output folder: apart for Debian, so that two compilers never share one.
    pub(crate) fn target_dir(self) -> PathBuf {
        let shared =
            std::env::var_os("CARGO_TARGET_DIR").map(|folder| process::root().join(folder));
        let shared = shared.unwrap_or_else(|| process::root().join("target"));
        match self {
            Self::Rustup => shared,
            Self::Debian => shared.join("debian-rust"),
        }
    }

    /// Its version line, which a table of measurements has to name.
    pub(crate) fn version_line(self) -> Result<String, Failure> {
        self.version().ok_or_else(|| Failure::failed("the compiler does not tell its version"))
    }

    /// Its version line.
    pub(crate) fn version(self) -> Option<String> {
        match self {
            Self::Rustup => process::output(rustc().arg("--version")),
            Self::Debian => process::output(Command::new(DEBIAN_RUSTC).arg("--version")),
        }
    }
}

/// A setting of cargo's for one target, as its `--config` takes it. A dot in the name stands as it is: cargo looks it
/// up as one more level.
pub(crate) fn setting(triple: &str, key: &str, value: &str) -> String {
    format!("target.{triple}.{key}={value}")
}

/// The compiler cargo would call here.
fn rustc() -> Command {
    let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    command.current_dir(process::root());
    command
}

fn has_core(triple: &str) -> bool {
    let folder = process::output(rustc().args(["--print", "target-libdir", "--target", triple]));
    folder.and_then(|folder| std::fs::read_dir(folder).ok()).is_some_and(|mut files| {
        files.any(|file| {
            file.is_ok_and(|file| file.file_name().to_string_lossy().starts_with("libcore-"))
        })
    })
}

/// What is missing of Debian's way, if anything.
fn debian_complaint() -> Option<String> {
    for program in [DEBIAN_RUSTC, DEBIAN_CARGO, DEBIAN_CLIPPY, DEBIAN_LINKER] {
        if !Path::new(program).is_file() {
            return Some(format!("Debian's {program}"));
        }
    }
    let sysroot = process::output(Command::new(DEBIAN_RUSTC).args(["--print", "sysroot"]))?;
    let source = Path::new(&sysroot).join("lib/rustlib/src/rust/library/core/Cargo.toml");
    (!source.is_file()).then(|| format!("the standard library's source, {}", source.display()))
}

fn add_with_rustup(triple: &str) -> Result<(), Failure> {
    if process::which("rustup").is_none() {
        return Err(Failure::missing("rustup", "https://rustup.rs"));
    }
    eprintln!("xtask: fetching the target {triple} with rustup: the boards are built for it");
    let mut rustup = Command::new("rustup");
    rustup.current_dir(process::root()).args(["target", "add", triple]);
    process::run_within(&mut rustup, RUSTUP_PATIENCE)
}

fn install_debian() -> Result<(), Failure> {
    apt::install(&DEBIAN_PACKAGES, "a compiler for the boards, with the source of `core`")
}
