//! A board as a machine in a proof: what drives there is what drives a car.

use crate::brain::{Brain, HIDDEN, OUTPUTS, Refusal};
use controller_core::blob::Blob;
use controller_core::network::State;
use equivalence_tests::closed_loop::Inspect;
use equivalence_tests::prove::Machine;

impl Inspect for Brain<'_, HIDDEN, OUTPUTS> {
    fn outputs(&self) -> &[f32; OUTPUTS] {
        self.outputs()
    }

    fn state(&self) -> &State<f32, HIDDEN> {
        self.state()
    }
}

/// Whatever board runs this.
#[derive(Clone, Copy, Debug)]
pub struct Board;

impl Machine for Board {
    type Controller<'w> = Brain<'w, HIDDEN, OUTPUTS>;
    type Refusal = Refusal;

    fn controller<'w>(blob: &Blob<'w>) -> Result<Self::Controller<'w>, Refusal> {
        Brain::new(blob)
    }
}
