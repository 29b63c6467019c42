//! What one board's program takes, and what it may take.

/// Bytes of stack that a program may take at most.
const STACK: u32 = 4096;

/// What one program takes, bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Row {
    pub(super) name: &'static str,
    /// Code, constants and initial values.
    pub(super) flash: u64,
    /// Flash that is kept for weights.
    pub(super) weights: u32,
    /// Variables, the stack not among them.
    pub(super) ram: u64,
    /// The most stack it can take; none where there is no bound.
    pub(super) bound: Option<u32>,
    /// The most it took in a run, if it was run and could tell.
    pub(super) used: Option<u32>,
    /// Functions of a heap.
    pub(super) heap: Vec<String>,
}

impl Row {
    /// Everything that may not be, as sentences.
    pub(super) fn missed(&self) -> Vec<String> {
        let Self { name, bound, used, heap, .. } = self;
        let mut missed = Vec::new();
        match bound {
            None => {
                missed.push(format!("{name}: no bound of the stack; cargo xtask stack says why"))
            }
            Some(bound @ STACK..) if *bound > STACK => {
                missed.push(format!("{name}: {bound} bytes of stack, at most {STACK} expected"));
            }
            Some(_) => {}
        }
        // A run that goes deeper, or never half as deep, shows that bound or run is not what it says.
        if let (Some(bound), Some(used)) = (bound, used)
            && !(bound / 2..=*bound).contains(used)
        {
            missed.push(format!(
                "{name}: {used} bytes of stack used, {} to {bound} expected",
                bound / 2
            ));
        }
        if let Some(function) = heap.first() {
            missed.push(format!("{name}: it has a heap: {function}"));
        }
        missed
    }
}

/// All rows as Markdown. Flash is in KiB: the texts of panics name files by their place on the machine that
/// compiled them, and so differ by some bytes.
pub(super) fn table(rows: &[Row]) -> String {
    let mut table = String::from(
        "| board | flash, KiB | kept for weights, KiB | static RAM, bytes | stack at most, bytes | stack used, bytes |\n\
         | --- | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let or_dash = |number: &Option<u32>| number.map_or("-".to_owned(), |number| number.to_string());
    for Row { name, flash, weights, ram, bound, used, .. } in rows {
        table += &format!(
            "| {name} | {} | {} | {ram} | {} | {} |\n",
            flash.div_ceil(1024),
            weights / 1024,
            or_dash(bound),
            or_dash(used)
        );
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_refused_for_its_stack_or_its_heap_with_the_numbers() {
        let good = Row { name: "b", bound: Some(4096), used: Some(2048), ..Row::default() };
        assert_eq!(good.missed(), [""; 0]);
        let one = |row: Row| <[String; 1]>::try_from(row.missed()).expect("one reason")[0].clone();
        assert_eq!(
            one(Row { bound: Some(4100), used: None, ..good.clone() }),
            "b: 4100 bytes of stack, at most 4096 expected"
        );
        for used in [2047, 4100] {
            let said = format!("b: {used} bytes of stack used, 2048 to 4096 expected");
            assert_eq!(one(Row { used: Some(used), ..good.clone() }), said);
        }
        assert!(one(Row { bound: None, ..good.clone() }).starts_with("b: no bound"));
        let heap = vec!["__rust_alloc".to_owned()];
        assert_eq!(one(Row { heap, ..good }), "b: it has a heap: __rust_alloc");
    }
}
