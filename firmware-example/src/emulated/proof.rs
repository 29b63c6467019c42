//! The proof on a board: cases from a file on the host, every value of every step into another.

use core::cell::RefCell;

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
        let cases = File::open(c"cases").map_err(|error| Trouble::Cases(error.into()))?;
        let file = File::create(c"results").map_err(|error| Trouble::Results(error.into()))?;
        let results = Results { file, held: results, count: 0 };
        prove::<Board, _, _>(Cases(cases), results, blob).map_err(Trouble::Proof)
    });
    match outcome {
        Ok(Driven { cases, steps }) => {
            defmt::info!("proof: {=u32} cases, {=u32} steps driven", cases, steps);
            true
        }
        Err(trouble) => {
            defmt::error!("proof: {}", trouble);
            false
        }
    }
}

/// Why there is no proof. `P` is what stopped it on the way.
enum Trouble<P> {
    Cases(System),
    Results(System),
    Memory,
    Proof(P),
}

controller_core::sentences! { impl<P> Trouble<P> {
    Self::Cases(error) => "the file `cases` cannot be opened: {}", error;
    Self::Results(error) => "the file `results` cannot be created: {}", error;
    Self::Memory => "its memory is in use";
    Self::Proof(error) => "{}", error;
} }

/// What the host's system says of a file: the number of its error, none at the file's end.
struct System(Option<i32>);

controller_core::sentences! { System {
    Self(Some(number)) => "error {} of the host's system", number;
    Self(None) => "the file ends early";
} }

impl From<io::Error> for System {
    fn from(error: io::Error) -> Self {
        Self(error.raw_os_error())
    }
}

struct Cases(File);

impl Source for Cases {
    type Error = System;

    fn fill(&mut self, words: &mut [u32]) -> Result<(), System> {
        Ok(self.0.read_exact(bytemuck::cast_slice_mut(words))?)
    }

    fn at_end(&mut self) -> Result<bool, System> {
        Ok(self.0.read(&mut [0])? == 0)
    }
}

/// Holds words back until there are [`CHUNK`].
struct Results<'a> {
    file: File,
    held: &'a mut [u32; CHUNK],
    count: usize,
}

impl Sink for Results<'_> {
    type Error = System;

    fn put(&mut self, words: &[u32]) -> Result<(), System> {
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

    fn flush(&mut self) -> Result<(), System> {
        let words = self.held.get(..self.count).unwrap_or_default();
        self.file.write_all(bytemuck::cast_slice(words))?;
        self.count = 0;
        Ok(())
    }
}
