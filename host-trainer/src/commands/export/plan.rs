//! What the options mean together: form, place and board.

use super::{ExportArgs, Format};
use crate::blob_file::BlobFile;
use crate::export::board::Board;
use crate::export::family::Family;
use crate::export::placement::PlacementError;
use crate::export::{intel_hex, placement, rust_source, uf2};
use crate::failure::Failure;

/// An export that makes sense.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) format: Format,
    pub(super) target: Target,
}

/// What the file is for.
#[derive(Clone, Debug)]
pub(super) enum Target {
    /// A program that is linked anew.
    Program,
    /// Flash behind a debug probe.
    Probe { chip: String, place: Place },
    /// A board that shows itself as a drive.
    Drive { family: Family, place: Place },
}

/// An address on a board.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) address: u32,
    /// The board, if it is known.
    pub(super) board: Option<&'static Board>,
}

impl Plan {
    /// Fills in defaults and refuses what cannot work, for a blob of `length` bytes.
    pub(super) fn resolve(args: &ExportArgs, length: usize) -> Result<Self, Failure> {
        refuse_unused(args)?;
        let target = match args.format {
            Format::Rs => Target::Program,
            Format::Bin | Format::Hex => {
                let chip = args.chip.clone().unwrap_or_else(|| Board::PICO_2.chip.to_owned());
                let board = Board::of_chip(&chip);
                let place = Place::resolve(args, board, ("chip", &chip), length)?;
                Target::Probe { chip, place }
            }
            Format::Uf2 => {
                let family = args.family.unwrap_or(Family::ABSOLUTE);
                let board = Board::of_family(family);
                let place = Place::resolve(args, board, ("family", &family.to_string()), length)?;
                Target::Drive { family, place }
            }
        };
        Ok(Self { format: args.format, target })
    }

    /// The file's bytes.
    pub(super) fn encode(&self, champion: &BlobFile) -> Result<Vec<u8>, Failure> {
        let bytes = champion.bytes();
        let (address, encoded) = match &self.target {
            Target::Program => {
                return Ok(rust_source::encode(&champion.blob(), bytes).into_bytes());
            }
            Target::Probe { place: Place { address, .. }, .. } if self.format == Format::Hex => {
                (address, intel_hex::encode(bytes, *address).map(String::into_bytes))
            }
            Target::Probe { place: Place { address, .. }, .. } => {
                let aligned =
                    placement::check(*address, bytes.len(), 4, "the car reads the words in place");
                (address, aligned.map(|()| bytes.to_vec()))
            }
            Target::Drive { family, place: Place { address, board } } => {
                let unit = board.map_or(uf2::PAYLOAD, |board| board.sector);
                (address, uf2::encode(bytes, *address, *family, unit))
            }
        };
        encoded.map_err(|error| bad_address(*address, &error.to_string()))
    }
}

impl Target {
    /// The board, if there is one and it is known.
    pub(super) fn board(&self) -> Option<&'static Board> {
        match self {
            Self::Program => None,
            Self::Probe { place, .. } | Self::Drive { place, .. } => place.board,
        }
    }
}

impl Place {
    /// `option` is what the board is known by: the option's name and value.
    fn resolve(
        args: &ExportArgs,
        board: Option<&'static Board>,
        option: (&str, &str),
        length: usize,
    ) -> Result<Self, Failure> {
        let (name, value) = option;
        let address = match (args.address, board) {
            (Some(address), _) => address,
            (None, Some(board)) => board.weights.start,
            (None, None) => {
                return Err(Failure::bad_input(format!(
                    "--address: expected with --{name} {value}, since this program does not know \
                     where that chip has free flash"
                )));
            }
        };
        if let Some(board) = board {
            // Who names a chip or a family may have a program that looks elsewhere.
            let is_default = args.chip.is_none() && args.family.is_none();
            let weights = if is_default { board.check_weights(address) } else { Ok(()) };
            board.check(address, length).and(weights).map_err(|error| match error {
                PlacementError::OutsideFlash { .. } | PlacementError::OutsideWeights { .. } => {
                    bad_address(address, &format!("{error}; another chip is named with --{name}"))
                }
                _ => bad_address(address, &error.to_string()),
            })?;
        }
        Ok(Self { address, board })
    }
}

fn bad_address(address: u32, reason: &str) -> Failure {
    Failure::bad_input(format!("--address {address:#010x}: {reason}"))
}

/// An option that would have no effect is a misunderstanding.
fn refuse_unused(args: &ExportArgs) -> Result<(), Failure> {
    let format = args.format;
    let unused = [
        (
            "--address",
            args.address.is_some() && format == Format::Rs,
            "the linker finds a place for rs",
        ),
        ("--family", args.family.is_some() && format != Format::Uf2, "only uf2 has a family"),
        (
            "--chip",
            args.chip.is_some() && !matches!(format, Format::Bin | Format::Hex),
            "only bin and hex go through a debug probe",
        ),
    ];
    match unused.into_iter().find(|(_, is_unused, _)| *is_unused) {
        None => Ok(()),
        Some((option, _, reason)) => Err(Failure::bad_input(format!(
            "{option}: not used by --format {}; {reason}",
            format.name()
        ))),
    }
}
