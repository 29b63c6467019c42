//! The most stack that a run can take: the deepest path through the calls.

use std::collections::BTreeSet;

use super::CallGraph;

/// The most stack that a run from one function takes, and what would make that number wrong.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Bound {
    /// Bytes.
    pub(crate) bytes: u32,
    /// The functions on the way to the deepest point, the first one first.
    pub(crate) path: Vec<usize>,
    /// Functions that lie on a circle of calls.
    pub(crate) recursive: BTreeSet<usize>,
    /// Functions that call through a register.
    pub(crate) through_register: BTreeSet<usize>,
    /// Functions whose frame or callee nobody could tell.
    pub(crate) unknown: BTreeSet<usize>,
}

impl Bound {
    /// Whether no run can take more.
    pub(crate) fn holds(&self) -> bool {
        self.recursive.is_empty() && self.through_register.is_empty() && self.unknown.is_empty()
    }
}

/// The bound of a run from `root`, not looking into `stop`, which do not return to the run.
pub(crate) fn deepest(graph: &CallGraph, root: usize, stop: &BTreeSet<usize>) -> Bound {
    let mut search = Search { graph, stop, found: vec![None; graph.nodes.len()], open: Vec::new() };
    let mut recursive = BTreeSet::new();
    let bytes = search.need(root, &mut recursive);
    let mut bound = Bound { bytes, recursive, ..Bound::default() };
    let mut next = Some(root);
    while let Some(node) = next {
        bound.path.push(node);
        next = search.found[node].and_then(|found| found.into);
    }
    for index in graph.reached(&[root], stop).difference(stop) {
        let node = &graph.nodes[*index];
        if node.register_calls > 0 {
            bound.through_register.insert(*index);
        }
        if node.stray_calls > 0 || node.decoded.or(node.recorded).is_none() {
            bound.unknown.insert(*index);
        }
    }
    bound
}

/// What is known of a function that was looked through.
#[derive(Clone, Copy)]
struct Found {
    bytes: u32,
    into: Option<usize>,
}

struct Search<'a> {
    graph: &'a CallGraph,
    stop: &'a BTreeSet<usize>,
    found: Vec<Option<Found>>,
    /// The functions between the root and here.
    open: Vec<usize>,
}

impl Search<'_> {
    fn need(&mut self, node: usize, recursive: &mut BTreeSet<usize>) -> u32 {
        if let Some(found) = self.found[node] {
            return found.bytes;
        }
        if let Some(start) = self.open.iter().position(|open| *open == node) {
            recursive.extend(&self.open[start..]);
            return 0;
        }
        let graph = self.graph;
        let mut deepest = Found { bytes: 0, into: None };
        if !self.stop.contains(&node) {
            self.open.push(node);
            for callee in &graph.nodes[node].calls {
                let bytes = self.need(*callee, recursive);
                if bytes > deepest.bytes {
                    deepest = Found { bytes, into: Some(*callee) };
                }
            }
            self.open.pop();
        }
        deepest.bytes += graph.nodes[node].frame;
        self.found[node] = Some(deepest);
        deepest.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::super::Node;
    use super::*;

    /// Functions with these frames and calls.
    fn graph(nodes: &[(u32, &[usize])]) -> CallGraph {
        let nodes = nodes.iter().map(|(frame, calls)| Node {
            frame: *frame,
            decoded: Some(*frame),
            calls: calls.iter().copied().collect(),
            ..Node::default()
        });
        CallGraph { nodes: nodes.collect() }
    }

    #[test]
    fn the_deepest_path_wins_though_another_is_longer() {
        let graph = graph(&[(8, &[1, 3]), (16, &[2]), (16, &[]), (100, &[])]);
        let bound = deepest(&graph, 0, &BTreeSet::new());
        assert_eq!((bound.bytes, bound.path.as_slice(), bound.holds()), (108, &[0, 3][..], true));
        let without = deepest(&graph, 0, &BTreeSet::from([1]));
        assert_eq!(without.bytes, 108);
        assert_eq!(deepest(&graph, 1, &BTreeSet::from([2])).bytes, 32, "its own frame counts");
    }

    #[test]
    fn recursion_is_named_and_no_bound_is_claimed() {
        let graph = graph(&[(8, &[1]), (16, &[2]), (32, &[1, 3]), (64, &[])]);
        let bound = deepest(&graph, 0, &BTreeSet::new());
        assert_eq!(bound.recursive, BTreeSet::from([1, 2]));
        assert!(!bound.holds());
        assert!(deepest(&graph, 3, &BTreeSet::new()).holds(), "the circle is not reached");
    }

    #[test]
    fn a_call_through_a_register_or_to_nowhere_leaves_no_bound() {
        let mut calls = graph(&[(8, &[1]), (16, &[])]);
        calls.nodes[1].register_calls = 1;
        assert_eq!(deepest(&calls, 0, &BTreeSet::new()).through_register, BTreeSet::from([1]));
        let mut calls = graph(&[(8, &[1]), (16, &[])]);
        calls.nodes[1].stray_calls = 1;
        assert_eq!(deepest(&calls, 0, &BTreeSet::new()).unknown, BTreeSet::from([1]));
        let mut calls = graph(&[(8, &[])]);
        calls.nodes[0].decoded = None;
        assert!(!deepest(&calls, 0, &BTreeSet::new()).holds());
        calls.nodes[0].recorded = Some(8);
        assert!(deepest(&calls, 0, &BTreeSet::new()).holds(), "the record is enough");
    }
}
