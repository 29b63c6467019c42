//! The page on run folders knows every file and every column.

use host_trainer::run_folder::{Metrics, MetricsRow, RunFolder};

use super::pages;

const PAGE: &str = "docs/run-folder.md";

#[test]
fn every_file_of_a_run_folder_is_described() {
    let page = pages::read(PAGE);
    let [a, b] = RunFolder::CHECKPOINTS;
    for file in [
        RunFolder::MANIFEST,
        RunFolder::FROM,
        RunFolder::METRICS,
        RunFolder::TIMING,
        a,
        b,
        RunFolder::CHAMPION,
        RunFolder::WORLDS,
        RunFolder::PLOTS,
        RunFolder::REPORT,
        RunFolder::LOCK,
    ] {
        let row =
            page.lines().any(|line| line.starts_with("| ") && line.contains(&format!("`{file}")));
        assert!(row, "{PAGE} has no row for {file}");
    }
}

#[test]
fn every_column_is_described_in_the_order_of_the_files() {
    let page = pages::read(PAGE);
    for (file, header) in
        [(RunFolder::METRICS, MetricsRow::HEADER), (RunFolder::TIMING, Metrics::TIMING_HEADER)]
    {
        let heading = format!("## `{file}`\n");
        let (_, section) = page.split_once(&heading).expect(&heading);
        let section = section.split("\n## ").next().unwrap_or(section);
        let described: Vec<&str> =
            pages::rows_of_code(section).into_iter().map(|row| row[0].trim_matches('`')).collect();
        assert_eq!(described.join(","), header, "{PAGE}, {file}");
    }
}
