//! RISC-V instructions of 32 bits, compressed ones included (The RISC-V Instruction Set Manual, volume I).

use super::{Flow, Instruction, Stack, signed};

const SP: u32 = 2;
const RA: u32 = 1;

/// The register that an AUIPC filled, and with what.
pub(super) type Upper = Option<(u32, u32)>;

/// The instruction that these bytes begin with; none if they are cut. `before` is what the
/// instruction in front of it left: a far call is a pair.
pub(super) fn decode(bytes: &[u8], address: u32, before: Upper) -> Option<Instruction> {
    let first = u16::from_le_bytes(bytes.get(..2)?.try_into().ok()?);
    if first & 3 == 3 {
        let code = u32::from_le_bytes(bytes.get(..4)?.try_into().ok()?);
        Some(Instruction { bytes: 4, stack: stack(code), flow: flow(code, address, before) })
    } else {
        let (stack, flow) = compressed(u32::from(first), address);
        Some(Instruction { bytes: 2, stack, flow })
    }
}

/// What AUIPC leaves in its register, if it is one.
pub(super) fn upper_part(bytes: &[u8], address: u32) -> Upper {
    let code = u32::from_le_bytes(bytes.get(..4)?.try_into().ok()?);
    (code & 0x7f == 0x17).then(|| (code >> 7 & 31, address.wrapping_add(code & 0xffff_f000)))
}

fn stack(code: u32) -> Stack {
    let (to, from) = (code >> 7 & 31, code >> 15 & 31);
    match code & 0x707f {
        // ADDI sp, sp, n
        0x13 if to == SP && from == SP => taken(signed(code >> 20, 12)),
        // ADD or SUB sp, register, register
        0x33 if to == SP => Stack::Unknown,
        _ => Stack::Same,
    }
}

fn flow(code: u32, address: u32, before: Upper) -> Flow {
    let (link, base) = (code >> 7 & 31, code >> 15 & 31);
    let pair = before.filter(|(register, _)| *register == base);
    let target = pair.map(|(_, upper)| upper.wrapping_add(signed(code >> 20, 12)));
    match code & 0x7f {
        // JAL
        0x6f => {
            let offset = (code >> 31) << 20
                | (code >> 12 & 0xff) << 12
                | (code >> 20 & 1) << 11
                | (code >> 21 & 0x3ff) << 1;
            let target = address.wrapping_add(signed(offset, 21));
            if link == 0 { Flow::Jump(target) } else { Flow::Call(target) }
        }
        // JALR
        0x67 => match (link, target) {
            (0, Some(target)) => Flow::Jump(target),
            (0, None) if base == RA => Flow::On,
            (0, None) => Flow::JumpRegister,
            (_, Some(target)) => Flow::Call(target),
            (_, None) => Flow::CallRegister,
        },
        // A conditional branch reaches 4 KiB: compilers keep it inside the function, assembly need not.
        0x63 => {
            let offset = (code >> 31) << 12
                | (code >> 7 & 1) << 11
                | (code >> 25 & 0x3f) << 5
                | (code >> 8 & 0xf) << 1;
            Flow::Jump(address.wrapping_add(signed(offset, 13)))
        }
        _ => Flow::On,
    }
}

fn compressed(code: u32, address: u32) -> (Stack, Flow) {
    let (register, other) = (code >> 7 & 31, code >> 2 & 31);
    let bit = |from: u32, to: u32| (code >> from & 1) << to;
    match (code & 3, code >> 13) {
        // C.ADDI sp
        (1, 0) if register == SP => (taken(signed(bit(12, 5) | other, 6)), Flow::On),
        // C.ADDI16SP
        (1, 3) if register == SP => {
            let amount = bit(12, 9) | bit(6, 4) | bit(5, 6) | (code >> 3 & 3) << 7 | bit(2, 5);
            (taken(signed(amount, 10)), Flow::On)
        }
        // C.JAL and C.J
        (1, form @ (1 | 5)) => {
            let offset = bit(12, 11)
                | bit(11, 4)
                | (code >> 9 & 3) << 8
                | bit(8, 10)
                | bit(7, 6)
                | bit(6, 7)
                | (code >> 3 & 7) << 1
                | bit(2, 5);
            let target = address.wrapping_add(signed(offset, 12));
            (Stack::Same, if form == 1 { Flow::Call(target) } else { Flow::Jump(target) })
        }
        // C.JR and C.JALR, with no second register
        (2, 4) if other == 0 && register != 0 => {
            let flow = match (code >> 12 & 1, register) {
                (1, _) => Flow::CallRegister,
                (_, RA) => Flow::On,
                _ => Flow::JumpRegister,
            };
            (Stack::Same, flow)
        }
        // C.ADD sp; a plain C.MV into sp restores it.
        (2, 4) if register == SP && code >> 12 & 1 == 1 => (Stack::Unknown, Flow::On),
        _ => (Stack::Same, Flow::On),
    }
}

/// A change of the stack pointer as what it takes.
fn taken(change: u32) -> Stack {
    if (change as i32) < 0 { Stack::Takes(change.wrapping_neg()) } else { Stack::Same }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values are those of `objdump -d` for the same words.
    fn at_1000(code: u32) -> Instruction {
        decode(&code.to_le_bytes(), 0x1000, None).expect("whole")
    }

    #[test]
    fn every_way_to_take_stack_is_seen_with_its_bytes() {
        for (code, taken) in [
            (0xff01_0113, 16),   // addi sp, sp, -16
            (0x8001_0113, 2048), // addi sp, sp, -2048
            (0x1141, 16),        // c.addi sp, -16
            (0x7179, 48),        // c.addi16sp sp, -48
            (0x7101, 512),       // c.addi16sp sp, -512
        ] {
            assert_eq!(at_1000(code).stack, Stack::Takes(taken), "{code:08x}");
        }
        assert_eq!(at_1000(0x6145).stack, Stack::Same, "c.addi16sp sp, 48");
        assert_eq!(at_1000(0x4051_0133).stack, Stack::Unknown, "sub sp, sp, t0");
    }

    #[test]
    fn calls_and_jumps_lead_where_the_disassembler_says() {
        for (code, flow) in [
            (0x0080_00ef, Flow::Call(0x1008)), // jal 0x1008
            (0xff9f_f0ef, Flow::Call(0x0ff8)), // jal 0xff8
            (0x0080_006f, Flow::Jump(0x1008)), // j 0x1008
            (0x2021, Flow::Call(0x1008)),      // c.jal 0x1008
            (0xa001, Flow::Jump(0x1000)),      // c.j 0x1000
            (0xbffd, Flow::Jump(0x0ffe)),      // c.j 0xffe
            (0x0005_0463, Flow::Jump(0x1008)), // beqz a0, 0x1008
            (0x8082, Flow::On),                // ret
            (0x8782, Flow::JumpRegister),      // jr a5
            (0x9782, Flow::CallRegister),      // jalr a5
            (0x0000_8067, Flow::On),           // ret, long
        ] {
            assert_eq!(at_1000(code).flow, flow, "{code:08x}");
        }
    }

    #[test]
    fn a_far_call_is_a_pair_of_instructions() {
        let auipc_ra = 0x0000_1097_u32.to_le_bytes();
        let upper = upper_part(&auipc_ra, 0x1000);
        assert_eq!(upper, Some((1, 0x2000)));
        let jalr_ra = 0xff80_80e7_u32.to_le_bytes();
        let call = decode(&jalr_ra, 0x1004, upper).expect("whole");
        assert_eq!(call.flow, Flow::Call(0x1ff8));
        assert_eq!(decode(&jalr_ra, 0x1004, None).expect("whole").flow, Flow::CallRegister);
    }
}
