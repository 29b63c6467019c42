//! Where a tanh is computed: this host in three ways, and the emulated Cortex-M4F.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use super::{Inputs, TANH};
use crate::boards;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use crate::process;
use crate::qemu;
use crate::targets::Toolchain;

/// The example that computes a hash, on the host as on the board.
const EXAMPLE: &str = "tanh_hash";

/// The board with the processor that the product is made for.
const BOARD: &str = "mps2-an386";

/// What `Inputs::SAMPLE` of `controller_core::activation::digest` is, for the board.
const SAMPLE: Order = Order { first: 0, stride: 257, last: (1 << 24) - 1 };

/// All inputs, for the board.
const ALL: Order = Order { first: 0, stride: 1, last: u32::MAX };

/// Something that computes a tanh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Environment {
    /// With assertions and overflow checks, hardly optimised.
    HostDebug,
    /// As users run it.
    HostRelease,
    /// 16 inputs at a time.
    HostLanes,
    /// In QEMU.
    Board,
}

impl Environment {
    /// In the order of their runs.
    pub(super) const ALL: [Self; 4] =
        [Self::HostDebug, Self::HostRelease, Self::HostLanes, Self::Board];

    /// Its name for people.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::HostDebug => "host, debug build",
            Self::HostRelease => "host, release build",
            Self::HostLanes => "host, release build, 16 lanes",
            Self::Board => "Cortex-M4F, mps2-an386 in QEMU",
        }
    }

    fn profile(self) -> &'static str {
        if self == Self::HostDebug { "dev" } else { "release" }
    }

    /// Builds the program that computes hashes there.
    pub(super) fn build(self, options: &Options) -> Result<PathBuf, Failure> {
        if self == Self::Board {
            return firmware::build_example(boards::named(BOARD)?, EXAMPLE, options);
        }
        process::run(process::cargo().args([
            "build",
            "--quiet",
            "--profile",
            self.profile(),
            "--package",
            "controller-core",
            "--example",
            EXAMPLE,
        ]))?;
        let folder = if self == Self::HostDebug { "debug" } else { "release" };
        Ok(Toolchain::Rustup.target_dir().join(folder).join("examples").join(EXAMPLE))
    }

    /// The hash of a tanh over these inputs.
    pub(super) fn hash(self, program: &Path, tanh: &str, inputs: Inputs) -> Result<u64, Failure> {
        if self == Self::Board {
            let kind = TANH.iter().position(|name| *name == tanh).unwrap_or_default() as u32;
            return on_board(program, kind, if inputs == Inputs::All { ALL } else { SAMPLE });
        }
        let inputs = if inputs == Inputs::All { "all" } else { "sample" };
        let width = if self == Self::HostLanes { "lanes" } else { "scalar" };
        let mut command = Command::new(program);
        let said = process::output(command.args([tanh, inputs, width])).unwrap_or_default();
        u64::from_str_radix(&said, 16).map_err(|_| {
            Failure::failed(format!("{EXAMPLE} {tanh} {inputs} {width}: no hash in `{said}`"))
        })
    }
}

/// Inputs as the board is told them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Order {
    first: u32,
    stride: u32,
    last: u32,
}

impl Order {
    /// The `part`-th of `parts` nearly equal parts.
    fn part(self, part: u64, parts: u64) -> Self {
        let count = u64::from(self.last) + 1;
        let [start, end] = [part, part + 1].map(|part| count * part / parts);
        let first = self.first.wrapping_add(self.stride.wrapping_mul(start as u32));
        Self { first, stride: self.stride, last: (end - start - 1) as u32 }
    }

    /// As it lies in the board's flash.
    fn bytes(self, tanh: u32) -> Vec<u8> {
        let Self { first, stride, last } = self;
        [tanh, first, stride, last].into_iter().flat_map(u32::to_le_bytes).collect()
    }
}

/// As many emulators as there are cores, each with its part of the inputs; a hash is a sum.
fn on_board(program: &Path, tanh: u32, inputs: Order) -> Result<u64, Failure> {
    let parts = thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
    thread::scope(|scope| {
        let emulators: Vec<_> = (0..parts)
            .map(|part| scope.spawn(move || hash_of(program, tanh, inputs.part(part, parts))))
            .collect();
        let mut sum = 0u64;
        for emulator in emulators {
            let hash = emulator.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            sum = sum.wrapping_add(hash?);
        }
        Ok(sum)
    })
}

fn hash_of(program: &Path, tanh: u32, inputs: Order) -> Result<u64, Failure> {
    let name = format!("xtask-tanh-{}-{}-{}.bin", std::process::id(), inputs.first, inputs.stride);
    let file = Toolchain::Rustup.target_dir().join(name);
    std::fs::write(&file, inputs.bytes(tanh))
        .map_err(|error| Failure::failed(format!("cannot write {}: {error}", file.display())))?;
    let weights = file.display().to_string();
    let log =
        qemu::log(boards::named(BOARD)?, program, &["--timeout", "86400", "--weights", &weights]);
    // A file left behind in cargo's folder harms nobody.
    let _ = std::fs::remove_file(&file);
    hash_in(&log?)
}

/// The hash that the board reported.
fn hash_in(log: &str) -> Result<u64, Failure> {
    let mut words =
        log.lines().flat_map(|line| line.split_whitespace().skip_while(|word| *word != "hash"));
    let hash = words.nth(1).and_then(|word| u64::from_str_radix(word, 16).ok());
    hash.ok_or_else(|| Failure::failed(format!("no line `hash …` in the board's log:\n{log}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_an_order_meet_every_input_once() {
        for parts in [1, 2, 3, 7] {
            let all: Vec<Order> = (0..parts).map(|part| ALL.part(part, parts)).collect();
            let count: u64 = all.iter().map(|part| u64::from(part.last) + 1).sum();
            assert_eq!(count, 1 << 32);
            let joined = all.windows(2).all(|two| two[0].first + two[0].last + 1 == two[1].first);
            assert!(joined, "{all:?}");
        }
        let second = SAMPLE.part(1, 2);
        assert_eq!(second, Order { first: 257 << 23, stride: 257, last: (1 << 23) - 1 });
    }

    #[test]
    fn the_sample_is_the_hosts() {
        let core = "controller-core/src/activation/digest.rs";
        let text = std::fs::read_to_string(process::root().join(core)).expect(core);
        let Order { first, stride, .. } = SAMPLE;
        let sample = format!("Self {{ first: {first}, stride: {stride}, count: 1 << 24 }}");
        assert!(text.contains(&sample), "{core} lacks `{sample}`");
    }

    #[test]
    fn a_boards_hash_is_found_and_a_log_without_one_is_refused() {
        let log = "INFO  hash 00000000000000ff  (main.rs:32)\n";
        assert_eq!(hash_in(log).expect("a hash"), 255);
        assert!(hash_in("INFO  hello").expect_err("none").to_string().contains("no line `hash"));
    }
}
