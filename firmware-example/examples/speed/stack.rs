//! How deep a call's stack reaches, by painting what lies below and looking how much is left.
#![expect(unsafe_code, reason = "memory below the stack pointer belongs to no variable")]

/// Paint: no address and no likely number.
const PAINT: u32 = 0xa5c3_96e1;

/// Words painted.
const WORDS: u32 = 1024;

/// Bytes of stack below this function that `call` uses, the measuring's own included.
///
/// # Errors
///
/// It uses all that was painted, or more.
#[inline(never)]
pub(crate) fn used(call: &mut dyn FnMut()) -> Result<u32, &'static str> {
    let top = cortex_m::register::msp::read();
    let words = || (1..=WORDS).map(|depth| ((top - 4 * depth) as *mut u32, depth));
    for (word, _) in words() {
        // SAFETY: it lies in this board's RAM, 4 MB of stack, below everything in use: there are no interrupts,
        // and whatever is called next writes before it reads.
        unsafe { word.write_volatile(PAINT) };
    }
    call();
    // SAFETY: as above; words that the call left behind are plain memory.
    let untouched = |word: *mut u32| unsafe { word.read_volatile() } == PAINT;
    let deepest = words().rev().find(|(word, _)| !untouched(*word)).map_or(0, |(_, depth)| depth);
    if deepest < WORDS { Ok(4 * deepest) } else { Err("a stack reaches deeper than was painted") }
}
