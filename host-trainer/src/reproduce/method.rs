//! What is tried: the paper's method, the advice it gives, and our presets beside both.

use crate::scenario::{Preset, Setting};

/// A way to train in every scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Short name: of its trials' files and of its row in the tables.
    pub name: &'static str,
    /// What it changes, in a few words.
    pub what: &'static str,
    /// What holds where the scene says nothing.
    pub preset: Preset,
    /// Keys of a scenario file and their values, over the scene's.
    pub settings: &'static [(&'static str, &'static str)],
    /// After how many times the scene's generations its champion is judged; ascending.
    pub lengths: &'static [u32],
}

/// The paper's own method; every list of methods begins with it.
pub const PAPER: Method = Method {
    name: "paper",
    what: "the paper's method",
    preset: Preset::Paper,
    settings: &[],
    lengths: &[1, 2, 3],
};

/// "more neurons in the hidden layers, the use of recurrent links in the ANN (see Fig. 2) as well
/// as […] more generations" (paper, end of section 3); the generations are [`PAPER`]'s lengths.
const ADVICE: [Method; 3] = [
    Method {
        name: "hidden-24",
        what: "24 neurons in each hidden layer",
        settings: &[("network.hidden", "24")],
        ..ONCE
    },
    Method {
        name: "self",
        what: "recurrent: each hidden neuron sees its own last output",
        settings: &[("network.recurrence", "\"self\"")],
        ..ONCE
    },
    Method {
        name: "elman",
        what: "recurrent: each hidden neuron sees its whole layer's last outputs",
        settings: &[("network.recurrence", "\"elman\"")],
        ..ONCE
    },
];

const ONCE: Method = Method { lengths: &[1], ..PAPER };

/// Every method, the paper's first, then its advice, then every other preset. A preset joins by
/// being one.
pub fn all() -> Vec<Method> {
    let presets = Preset::ALL.into_iter().filter(|preset| learns_to_drive(*preset));
    let beside = presets.map(|preset| Method {
        name: preset.name(),
        what: "our preset of this name",
        preset,
        ..ONCE
    });
    std::iter::once(PAPER).chain(ADVICE).chain(beside).collect()
}

/// Whether it learns a scene to drive in it, as the paper asks: a refinement begins with what has been
/// learnt, a generalist learns elsewhere, and a search for novelty is for the one way through a maze.
fn learns_to_drive(preset: Preset) -> bool {
    !matches!(preset, Preset::Paper | Preset::Refine | Preset::Generalist | Preset::Novelty)
}

/// The method of this name, if there is one.
pub fn by_name(name: &str) -> Option<Method> {
    all().into_iter().find(|method| method.name == name)
}

impl Method {
    /// Its settings, as from the command line.
    pub fn settings(&self) -> impl Iterator<Item = Setting> {
        let label = format!("the method {}", self.name);
        self.settings.iter().map(move |(key, value)| Setting::option(&label, key, value))
    }

    /// The name of the variant that is seen after `length` times the scene's generations.
    pub fn variant(&self, length: u32) -> String {
        match length {
            1 => self.name.to_owned(),
            length => format!("{}, {length}× generations", self.name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario;

    #[test]
    fn every_preset_that_learns_to_drive_is_a_method_and_the_papers_comes_first() {
        let methods = all();
        assert_eq!(methods[0], PAPER);
        for preset in Preset::ALL.into_iter().filter(|preset| learns_to_drive(*preset)) {
            assert!(methods.iter().any(|method| method.name == preset.name()), "{preset:?}");
        }
    }

    #[test]
    fn names_are_different_and_fit_into_a_files_name() {
        let mut names: Vec<&str> = all().iter().map(|method| method.name).collect();
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
        assert!(names.iter().all(|name| name.chars().all(plain)), "{names:?}");
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{names:?}");
    }

    #[test]
    fn the_advice_is_more_neurons_recurrent_links_and_more_generations() {
        let network = |name| {
            let settings: Vec<Setting> = by_name(name).unwrap().settings().collect();
            let source = scenario::find("complex").unwrap();
            let network = scenario::load(&source, None, &settings).unwrap().network;
            format!("{} {:?}", network.hidden, network.recurrence)
        };
        assert_eq!(
            ["paper", "hidden-24", "self", "elman"].map(network),
            ["12 Feedforward", "24 Feedforward", "12 SelfLoop", "12 Elman"]
        );
        assert_eq!(PAPER.lengths, [1, 2, 3]);
    }
}
