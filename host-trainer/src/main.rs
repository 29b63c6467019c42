//! The `evosteer` command.
fn main() {}
