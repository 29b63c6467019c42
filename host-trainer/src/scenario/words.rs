//! Settings that are a word, a flag, a text, or a word with a number.

use std::path::PathBuf;

use controller_core::observation::{DistanceLaw, TypeCode};
use toml::de::DeValue;

use super::number::{Number, Whole};
use super::problem::Problem;
use super::schema::Codec;
use super::value::Found;
use super::*;

/// How readings become inputs, in a scenario file's words: `linear, nearest`.
pub fn words_of(encoding: &Encoding) -> String {
    let law = match encoding.distance {
        DistanceLaw::Linear => "linear".to_owned(),
        DistanceLaw::Saturating { half } => format!("saturating, half at {half} m"),
    };
    let code = TYPE_CODES.iter().find(|(_, code)| *code == encoding.types);
    format!("{law}, {}", code.map_or("unknown", |(word, _)| word))
}

pub(super) const TYPE_CODES: &[(&str, TypeCode)] = &[
    ("any", TypeCode::Any),
    ("nearest", TypeCode::Nearest),
    ("share", TypeCode::Share),
    ("nearest-wall-any-target", TypeCode::NearestWallAnyTarget),
    ("bearing", TypeCode::Bearing),
];

pub(super) const RECURRENCES: &[(&str, RecurrenceKind)] = &[
    ("feedforward", RecurrenceKind::Feedforward),
    ("self", RecurrenceKind::SelfLoop),
    ("elman", RecurrenceKind::Elman),
];

pub(super) const ACTIVATIONS: &[(&str, ActivationKind)] = &[
    ("rational", ActivationKind::Rational),
    ("libm", ActivationKind::Libm),
    ("micromath", ActivationKind::Micromath),
];

pub(super) const FITNESS_KINDS: &[(&str, FitnessKind)] =
    &[("paper", FitnessKind::Paper), ("reached-first", FitnessKind::ReachedFirst)];

pub(super) const COLLISIONS: &[(&str, OnCollision)] =
    &[("hold", OnCollision::Hold), ("stop", OnCollision::Stop)];

pub(super) const TOUCHES: &[(&str, ReachedBy)] =
    &[("body", ReachedBy::Body), ("reference-point", ReachedBy::ReferencePoint)];

pub(super) const DISTANCE_LAW: Choice<DistanceLaw> = Choice {
    words: &[("linear", DistanceLaw::Linear)],
    tuned: &[Tuned {
        key: "saturating_half_m",
        number: Number::metres(0.001, 1000.0),
        make: |half| DistanceLaw::Saturating { half },
        get: |law| match law {
            DistanceLaw::Saturating { half } => Some(*half),
            DistanceLaw::Linear => None,
        },
    }],
};

pub(super) const SELECTION: Choice<Selection> = Choice {
    words: &[("sus", Selection::Sus)],
    tuned: &[
        Tuned {
            key: "linear_rank_pressure",
            number: Number::plain(1.0, 2.0),
            make: |pressure| Selection::LinearRank { pressure },
            get: |selection| match selection {
                Selection::LinearRank { pressure } => Some(*pressure),
                _ => None,
            },
        },
        Tuned {
            key: "truncation_share",
            number: Number::share().above(),
            make: |share| Selection::Truncation { share },
            get: |selection| match selection {
                Selection::Truncation { share } => Some(*share),
                _ => None,
            },
        },
    ],
};

pub(super) const MUTATION: Choice<Mutation> = Choice {
    words: &[("uniform", Mutation::Uniform)],
    tuned: &[
        Tuned {
            key: "additive_amplitude",
            number: Number::plain(0.0, 2000.0).above(),
            make: |amplitude| Mutation::Additive { amplitude },
            get: |mutation| match mutation {
                Mutation::Additive { amplitude } => Some(*amplitude),
                _ => None,
            },
        },
        Tuned {
            key: "gaussian_sigma",
            number: Number::plain(0.0, 2000.0).above(),
            make: |sigma| Mutation::Gaussian { sigma },
            get: |mutation| match mutation {
                Mutation::Gaussian { sigma } => Some(*sigma),
                _ => None,
            },
        },
        Tuned {
            key: "every_gene_sigma",
            number: Number::plain(0.0, 2000.0).above(),
            make: |sigma| Mutation::EveryGene { sigma },
            get: |mutation| match mutation {
                Mutation::EveryGene { sigma } => Some(*sigma),
                _ => None,
            },
        },
    ],
};

pub(super) const INITIAL: Choice<Initial> = Choice {
    words: &[("uniform", Initial::Uniform)],
    tuned: &[Tuned {
        key: "gaussian_sigma",
        number: Number::plain(0.0, 2000.0).above(),
        make: |sigma| Initial::Gaussian { sigma },
        get: |initial| match initial {
            Initial::Gaussian { sigma } => Some(*sigma),
            Initial::Uniform => None,
        },
    }],
};

/// `true` or `false`.
#[derive(Clone, Copy)]
pub(super) struct Flag;

impl Codec<bool> for Flag {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<bool> {
        if let DeValue::Boolean(flag) = found.node.get_ref() {
            return Some(*flag);
        }
        found.wrong_type(&self.expected(), problems);
        None
    }

    fn write(&self, value: &bool) -> Option<String> {
        Some(value.to_string())
    }

    fn expected(&self) -> String {
        "true or false".to_owned()
    }
}

/// One of a list of words.
#[derive(Clone, Copy)]
pub(super) struct Word<T: 'static>(pub(super) &'static [(&'static str, T)]);

impl<T: Copy + PartialEq> Codec<T> for Word<T> {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T> {
        let DeValue::String(text) = found.node.get_ref() else {
            found.wrong_type(&self.expected(), problems);
            return None;
        };
        let value = self.0.iter().find(|(word, _)| word == text).map(|(_, value)| *value);
        if value.is_none() {
            let detail = format!("found {}, expected {}", found.shown(), self.expected());
            found.refuse("is not one of the choices", detail, problems);
            suggest(problems, text, self.0.iter().map(|(word, _)| *word));
        }
        value
    }

    fn write(&self, value: &T) -> Option<String> {
        self.0.iter().find(|(_, known)| known == value).map(|(word, _)| format!("\"{word}\""))
    }

    fn expected(&self) -> String {
        listed(self.0.iter().map(|(word, _)| format!("\"{word}\"")))
    }
}

/// A word, or a table with one key whose number tunes the choice.
pub(super) struct Choice<T: 'static> {
    words: &'static [(&'static str, T)],
    tuned: &'static [Tuned<T>],
}

/// A choice with a number.
pub(super) struct Tuned<T> {
    key: &'static str,
    number: Number,
    make: fn(f32) -> T,
    get: fn(&T) -> Option<f32>,
}

impl<T: Copy + PartialEq> Codec<T> for Choice<T> {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T> {
        let Some(table) = found.table() else {
            if let DeValue::String(text) = found.node.get_ref()
                && let Some((_, value)) = self.words.iter().find(|(word, _)| word == text)
            {
                return Some(*value);
            }
            let detail = format!("found {}, expected {}", found.shown(), self.expected());
            found.refuse("is not one of the choices", detail, problems);
            return None;
        };
        let mut entries = table.iter();
        if let (Some((key, node)), None) = (entries.next(), entries.next())
            && let Some(tuned) = self.tuned.iter().find(|tuned| tuned.key == key.get_ref())
        {
            let path = value::Path::Field(&found.path, tuned.key);
            let inner = Found { node, document: found.document, path };
            return tuned.number.read(&inner, problems).map(tuned.make);
        }
        let keys: Vec<&str> = table.keys().map(|key| key.get_ref().as_ref()).collect();
        let keys = if keys.is_empty() { "no key".to_owned() } else { keys.join(", ") };
        let detail = format!("found a table with {keys}, expected {}", self.expected());
        found.refuse("is not one of the choices", detail, problems);
        None
    }

    fn write(&self, value: &T) -> Option<String> {
        if let Some((word, _)) = self.words.iter().find(|(_, known)| known == value) {
            return Some(format!("\"{word}\""));
        }
        self.tuned.iter().find_map(|tuned| {
            let number = tuned.number.write(&(tuned.get)(value)?)?;
            Some(format!("{{ {} = {number} }}", tuned.key))
        })
    }

    fn expected(&self) -> String {
        let words = self.words.iter().map(|(word, _)| format!("\"{word}\""));
        let tuned = self
            .tuned
            .iter()
            .map(|tuned| format!("{{ {} = {} }}", tuned.key, tuned.number.expected()));
        listed(words.chain(tuned))
    }
}

/// One of [`NetworkSpec::HIDDEN`].
pub(super) struct Hidden;

impl Codec<u8> for Hidden {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<u8> {
        let mut own = Vec::new();
        let value = Whole { low: 0, high: 255 }.read(found, &mut own);
        let value = value.filter(|size| NetworkSpec::HIDDEN.contains(size));
        match (value, found.node.get_ref()) {
            (Some(_), _) => {}
            (None, DeValue::Integer(_)) => found.out_of_range(&self.expected(), problems),
            (None, _) => found.wrong_type(&self.expected(), problems),
        }
        value
    }

    fn write(&self, value: &u8) -> Option<String> {
        Some(value.to_string())
    }

    fn expected(&self) -> String {
        listed(NetworkSpec::HIDDEN.map(|size| size.to_string()).into_iter())
    }
}

/// Metres per control period: one length, or a lower and an upper one.
pub(super) struct Step;

impl Step {
    const LENGTH: Number = Number::metres(0.0, 100.0).above();
    const LOWER: Number = Number::metres(0.0, 100.0);
}

impl Codec<StepLength> for Step {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<StepLength> {
        match found.node.get_ref() {
            DeValue::Array(_) => {
                let [lower, upper] = found.exactly(&self.expected(), problems)?;
                let lower = Self::LOWER.read(&lower, problems);
                let upper = Self::LENGTH.read(&upper, problems);
                let (lower, upper) = lower.zip(upper)?;
                if lower <= upper {
                    return Some(StepLength::Variable { lower, upper });
                }
                let detail = format!("found {lower} above {upper}, expected the smaller one first");
                found.refuse("is in the wrong order", detail, problems);
                None
            }
            DeValue::Float(_) | DeValue::Integer(_) => {
                Self::LENGTH.read(found, problems).map(StepLength::Constant)
            }
            _ => {
                found.wrong_type(&self.expected(), problems);
                None
            }
        }
    }

    fn write(&self, value: &StepLength) -> Option<String> {
        match value {
            StepLength::Constant(step) => Self::LENGTH.write(step),
            StepLength::Variable { lower, upper } => {
                let [lower, upper] = [Self::LENGTH.write(lower)?, Self::LENGTH.write(upper)?];
                Some(format!("[{lower}, {upper}]"))
            }
        }
    }

    fn expected(&self) -> String {
        format!("{}, or two of them [lower, upper]", Self::LENGTH.expected())
    }
}

/// A scenario's name.
pub(super) struct Name;

impl Codec<String> for Name {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<String> {
        let DeValue::String(text) = found.node.get_ref() else {
            found.wrong_type(&self.expected(), problems);
            return None;
        };
        let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if (1..=NAME_LENGTH).contains(&text.len()) && text.chars().all(allowed) {
            return Some(text.to_string());
        }
        let detail = format!("found {}, expected {}", found.shown(), self.expected());
        found.refuse("is not a name", detail, problems);
        None
    }

    fn write(&self, value: &String) -> Option<String> {
        Some(quoted(value))
    }

    fn expected(&self) -> String {
        format!("1 to {NAME_LENGTH} letters, digits, `-` or `_` in quotes")
    }
}

/// A line of text.
pub(super) struct Line;

impl Codec<String> for Line {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<String> {
        let DeValue::String(text) = found.node.get_ref() else {
            found.wrong_type(&self.expected(), problems);
            return None;
        };
        if text.chars().count() <= LINE_LENGTH && !text.chars().any(char::is_control) {
            return Some(text.to_string());
        }
        found.refuse("is not one line", format!("expected {}", self.expected()), problems);
        None
    }

    fn write(&self, value: &String) -> Option<String> {
        (!value.is_empty()).then(|| quoted(value))
    }

    fn expected(&self) -> String {
        format!("one line of at most {LINE_LENGTH} characters in quotes")
    }
}

/// A path to a file.
pub(super) struct Text;

impl Codec<PathBuf> for Text {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<PathBuf> {
        let DeValue::String(text) = found.node.get_ref() else {
            found.wrong_type(&self.expected(), problems);
            return None;
        };
        if !text.is_empty() && !text.contains('\0') {
            return Some(PathBuf::from(text.as_ref()));
        }
        let detail = format!("found {}, expected {}", found.shown(), self.expected());
        found.refuse("is not a path", detail, problems);
        None
    }

    fn write(&self, value: &PathBuf) -> Option<String> {
        Some(quoted(&value.to_string_lossy()))
    }

    fn expected(&self) -> String {
        "the path of a file in quotes".to_owned()
    }
}

/// A text as TOML writes it.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// `a`, `a or b`, `a, b or c`.
pub(super) fn listed(items: impl Iterator<Item = String>) -> String {
    let mut items: Vec<String> = items.collect();
    match items.pop() {
        None => String::new(),
        Some(only) if items.is_empty() => only,
        Some(last) => format!("{} or {last}", items.join(", ")),
    }
}

/// Adds "did you mean" to the last problem if one of the words is near the one found.
fn suggest(problems: &mut [Problem], found: &str, words: impl Iterator<Item = &'static str>) {
    if let (Some(problem), Some(word)) = (problems.last_mut(), nearest(found, words)) {
        problem.help = Some(format!("did you mean `{word}`?"));
    }
}

/// The word that is most likely meant, if any is likely.
pub(super) fn nearest<'a>(found: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    // Long strangers are no slip of the pen, and comparing them takes time.
    if found.len() > 64 {
        return None;
    }
    let likeness = |word: &str| {
        let likeness = strsim::normalized_damerau_levenshtein(found, word);
        // `width` is meant as `width_m`, and `steer_limit` as `steer_limit_deg`.
        let unfinished = found.len() >= 3 && word.starts_with(found);
        if unfinished { 0.9 + likeness / 10.0 } else { likeness }
    };
    let mut best = (0.6, None);
    for word in words {
        let likeness = likeness(word);
        if likeness >= best.0 && (best.1.is_none() || likeness > best.0) {
            best = (likeness, Some(word));
        }
    }
    best.1
}
