//! `cargo xtask panics`: which functions of a program can panic, and what each runs into.

use crate::boards;
use crate::call_graph::CallGraph;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use crate::stack;

/// Builds the boards and lists who calls a panic.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    for program in boards::chosen_programs(options)? {
        let elf = firmware::build_program(&program, options)?;
        let graph = stack::graph(&elf)?;
        let paths = of(&graph);
        println!("{}: {} panic paths", program.name, paths.len());
        for (from, into) in paths {
            println!("  {from} -> {into}");
        }
    }
    Ok(())
}

/// Every function that calls a panic, and which one.
pub(crate) fn of(graph: &CallGraph) -> Vec<(&str, &str)> {
    let panics = |name: &str| name.starts_with("core::panicking::");
    let mut paths = Vec::new();
    for node in graph.nodes.iter().filter(|node| !panics(&node.name)) {
        for callee in &node.calls {
            let callee = graph.nodes[*callee].name.as_str();
            if panics(callee) {
                paths.push((node.name.as_str(), callee));
            }
        }
    }
    paths
}
