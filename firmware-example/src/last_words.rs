//! What a device says of a panic, without the standard formatter.

use core::panic::PanicInfo;

/// A panic in the log: where it happened, and its text unless values would have to be formatted into it.
///
/// The standard formatter would be the largest part of the program, there for this line only, and calls
/// through pointers, which leaves the stack without a bound.
pub(crate) struct LastWords<'a>(pub(crate) &'a PanicInfo<'a>);

impl defmt::Format for LastWords<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let text = self.0.message().as_str().unwrap_or("see the source for why");
        match self.0.location() {
            Some(place) => defmt::write!(
                f,
                "panic at {=str}:{=u32}:{=u32}: {=str}",
                place.file(),
                place.line(),
                place.column(),
                text
            ),
            None => defmt::write!(f, "panic: {=str}", text),
        }
    }
}
