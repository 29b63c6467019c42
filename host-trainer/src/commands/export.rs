//! `evosteer export`: a champion in the form that goes into flash.

mod destination;
mod plan;
mod report;

use std::path::PathBuf;

use clap::ValueEnum;

use crate::blob_file::BlobFile;
use crate::export::family::{Family, FamilyError};
use crate::export::placement::parse_number;
use crate::failure::Failure;
use crate::output::Output;
use destination::Destination;
use plan::Plan;
use report::Report;

/// Writes a champion in the form that goes into flash, and says how to put it there
///
/// For a Raspberry Pi Pico 2 nothing but the format has to be chosen: the last 64 KiB of its
/// 4 MiB of flash, but for the very last sector, are kept for weights, from 0x103f0000. Other
/// boards need --address, and --chip or --family.
#[derive(Clone, Debug, clap::Args)]
pub struct ExportArgs {
    /// A weight blob, or a run folder for its champion.blob
    champion: PathBuf,

    /// What to write
    #[arg(long, value_enum)]
    format: Format,

    /// File to write, `-` for standard output [default: beside the champion]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Address in flash, such as 0x103f_0000; a multiple of 256 for uf2, else of 4 [default: the
    /// board's region for weights]
    #[arg(long, value_name = "ADDRESS", value_parser = parse_number)]
    address: Option<u32>,

    /// UF2 family of the chip: a name such as rp2040 or nrf52840, or a number [default: absolute,
    /// for RP2350]
    #[arg(long, value_name = "FAMILY", value_parser = parse_family)]
    family: Option<Family>,

    /// Chip as probe-rs calls it, for bin and hex [default: RP235x]
    #[arg(long, value_name = "CHIP")]
    chip: Option<String>,

    /// Replace FILE if it exists
    #[arg(long)]
    force: bool,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// What [`run`] writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// The blob's bytes alone, for a debug probe
    Bin,
    /// Intel HEX, which holds the address too
    Hex,
    /// Blocks for a board that shows itself as a drive
    Uf2,
    /// Rust source with an aligned static, for a no_std crate
    Rs,
}

impl Format {
    /// The name on the command line, which is also the file's extension.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bin => "bin",
            Self::Hex => "hex",
            Self::Uf2 => "uf2",
            Self::Rs => "rs",
        }
    }
}

fn parse_family(text: &str) -> Result<Family, FamilyError> {
    text.parse()
}

/// Exports a champion.
///
/// # Errors
///
/// Bad input for options that make no sense together, a refused blob, a place in flash that
/// cannot work or a file that exists; input/output when reading or writing fails. Nothing
/// is written then.
pub fn run(args: &ExportArgs, output: &mut Output) -> Result<(), Failure> {
    let champion = BlobFile::read(&args.champion)?;
    let plan = Plan::resolve(args, champion.bytes().len())?;
    let destination = Destination::resolve(args, &champion)?;
    let file = plan.encode(&champion)?;
    destination.write(&file, output)?;
    Report::new(&plan, &destination, &champion, &file).print(output);
    Ok(())
}

#[cfg(test)]
mod tests;
