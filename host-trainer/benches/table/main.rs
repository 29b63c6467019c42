//! How fast everything is, in one table: `cargo xtask bench`, or `cargo bench -p host-trainer
//! --bench table [-- [--json] [--max WALLS]]`.
//!
//! What is compared takes turns, round by round, and the middle round counts: what else the
//! machine does falls on all alike. Trust the ratios more than the rates.
//!
//! | look in | for |
//! | --- | --- |
//! | `driving` | steps per second of the fixed workload, the paper-size run |
//! | `beams`, `scenes`, `poses` | what a beam and a contact cost against the number of walls |
//! | `networks` | what a step of the network costs |
//! | `peaks` | what this machine's arithmetic and caches can do |
//! | `roofline` | the share of that which a step reaches |
//! | `row` | a line of the table |

mod beams;
mod driving;
mod networks;
mod peaks;
mod poses;
mod roofline;
mod row;
mod scenes;
mod timing;

use host_trainer::bench::workload;
use host_trainer::vector::Instructions;
use std::time::Instant;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let max = match words.iter().position(|word| word == "--max") {
        None => 1_100_000,
        Some(at) => words.get(at + 1).and_then(|word| word.parse().ok()).unwrap_or_else(|| {
            eprintln!("--max: expected a number of walls");
            std::process::exit(2)
        }),
    };
    let problem = workload::problem().expect("part of the program");
    let sets: Vec<Instructions> = Instructions::available().collect();

    let mut rows = Vec::new();
    let begun = Instant::now();
    let note = |what| eprintln!("{:>4.0} s: {what}", begun.elapsed().as_secs_f64());
    note("drives");
    let driving = driving::measure(&problem, &sets);
    rows.extend(driving.rows());
    note("networks");
    let networks = networks::measure(&problem, &sets);
    rows.extend(networks::rows(&networks));
    note("beams and contacts");
    let (beams, here) = beams::measure(&problem, max);
    rows.extend(beams);
    note("peaks");
    let peaks = peaks::measure(&sets);
    rows.extend(peaks::rows(&peaks));
    note("done");
    rows.extend(roofline::rows(&problem, &driving, &networks, &here, &peaks));

    if words.iter().any(|word| word == "--json") {
        println!("{}", row::json(&rows));
    } else {
        print!("{}", row::table(&rows));
    }
}
