//! `evosteer bench`: how fast is this machine, and does it compute what it should?

use super::advice::counted;
use super::number::whole;
use super::threads::Threads;
use crate::bench::{golden, speed, workload};
use crate::failure::Failure;
use crate::output::Output;
use crate::vector::Instructions;
use serde::Serialize;

/// Measures the simulator's speed on a fixed workload
///
/// 160 networks drive 5 pairs of 300 steps among 36 walls: 240 000 steps. A paper-size run is
/// 200 generations of them, evolution included. First 256 steps are compared with those of
/// another program.
#[derive(Clone, Debug, clap::Args)]
pub struct BenchArgs {
    #[command(flatten)]
    threads: Threads,

    /// Vector instructions to use: scalar, sse2, avx2 or avx512; the widest of this CPU if not
    /// given
    #[arg(long, value_name = "SET")]
    instructions: Option<Instructions>,

    /// How often to measure; the middle measurement counts
    #[arg(
        long,
        value_name = "N",
        default_value_t = 5,
        value_parser = whole(1..=1000_u16),
        allow_negative_numbers = true
    )]
    repeat: u16,

    /// Leave out the paper-size run
    #[arg(long)]
    short: bool,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Report {
    instructions: String,
    threads: usize,
    golden_steps: usize,
    golden_misses: usize,
    golden_worst_difference: f64,
    steps_per_second: f64,
    steps_per_second_alone: f64,
    crashes: u64,
    reached: u64,
    mean_cost: f64,
    paper_run_seconds: Option<f64>,
    paper_run_steps: Option<u64>,
    paper_run_evolution_seconds: Option<f64>,
    paper_run_best_cost: Option<f64>,
}

/// Measures.
///
/// # Errors
///
/// Golden steps that come out otherwise: a speed would mean nothing.
pub fn run(args: &BenchArgs, output: &mut Output) -> Result<(), Failure> {
    let pool = args.threads.pool()?;
    let instructions = args.instructions.unwrap_or_else(Instructions::in_use);
    let report = pool.install(|| measure(instructions, args.repeat, args.short))?;
    output.line(format_args!(
        "{} on {}, {} golden steps as they should be",
        report.instructions,
        counted(report.threads as u64, "thread"),
        report.golden_steps
    ));
    let million = |steps: f64| format!("{:.2} million steps per second", steps / 1e6);
    output.line(format_args!("  all cars         {}", million(report.steps_per_second)));
    output.line(format_args!("  one by one       {}", million(report.steps_per_second_alone)));
    if let (Some(whole), Some(evolution)) =
        (report.paper_run_seconds, report.paper_run_evolution_seconds)
    {
        output.line(format_args!(
            "  paper-size run   {whole:.2} s, {:.1} % of it evolution",
            100.0 * evolution / whole
        ));
    }
    output.json(&report);
    Ok(())
}

fn measure(instructions: Instructions, repeat: u16, short: bool) -> Result<Report, Failure> {
    let problem = workload::problem()?;
    let golden = golden::compare(&problem);
    if golden.misses > 0 {
        return Err(Failure::bad_input(format!(
            "bench: {} of {} golden steps come out otherwise, by up to {}; this program or this \
             CPU computes wrongly",
            golden.misses, golden.steps, golden.worst
        )));
    }
    let genomes = workload::population(workload::POPULATION);
    // Once for the caches, and for what happens in it.
    let (_, drives) = speed::generation(&problem, &genomes, instructions);
    let costs = workload::costs(&problem, &drives.outcomes);
    let once = |_| speed::generation(&problem, &genomes, instructions).0;
    let all_cars = speed::median((0..repeat).map(once).collect());
    let few = &genomes[..genomes.len() / 16];
    let alone = speed::generation_alone(&problem, few);
    let mut runs = Vec::new();
    for _ in 0..if short { 0 } else { repeat } {
        runs.push(speed::run(&problem, instructions)?);
    }
    runs.sort_by_key(|run| run.whole.time);
    let run = runs.get(runs.len() / 2);
    Ok(Report {
        instructions: instructions.to_string(),
        threads: rayon::current_num_threads(),
        golden_steps: golden.steps,
        golden_misses: golden.misses,
        golden_worst_difference: golden.worst,
        steps_per_second: all_cars.steps_per_second(),
        steps_per_second_alone: alone.steps_per_second(),
        crashes: drives.tally.stopped,
        reached: drives.tally.reached,
        mean_cost: costs.iter().map(|cost| cost.value() / costs.len() as f64).sum(),
        paper_run_seconds: run.map(|run| run.whole.time.as_secs_f64()),
        paper_run_steps: run.map(|run| run.whole.steps),
        paper_run_evolution_seconds: run.map(|run| run.evolution.as_secs_f64()),
        paper_run_best_cost: run.map(|run| run.best),
    })
}
