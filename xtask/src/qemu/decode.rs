//! A board's defmt frames as lines of text.

use defmt_decoder::{DecodeError, Locations, StreamDecoder, Table};

use crate::process::root;

/// What a program can log, read from its ELF file.
pub(super) struct Log {
    table: Option<Table>,
    locations: Option<Locations>,
}

impl Log {
    /// Reads the tables of `elf`; a program without defmt has none and its output is plain text.
    pub(super) fn of(elf: &[u8]) -> anyhow::Result<Self> {
        let table = Table::parse(elf)?;
        let locations = table.as_ref().map(|table| table.get_locations(elf)).transpose()?;
        // Without debug information defmt finds no location for any message; then none is printed.
        let locations = locations.filter(|locations| !locations.is_empty());
        Ok(Self { table, locations })
    }

    /// Starts at the beginning of a run.
    pub(super) fn decoder(&self) -> Decoder<'_> {
        let stream = self.table.as_ref().map(Table::new_stream_decoder);
        Decoder { stream, locations: self.locations.as_ref() }
    }
}

/// The frames of one run.
pub(super) struct Decoder<'log> {
    stream: Option<Box<dyn StreamDecoder + Send + Sync + 'log>>,
    locations: Option<&'log Locations>,
}

impl Decoder<'_> {
    /// The lines completed by `bytes`: level, message, and where in the source it was said.
    pub(super) fn text(&mut self, bytes: &[u8]) -> Vec<u8> {
        let Some(stream) = &mut self.stream else { return bytes.to_vec() };
        stream.received(bytes);
        let mut text = String::new();
        loop {
            match stream.decode() {
                Ok(frame) => {
                    let level = frame.level().map_or("", |level| level.as_str()).to_uppercase();
                    text += &format!("{level:5} {}", frame.display_message());
                    if let Some(at) =
                        self.locations.and_then(|locations| locations.get(&frame.index()))
                    {
                        let file = at.file.strip_prefix(root()).unwrap_or(&at.file);
                        text += &format!("  ({}:{})", file.display(), at.line);
                    }
                    text.push('\n');
                }
                Err(DecodeError::UnexpectedEof) => break,
                Err(DecodeError::Malformed) => text += "????? a damaged log frame\n",
            }
        }
        text.into_bytes()
    }
}
