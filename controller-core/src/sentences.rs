//! One text for people at a terminal and for the log of a device.

/// Implements `Display` and, for the log of a device, `defmt::Format` with the same sentences.
///
/// The log gets the sentence's number and its values; the words stay on the host that decodes it.
/// Formatting `Display` on the device instead would link the standard formatter: some 20 KB, calls
/// through pointers that leave the stack without a bound, and panics in its float conversion.
///
/// A sentence may use what both know: `{}`, `{:x}` and its padded forms, by position.
///
/// ```
/// enum Fault {
///     Silent { beam: usize },
///     Off,
/// }
/// controller_core::sentences! { Fault {
///     Self::Silent { beam } => "beam {} is silent", beam;
///     Self::Off => "no power";
/// } }
///
/// assert_eq!(Fault::Silent { beam: 3 }.to_string(), "beam 3 is silent");
/// assert_eq!(Fault::Off.to_string(), "no power");
/// ```
///
/// For a type with parameters, each of which has sentences of its own: `impl<E> Fault<E> { … }`.
#[macro_export]
macro_rules! sentences {
    (impl<$($parameter:ident),+> $type:ty {
        $($pattern:pat => $text:literal $(, $value:expr)*;)+
    }) => {
        impl<$($parameter: ::core::fmt::Display),+> ::core::fmt::Display for $type {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                match self {
                    $($pattern => ::core::write!(f, $text $(, $value)*),)+
                }
            }
        }

        #[cfg(feature = "defmt")]
        impl<$($parameter: defmt::Format),+> defmt::Format for $type {
            fn format(&self, f: defmt::Formatter<'_>) {
                match self {
                    $($pattern => defmt::write!(f, $text $(, $value)*),)+
                }
            }
        }
    };
    ($type:ty { $($pattern:pat => $text:literal $(, $value:expr)*;)+ }) => {
        impl ::core::fmt::Display for $type {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                match self {
                    $($pattern => ::core::write!(f, $text $(, $value)*),)+
                }
            }
        }

        #[cfg(feature = "defmt")]
        impl defmt::Format for $type {
            fn format(&self, f: defmt::Formatter<'_>) {
                match self {
                    $($pattern => defmt::write!(f, $text $(, $value)*),)+
                }
            }
        }
    };
}
