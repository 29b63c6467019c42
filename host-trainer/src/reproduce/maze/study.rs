//! Trials and their numbers as the report shows them, and the pictures as files.

use super::course::{Published, SOURCE};
use super::method::MazeMethod;
use super::plan::{MazePlan, MazeSetup};
use super::results::{CourseResults, Evaluations, MazeResults, MazeRow, thousands};
use super::trial::MazeTrial;
use crate::failure::Failure;
use crate::picture;
use crate::report::map;
use crate::report::study::{Part, Section, Study, Table};
use crate::reproduce::study::Shown;

/// Draws everything.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn of(
    plan: &MazePlan,
    setups: &[MazeSetup],
    trials: &[Vec<MazeTrial>],
    results: &MazeResults,
) -> Result<Shown, Failure> {
    let together: Vec<Searched<'_>> = setups.iter().zip(trials).collect();
    let mut pictures = Vec::new();
    let mut sections = Vec::new();
    let courses = together.chunk_by(|(a, _), (b, _)| a.course == b.course);
    for (methods, course) in courses.zip(&results.courses) {
        sections.push(section(methods, course, &mut pictures)?);
    }
    let study = Study {
        title: "Mazes, with and without a goal in mind".to_owned(),
        kind: "reproduction",
        summary: format!(
            "One search, told three things of each individual: {}. Every run begins at the maze's \
             own start and ends when the goal is reached or its budget is spent. Beside it: \
             {SOURCE}; its robot, its sensors and its networks are others.",
            told()
        ),
        sections,
        provenance: provenance(plan),
    };
    Ok(Shown { study, pictures })
}

/// A method on one course with its trials, by seed.
type Searched<'a> = (&'a MazeSetup, &'a Vec<MazeTrial>);

fn told() -> String {
    let each = MazeMethod::ALL.map(|method| format!("{} ({})", method.name(), method.what()));
    each.join(", ")
}

fn section(
    methods: &[Searched<'_>],
    results: &CourseResults,
    pictures: &mut Vec<(String, String)>,
) -> Result<Section, Failure> {
    let name = results.course.name();
    let mut svgs = Vec::new();
    for (setup, trials) in methods {
        let Some(trial) = trials.first() else { continue };
        let svg = ends(setup, trial)?;
        pictures.push((format!("{name}-{}", setup.method.name()), svg.clone()));
        svgs.push(svg);
    }
    let caption = "The run of the first seed: a point where each drive ended (evenly some of them, \
                   where there were very many), and the drive that reached the goal or came nearest."
        .to_owned();
    let parts = vec![
        Part::Table(table(results)),
        Part::Text(
            "Evaluations of the runs that reached the goal; whole generations count.".to_owned(),
        ),
        Part::Maps { svgs, caption },
    ];
    let heading = format!("{}: {}", results.course.scenario().replace('_', " "), results.rule);
    Ok(Section { id: name.to_owned(), heading, parts })
}

/// Where the drives of one run ended.
fn ends(setup: &MazeSetup, trial: &MazeTrial) -> Result<String, Failure> {
    let drive = trial.drive(setup)?;
    let end = if trial.solved { "reached" } else { "not reached" };
    let heading = format!(
        "{}, seed {}: {end} in {} drives",
        setup.method.name(),
        trial.seed,
        thousands(trial.evaluations as f64)
    );
    Ok(map::ends_svg(&picture::scene(&setup.problem), &trial.ends, drive.as_ref(), &heading))
}

fn table(results: &CourseResults) -> Table {
    let columns = vec![
        ("Selected by", false),
        ("Solved", false),
        ("Mean", true),
        ("SD", true),
        ("Median", true),
        ("Least", true),
        ("Most", true),
        ("Seed by seed", false),
    ];
    let rows = results.rows.iter().map(own).chain(results.published.iter().map(published));
    Table { columns, rows: rows.collect() }
}

fn own(row: &MazeRow) -> Vec<String> {
    let number = |get: fn(&Evaluations) -> Option<f64>| {
        row.evaluations.as_ref().and_then(get).map_or("–".to_owned(), thousands)
    };
    vec![
        row.method.name().to_owned(),
        row.solved.to_string(),
        number(|all| Some(all.mean)),
        number(|all| all.deviation),
        number(|all| Some(all.spread.median)),
        number(|all| Some(all.spread.least)),
        number(|all| Some(all.spread.most)),
        row.against_first.as_ref().map_or("–".to_owned(), ToString::to_string),
    ]
}

fn published(published: &Published) -> Vec<String> {
    let Published { method, solved, runs, mean, deviation } = published;
    let mut row = vec![
        format!("{}, published", method.name()),
        format!("{solved} of {runs}"),
        thousands(*mean),
        deviation.map_or("–".to_owned(), thousands),
    ];
    row.resize(8, "–".to_owned());
    row
}

fn provenance(plan: &MazePlan) -> Vec<(String, String)> {
    let own = |number: Option<u32>| number.map_or("the preset's".to_owned(), |n| n.to_string());
    let methods: Vec<&str> = plan.methods.iter().map(|method| method.name()).collect();
    let rows = [
        ("evosteer", plan.evosteer.clone()),
        ("methods", methods.join(", ")),
        ("first seed", plan.seed.to_string()),
        ("seeds", plan.seeds.to_string()),
        ("population", own(plan.population)),
        ("generations", own(plan.generations)),
    ];
    rows.map(|(name, value)| (name.to_owned(), value)).to_vec()
}
