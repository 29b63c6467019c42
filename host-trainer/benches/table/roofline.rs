//! How near a step comes to what the machine can do.
//!
//! The bound of a part is the longest of: its sums, products, comparisons and selections at the
//! rate of sums and products in turn; its quotients and square roots at theirs; its bytes at the
//! first cache's. A CPU does all three at once, so no program is faster.

use crate::beams::Cost;
use crate::driving::Driving;
use crate::networks::Times;
use crate::peaks::Peaks;
use crate::row::Row;
use controller_core::observation::BEAMS;
use host_trainer::bench::operations::{self, Operations};
use host_trainer::problem::Problem;
use host_trainer::vector::Instructions;
use host_trainer::wide::SLOTS;

/// Bytes that a network step reads and writes: each weight once for all cars of a lane; each
/// input and hidden output of a layer once per neuron.
fn network_bytes() -> f64 {
    const H: u64 = 12;
    const I: u64 = 7;
    let weights = (H * I + 3 * H * H + 2 * H + H + 1) as f64 / SLOTS as f64;
    let read = H * (I + H) + H * (H + H) + H;
    let written = 2 * H + 1;
    4.0 * (weights + (read + written) as f64)
}

fn bound(work: &Operations, bytes: f64, peaks: &Peaks) -> f64 {
    let simple = work.simple() as f64 / peaks.mixed;
    let slow = work.div as f64 / peaks.div + work.sqrt as f64 / peaks.sqrt;
    simple.max(slow).max(bytes / peaks.near)
}

/// The lines of the table: nanoseconds per step on one thread, with the bound beside.
pub(crate) fn rows(
    problem: &Problem,
    driving: &Driving,
    networks: &Times,
    here: &Cost,
    peaks: &[(Instructions, Peaks)],
) -> Vec<Row> {
    let parts = operations::of_a_step(problem);
    let beams = parts.beam_and_wall.times(BEAMS as u64);
    let mut rows = Vec::new();
    for (name, part) in
        [("network", parts.network), ("car", parts.car), ("5 beams, a wall each", beams)]
    {
        rows.push(Row::new(
            "operations",
            format!("{name}, simple"),
            part.simple() as f64,
            "per step",
        ));
        let slow = (part.div + part.sqrt) as f64;
        rows.push(Row::new("operations", format!("{name}, quotients and roots"), slow, "per step"));
    }
    for (set, peaks) in peaks {
        let Some(step) = driving.step(*set) else { continue };
        let network = networks.iter().find(|(way, _)| *way == Some(*set));
        let network = network.map_or(f64::NAN, |(_, time)| *time);
        let network_bound = bound(&parts.network, network_bytes(), peaks);
        let car_bound = bound(&parts.car, 0.0, peaks);
        let beams_bound = bound(&beams, 0.0, peaks);
        let share = |part: &str, time: f64, bound: f64| {
            Row::new("roofline", format!("{set}, {part}"), time, "ns per step")
                .beside_time("bound", bound)
        };
        rows.push(share("network", network, network_bound));
        if *set == Instructions::in_use() {
            let (sensing, contacts) = (here.beam * BEAMS as f64, here.contact);
            rows.push(share("beams", sensing, beams_bound));
            rows.push(Row::new("roofline", format!("{set}, contacts"), contacts, "ns per step"));
            rows.push(share("rest", step - network - sensing - contacts, car_bound));
        }
        rows.push(share("whole", step, network_bound + car_bound + beams_bound));
    }
    rows
}
