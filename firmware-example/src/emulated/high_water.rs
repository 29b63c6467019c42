//! How deep the stack has been: `cortex-m-rt` paints it before the program starts, and what is not paint any more
//! was used.
#![expect(unsafe_code, reason = "only the linker knows where the stack is")]

use cortex_m_rt::STACK_PAINT_VALUE;

unsafe extern "C" {
    static _stack_start: u32;
    static _stack_end: u32;
}

/// Bytes between the top of the stack and the deepest word that was ever written.
pub(super) fn bytes() -> usize {
    let (top, end) = (&raw const _stack_start, &raw const _stack_end);
    let words = (top.addr() - end.addr()) / size_of::<u32>();
    // SAFETY: between the two lies the stack's memory, all of it written by the painting.
    let painted = |index: &usize| unsafe { end.add(*index).read_volatile() } == STACK_PAINT_VALUE;
    let untouched = (0..words).take_while(painted).count();
    (words - untouched) * size_of::<u32>()
}
