//! Trials and their numbers as the report shows them, and the pictures as files.

mod curves;
mod drives;
mod tables;

use super::plan::Plan;
use super::results::{Results, SceneResults};
use super::setup::Setup;
use super::trial::Trial;
use crate::failure::Failure;
use crate::report::study::{Part, Section, Study};

/// A report and its pictures.
#[derive(Clone, Debug)]
pub struct Shown {
    /// The page.
    pub study: Study,
    /// Name, without an ending, and SVG of each picture in it.
    pub pictures: Vec<(String, String)>,
}

/// Draws everything.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn of(
    plan: &Plan,
    setups: &[Setup],
    trials: &[Vec<Trial>],
    results: &Results,
) -> Result<Shown, Failure> {
    let together: Vec<Method<'_>> = setups.iter().zip(trials).collect();
    let mut pictures = Vec::new();
    let mut sections = Vec::new();
    let scenes = together.chunk_by(|(a, _), (b, _)| a.scene == b.scene);
    for (methods, scene) in scenes.zip(&results.scenes) {
        sections.push(section(methods, scene, &mut pictures)?);
    }
    let names: Vec<&str> = plan.scenes.iter().map(|scene| scene.name()).collect();
    let study = Study {
        title: format!("The paper's experiments: {}", names.join(", ")),
        kind: "reproduction",
        summary: summary(plan),
        sections,
        provenance: provenance(plan),
    };
    Ok(Shown { study, pictures })
}

/// A method in one scene with its trials, by seed.
type Method<'a> = (&'a Setup, &'a Vec<Trial>);

fn section(
    methods: &[Method<'_>],
    results: &SceneResults,
    pictures: &mut Vec<(String, String)>,
) -> Result<Section, Failure> {
    let (setup, trials) = methods[0];
    let name = setup.scene.name();
    let mut parts = vec![
        Part::Table(tables::claims(results)),
        Part::Heading("Variants".to_owned()),
        Part::Table(tables::variants(results)),
        Part::Text(tables::explained(results)),
    ];
    let mut picture = |parts: &mut Vec<Part>, what: &str, (svg, caption): (String, String)| {
        pictures.push((format!("{name}-{what}"), svg.clone()));
        parts.push(Part::Picture { svg, caption });
    };
    picture(&mut parts, "unseen", curves::unseen(name, results));
    parts.push(Part::Heading("Learning".to_owned()));
    picture(&mut parts, "fitness", curves::fitness(methods));
    picture(&mut parts, "criteria", curves::criteria(setup, trials));
    for group in drives::groups(setup, trials)? {
        let numbered = (1..).zip(&group.svgs);
        pictures.extend(numbered.map(|(n, svg)| (format!("{name}-{}-{n}", group.id), svg.clone())));
        parts.push(Part::Heading(group.heading));
        parts.push(Part::Maps { svgs: group.svgs, caption: group.caption });
    }
    let summary = "The seeds one by one".to_owned();
    parts.push(Part::Folded { summary, table: tables::seeds(results) });
    let heading = format!("{name} ({})", setup.scene.figures());
    Ok(Section { id: name.to_owned(), heading, parts })
}

fn summary(plan: &Plan) -> String {
    let Plan { seeds, pairs, .. } = plan;
    let last = plan.seeds().last().map_or(plan.seed, |seed| seed.0);
    let other = match (plan.generations, plan.population) {
        (None, None) => "",
        _ => " Population or generations are not the paper's.",
    };
    format!(
        "I. Sekaj, L. Cíferský and M. Hvozdík, Neuro-Evolution of Mobile Robot Controller, MENDEL \
         25(1), 2019, over {seeds} seeds ({} to {last}). Every run draws its own training pairs \
         from its seed; its champion is then judged on {pairs} pairs that training never used, \
         under the paper's rules.{other}",
        plan.seed
    )
}

fn provenance(plan: &Plan) -> Vec<(String, String)> {
    let own = |number: Option<u32>| number.map_or("the scene's".to_owned(), |n| n.to_string());
    let rows = [
        ("evosteer", plan.evosteer.clone()),
        ("methods", plan.methods.join(", ")),
        ("first seed", plan.seed.to_string()),
        ("seeds", plan.seeds.to_string()),
        ("unseen pairs per champion", plan.pairs.to_string()),
        ("population", own(plan.population)),
        ("generations", own(plan.generations)),
    ];
    rows.map(|(name, value)| (name.to_owned(), value)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::page;
    use crate::reproduce::sample;

    fn shown() -> (Shown, String) {
        let plan = sample::plan();
        let (setups, trials) = sample::trials(&plan);
        let results = Results::of(&plan, &setups, &trials);
        let shown = of(&plan, &setups, &trials, &results).unwrap();
        let page = page::render_study(&shown.study);
        (shown, page)
    }

    #[test]
    fn every_picture_is_in_the_page_and_none_has_a_number_that_is_none() {
        let (shown, page) = shown();
        let names: Vec<&str> = shown.pictures.iter().map(|(name, _)| &**name).collect();
        for name in ["open-unseen", "open-fitness", "open-criteria", "open-best-1", "open-median-5"]
        {
            assert!(names.contains(&name), "{names:?}");
        }
        for (name, svg) in &shown.pictures {
            assert!(page.contains(svg.as_str()), "{name}");
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{name}");
        }
    }

    #[test]
    fn the_page_is_whole_without_a_network_or_a_script_of_its_own() {
        let (_, page) = shown();
        let addresses = page.matches("http://").count() + page.matches("https://").count();
        assert_eq!(addresses, page.matches("http://www.w3.org/").count());
        assert!(!page.contains(" src=") && !page.contains("url(http"));
    }
}
