use super::*;
use crate::output::Page;

fn row(generation: u32) -> MetricsRow {
    MetricsRow {
        generation,
        best: -23_456.71,
        mean: 812.04,
        worst: 9_000.0,
        collisions: 1,
        distance_to_target: 0.0,
        bonus: 5,
        path_length: 41.5,
        reached: 1.0,
        clean: 0.8,
        population_reached: 0.31,
        live_steps: 250_000,
    }
}

/// What plain lines a quick run prints from generation `done` on.
fn lines(done: u32, total: u32) -> Vec<String> {
    let stderr = Page::default();
    let mut output = Output::to(false, std::io::sink(), stderr.clone());
    let mut progress = Progress { total, display: Display::Lines { last: None } };
    for generation in done..total {
        progress.update(&mut output, &row(generation), 1_234_567.0);
    }
    progress.finish();
    stderr.text().lines().map(str::to_owned).collect()
}

#[test]
fn a_quick_run_prints_its_first_its_last_and_every_tenth_part() {
    let printed = lines(0, 65);
    assert_eq!(
        printed[0],
        "generation 1/65  mean 812.0  best -23456.7  reached 100 %  1.23 M steps/s"
    );
    let numbers: Vec<&str> =
        printed.iter().map(|line| line["generation ".len()..].split('/').next().unwrap()).collect();
    assert_eq!(numbers, ["1", "6", "12", "18", "24", "30", "36", "42", "48", "54", "60", "65"]);
}

#[test]
fn a_run_of_one_generation_and_a_resumed_one_print_too() {
    assert_eq!(lines(0, 1).len(), 1);
    assert_eq!(lines(58, 60).len(), 2);
}

#[test]
fn speeds_have_three_digits_and_a_prefix() {
    let cases = [0.0, 7.4, 999.4, 999.6, 1_000.0, 56_789.0, 999_600.0, 12_345_678.0, 2.5e9];
    assert_eq!(
        cases.map(with_prefix),
        ["0", "7", "999", "1.00 k", "1.00 k", "56.8 k", "1.00 M", "12.3 M", "2.50 G"]
    );
}

#[test]
fn a_speed_that_is_no_number_is_printed_as_such() {
    assert_eq!(with_prefix(f64::NAN), "NaN");
    assert_eq!(with_prefix(f64::INFINITY), "inf G");
}
