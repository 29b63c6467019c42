//! Gives the linker the memory map of the chosen board, and the log its level.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Feature prefix that cargo turns into an environment variable per chosen board.
const FEATURE: &str = "CARGO_FEATURE_BOARD_";

fn main() {
    log_level();
    println!("cargo::rerun-if-changed=boards");
    println!("cargo::rerun-if-changed=examples");
    let chosen: Vec<String> = env::vars()
        .filter_map(|(name, _)| Some(name.strip_prefix(FEATURE)?.to_lowercase().replace('_', "-")))
        .collect();
    let on_a_board = env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none");
    let panic_free = env::var_os("CARGO_FEATURE_PANIC_FREE").is_some();
    let result = match (on_a_board, chosen.as_slice()) {
        (true, []) if panic_free => link(Path::new("examples/panic_free"), &["-Tlink.x"]),
        // The library alone needs no memory map.
        (_, []) => Ok(()),
        (false, [board, ..]) => {
            Err(format!("{board} cannot be built for a host; use: cargo xtask build {board}"))
        }
        (true, [board]) => link(&Path::new("boards").join(board), &["-Tlink.x", "-Tdefmt.x"]),
        (true, several) => Err(format!("one board at a time, found: {}", several.join(", "))),
    };
    if let Err(message) = result {
        println!("cargo::error={message}");
    }
}

/// Without a level defmt prints errors only, and a healthy board looks dead. Set here it holds for every way
/// to call cargo, from wherever; `DEFMT_LOG` in the environment says otherwise.
fn log_level() {
    println!("cargo::rerun-if-env-changed=DEFMT_LOG");
    if env::var_os("DEFMT_LOG").is_none() {
        println!("cargo::rustc-env=DEFMT_LOG=info");
    }
}

fn link(folder: &Path, scripts: &[&str]) -> Result<(), String> {
    let map = folder.join("memory.x");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(&map, out.join("memory.x")).map_err(|error| format!("{}: {error}", map.display()))?;
    println!("cargo::rustc-link-search={}", out.display());
    for argument in ["--nmagic"].iter().chain(scripts) {
        println!("cargo::rustc-link-arg-bins={argument}");
        println!("cargo::rustc-link-arg-examples={argument}");
    }
    Ok(())
}
