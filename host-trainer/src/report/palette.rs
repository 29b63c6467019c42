//! The colours of every picture, once, in a light and a dark form.
//!
//! SVG files carry the light form, because a file may be opened anywhere. A page overrides
//! it by attribute, so that the same picture follows the reader's colour scheme there.

use std::fmt::Write;

/// A role in a picture: its name in the page's style sheet, on light and on dark ground.
pub(super) struct Colour {
    pub(super) name: &'static str,
    pub(super) light: &'static str,
    pub(super) dark: &'static str,
}

macro_rules! palette {
    ($($role:ident $name:literal $light:literal $dark:literal)*) => {
        $(pub(super) const $role: &str = $light;)*
        /// Every role.
        pub(super) const ALL: &[Colour] =
            &[$(Colour { name: $name, light: $light, dark: $dark }),*];
    };
}

palette! {
    PAPER     "paper"     "#fefefe" "#171b21"
    INK       "ink"       "#1f2733" "#e4e8ee"
    MUTED     "muted"     "#5c6776" "#9aa5b4"
    RULE      "rule"      "#dfe3e9" "#313945"
    WALL      "wall"      "#4a5565" "#77859a"
    PATH      "path"      "#2160c4" "#74adff"
    START     "start"     "#1447a6" "#a3c8ff"
    GOAL      "goal"      "#16803f" "#43c97c"
    GOAL_SOFT "goal-soft" "#cdebd8" "#1d4a31"
    COLLISION "collision" "#cf2626" "#ff6f66"
    LOOP      "loop"      "#b45f06" "#f5ae3c"
    BODY      "body"      "#f2b705" "#f2c230"
    BAND      "band"      "#7d8ba0" "#8190a6"
}

/// The palette as custom properties, and the rules that make pictures use them.
pub(super) fn style_sheet() -> String {
    let declare = |out: &mut String, value: fn(&Colour) -> &'static str| {
        for colour in ALL {
            let _ = write!(out, "--{}:{};", colour.name, value(colour));
        }
    };
    let mut css = String::from(":root{");
    declare(&mut css, |c| c.light);
    css.push_str("}\n@media (prefers-color-scheme:dark){:root{");
    declare(&mut css, |c| c.dark);
    css.push_str("}}\n");
    for Colour { name, light, .. } in ALL {
        for paint in ["fill", "stroke"] {
            let _ = writeln!(css, "[{paint}=\"{light}\"]{{{paint}:var(--{name})}}");
        }
    }
    css
}
