//! How many bytes of code a function needs: its own, and all that it calls.

use std::collections::{BTreeMap, BTreeSet};

use crate::call_graph::CallGraph;
use crate::elf;

/// A program's functions.
pub(super) struct Code {
    graph: CallGraph,
    /// Instructions and the constants between them, by address.
    bytes: BTreeMap<u32, usize>,
}

impl Code {
    /// Reads them from an ELF file.
    pub(super) fn of(elf: &[u8]) -> Result<Self, String> {
        let functions = elf::functions(elf)?.into_iter();
        let bytes = functions.map(|function| (function.address, function.code.len())).collect();
        Ok(Self { graph: CallGraph::of(elf)?, bytes })
    }

    /// Bytes of the function that starts there and of everything that it calls.
    pub(super) fn bytes(&self, start: u32) -> Result<u32, String> {
        let root = self.graph.nodes.iter().position(|node| node.address == start);
        let root = root.ok_or_else(|| format!("no function starts at {start:#x}"))?;
        let mut sum = 0;
        for index in self.graph.reached(&[root], &BTreeSet::new()) {
            let node = &self.graph.nodes[index];
            if node.register_calls + node.stray_calls > 0 {
                return Err(format!("what {} calls is unknown", node.name));
            }
            sum += self.bytes.get(&node.address).copied().unwrap_or_default();
        }
        Ok(sum as u32)
    }
}
