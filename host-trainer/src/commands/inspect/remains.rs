//! What a refused file still says, to help its owner find out what it is.

use controller_core::blob::{Blob, BlobError, MAGIC, VERSION};
use serde::Serialize;

use crate::blob_file::FileBytes;
use crate::fingerprint;
use crate::output::Output;

/// What can be read of a file that is no blob. Nothing of it is checked.
#[derive(Debug, Serialize)]
pub(super) struct Remains {
    file: String,
    accepted: bool,
    /// Why it is refused.
    refusal: String,
    /// Length of the file.
    bytes: usize,
    /// SHA-256 of the file, hexadecimal.
    sha256: String,
    /// Format version after a blob's first bytes.
    version: Option<u16>,
    /// Length of the blob that the header states.
    stated_bytes: Option<u32>,
    /// Inputs, neurons of a hidden layer and outputs that the header states.
    sizes: Option<[u8; 3]>,
    /// What else it may be.
    hint: Option<String>,
}

impl Remains {
    pub(super) fn new(file: &FileBytes, cause: &BlobError) -> Self {
        let bytes = file.bytes();
        let header = bytes.strip_prefix(&MAGIC);
        let version =
            header.and_then(|rest| rest.first_chunk()).map(|two| u16::from_le_bytes(*two));
        // Where the other fields lie is known for our own version only.
        let header = header.filter(|_| version == Some(VERSION));
        let stated = header.and_then(|rest| rest.get(4..)?.first_chunk());
        let sizes = header.and_then(|rest| rest.get(8..)?.first_chunk());
        Self {
            file: file.path().display().to_string(),
            accepted: false,
            refusal: cause.to_string(),
            bytes: bytes.len(),
            sha256: fingerprint::sha256(bytes),
            version,
            stated_bytes: stated.map(|four| u32::from_le_bytes(*four)),
            sizes: sizes.copied(),
            hint: hint(bytes),
        }
    }

    pub(super) fn print(&self, output: &mut Output) {
        output.line(format_args!("{}: no usable weight blob", self.file));
        output.line(format_args!("  length   {} bytes", self.bytes));
        output.line(format_args!("  sha256   {}", self.sha256));
        if let Some(version) = self.version {
            output.line(format_args!("  version  {version}"));
        }
        if let Some(stated) = self.stated_bytes {
            output.line(format_args!("  header   says {stated} bytes in all"));
        }
        if let Some([inputs, hidden, outputs]) = self.sizes {
            output.line(format_args!("  network  {inputs}-{hidden}-{hidden}-{outputs}, unchecked"));
        }
        if let Some(hint) = &self.hint {
            output.line(format_args!("  hint     {hint}"));
        }
        output.json(self);
    }
}

fn hint(bytes: &[u8]) -> Option<String> {
    if let Ok(blob) = Blob::parse_prefix(bytes) {
        let length = blob.header().blob_len();
        return Some(format!("the first {length} bytes are a whole blob; cut off the rest"));
    }
    let export = "what evosteer export writes; inspect the blob it was made from";
    Some(match bytes {
        [] => "an empty file".to_owned(),
        _ if bytes.iter().all(|byte| *byte == 0xff) => "erased flash".to_owned(),
        _ if bytes.iter().all(|byte| *byte == 0) => "zeros only".to_owned(),
        [b'U', b'F', b'2', b'\n', ..] => format!("a UF2 file, {export}"),
        [b':', ..] => format!("Intel HEX by its first byte, {export}"),
        [b'/', b'/', b'!', ..] => format!("Rust source by its first bytes, {export}"),
        [0x7f, b'E', b'L', b'F', ..] => "a program (ELF)".to_owned(),
        _ if bytes.starts_with(&MAGIC) => return None,
        _ if std::str::from_utf8(bytes).is_ok_and(is_text) => "a text file".to_owned(),
        _ => return None,
    })
}

fn is_text(text: &str) -> bool {
    !text.contains(|letter: char| letter.is_control() && !"\t\r\n".contains(letter))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hint_says_what_a_file_may_be() {
        let hints = [
            (&b""[..], Some("an empty file")),
            (&[0xff; 16], Some("erased flash")),
            (&[0; 16], Some("zeros only")),
            (b"\x7fELF\x01\x01", Some("a program (ELF)")),
            (b"[scenario]\nname = \"\xc3\xa4\"\n", Some("a text file")),
            (b"\x89PNG\r\n\x1a\n", None),
            (b"EVOSTEER", None),
        ];
        for (bytes, expected) in hints {
            assert_eq!(hint(bytes).as_deref(), expected, "{bytes:?}");
        }
    }
}
