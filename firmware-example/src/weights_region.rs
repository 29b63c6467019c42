//! The flash that a board's memory map keeps for weights.
#![expect(unsafe_code, reason = "only the linker knows where the region is")]

unsafe extern "C" {
    static _weights_start: u8;
    static _weights_end: u8;
}

/// What lies there: a weight blob at the start, or whatever else. It starts at a multiple of 4 bytes.
pub fn bytes() -> &'static [u8] {
    let (start, end) = (&raw const _weights_start, &raw const _weights_end);
    // SAFETY: memory.x reserves the bytes between the two and nothing in the program writes them.
    unsafe { core::slice::from_raw_parts(start, end.addr() - start.addr()) }
}
