//! What was written, and the command that puts it on the car.

use std::path::Path;

use serde::Serialize;

use super::destination::Destination;
use super::plan::{Place, Plan, Target};
use crate::blob_file::BlobFile;
use crate::commands::advice::in_shell;
use crate::commands::blob_summary::BlobSummary;
use crate::export::board::Board;
use crate::export::fit::Misfits;
use crate::fingerprint;
use crate::output::Output;

/// The result of an export; with `--json`, what is printed.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// The file, or none for standard output.
    file: Option<String>,
    format: &'static str,
    /// Length of the file.
    bytes: usize,
    /// SHA-256 of the file, hexadecimal.
    sha256: String,
    /// Where the blob begins, hexadecimal.
    address: Option<String>,
    /// UF2 family, name and number.
    family: Option<String>,
    /// Chip as probe-rs calls it.
    chip: Option<String>,
    /// The command that writes it to flash, where one is enough.
    command: Option<String>,
    /// What to know before driving: why the car as shipped will refuse the champion.
    notes: Vec<String>,
    /// The champion in the file.
    blob: BlobSummary,
    /// How the file reaches the car, in words.
    #[serde(skip)]
    instructions: Vec<String>,
    #[serde(skip)]
    warning: Option<String>,
}

impl Report {
    pub(super) fn new(
        plan: &Plan,
        destination: &Destination,
        champion: &BlobFile,
        file: &[u8],
    ) -> Self {
        let mut report = Self {
            file: destination.path().map(|path| path.display().to_string()),
            format: plan.format.name(),
            bytes: file.len(),
            sha256: fingerprint::sha256(file),
            address: None,
            family: None,
            chip: None,
            command: None,
            notes: notes(plan, champion),
            blob: BlobSummary::of(champion),
            instructions: Vec::new(),
            warning: None,
        };
        let name = destination.path().map_or_else(|| "FILE".to_owned(), in_shell);
        match &plan.target {
            Target::Program => report.instructions.push(format!(
                "declare {name} as a module, and read it with Blob::parse(&CHAMPION.0)"
            )),
            Target::Probe { chip, place } => {
                report.place(place);
                let format = match plan.format.name() {
                    "bin" => format!("bin --base-address {:#010x}", place.address),
                    other => other.to_owned(),
                };
                let command = format!(
                    "probe-rs download --chip {} --binary-format {format} {name}",
                    in_shell(Path::new(chip))
                );
                report.instructions.push(format!("put it on the car:\n  {command}"));
                if place.board.is_none() {
                    report.instructions.push(
                        "whole sectors are erased first; to keep what else is in them add \
                         --restore-unwritten"
                            .to_owned(),
                    );
                }
                report.command = Some(command);
                report.chip = Some(chip.clone());
            }
            Target::Drive { family, place } => {
                report.place(place);
                report.family = Some(family.to_string());
                report.instructions.push(match place.board {
                    Some(board) => format!(
                        "put it on the car: hold BOOTSEL while plugging it in, then copy {name} \
                         to the drive {}",
                        board.drive
                    ),
                    None => format!(
                        "put it on the car: start its boot loader, then copy {name} to the drive \
                         that appears; the last page of 256 bytes is filled with 0xff"
                    ),
                });
            }
        }
        report
    }

    /// Notes the address, and what writing there does to its surroundings.
    fn place(&mut self, place: &Place) {
        let address = place.address;
        self.address = Some(format!("{address:#010x}"));
        let Some(board) = place.board else { return };
        let erased = board.erased(address, self.blob.bytes);
        self.instructions.push(format!(
            "on a {} this erases {:#010x} to {:#010x}, whole sectors of {} bytes; what follows \
             the blob then reads 0xff",
            board.name,
            erased.start,
            erased.end - 1,
            board.sector
        ));
        if erased.start < u64::from(address) {
            self.warning = Some(format!(
                "--address {address:#010x}: also erases what lies before it, from {:#010x} on",
                erased.start
            ));
        }
    }

    /// Prints it; to standard error where standard output carries the file.
    pub(super) fn print(&self, output: &mut Output) {
        let Self { blob, bytes, sha256, .. } = self;
        let place = match &self.address {
            Some(address) => format!(" at {address}"),
            None => String::new(),
        };
        let family = match &self.family {
            Some(family) => format!(", family {family}"),
            None => String::new(),
        };
        let file = self.file.as_deref().unwrap_or("standard output");
        let mut lines = vec![
            format!("{file}: {bytes} bytes, format {}{family}", self.format),
            format!("  sha256   {sha256}"),
            format!("  network  {}", blob.network()),
            format!("  trained  {}", blob.origin()),
            format!("  blob     {} bytes{place}, check {}", blob.bytes, blob.check),
        ];
        lines.extend(self.instructions.iter().cloned());
        lines.extend(self.notes.iter().map(|note| format!("note: {note}")));
        for line in lines {
            match self.file {
                Some(_) => output.line(line),
                None => output.status(line),
            }
        }
        if let Some(warning) = &self.warning {
            output.warning(warning);
        }
        output.json(self);
    }
}

fn notes(plan: &Plan, champion: &BlobFile) -> Vec<String> {
    let car = plan.target.board().and_then(Board::car);
    let misfits = car.and_then(|car| Misfits::of(champion.blob().header(), car));
    misfits.iter().map(Misfits::to_string).collect()
}
