//! `cargo xtask stack`: the most stack that each board's program can take, and on which path.

use std::collections::BTreeSet;
use std::path::Path;

use crate::boards;
use crate::call_graph::{Bound, CallGraph, Node, deepest};
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;

/// Where a program starts: `cortex-m-rt`'s name; and what `riscv-rt` calls, whose own code before that
/// takes no stack.
const STARTS: [&str; 2] = ["Reset", "main"];

/// Every panic ends up here; the handler ends the program.
const PANIC: &str = "core::panicking::panic_fmt";

/// Builds the boards and prints the deepest path of each; fails where there is no bound.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let mut unbounded = Vec::new();
    for program in boards::chosen_programs(options)? {
        let elf = firmware::build_program(&program, options)?;
        let (graph, bound) = of(&elf)?;
        println!("{}: {} bytes", program.name, bound.bytes);
        for index in &bound.path {
            let node = &graph.nodes[*index];
            println!("  {:6} {}", node.frame, node.name);
        }
        for (what, list) in [
            ("recursive", &bound.recursive),
            ("calls through a register", &bound.through_register),
            ("frame or callee unknown", &bound.unknown),
        ] {
            for index in list {
                println!("  {what}: {}", graph.nodes[*index].name);
            }
        }
        if !bound.holds() {
            unbounded.push(program.name);
        }
    }
    match unbounded.as_slice() {
        [] => Ok(()),
        names => Err(Failure::failed(format!("no bound of the stack: {}", names.join(", ")))),
    }
}

/// The bound of a program from its start, a panic left out.
pub(crate) fn of(program: &Path) -> Result<(CallGraph, Bound), Failure> {
    let graph = graph(program)?;
    let start = start(&graph).ok_or_else(|| {
        Failure::failed(format!("{}: no function {}", program.display(), STARTS.join(" or ")))
    })?;
    let panic: BTreeSet<usize> = graph.named(PANIC).into_iter().collect();
    let bound = deepest(&graph, start, &panic);
    Ok((graph, bound))
}

/// The functions that a run may come to, a panic left out.
pub(crate) fn running(graph: &CallGraph) -> impl Iterator<Item = &Node> {
    let panic: BTreeSet<usize> = graph.named(PANIC).into_iter().collect();
    let roots: Vec<usize> = start(graph).into_iter().collect();
    graph.reached(&roots, &panic).into_iter().map(|index| &graph.nodes[index])
}

fn start(graph: &CallGraph) -> Option<usize> {
    STARTS.iter().find_map(|name| graph.named(name))
}

/// The calls of a program.
pub(crate) fn graph(program: &Path) -> Result<CallGraph, Failure> {
    let unreadable = |why: String| Failure::failed(format!("{}: {why}", program.display()));
    let elf = std::fs::read(program).map_err(|error| unreadable(error.to_string()))?;
    CallGraph::of(&elf).map_err(unreadable)
}
