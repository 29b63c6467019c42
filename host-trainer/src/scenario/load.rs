//! From text to a scenario: defaults, then the file, the preset, `--set` and other options.

use std::borrow::Cow;
use std::path::Path;

use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use super::check::complaints;
use super::problem::{self, Complaint, Document, Place, Problem};
use super::reader::{Layer, read_layers};
use super::source::Source;
use super::{Bounds, Preset, Scenario};
use crate::failure::Failure;
use crate::map::{self, MapProblem};

/// A setting from the command line; later ones win over earlier ones and over the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    option: String,
    text: String,
}

impl Setting {
    /// The argument of `--set`: any key of a scenario file, `=`, and a value. Quotes around a
    /// word may be left out.
    pub fn set(argument: &str) -> Self {
        Self { option: "--set".to_owned(), text: argument.to_owned() }
    }

    /// Another option that stands for a key, such as `--population` for
    /// `training.population`; messages name the option.
    pub fn option(option: &str, key: &str, value: impl std::fmt::Display) -> Self {
        Self { option: option.to_owned(), text: format!("{key} = {value}") }
    }

    /// The setting as TOML.
    fn toml(&self) -> Cow<'_, str> {
        let text = Cow::from(&self.text);
        if DeTable::parse(&text).is_ok() {
            return text;
        }
        let Some((key, value)) = self.text.split_once('=') else { return text };
        let value = value.trim();
        if value.is_empty() || value.starts_with(['"', '\'', '[', '{']) {
            return text;
        }
        let quoted = format!("{key}= {}", toml::Value::from(value));
        if DeTable::parse(&quoted).is_ok() { Cow::from(quoted) } else { text }
    }
}

/// Reads a scenario. The settings win over the preset, the preset over the text, the text over
/// the paper's settings.
///
/// # Errors
///
/// Bad input, with every problem that was found: its file, line and column or its option, what
/// stands there and what was expected.
pub fn load(
    source: &Source,
    preset: Option<Preset>,
    settings: &[Setting],
) -> Result<Scenario, Failure> {
    let documents = documents(source, preset, settings);
    let (tables, mut problems) = parse(&documents);
    if !problems.is_empty() {
        return Err(failure(problems, &documents));
    }
    let mut scenario = super::preset::paper();
    scenario.name.clone_from(&source.name);
    read_layers(&mut scenario, layers(&tables), &mut problems);
    if !problems.is_empty() {
        return Err(failure(problems, &documents));
    }
    if let Some(map) = &mut scenario.world.map {
        map.yaml = source.resolve(&map.yaml);
        let written = |key| locate(key, &tables).is_some();
        let bounds = bounds_of(&map.yaml, |complaint| point(&[complaint], &tables, &documents))?;
        if !written("world.min_m") {
            scenario.world.bounds.min = bounds.min;
        }
        if !written("world.max_m") {
            scenario.world.bounds.max = bounds.max;
        }
        let Bounds { min, max } = bounds;
        if !scenario.world.bounds.overlaps(min, max) {
            let detail = format!(
                "found a map from ({}, {}) to ({}, {}), expected a part of it in the room",
                min[0], min[1], max[0], max[1]
            );
            let outside = Complaint::new("world.map.yaml", "the map lies outside the room", detail);
            return Err(point(&[outside], &tables, &documents));
        }
    }
    let mut complaints = complaints(&scenario);
    complaints.extend(listed_and_drawn(source, settings));
    if complaints.is_empty() { Ok(scenario) } else { Err(point(&complaints, &tables, &documents)) }
}

/// The failure that complaints about a loaded scenario mean, with their places.
pub fn refuse(source: &Source, settings: &[Setting], complaints: &[Complaint]) -> Failure {
    let documents = documents(source, None, settings);
    point(complaints, &parse(&documents).0, &documents)
}

/// The room that a map takes up.
fn bounds_of(yaml: &Path, refuse: impl Fn(Complaint) -> Failure) -> Result<Bounds, Failure> {
    let missing = || {
        let detail =
            format!("found no file {}, expected one in map_server's format", yaml.display());
        Complaint::new("world.map.yaml", "the map does not exist", detail)
    };
    map::load(yaml).map(|map| map.bounds()).map_err(|error| match error.problem {
        MapProblem::Missing => refuse(missing()),
        _ => error.into(),
    })
}

fn documents<'a>(
    source: &'a Source,
    preset: Option<Preset>,
    settings: &'a [Setting],
) -> Vec<Document<'a>> {
    let file = Document { label: &source.label, text: Cow::from(&source.text) };
    let over = preset.map_or(&[] as &[&str], Preset::over).iter();
    let over = over.map(|text| Document { label: "--preset", text: Cow::from(*text) });
    let options =
        settings.iter().map(|setting| Document { label: &setting.option, text: setting.toml() });
    std::iter::once(file).chain(over).chain(options).collect()
}

type Tables<'a> = Vec<Spanned<DeTable<'a>>>;

fn parse<'a>(documents: &'a [Document<'a>]) -> (Tables<'a>, Vec<Problem>) {
    let mut problems = Vec::new();
    let mut tables = Vec::new();
    for (document, Document { text, .. }) in documents.iter().enumerate() {
        let (table, errors) = DeTable::parse_recoverable(text);
        if document > 0 && table.get_ref().is_empty() && errors.is_empty() {
            problems.push(Problem {
                place: Some(Place { document, span: 0..0 }),
                title: "no setting".to_owned(),
                detail: "expected key=value, such as episode.step_limit=400".to_owned(),
                help: None,
            });
        }
        tables.push(table);
        // What follows the first syntax error is usually an echo of it.
        if let Some(error) = errors.first() {
            let span = error.span().unwrap_or(text.len()..text.len());
            problems.push(Problem {
                place: Some(Place { document, span }),
                title: "not valid TOML".to_owned(),
                detail: error.message().to_owned(),
                help: None,
            });
        }
    }
    (tables, problems)
}

fn layers<'a>(tables: &'a Tables<'a>) -> Vec<Layer<'a>> {
    let layer = |(document, table): (usize, &'a Spanned<DeTable<'a>>)| Layer {
        document,
        table: table.get_ref(),
        span: table.span(),
    };
    tables.iter().enumerate().map(layer).collect()
}

/// Listed pairs leave nothing to draw. (What a preset says of drawing does no harm.)
fn listed_and_drawn(source: &Source, settings: &[Setting]) -> Option<Complaint> {
    let documents = documents(source, None, settings);
    let tables = &parse(&documents).0;
    locate("pairs.list[0]", tables)?;
    let drawn = ["pairs.count", "pairs.resample", "pairs.count_end", "pairs.mine"];
    let key = drawn.into_iter().find(|key| locate(key, tables).is_some())?;
    let title = format!("`{key}` means nothing beside `pairs.list`");
    let detail = "found both, expected pairs that are either listed or drawn";
    Some(Complaint::new(key, title, detail))
}

fn point(complaints: &[Complaint], tables: &Tables<'_>, documents: &[Document<'_>]) -> Failure {
    let problems = complaints.iter().map(|complaint| Problem {
        place: complaint.keys.iter().find_map(|key| locate(key, tables)),
        title: complaint.title.clone(),
        detail: complaint.detail.clone(),
        help: complaint.help.clone(),
    });
    failure(problems.collect(), documents)
}

fn failure(problems: Vec<Problem>, documents: &[Document<'_>]) -> Failure {
    Failure::bad_input(problem::print(problems, documents))
}

/// Where the value at a path such as `pairs.list[2].start` was written, latest text first.
fn locate(path: &str, tables: &Tables<'_>) -> Option<Place> {
    tables.iter().enumerate().rev().find_map(|(document, table)| {
        let mut steps = path.split(['.', '[']).map(|step| step.trim_end_matches(']'));
        let mut node = table.get_ref().get(steps.next()?)?;
        for step in steps {
            node = match node.get_ref() {
                DeValue::Table(table) => table.get(step)?,
                DeValue::Array(items) => items.get(step.parse::<usize>().ok()?)?,
                _ => return None,
            };
        }
        Some(Place { document, span: node.span() })
    })
}
