//! Every promise of the README names tests that exist and are run.

use super::pages;

/// A test as the table names it: `[name](file)`.
#[derive(Debug)]
struct Proof<'a> {
    name: &'a str,
    file: &'a str,
}

fn proofs(row: &str) -> Vec<Proof<'_>> {
    let links = row.split('[').skip(1).filter_map(|rest| rest.split_once("]("));
    let parts = links.filter_map(|(name, rest)| Some((name, rest.split_once(')')?.0)));
    parts.map(|(name, file)| Proof { name: name.trim_matches('`'), file }).collect()
}

#[test]
fn every_promise_names_tests_that_exist() {
    let readme = pages::read("README.md");
    let table = readme.split("## Promises").nth(1).expect("a section of promises");
    let table = table.split("\n## ").next().unwrap_or(table);
    let rows: Vec<&str> = table.lines().filter(|line| line.starts_with("| ")).skip(2).collect();
    assert!(rows.len() > 5, "{table}");
    for row in rows {
        let proofs = proofs(row);
        assert!(!proofs.is_empty(), "no test for the promise {row}");
        for Proof { name, file } in proofs {
            let source = pages::read(file);
            if source.contains(&format!("(\"{name}\", "))
                || source.contains(&format!("\"{name}\",\n"))
            {
                continue; // A test by name, in a file with a `main` of its own.
            }
            let (before, _) = source
                .split_once(&format!("fn {name}("))
                .unwrap_or_else(|| panic!("{file} has no test {name}"));
            // Attributes stand between the end of the item before and the function.
            let attributes = before.rsplit("}\n").next().unwrap_or(before);
            assert!(attributes.contains("#[test]"), "{file}: {name} is not run as a test");
            assert!(!attributes.contains("#[ignore"), "{file}: {name} is left out");
        }
    }
}
