//! What is wrong with a scenario, where, and how that is printed.

use std::borrow::Cow;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// Most problems printed at once.
pub(super) const MOST_PRINTED: usize = 20;

/// Something that is wrong with a scenario as a whole, such as a start inside a wall.
///
/// It names settings, not places in a text; [`refuse`](super::refuse) finds the places.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Complaint {
    /// Settings to point at, such as `pairs.list[2].start`; the first one that somebody wrote.
    pub keys: Vec<String>,
    /// The headline.
    pub title: String,
    /// What was found and what was expected.
    pub detail: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl Complaint {
    /// A complaint about one setting.
    pub fn new(
        key: impl Into<String>,
        title: impl Into<String>,
        detail: impl Into<String>,
    ) -> Self {
        Self { keys: vec![key.into()], title: title.into(), detail: detail.into(), help: None }
    }

    /// Adds a setting to point at if nobody wrote the earlier ones.
    pub fn or_at(mut self, key: impl Into<String>) -> Self {
        self.keys.push(key.into());
        self
    }

    /// Adds what to do about it.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// A place in one of the texts that settings come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the text.
    pub(super) document: usize,
    /// Bytes of the text.
    pub(super) span: Range<usize>,
}

/// A complaint whose place is known, if there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) place: Option<Place>,
    pub(super) title: String,
    pub(super) detail: String,
    pub(super) help: Option<String>,
}

/// A text that settings come from: a scenario file or a command-line option.
#[derive(Clone, Debug)]
pub(super) struct Document<'a> {
    /// A path, or the option's name.
    pub(super) label: &'a str,
    pub(super) text: Cow<'a, str>,
}

/// All problems for people, in the order of their places, as a compiler prints them.
///
/// The first one's `error: ` is left to whoever prints the failure.
pub(super) fn print(mut problems: Vec<Problem>, documents: &[Document<'_>]) -> String {
    problems.sort_by_key(|problem| {
        problem.place.as_ref().map(|place| (place.document, place.span.start))
    });
    problems.dedup();
    let more = problems.len().saturating_sub(MOST_PRINTED);
    problems.truncate(MOST_PRINTED);
    let printed: Vec<String> =
        problems.iter().map(|problem| print_one(problem, documents)).collect();
    let mut text = printed.join("\n\nerror: ");
    if more > 0 {
        text.push_str(&format!("\n\nerror: {more} more problems like these"));
    }
    text
}

fn print_one(problem: &Problem, documents: &[Document<'_>]) -> String {
    let help = problem.help.as_ref().map(|help| Level::HELP.message(help.as_str()));
    let located = problem.place.as_ref().and_then(|place| {
        documents.get(place.document).map(|document| (document, place.span.clone()))
    });
    let Some((document, span)) = located else {
        let help = problem.help.as_ref().map(|help| format!("\n  help: {help}"));
        return format!("{}: {}{}", problem.title, problem.detail, help.unwrap_or_default());
    };
    let (excerpt, line, span) = excerpt(&document.text, span);
    let snippet = Snippet::source(excerpt)
        .path(document.label)
        .line_start(line)
        .annotation(AnnotationKind::Primary.span(span).label(problem.detail.as_str()));
    let group = Level::ERROR.no_name().primary_title(problem.title.as_str()).element(snippet);
    let group = match help {
        Some(help) => group.element(help),
        None => group,
    };
    Renderer::plain().render(&[group])
}

/// The first line of a span: its text, its number, and the span within it.
///
/// A value can go on for many lines; its beginning is enough to find it.
fn excerpt(text: &str, span: Range<usize>) -> (&str, usize, Range<usize>) {
    let boundary = |mut at: usize| {
        at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let (start, end) = (boundary(span.start), boundary(span.end.max(span.start)));
    let before = text.get(..start).unwrap_or("");
    let first = before.rfind('\n').map_or(0, |newline| newline + 1);
    let rest = text.get(start..).unwrap_or("");
    let last = rest.find(['\n', '\r']).map_or(text.len(), |length| start + length);
    let line = before.matches('\n').count() + 1;
    let inside = start - first..end.min(last).max(start) - first;
    (text.get(first..last).unwrap_or(""), line, inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_excerpt_is_the_first_line_of_the_span() {
        let text = "a = 1\nbc = [1,\n2]\n";
        assert_eq!(excerpt(text, 11..17), ("bc = [1,", 2, 5..8));
        assert_eq!(excerpt(text, 0..1), ("a = 1", 1, 0..1));
        assert_eq!(excerpt(text, 18..18), ("", 4, 0..0));
        assert_eq!(excerpt(text, 500..501), ("", 4, 0..0));
        assert_eq!(excerpt("ä = 1", 1..3), ("ä = 1", 1, 0..3));
    }
}
