//! Reads what callgrind writes: <https://valgrind.org/docs/manual/cl-format.html>.

use std::collections::HashMap;

/// Instructions of all calls of the functions whose names contain `name`, with everything that
/// they call; none if there is no such call.
pub(super) fn inclusive(profile: &str, name: &str) -> Option<u64> {
    let mut names: HashMap<&str, &str> = HashMap::new();
    let mut called = "";
    let mut total = None;
    let mut lines = profile.lines();
    while let Some(line) = lines.next() {
        let function = line.strip_prefix("cfn=").or_else(|| line.strip_prefix("fn="));
        if let Some(function) = function {
            // `(7) name` the first time, then `(7)`.
            let (id, given) = function.split_once(' ').unwrap_or((function, function));
            let name = *names.entry(id).or_insert(given);
            if line.starts_with('c') {
                called = name;
            }
        } else if line.starts_with("calls=")
            && let Some(cost) = lines.next()
            && called.contains(name)
        {
            let cost: u64 = cost.split_whitespace().nth(1)?.parse().ok()?;
            total = Some(total.unwrap_or(0) + cost);
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROFILE: &str = "\
version: 1
events: Ir

fn=(1) counted::count
0 12
cfn=(2) counted::counted_beams
calls=1 0
0 4000
cfn=(3) alloc::vec
calls=2 0
0 70
cfn=(2)
calls=1 0
0 4002

fn=(2)
0 900
cfn=(3)
calls=5 0
0 30
";

    #[test]
    fn calls_of_a_function_count_with_all_that_they_call() {
        assert_eq!(inclusive(PROFILE, "counted_beams"), Some(8002));
        assert_eq!(inclusive(PROFILE, "vec"), Some(100));
        assert_eq!(inclusive(PROFILE, "counted_drives"), None);
    }
}
