//! Which function of a program calls which, and what each takes of the stack.

mod deepest;

use std::collections::{BTreeMap, BTreeSet};

use crate::elf::{self, Function};
use crate::machine::{Flow, Instruction, Machine, Stack};

pub(crate) use deepest::{Bound, deepest};

/// A program's functions and the calls between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct CallGraph {
    /// By address.
    pub(crate) nodes: Vec<Node>,
}

/// One function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Node {
    /// Its path in the source, or its bare name where it is not Rust's.
    pub(crate) name: String,
    /// Where it starts.
    pub(crate) address: u32,
    /// Bytes it takes of the stack for itself, at most.
    pub(crate) frame: u32,
    /// The same as the compiler recorded it; hand-written and precompiled code has no record.
    pub(crate) recorded: Option<u32>,
    /// The same as its instructions tell; none if one of them moves the stack by a register.
    pub(crate) decoded: Option<u32>,
    /// What it calls, jumps of a call in tail position included, as places in the list of nodes.
    pub(crate) calls: BTreeSet<usize>,
    /// Calls through a register: to whom, its instructions do not tell.
    pub(crate) register_calls: usize,
    /// Calls to addresses where no function is.
    pub(crate) stray_calls: usize,
}

impl CallGraph {
    /// Reads it from a program.
    pub(crate) fn of(elf: &[u8]) -> Result<Self, String> {
        let number = elf::machine(elf)?;
        let machine =
            Machine::of(number).ok_or_else(|| format!("no decoder for ELF machine {number}"))?;
        let functions = elf::functions(elf)?;
        let recorded = elf::stack_sizes(elf)?;
        let nodes = functions
            .iter()
            .map(|function| node(function, &functions, machine, &recorded))
            .collect();
        Ok(Self { nodes })
    }

    /// The function with this name.
    pub(crate) fn named(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| node.name == name)
    }

    /// Everything that runs when these run, themselves included; `stop` are not looked into.
    pub(crate) fn reached(&self, roots: &[usize], stop: &BTreeSet<usize>) -> BTreeSet<usize> {
        let mut reached = BTreeSet::new();
        let mut waiting = roots.to_vec();
        while let Some(node) = waiting.pop() {
            if reached.insert(node) && !stop.contains(&node) {
                waiting.extend(&self.nodes[node].calls);
            }
        }
        reached
    }
}

fn node(
    function: &Function,
    all: &[Function],
    machine: Machine,
    recorded: &BTreeMap<u32, u32>,
) -> Node {
    let instructions = machine.instructions(&function.code, &function.constants, function.address);
    let recorded = recorded.get(&function.address).copied();
    let decoded = frame(&instructions);
    let mut node = Node {
        name: format!("{:#}", rustc_demangle::demangle(&function.name)),
        address: function.address,
        frame: recorded.unwrap_or(0).max(decoded.unwrap_or(0)),
        recorded,
        decoded,
        ..Node::default()
    };
    let end = function.address.saturating_add(function.code.len() as u32);
    // The Cortex-M0 has no other far branch than a call: into its own middle it is no call.
    let inside = function.address + 1..end;
    for Instruction { flow, .. } in instructions {
        let target = match flow {
            Flow::On => continue,
            Flow::Jump(target) if target == function.address => continue,
            Flow::Call(target) | Flow::Jump(target) if inside.contains(&target) => continue,
            Flow::Call(target) | Flow::Jump(target) => target,
            Flow::CallRegister | Flow::JumpRegister => {
                node.register_calls += 1;
                continue;
            }
        };
        match holder(all, target) {
            Some(callee) => {
                node.calls.insert(callee);
            }
            None => node.stray_calls += 1,
        }
    }
    node
}

/// All that a function's instructions take together: never too little, unless one of them stands in
/// a loop, which no compiler does.
fn frame(instructions: &[Instruction]) -> Option<u32> {
    instructions.iter().try_fold(0, |sum, instruction| match instruction.stack {
        Stack::Same => Some(sum),
        Stack::Takes(bytes) => Some(sum + bytes),
        Stack::Unknown => None,
    })
}

/// The function whose code this address is in.
fn holder(functions: &[Function], address: u32) -> Option<usize> {
    let index = functions.partition_point(|function| function.address <= address).checked_sub(1)?;
    let function = &functions[index];
    let offset = address - function.address;
    ((offset as usize) < function.code.len()).then_some(index)
}
