//! Whether a program has a heap.

use crate::call_graph::CallGraph;

/// What the compiler calls to take memory from a heap, and the crate whose types do.
const SIGNS: [&str; 3] = ["__rust_alloc", "__rust_realloc", "alloc::"];

/// Functions of a heap, or of types that need one.
pub(super) fn calls(graph: &CallGraph) -> Vec<String> {
    let of_heap = |name: &str| SIGNS.iter().any(|sign| starts_a_path(name, sign));
    graph.nodes.iter().map(|node| &node.name).filter(|name| of_heap(name)).cloned().collect()
}

/// Whether `name` has `sign` in it, not as the end of a longer word.
fn starts_a_path(name: &str, sign: &str) -> bool {
    let in_a_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b':';
    name.match_indices(sign)
        .any(|(at, _)| at == 0 || !in_a_word(name.as_bytes()[at - 1]) || sign.starts_with('_'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::call_graph::Node;

    #[test]
    fn a_heap_is_found_by_its_functions_and_by_the_types_that_need_one() {
        let names = [
            "__rustc::__rust_alloc",
            "<alloc::vec::Vec<u8>>::push",
            "alloc::raw_vec::finish_grow",
            "firmware_example::app::run",
            "my_alloc::steps",
        ];
        let nodes = names.map(|name| Node { name: name.into(), ..Node::default() });
        let graph = CallGraph { nodes: nodes.into() };
        assert_eq!(calls(&graph), names[..3]);
    }
}
