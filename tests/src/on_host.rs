//! What the host computes, one drive at a time: the reference, made anew in every proof.

use controller_core::blob::{Blob, WrongTopology};
use controller_core::control_loop::Decide;
use controller_core::controller::{Command, Controller};
use controller_core::network::{Elman, Feedforward, Recurrence, RecurrenceKind, SelfLoop, State};
use controller_core::observation::{Reading, ReadingError};

use crate::closed_loop::{Bits, ClosedLoop, HIDDEN, Inspect, OUTPUTS};
use crate::course::Course;
use crate::files::Case;
use crate::prove::Machine;

/// The host as a machine like any board.
#[derive(Clone, Copy, Debug)]
pub struct Host;

impl Machine for Host {
    type Controller<'w> = Box<dyn Inspect + 'w>;
    type Refusal = WrongTopology;

    fn controller<'w>(blob: &Blob<'w>) -> Result<Self::Controller<'w>, WrongTopology> {
        match blob.header().topology.recurrence {
            RecurrenceKind::Feedforward => controller::<Feedforward>(blob),
            RecurrenceKind::SelfLoop => controller::<SelfLoop>(blob),
            RecurrenceKind::Elman => controller::<Elman>(blob),
        }
    }
}

fn controller<'w, R: Recurrence + 'w>(
    blob: &Blob<'w>,
) -> Result<Box<dyn Inspect + 'w>, WrongTopology> {
    let network = blob.network::<R, HIDDEN, OUTPUTS>()?;
    Ok(Box::new(Controller::new(network, blob.header().activation, blob.scaling())))
}

impl Decide for Box<dyn Inspect + '_> {
    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command {
        (**self).decide(reading)
    }
}

impl Inspect for Box<dyn Inspect + '_> {
    fn outputs(&self) -> &[f32; OUTPUTS] {
        (**self).outputs()
    }

    fn state(&self) -> &State<f32, HIDDEN> {
        (**self).state()
    }
}

/// The steps of a case, one after the other, for ever.
///
/// # Errors
///
/// A network of another size.
pub fn steps<'b>(
    blob: &'b Blob<'_>,
    case: Case,
) -> Result<impl Iterator<Item = Bits> + use<'b>, WrongTopology> {
    let mut controller = Host::controller(blob)?;
    let mut car = ClosedLoop::new(blob.header(), Course::Seeded(case.seed));
    Ok(std::iter::repeat_with(move || car.step(&mut controller)))
}
