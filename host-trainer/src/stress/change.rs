//! What became of a share when the same drives were driven again in another way.

use serde::Serialize;

/// The difference between two shares of the same drives, with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The second share less the first, -1 to 1.
    pub by: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

impl Change {
    /// From drives that counted before and count now.
    ///
    /// The interval is that of A. Agresti and Y. Min (2005) for matched pairs: half a drive is
    /// added to each of the four cells. Drives that end alike both times make it narrow, as they
    /// should: only those that end differently say anything.
    ///
    /// ```
    /// use host_trainer::stress::Change;
    ///
    /// // Of 100 drives 70 count both times, 8 only before and 2 only now.
    /// let drives = (0..100).map(|i| (i < 78, i < 70 || i >= 98));
    /// let Change { by, interval: [low, high] } = Change::between(drives);
    /// assert_eq!(format!("{by:.2}, {low:.4} to {high:.4}"), "-0.06, -0.1215 to 0.0039");
    /// ```
    pub fn between(drives: impl Iterator<Item = (bool, bool)>) -> Self {
        const Z: f64 = 1.959_963_984_540_054;
        let (mut all, mut lost, mut won) = (0.0, 0.0, 0.0);
        for (before, now) in drives {
            all += 1.0;
            lost += f64::from(u8::from(before && !now));
            won += f64::from(u8::from(now && !before));
        }
        let n = all + 2.0;
        let middle = (won - lost) / n;
        let spread = Z * ((lost + won + 1.0) / n - middle * middle).sqrt() / n.sqrt();
        let interval = [(middle - spread).max(-1.0), (middle + spread).min(1.0)];
        Self { by: (won - lost) / all, interval }
    }

    /// Whether the share fell by more than chance explains.
    pub fn is_a_fall(self) -> bool {
        self.interval[1] < 0.0
    }
}
