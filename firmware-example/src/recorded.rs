//! The recorded drives in `recorded/`: each a weight blob and what it did, written by a host.
//!
//! `cargo test -p equivalence-tests` fails where the files are not what its host would write;
//! with `EVOSTEER_BLESS=1` it writes them anew.

/// A recorded drive and the weights that drove.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// What it covers: recurrence and activation.
    pub name: &'static str,
    /// The weight blob's bytes.
    pub blob: &'static [u8],
    /// The recording's bytes.
    pub recording: &'static [u8],
}

/// Blobs and recordings are read in place as words, so they must start at a multiple of 4 bytes.
#[repr(C, align(4))]
struct Words<T: ?Sized>(T);

macro_rules! words {
    ($file:expr) => {{
        static WORDS: &Words<[u8]> = &Words(*include_bytes!(concat!("../recorded/", $file)));
        &WORDS.0
    }};
}

macro_rules! drive {
    ($name:literal) => {
        Drive {
            name: $name,
            blob: words!(concat!($name, ".blob")),
            recording: words!(concat!($name, ".drive")),
        }
    };
}

/// The drive that a board with little flash goes without: other drives have its recurrence and its activation.
pub const SPARE: &str = "elman-rational";

/// Every recurrence, every activation and every type code at least once.
pub static ALL: &[Drive] = &[
    drive!("feedforward-rational"),
    drive!("self-libm"),
    #[cfg(not(feature = "little-flash"))]
    drive!("elman-rational"),
    drive!("elman-micromath"),
    drive!("self-rational"),
];
