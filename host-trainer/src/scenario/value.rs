//! One value of a TOML text: what it is, where it stands, and how it is refused.

use std::fmt;

use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use super::problem::{Place, Problem};

/// A value somebody wrote.
#[derive(Clone, Copy)]
pub(super) struct Found<'a> {
    pub(super) node: &'a Spanned<DeValue<'a>>,
    /// Index of the text it stands in.
    pub(super) document: usize,
    pub(super) path: Path<'a>,
}

/// The way to a value, for people: `pairs.list[2].start`.
#[derive(Clone, Copy)]
pub(super) enum Path<'a> {
    /// A section or a key at the top: its whole name.
    Key(&'a str),
    Field(&'a Path<'a>, &'a str),
    Item(&'a Path<'a>, usize),
}

impl fmt::Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => f.write_str(key),
            Self::Field(parent, key) => write!(f, "{parent}.{key}"),
            Self::Item(parent, index) => write!(f, "{parent}[{index}]"),
        }
    }
}

impl<'a> Found<'a> {
    /// The items of a list, or a refusal.
    pub(super) fn items(
        &'a self,
        expected: &str,
        problems: &mut Vec<Problem>,
    ) -> Option<impl ExactSizeIterator<Item = Found<'a>> + use<'a>> {
        let DeValue::Array(items) = self.node.get_ref() else {
            self.wrong_type(expected, problems);
            return None;
        };
        Some(items.iter().enumerate().map(|(index, node)| Found {
            node,
            document: self.document,
            path: Path::Item(&self.path, index),
        }))
    }

    /// Exactly `N` items of a list, or a refusal.
    pub(super) fn exactly<const N: usize>(
        &'a self,
        expected: &str,
        problems: &mut Vec<Problem>,
    ) -> Option<[Found<'a>; N]> {
        let items: Vec<_> = self.items(expected, problems)?.collect();
        let count = items.len();
        let items = items.try_into().ok();
        if items.is_none() {
            let entries = if count == 1 { "entry" } else { "entries" };
            let detail = format!("found {count} {entries}, expected {expected}");
            self.refuse("has the wrong length", detail, problems);
        }
        items
    }

    pub(super) fn table(&self) -> Option<&'a DeTable<'a>> {
        match self.node.get_ref() {
            DeValue::Table(table) => Some(table),
            _ => None,
        }
    }

    pub(super) fn wrong_type(&self, expected: &str, problems: &mut Vec<Problem>) {
        let detail = format!("found {}, expected {expected}", self.named());
        self.refuse("has the wrong type", detail, problems);
    }

    pub(super) fn out_of_range(&self, expected: &str, problems: &mut Vec<Problem>) {
        let detail = format!("found {}, expected {expected}", self.shown());
        self.refuse("is out of range", detail, problems);
    }

    /// Refuses the value; `title` goes on after its path.
    pub(super) fn refuse(&self, title: &str, detail: String, problems: &mut Vec<Problem>) {
        let title = format!("`{}` {title}", self.path);
        problems.push(Problem { place: Some(self.place()), title, detail, help: None });
    }

    pub(super) fn place(&self) -> Place {
        Place { document: self.document, span: self.node.span() }
    }

    /// The value with its type: "the text `many`".
    fn named(&self) -> String {
        let article = match self.node.get_ref() {
            DeValue::String(_) => "the text ",
            DeValue::Integer(_) => "the whole number ",
            DeValue::Float(_) => "the number ",
            _ => "",
        };
        format!("{article}{}", self.shown())
    }

    /// The value's type, for those whose content is no help.
    fn kind(&self) -> &'static str {
        match self.node.get_ref() {
            DeValue::Datetime(_) => "a date or time",
            DeValue::Array(_) => "a list",
            DeValue::Table(_) => "a table",
            DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_) | DeValue::Boolean(_) => {
                "a value"
            }
        }
    }

    /// The value's content, cut to a readable length.
    pub(super) fn shown(&self) -> String {
        const LONGEST: usize = 40;
        let (mark, text) = match self.node.get_ref() {
            DeValue::String(text) => ("`", text.to_string()),
            DeValue::Integer(number) => ("", number.to_string()),
            DeValue::Float(number) => ("", number.to_string()),
            DeValue::Boolean(flag) => ("", flag.to_string()),
            _ => ("", self.kind().to_owned()),
        };
        if text.chars().count() <= LONGEST {
            return format!("{mark}{text}{mark}");
        }
        let start: String = text.chars().take(LONGEST).collect();
        format!("{mark}{start}…{mark}")
    }
}
