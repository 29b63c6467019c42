//! What an instruction does to the stack and where it goes next: all that a stack bound asks.

mod riscv;
mod thumb;

/// An instruction set, by its ELF number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Machine {
    /// Thumb of ARMv6-M to ARMv8-M.
    Thumb,
    /// RISC-V of 32 bits with compressed instructions.
    Riscv,
}

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Instruction {
    /// Its length in bytes.
    pub(crate) bytes: usize,
    /// What it does to the stack pointer.
    pub(crate) stack: Stack,
    /// Where it goes.
    pub(crate) flow: Flow,
}

/// What an instruction does to the stack pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stack {
    /// Nothing, or it gives stack back.
    Same,
    /// It takes so many bytes.
    Takes(u32),
    /// It moves it by what is in a register.
    Unknown,
}

/// Where an instruction goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    /// To the next one, or back to the caller, or through a table of its own function.
    On,
    /// To this address, and comes back.
    Call(u32),
    /// To this address, and does not come back; another function's is a call in tail position.
    Jump(u32),
    /// To an address in a register, and comes back.
    CallRegister,
    /// To an address in a register; a table of its own function, or another function.
    JumpRegister,
}

impl Machine {
    /// By the header's `e_machine`.
    pub(crate) fn of(number: u16) -> Option<Self> {
        match number {
            40 => Some(Self::Thumb),
            243 => Some(Self::Riscv),
            _ => None,
        }
    }

    /// All instructions of a function, its constants left out; the last may be cut.
    pub(crate) fn instructions(
        self,
        code: &[u8],
        constants: &[(usize, usize)],
        address: u32,
    ) -> Vec<Instruction> {
        let mut instructions = Vec::new();
        let mut at = 0;
        let mut before = None;
        while at < code.len() {
            if let Some((_, end)) =
                constants.iter().find(|(start, end)| (*start..*end).contains(&at))
            {
                at = *end;
                continue;
            }
            let here = address.wrapping_add(at as u32);
            let decoded = match self {
                Self::Thumb => thumb::decode(&code[at..], here),
                Self::Riscv => riscv::decode(&code[at..], here, before),
            };
            let Some(instruction) = decoded else { break };
            before = riscv::upper_part(&code[at..], here);
            at += instruction.bytes;
            instructions.push(instruction);
        }
        instructions
    }
}

/// The lowest `bits` bits of a number as a signed one.
fn signed(value: u32, bits: u32) -> u32 {
    let unused = 32 - bits;
    ((value << unused) as i32 >> unused) as u32
}
