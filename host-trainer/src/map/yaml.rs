//! The keys of a map's YAML file with their values and places, before anything is checked.

use std::cell::Cell;
use std::fmt;
use std::path::Path;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde_saphyr::{Error, Location, Spanned};

use super::error::{MapError, MapProblem, Place};

/// Longest value repeated in a message, characters.
const QUOTE: usize = 40;

/// A key that has no meaning in a map file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownKey {
    /// The key.
    pub key: String,
    /// Line in the YAML, from 1.
    pub line: u64,
}

impl fmt::Display for UnknownKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: unknown key `{}` ignored", self.line, self.key)
    }
}

/// The file's values, each with its place.
#[derive(Debug, Default)]
pub(super) struct Keys {
    pub(super) image: Option<Spanned<String>>,
    pub(super) resolution: Option<Spanned<f64>>,
    pub(super) origin: Option<Spanned<Vec<f64>>>,
    pub(super) negate: Option<Spanned<String>>,
    pub(super) occupied_thresh: Option<Spanned<f64>>,
    pub(super) free_thresh: Option<Spanned<f64>>,
    pub(super) mode: Option<Spanned<String>>,
    pub(super) unknown: Vec<UnknownKey>,
}

/// What a key's value should be.
pub(super) fn expected(key: &str) -> &'static str {
    match key {
        "image" => "the name of a PGM or PNG file",
        "resolution" => "metres per pixel, from 0.000001 to 1000000",
        "origin" => "three finite numbers [x, y, yaw], metres and radians",
        "negate" => "0, 1, false or true",
        "mode" => "trinary, scale or raw",
        _ => "a number from 0 to 1",
    }
}

impl Keys {
    /// Reads the bytes of a YAML file; `yaml` is its path.
    pub(super) fn parse(text: &[u8], yaml: &Path) -> Result<Self, MapError> {
        let text = std::str::from_utf8(text).map_err(|error| {
            let place = Place::Byte(error.valid_up_to() as u64);
            MapProblem::Yaml("found bytes that are not UTF-8, expected text".into()).at(yaml, place)
        })?;
        let at = Cell::new(None);
        let options = serde_saphyr::options! { with_snippet: false };
        serde_saphyr::with_deserializer_from_str_with_options(text, options, |yaml| {
            Reading { at: &at }.deserialize(yaml)
        })
        .map_err(|error| {
            let place = error.location().map_or(Place::File, place);
            explain(error.without_snippet(), at.get(), quote(text, place)).at(yaml, place)
        })
    }
}

/// A position of the YAML reader in our form.
pub(super) fn place(location: Location) -> Place {
    match (location.line(), location.column()) {
        (0, _) => Place::File,
        (line, column) => Place::Text { line, column },
    }
}

/// The rest of the line at a place.
fn quote(text: &str, place: Place) -> String {
    let Place::Text { line, column } = place else { return String::new() };
    let skip = |count: u64| usize::try_from(count.saturating_sub(1)).unwrap_or(usize::MAX);
    let line = text.lines().nth(skip(line)).unwrap_or_default();
    let rest: String = line.chars().skip(skip(column)).take(QUOTE).collect();
    rest.trim().to_owned()
}

/// The reader's error in the words of a map file. `key` is the key whose value was being
/// read, `rest` what stands at the place of the error.
fn explain(error: &Error, key: Option<&'static str>, rest: String) -> MapProblem {
    match (error, key) {
        (
            Error::Unexpected { .. }
            | Error::InvalidScalar { .. }
            | Error::NullIntoString { .. }
            | Error::SerdeInvalidType { .. },
            Some(key),
        ) => {
            // A key without a value puts the error at its colon.
            let found = match rest.trim_start_matches(':') {
                "" => "nothing".to_owned(),
                rest => format!("`{}`", rest.trim().escape_debug()),
            };
            MapProblem::BadValue { key, found, expected: expected(key) }
        }
        (Error::Unexpected { .. }, None) => MapProblem::Yaml(
            "expected the description of a map: image, resolution, origin and so on".to_owned(),
        ),
        (Error::DuplicateMappingKey { .. }, _) => {
            MapProblem::Yaml(format!("`{}`: this key stands here twice", rest.escape_debug()))
        }
        _ => {
            let message = error.to_string();
            let end = message.rfind(" at line ").unwrap_or(message.len());
            MapProblem::Yaml(message[..end].to_owned())
        }
    }
}

/// Reads [`Keys`], noting whose value is being read.
struct Reading<'a> {
    at: &'a Cell<Option<&'static str>>,
}

impl<'de> DeserializeSeed<'de> for Reading<'_> {
    type Value = Keys;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Keys, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Reading<'_> {
    type Value = Keys;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the description of a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Keys, A::Error> {
        let mut keys = Keys::default();
        while let Some(key) = map.next_key::<Spanned<String>>()? {
            macro_rules! read {
                ($field:ident) => {{
                    self.at.set(Some(stringify!($field)));
                    keys.$field = Some(map.next_value()?);
                    self.at.set(None);
                }};
            }
            match key.value.as_str() {
                "image" => read!(image),
                "resolution" => read!(resolution),
                "origin" => read!(origin),
                "negate" => read!(negate),
                "occupied_thresh" => read!(occupied_thresh),
                "free_thresh" => read!(free_thresh),
                "mode" => read!(mode),
                _ => {
                    let line = key.referenced.line();
                    keys.unknown.push(UnknownKey { key: key.value, line });
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        Ok(keys)
    }
}
