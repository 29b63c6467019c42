//! Reads settings from layers of TOML tables, the later ones before the earlier ones.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::keys::{all_keys, braces, keys_of};
use super::problem::{MOST_PRINTED, Place, Problem};
use super::schema::{Codec, Record, Visit};
use super::value::{Found, Path};
use super::words::{listed, nearest};

/// The part of one text that a section is read from.
#[derive(Clone)]
pub(super) struct Layer<'a> {
    /// Index of the text.
    pub(super) document: usize,
    pub(super) table: &'a DeTable<'a>,
    /// Where the table is, for keys that are missing in it.
    pub(super) span: Range<usize>,
}

/// Fills `record` from the layers; keys that no layer has keep their value.
pub(super) fn read_layers(
    record: &mut impl Record,
    layers: Vec<Layer<'_>>,
    problems: &mut Vec<Problem>,
) {
    Reader { path: None, layers, seen: Vec::new(), problems }.read(record);
}

/// Reads a table that stands for itself, such as one wall of a list.
pub(super) fn read_record<R: Record>(
    found: &Found<'_>,
    mut blank: R,
    problems: &mut Vec<Problem>,
) -> Option<R> {
    let Some(table) = found.table() else {
        found.wrong_type(&format!("a table {}", braces(&mut blank)), problems);
        return None;
    };
    let before = problems.len();
    let layers = vec![Layer { document: found.document, table, span: found.node.span() }];
    Reader { path: Some(found.path), layers, seen: Vec::new(), problems }.read(&mut blank);
    (problems.len() == before).then_some(blank)
}

struct Reader<'a, 'p> {
    /// None at the top of the file.
    path: Option<Path<'a>>,
    layers: Vec<Layer<'a>>,
    seen: Vec<&'static str>,
    problems: &'p mut Vec<Problem>,
}

impl Reader<'_, '_> {
    fn read<R: Record>(mut self, record: &mut R) {
        record.visit(&mut self);
        self.refuse_unknown_keys();
        for key in R::REQUIRED {
            let written = self.layers.iter().any(|layer| layer.table.contains_key(*key));
            let (false, Some(layer)) = (written, self.layers.first()) else { continue };
            let place = Place { document: layer.document, span: layer.span.clone() };
            let title = format!("`{}` is missing", self.name(key));
            let keys = keys_of(record);
            let known = keys.iter().find(|known| known.path == *key);
            let detail = known.map(|known| format!("expected {key} = {}", known.expected));
            let detail = detail.unwrap_or_default();
            self.problems.push(Problem { place: Some(place), title, detail, help: None });
        }
    }

    fn name(&self, key: &str) -> String {
        path_to(&self.path, key).to_string()
    }

    fn refuse_unknown_keys(&mut self) {
        let mut unknown: Vec<_> = self
            .layers
            .iter()
            .flat_map(|layer| layer.table.keys().map(|key| (layer.document, key)))
            .filter(|(_, key)| !self.seen.contains(&key.get_ref().as_ref()))
            .collect();
        unknown.sort_by_key(|(document, key)| (*document, key.span().start));
        let choices = listed(self.seen.iter().map(|key| (*key).to_owned()));
        for (rank, (document, key)) in unknown.into_iter().enumerate() {
            let name: &str = key.get_ref();
            // Looking for what was meant takes time, and only the first problems are printed.
            let meant = if rank < MOST_PRINTED { self.meant(name) } else { None };
            self.problems.push(Problem {
                place: Some(Place { document, span: key.span() }),
                title: format!("unknown key `{}`", self.name(name)),
                detail: format!("expected {choices}"),
                help: meant.map(|key| format!("did you mean `{key}`?")),
            });
        }
    }

    /// The key that an unknown one is probably meant to be: in this table, or its like anywhere.
    fn meant(&self, name: &str) -> Option<String> {
        if let Some(key) = nearest(name, self.seen.iter().copied()) {
            return Some(key.to_owned());
        }
        fn last(path: &str) -> &str {
            path.rsplit('.').next().unwrap_or(path)
        }
        let all = all_keys();
        let near = nearest(name, all.iter().map(|key| last(&key.path)))?;
        all.iter().find(|key| last(&key.path) == near).map(|key| key.path.clone())
    }

    /// Reads a section from the layers that have it; whether any has.
    fn section_from<R: Record>(&mut self, key: &'static str, record: &mut R) -> bool {
        self.seen.push(key);
        let parent = self.path;
        let path = path_to(&parent, key);
        let mut layers = Vec::new();
        for layer in &self.layers {
            let Some((name, node)) = layer.table.get_key_value(key) else { continue };
            if let DeValue::Table(table) = node.get_ref() {
                layers.push(Layer { document: layer.document, table, span: name.span() });
            } else {
                let found = Found { node, document: layer.document, path };
                found.wrong_type(&format!("a table: [{path}]"), self.problems);
            }
        }
        let present = !layers.is_empty();
        if present {
            Reader { path: Some(path), layers, seen: Vec::new(), problems: self.problems }
                .read(record);
        }
        present
    }
}

fn path_to<'a>(parent: &'a Option<Path<'a>>, key: &'a str) -> Path<'a> {
    match parent {
        None => Path::Key(key),
        Some(parent) => Path::Field(parent, key),
    }
}

impl Visit for Reader<'_, '_> {
    fn value<T>(&mut self, key: &'static str, slot: &mut T, codec: impl Codec<T>, _about: &str) {
        self.seen.push(key);
        let latest = self
            .layers
            .iter()
            .rev()
            .find_map(|layer| layer.table.get(key).map(|node| (layer.document, node)));
        let Some((document, node)) = latest else { return };
        let found = Found { node, document, path: path_to(&self.path, key) };
        if let Some(value) = codec.read(&found, self.problems) {
            *slot = value;
        }
    }

    fn section(&mut self, key: &'static str, record: &mut impl Record) {
        self.section_from(key, record);
    }

    fn optional_section<R: Record>(
        &mut self,
        key: &'static str,
        slot: &mut Option<R>,
        mut blank: R,
    ) {
        match slot {
            Some(record) => {
                self.section_from(key, record);
            }
            None => {
                if self.section_from(key, &mut blank) {
                    *slot = Some(blank);
                }
            }
        }
    }
}
