//! Lists the settings of a scenario file.

use super::Preset;
use super::schema::{Codec, Record, Visit};

/// One setting, as documentation shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// Where it stands, such as `episode.step_limit`.
    pub path: String,
    /// What may stand there.
    pub expected: String,
    /// What it is.
    pub about: String,
    /// What holds if nobody says anything, as TOML; empty for nothing.
    pub default: String,
}

/// Every setting of a scenario file, in the order of the file.
pub fn all_keys() -> Vec<Key> {
    keys_of(&mut Preset::default().scenario())
}

/// The keys of a table that stands for itself; the record stays as it is.
pub(super) fn keys_of(record: &mut impl Record) -> Vec<Key> {
    let mut keys = Keys::default();
    record.visit(&mut keys);
    keys.found
}

/// The keys of a table as a person would write it: `{ start, goal }`.
pub(super) fn braces(record: &mut impl Record) -> String {
    let keys: Vec<String> = keys_of(record).into_iter().map(|key| key.path).collect();
    format!("{{ {} }}", keys.join(", "))
}

#[derive(Default)]
struct Keys {
    prefix: String,
    found: Vec<Key>,
}

impl Visit for Keys {
    fn value<T>(&mut self, key: &'static str, slot: &mut T, codec: impl Codec<T>, about: &str) {
        self.found.push(Key {
            path: format!("{}{key}", self.prefix),
            expected: codec.expected(),
            about: about.to_owned(),
            default: codec.write(slot).unwrap_or_default(),
        });
    }

    fn section(&mut self, key: &'static str, record: &mut impl Record) {
        let outer = self.prefix.len();
        self.prefix.push_str(key);
        self.prefix.push('.');
        record.visit(self);
        self.prefix.truncate(outer);
    }

    fn optional_section<R: Record>(
        &mut self,
        key: &'static str,
        _slot: &mut Option<R>,
        mut blank: R,
    ) {
        self.section(key, &mut blank);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_is_listed_twice() {
        let mut paths: Vec<String> = all_keys().into_iter().map(|key| key.path).collect();
        let count = paths.len();
        paths.sort();
        paths.dedup();
        assert_eq!(paths.len(), count);
    }
}
