//! Instructions of a simulated step, part by part.

use super::callgrind::inclusive;

/// Instructions per step with one set of vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Counts {
    set: &'static str,
    network: u64,
    beams: u64,
    contacts: u64,
    /// What is left of a step: target, inputs, motion, and keeping the drives going.
    rest: u64,
    whole: u64,
}

impl Counts {
    /// Reads the counting program's profile; its functions made `steps` steps each.
    pub(super) fn of(set: &'static str, profile: &str, steps: u64) -> Result<Self, String> {
        let per_step = |name: &str| {
            let count = inclusive(profile, name).ok_or(format!("no call of {name}"))?;
            Ok::<u64, String>(count.checked_div(steps).ok_or("no steps")?)
        };
        let [network, beams, contacts, whole] =
            ["counted_networks", "counted_beams", "counted_contacts", "counted_drives"]
                .map(per_step);
        let (network, beams, contacts, whole) = (network?, beams?, contacts?, whole?);
        let rest = whole.saturating_sub(network + beams + contacts);
        Ok(Self { set, network, beams, contacts, rest, whole })
    }
}

/// As a Markdown table.
pub(super) fn table(counts: &[Counts]) -> String {
    let mut text = String::from(
        "| vectors | network | beams | contacts | rest | whole step |\n\
         | --- | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for Counts { set, network, beams, contacts, rest, whole } in counts {
        text += &format!("| {set} | {network} | {beams} | {contacts} | {rest} | {whole} |\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(whole: u64) -> String {
        let call = |name: &str, cost: u64| format!("cfn=counted::{name}\ncalls=1 0\n0 {cost}\n");
        let calls = [("counted_networks", 400), ("counted_beams", 300), ("counted_contacts", 100)];
        let calls: String = calls.map(|(name, cost)| call(name, cost)).concat();
        calls + &call("counted_drives", whole)
    }

    #[test]
    fn what_no_part_accounts_for_is_the_rest() {
        let counts = Counts::of("avx2", &profile(1000), 2).expect("all calls are there");
        assert_eq!(table(&[counts]).lines().last(), Some("| avx2 | 200 | 150 | 50 | 100 | 500 |"));
    }

    #[test]
    fn a_part_that_was_not_called_is_named() {
        let refused = Counts::of("sse2", "fn=(1) main\n0 1\n", 2).expect_err("nothing is called");
        assert_eq!(refused, "no call of counted_networks");
        assert!(Counts::of("sse2", &profile(1), 0).is_err());
    }
}
