//! The weights, part by part of the network.

use controller_core::network::Topology;
use serde::Serialize;

/// Statistics of one part's weights.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Part {
    /// Which part.
    pub(super) part: &'static str,
    /// Number of weights.
    pub(super) count: usize,
    /// Smallest weight.
    pub(super) min: f32,
    /// Largest weight.
    pub(super) max: f32,
    /// Mean of the weights' magnitudes.
    pub(super) mean_abs: f64,
}

impl Part {
    fn of(part: &'static str, weights: &[f32]) -> Self {
        // f64 holds the sum of any blob's magnitudes exactly enough for four digits.
        let sum: f64 = weights.iter().map(|weight| f64::from(weight.abs())).sum();
        Self {
            part,
            count: weights.len(),
            min: weights.iter().copied().fold(f32::INFINITY, f32::min),
            max: weights.iter().copied().fold(f32::NEG_INFINITY, f32::max),
            mean_abs: sum / weights.len() as f64,
        }
    }
}

/// Parts that the network has, in the genome's order, then all weights together.
pub(super) fn parts(topology: Topology, weights: &[f32]) -> Vec<Part> {
    let [inputs, hidden, outputs] =
        [topology.inputs, topology.hidden, topology.outputs].map(usize::from);
    let recurrent = topology.recurrence.weights(hidden);
    let bias = |neurons: usize| if topology.biases { neurons } else { 0 };
    let sizes = [
        ("first hidden layer, from inputs", inputs * hidden),
        ("first hidden layer, recurrent", recurrent),
        ("first hidden layer, biases", bias(hidden)),
        ("second hidden layer, from first", hidden * hidden),
        ("second hidden layer, recurrent", recurrent),
        ("second hidden layer, biases", bias(hidden)),
        ("output layer, from second", hidden * outputs),
        ("output layer, biases", bias(outputs)),
    ];
    let mut rest = weights;
    let mut parts = Vec::new();
    for (part, count) in sizes {
        let (mine, after) = rest.split_at_checked(count).unwrap_or((rest, &[]));
        rest = after;
        if !mine.is_empty() {
            parts.push(Part::of(part, mine));
        }
    }
    parts.push(Part::of("all", weights));
    parts
}

#[cfg(test)]
mod tests {
    use controller_core::network::RecurrenceKind;

    use super::*;

    /// Every weight is its index, so a part's smallest is where it begins in the genome.
    #[test]
    fn parts_lie_in_the_genome_where_the_format_says() {
        let topology = Topology {
            inputs: 7,
            hidden: 12,
            outputs: 1,
            recurrence: RecurrenceKind::Elman,
            biases: true,
        };
        let weights: Vec<f32> = (0..553).map(|index| index as f32).collect();
        let found: Vec<(f32, f32, usize)> =
            parts(topology, &weights).iter().map(|part| (part.min, part.max, part.count)).collect();
        let expected = [
            (0.0, 83.0, 84),
            (84.0, 227.0, 144),
            (228.0, 239.0, 12),
            (240.0, 383.0, 144),
            (384.0, 527.0, 144),
            (528.0, 539.0, 12),
            (540.0, 551.0, 12),
            (552.0, 552.0, 1),
            (0.0, 552.0, 553),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_feedforward_network_without_biases_has_three_parts() {
        let topology = Topology {
            inputs: 7,
            hidden: 12,
            outputs: 1,
            recurrence: RecurrenceKind::Feedforward,
            biases: false,
        };
        let mut weights = vec![0.0; 240];
        weights[0] = -3.0;
        weights[83] = 1.2;
        let parts = parts(topology, &weights);
        let counts: Vec<usize> = parts.iter().map(|part| part.count).collect();
        assert_eq!(counts, [84, 144, 12, 240]);
        assert_eq!((parts[0].min, parts[0].max), (-3.0, 1.2));
        assert!((parts[0].mean_abs - 4.2 / 84.0).abs() < 1e-6);
    }
}
