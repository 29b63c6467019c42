//! One line of the counting program, and the table of all.

use std::fmt;

use crate::failure::Failure;

/// One thing that was measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Row {
    /// A network step, a control step or a tanh.
    pub(super) what: String,
    /// The network's recurrence; `-` for a tanh.
    pub(super) recurrence: String,
    /// Which tanh.
    pub(super) tanh: String,
    /// Fewest instructions.
    pub(super) min: u32,
    /// Most instructions.
    pub(super) max: u32,
    /// Instructions with all inputs together.
    pub(super) sum: u32,
    /// How many inputs.
    pub(super) inputs: u32,
    /// Bytes of stack.
    pub(super) stack: u32,
    /// Bytes of its code, functions that it calls included.
    pub(super) code: u32,
    /// Bytes of a network's state.
    pub(super) state: u32,
    /// Bytes of the network's weights.
    pub(super) weights: u32,
}

impl Row {
    /// A network step with the default tanh.
    pub(super) fn is_default_step(&self) -> bool {
        self.what == "network" && self.tanh == "rational"
    }

    /// The one of this recurrence.
    pub(super) fn is_default_step_of(&self, recurrence: &str) -> bool {
        self.is_default_step() && self.recurrence == recurrence
    }

    fn read(line: &str, code: impl Fn(u32) -> Result<u32, String>) -> Result<Self, String> {
        let mut words = line.split_whitespace();
        let mut name = || words.next().unwrap_or_default().to_owned();
        let (_level, what, recurrence, tanh) = (name(), name(), name(), name());
        let pairs: Vec<(&str, &str)> = words.filter_map(|word| word.split_once('=')).collect();
        let number = |key: &str| -> Result<u32, String> {
            let found = pairs.iter().find(|(name, _)| *name == key);
            found.and_then(|(_, value)| value.parse().ok()).ok_or(format!("no number {key}="))
        };
        let code = code(number("code")?)?;
        Ok(Self {
            what,
            recurrence,
            tanh,
            min: number("min")?,
            max: number("max")?,
            sum: number("sum")?,
            inputs: number("inputs")?,
            stack: number("stack")?,
            code,
            state: number("state")?,
            weights: number("weights")?,
        })
    }

    #[cfg(test)]
    pub(super) fn of_default_step(recurrence: &str) -> Self {
        let (instructions, flash) = if recurrence == "elman" { (2550, 6400) } else { (1600, 4200) };
        Self {
            what: "network".into(),
            recurrence: recurrence.into(),
            tanh: "rational".into(),
            min: instructions,
            max: instructions,
            sum: 2 * instructions,
            inputs: 2,
            stack: 200,
            code: flash - 1000,
            state: 96,
            weights: 1000,
        }
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.what, self.recurrence, self.tanh)
    }
}

/// Reads what the program said; `code` tells the bytes of the function at an address.
pub(super) fn read(
    log: &str,
    code: impl Fn(u32) -> Result<u32, String>,
) -> Result<Vec<Row>, Failure> {
    let lines = log.lines().filter(|line| line.contains(" min="));
    let rows: Vec<Row> = lines
        .map(|line| {
            Row::read(line, &code).map_err(|why| {
                Failure::failed(format!("the counting program said `{line}`: {why}"))
            })
        })
        .collect::<Result<_, _>>()?;
    if rows.is_empty() {
        return Err(Failure::failed(format!("the counting program counted nothing:\n{log}")));
    }
    Ok(rows)
}

/// All rows as a table for the documentation.
pub(super) fn table(rows: &[Row]) -> String {
    let mut table = String::from(
        "| | tanh | instructions: fewest | mean | most | stack, bytes | code, bytes | with weights |\n\
         | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for row in rows {
        let Row { min, max, stack, .. } = row;
        let what = match row.what.as_str() {
            "network" => format!("network step, {}", row.recurrence),
            "control" => format!("control step, {}", row.recurrence),
            other => format!("one {other}"),
        };
        let mean = f64::from(row.sum) / f64::from(row.inputs.max(1));
        table += &format!(
            "| {what} | {} | {min} | {mean:.0} | {max} | {stack} | {} | {} |\n",
            row.tanh,
            row.code,
            row.code + row.weights
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: &str = "INFO  network elman rational min=2543 max=2545 sum=5088 inputs=2 stack=116 \
                        code=51424 state=96 weights=2212  (cases.rs:121)";

    #[test]
    fn a_line_becomes_a_row_with_the_size_of_the_code() {
        let rows = read(&format!("INFO  hello\n{LINE}\n"), |address| {
            assert_eq!(address, 51424);
            Ok(3030)
        });
        let table = table(&rows.expect("readable"));
        let row = "| network step, elman | rational | 2543 | 2544 | 2545 | 116 | 3030 | 5242 |";
        assert_eq!(table.lines().last(), Some(row));
    }

    #[test]
    fn a_line_that_lacks_a_number_and_a_log_without_lines_are_refused() {
        let refusal = |log: &str| read(log, |_| Ok(1)).expect_err("unreadable").to_string();
        assert!(refusal(&LINE.replace("stack=116", "stack=")).contains("no number stack="));
        assert!(refusal("INFO  hello").contains("counted nothing"));
        let nowhere = read(LINE, |_| Err("no function starts there".into()));
        let nowhere = nowhere.expect_err("no function").to_string();
        assert!(nowhere.ends_with("no function starts there"), "{nowhere}");
    }
}
