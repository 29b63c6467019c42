//! How large each weight of a network is beside the others, typically.

use controller_core::network::Topology;

/// `√(3/n)` for every weight of a neuron with `n` inputs, in the order of the genome: with weights
/// of one spread times these, a neuron's sum has one spread however many inputs it has.
///
/// The memory of a recurrent layer counts as inputs of its own; a bias goes with its neuron.
pub(super) fn scales(topology: Topology) -> Vec<f32> {
    let [inputs, hidden, outputs] =
        [topology.inputs, topology.hidden, topology.outputs].map(usize::from);
    let memory = topology.recurrence.weights(hidden);
    let mut fan_ins = Vec::with_capacity(topology.weights());
    for (from, to, memory) in
        [(inputs, hidden, memory), (hidden, hidden, memory), (hidden, outputs, 0)]
    {
        fan_ins.extend(std::iter::repeat_n(from, from * to));
        fan_ins.extend(std::iter::repeat_n(hidden, memory));
        fan_ins.extend(std::iter::repeat_n(from, if topology.biases { to } else { 0 }));
    }
    fan_ins.into_iter().map(|fan_in| libm::sqrtf(3.0 / fan_in as f32)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brain;
    use controller_core::activation::ActivationKind;
    use controller_core::network::RecurrenceKind;

    fn topologies() -> impl Iterator<Item = Topology> {
        let kinds = [RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman];
        let of = |recurrence| {
            [false, true].map(|biases| Topology {
                inputs: 7,
                hidden: 12,
                outputs: 2,
                recurrence,
                biases,
            })
        };
        kinds.into_iter().flat_map(of)
    }

    #[test]
    fn there_is_one_for_every_weight() {
        for topology in topologies() {
            assert_eq!(scales(topology).len(), topology.weights(), "{topology:?}");
        }
    }

    /// Oracle: the network itself. With all memory at 0 and only the genes of 7 inputs set, the
    /// second hidden layer, which has 12, must stay at 0.
    #[test]
    fn the_genes_of_seven_inputs_are_those_of_the_first_layer() {
        let seven = libm::sqrtf(3.0 / 7.0);
        for topology in topologies() {
            let first = scales(topology).into_iter().map(|scale| f32::from(scale == seven));
            let genome: Vec<f32> = first.collect();
            let scaling = crate::car::scaling_of(&crate::scenario::Preset::Paper.scenario());
            let brain = brain::build(topology, ActivationKind::Rational, scaling, &genome).unwrap();
            let rest = brain.hidden();
            assert_eq!(brain.outputs(&[1.0; 7], &rest).unwrap(), [0.0; 2], "{topology:?}");
            let weights = genome.iter().sum::<f32>() as usize;
            assert_eq!(weights, 12 * (7 + usize::from(topology.biases)));
        }
    }
}
