//! The proof on a board: cases from a file on the host, every value of every step into another.

use core::cell::RefCell;
use core::fmt;

use critical_section::Mutex;
use equivalence_tests::files::{BLOB_WORDS, Sink, Source};
use equivalence_tests::prove::{Driven, prove};
use semihosting::experimental::env;
use semihosting::fs::File;
use semihosting::io::{self, Read, Write};

use crate::proof::Board;

/// The command line that asks for a proof.
const COMMAND: &str = "prove";

/// Words that are written at once: a call to the host costs as much as thousands of instructions.
const CHUNK: usize = 512;

/// The memory a proof takes; apart from the stack, so that the stack's bound is that of driving.
static MEMORY: Mutex<RefCell<Memory>> =
    Mutex::new(RefCell::new(Memory { blob: [0; BLOB_WORDS], results: [0; CHUNK] }));

struct Memory {
    blob: [u32; BLOB_WORDS],
    results: [u32; CHUNK],
}

/// Whether the command line asks for a proof. Without one QEMU gives the program's path, which may be longer than
/// what is kept of it.
pub(super) fn is_asked_for() -> bool {
    let Ok(words) = env::args::<16>() else { return false };
    let mut words = &words;
    matches!((words.next(), words.next()), (Some(Ok(COMMAND)), None))
}

/// Drives the cases in the file `cases` and writes `results`, both in the folder that QEMU runs in; false if
/// something is wrong, after saying what.
pub(super) fn run() -> bool {
    // Nothing else runs on this board: no interrupt is enabled.
    let outcome = critical_section::with(|token| {
        let mut memory = MEMORY.borrow(token).try_borrow_mut().map_err(|_| Trouble::Memory)?;
        let Memory { blob, results } = &mut *memory;
        let cases = File::open(c"cases").map_err(Trouble::Cases)?;
        let file = File::create(c"results").map_err(Trouble::Results)?;
        let results = Results { file, held: results, count: 0 };
        prove::<Board, _, _>(Cases(cases), results, blob).map_err(Trouble::Proof)
    });
    match outcome {
        Ok(Driven { cases, steps }) => {
            defmt::info!("proof: {=u32} cases, {=u32} steps driven", cases, steps);
            true
        }
        Err(trouble) => {
            defmt::error!("proof: {}", defmt::Display2Format(&trouble));
            false
        }
    }
}

/// Why there is no proof. `P` is what stopped it on the way.
enum Trouble<P> {
    Cases(io::Error),
    Results(io::Error),
    Memory,
    Proof(P),
}

impl<P: fmt::Display> fmt::Display for Trouble<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cases(error) => write!(f, "the file `cases` cannot be opened: {error}"),
            Self::Results(error) => write!(f, "the file `results` cannot be created: {error}"),
            Self::Memory => f.write_str("its memory is in use"),
            Self::Proof(error) => error.fmt(f),
        }
    }
}

struct Cases(File);

impl Source for Cases {
    type Error = io::Error;

    fn fill(&mut self, words: &mut [u32]) -> io::Result<()> {
        self.0.read_exact(bytemuck::cast_slice_mut(words))
    }

    fn at_end(&mut self) -> io::Result<bool> {
        self.0.read(&mut [0]).map(|count| count == 0)
    }
}

/// Holds words back until there are [`CHUNK`].
struct Results<'a> {
    file: File,
    held: &'a mut [u32; CHUNK],
    count: usize,
}

impl Sink for Results<'_> {
    type Error = io::Error;

    fn put(&mut self, words: &[u32]) -> io::Result<()> {
        for word in words {
            if self.count == CHUNK {
                self.flush()?;
            }
            if let Some(slot) = self.held.get_mut(self.count) {
                *slot = *word;
                self.count += 1;
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        let words = self.held.get(..self.count).unwrap_or_default();
        self.file.write_all(bytemuck::cast_slice(words))?;
        self.count = 0;
        Ok(())
    }
}
