//! The proof: every value of every step, on every board, against what the host computes now.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Instant;

use equivalence_tests::checkout::{self, Checkout};
use equivalence_tests::compare::{self, Drive, Tally};
use equivalence_tests::files::{Case, ResultsReader, Stream};
use equivalence_tests::harness::Trouble;
use equivalence_tests::on_host;
use equivalence_tests::weight_sets::{PER_KIND, WeightSet};

use crate::{BOARD, boards};

/// Steps of each of 144 weight sets on the board with the fast arithmetic: 1 008 000 together.
const MILLION: u32 = 7_000;

/// And on every other board: 100 800 together.
const HUNDRED_THOUSAND: u32 = 700;

/// Drives of one run: a run of the long proof leaves 30 MB of results, and they are gone after it.
const PER_RUN: usize = 36;

/// Two boards at a time, the slow ones first.
pub(crate) fn million() -> Result<(), Trouble> {
    let checkout = Checkout::compiled_in();
    let mut jobs = Vec::new();
    for board in boards() {
        let program = checkout.build(&board, None)?;
        let steps = if board == BOARD { MILLION } else { HUNDRED_THOUSAND };
        jobs.push((board, program, steps));
    }
    // Taken from the end: soft floating point is slowest, then the million steps.
    jobs.sort_by_key(|(board, ..)| match board.as_str() {
        "microbit" | "mps2-an385" => 2,
        BOARD => 1,
        _ => 0,
    });
    let (jobs, tallies) = (Mutex::new(jobs), Mutex::new(Vec::new()));
    std::thread::scope(|threads| {
        for _ in 0..2 {
            threads.spawn(|| {
                while let Some((board, program, steps)) = pop(&jobs) {
                    let started = Instant::now();
                    let tally =
                        prove(&checkout, &board, &program, &compare::generated_drives(steps));
                    let seconds = started.elapsed().as_secs_f64();
                    tallies.lock().expect("no panic").push((board, steps, tally, seconds));
                }
            });
        }
    });
    for (board, steps, tally, seconds) in tallies.into_inner().expect("no panic") {
        let tally = tally?;
        println!(
            "{board}: {} steps, {} differing bits ({seconds:.0} s)",
            tally.steps, tally.differing_bits
        );
        if (tally.steps, tally.differing_bits) != (144 * u64::from(steps), 0) {
            return Err(Trouble::Failed(format!("{board}: {tally:?}")));
        }
    }
    Ok(())
}

/// The reference is what the build of this test computes; the builds a user has are not this one.
pub(crate) fn builds_of_the_host() -> Result<(), Trouble> {
    let drives = compare::generated_drives(HUNDRED_THOUSAND);
    let builds: [(&str, &[&str]); 2] = [
        ("not optimised", &["--config", "profile.dev.opt-level=0"]),
        ("optimised", &["--release"]),
    ];
    for (name, options) in builds {
        let folder = Folder::new()?;
        let failed = |error: std::io::Error| Trouble::Failed(format!("{name}: {error}"));
        checkout::write_cases(&folder.0.join("cases"), &drives).map_err(failed)?;
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = Command::new(cargo)
            .current_dir(Checkout::compiled_in().folder())
            .args(["run", "--quiet", "--package", "equivalence-tests", "--bin", "prove-on-host"])
            .args(options)
            .arg("--")
            .arg(&folder.0)
            .output()
            .map_err(failed)?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(Trouble::Failed(format!("{name}: {}: {said}", output.status)));
        }
        let results = File::open(folder.0.join("results")).map_err(failed)?;
        let tally = compare::with_host(&drives, Stream(BufReader::new(results)))
            .map_err(|error| Trouble::Failed(format!("{name}: {error}")))?;
        println!("host, {name}: {} steps, {} differing bits", tally.steps, tally.differing_bits);
        if (tally.steps, tally.differing_bits) != (100_800, 0) {
            return Err(Trouble::Failed(format!("{name}: {tally:?}")));
        }
    }
    Ok(())
}

/// Every weight of one set per recurrence, one unit in the last place up and down. The host says at which step of
/// the million the change first shows in any value; the board, driving with the changed weight, has to agree with
/// the unchanged host up to there and differ from it there.
pub(crate) fn one_ulp() -> Result<(), Trouble> {
    let checkout = Checkout::compiled_in();
    let program = checkout.build(BOARD, None)?;
    // The first set of each recurrence: rational tanh, with biases, small weights.
    for number in [0, 3 * PER_KIND, 6 * PER_KIND] {
        let Drive { weights: unchanged, case } =
            compare::generated_drives(MILLION).swap_remove(number as usize);
        let weights = unchanged.blob().weights().to_vec();
        let mut drives = Vec::new();
        for (index, weight) in weights.iter().enumerate() {
            for changed in [weight.next_up(), weight.next_down()] {
                let changed = unchanged.with_weight(index, changed);
                let step = first_difference(&unchanged, &changed, case).ok_or_else(|| {
                    Trouble::Failed(format!("{}: not noticed in {MILLION} steps", changed.name()))
                })?;
                drives.push(Drive { weights: changed, case: Case { steps: step + 1, ..case } });
            }
        }
        let folder = Folder::new()?;
        let results = checkout.drive(BOARD, &program, &folder.0, &drives)?;
        let refused = |error| Trouble::Failed(format!("results refused: {error}"));
        let mut results = ResultsReader::new(results, drives.len() as u32).map_err(refused)?;
        for Drive { weights: changed, case } in &drives {
            let tally = compare::case_with_host(&mut results, changed, &unchanged, *case)
                .map_err(refused)?;
            let found = tally.first.map(|difference| difference.step + 1);
            if found != Some(case.steps) {
                return Err(Trouble::Failed(format!(
                    "{}: first difference in step {found:?}, {} expected",
                    changed.name(),
                    case.steps
                )));
            }
        }
        results.finish().map_err(refused)?;
        let mut steps: Vec<u32> = drives.iter().map(|drive| drive.case.steps).collect();
        steps.sort_unstable();
        println!(
            "{}: {} changes of one ULP, noticed after {} steps at the median, {} at most",
            unchanged.name(),
            steps.len(),
            steps[steps.len() / 2],
            steps[steps.len() - 1]
        );
    }
    Ok(())
}

/// The first step in which any value differs.
fn first_difference(one: &WeightSet, other: &WeightSet, case: Case) -> Option<u32> {
    let (one, other) = (one.blob(), other.blob());
    let [one, other] =
        [&one, &other].map(|blob| on_host::steps(blob, case).expect("a weight set fits"));
    (0..case.steps).zip(one.zip(other)).find_map(|(step, (a, b))| (a != b).then_some(step))
}

pub(crate) fn spoilt_sums() -> Result<(), Trouble> {
    let checkout = Checkout::compiled_in();
    let drives = compare::generated_drives(10);
    for way in ["reordered-sum", "fused-sum"] {
        let program = checkout.build(BOARD, Some(way))?;
        let tally = prove(&checkout, BOARD, &program, &drives)?;
        let Some(first) = &tally.first else {
            return Err(Trouble::Failed(format!("{way}: not noticed")));
        };
        println!("{way}: {} bits of {} steps differ; {first}", tally.differing_bits, tally.steps);
        let said = first.to_string();
        if first.step != 0 || !said.contains(" hidden layer: ") {
            return Err(Trouble::Failed(format!("{way}: {said}")));
        }
    }
    Ok(())
}

pub(crate) fn damaged_cases() -> Result<(), Trouble> {
    let checkout = Checkout::compiled_in();
    let program = checkout.build(BOARD, None)?;
    let folder = Folder::new()?;
    checkout.drive(BOARD, &program, &folder.0, &compare::generated_drives(1)[..2])?;
    let io = |error: std::io::Error| Trouble::Failed(error.to_string());
    let cases = std::fs::read(folder.0.join("cases")).map_err(io)?;
    let mut flipped = cases.clone();
    flipped[700] ^= 8;
    for (damaged, why) in [
        (flipped, "proof: cases refused: damaged: check "),
        (cases[..cases.len() - 4].to_vec(), "proof: cases refused: "),
        (Vec::new(), "proof: cases refused: "),
    ] {
        std::fs::write(folder.0.join("cases"), damaged).map_err(io)?;
        let arguments = [program.as_os_str(), "--prove".as_ref(), folder.0.as_os_str()];
        let arguments: Vec<_> = std::iter::once("qemu".as_ref()).chain(arguments).collect();
        let output = checkout.xtask(&arguments)?;
        let said = String::from_utf8_lossy(&output.stdout);
        if output.status.code() != Some(1) || !said.contains(why) {
            return Err(Trouble::Failed(format!(
                "{why} expected, found {}: {said}",
                output.status
            )));
        }
    }
    Ok(())
}

/// Drives and compares, in several runs.
fn prove(
    checkout: &Checkout,
    board: &str,
    program: &std::path::Path,
    drives: &[Drive],
) -> Result<Tally, Trouble> {
    let mut tally = Tally::default();
    for drives in drives.chunks(PER_RUN) {
        let folder = Folder::new()?;
        tally.add(checkout.prove(board, program, &folder.0, drives)?);
    }
    Ok(tally)
}

fn pop<T>(jobs: &Mutex<Vec<T>>) -> Option<T> {
    jobs.lock().expect("no panic").pop()
}

/// A folder that is gone when it is no longer needed.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, Trouble> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("proof-{}-{number}", std::process::id());
        let folder = Self(PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name));
        std::fs::create_dir_all(&folder.0)
            .map_err(|error| Trouble::Failed(format!("{}: {error}", folder.0.display())))?;
        Ok(folder)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What is left behind in cargo's folder for such files harms nobody.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
