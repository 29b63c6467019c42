//! Thumb instructions (Arm DDI 0403, chapter A7; DDI 0419 for ARMv6-M).

use super::{Flow, Instruction, Stack, signed};

const LR: u16 = 14;

/// The instruction that these bytes begin with; none if they are cut.
pub(super) fn decode(bytes: &[u8], address: u32) -> Option<Instruction> {
    let half = |at: usize| Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
    let first = half(0)?;
    // A branch counts from two instructions further on.
    let pc = address.wrapping_add(4);
    // A7.1: three patterns of the first five bits begin a long instruction.
    if first >> 11 >= 0b11101 {
        let (stack, flow) = long(first, half(2)?, pc);
        Some(Instruction { bytes: 4, stack, flow })
    } else {
        let (stack, flow) = short(first, pc);
        Some(Instruction { bytes: 2, stack, flow })
    }
}

fn short(code: u16, pc: u32) -> (Stack, Flow) {
    let bits = u32::from(code);
    let register = code >> 3 & 0x0f;
    let stack = match code {
        // PUSH: r0 to r7 and lr.
        _ if code & 0xfe00 == 0xb400 => Stack::Takes(4 * (bits & 0x1ff).count_ones()),
        // SUB SP, #
        _ if code & 0xff80 == 0xb080 => Stack::Takes(4 * (bits & 0x7f)),
        // ADD SP, register, and MOV SP, register.
        _ if code & 0xff87 == 0x4485 || code & 0xff87 == 0x4685 => Stack::Unknown,
        _ => Stack::Same,
    };
    let flow = match code {
        // BX; through lr it returns.
        _ if code & 0xff87 == 0x4700 && register != LR => Flow::JumpRegister,
        // BLX
        _ if code & 0xff87 == 0x4780 => Flow::CallRegister,
        // B
        _ if code & 0xf800 == 0xe000 => Flow::Jump(pc.wrapping_add(signed(bits << 1, 12))),
        // B<condition>; the two highest are UDF and SVC. MOV PC and TBB go through tables.
        _ if code & 0xf000 == 0xd000 && code & 0x0e00 != 0x0e00 => {
            Flow::Jump(pc.wrapping_add(signed(bits << 1, 9)))
        }
        _ => Flow::On,
    };
    (stack, flow)
}

fn long(first: u16, second: u16, pc: u32) -> (Stack, Flow) {
    let (high, low) = (u32::from(first), u32::from(second));
    // With its highest bit set the second half would be a branch's.
    let into_sp = second & 0x8f00 == 0x0d00;
    let stack = match first {
        // PUSH.W
        0xe92d => Stack::Takes(4 * low.count_ones()),
        // STR register, [SP, #-n]!
        0xf84d if second & 0x0f00 == 0x0d00 => Stack::Takes(low & 0xff),
        // STRD registers, [SP, #-n]!
        0xe96d => Stack::Takes(4 * (low & 0xff)),
        // VPUSH
        0xed2d | 0xed6d if second & 0x0e00 == 0x0a00 => Stack::Takes(4 * (low & 0xff)),
        // SUB.W SP, SP, #
        _ if first & 0xfbef == 0xf1ad && into_sp => Stack::Takes(modified(immediate(high, low))),
        // SUBW SP, SP, #
        _ if first & 0xfbff == 0xf2ad && into_sp => Stack::Takes(immediate(high, low)),
        // SUB.W or ADD.W SP, SP, register
        _ if matches!(first & 0xffef, 0xebad | 0xeb0d) && into_sp => Stack::Unknown,
        _ => Stack::Same,
    };
    let branch = first & 0xf800 == 0xf000;
    let flow = match second & 0xd000 {
        0xd000 if branch => Flow::Call(pc.wrapping_add(far(high, low))),
        0x9000 if branch => Flow::Jump(pc.wrapping_add(far(high, low))),
        // The conditions from 14 on stand for other instructions.
        0x8000 if branch && first & 0x0380 != 0x0380 => {
            let offset = (high >> 10 & 1) << 20
                | (low >> 11 & 1) << 19
                | (low >> 13 & 1) << 18
                | (high & 0x3f) << 12
                | (low & 0x7ff) << 1;
            Flow::Jump(pc.wrapping_add(signed(offset, 21)))
        }
        _ => Flow::On,
    };
    (stack, flow)
}

/// Offset of BL and of B.W (A7.7.12, encoding T4).
fn far(high: u32, low: u32) -> u32 {
    let sign = high >> 10 & 1;
    let bit_23 = !(low >> 13 ^ sign) & 1;
    let bit_22 = !(low >> 11 ^ sign) & 1;
    let offset =
        sign << 24 | bit_23 << 23 | bit_22 << 22 | (high & 0x3ff) << 12 | (low & 0x7ff) << 1;
    signed(offset, 25)
}

/// The twelve bits of an immediate operand.
fn immediate(high: u32, low: u32) -> u32 {
    (high >> 10 & 1) << 11 | (low >> 12 & 7) << 8 | low & 0xff
}

/// What twelve bits stand for (A5.3.2).
fn modified(bits: u32) -> u32 {
    let byte = bits & 0xff;
    match bits >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte * 0x0101_0101,
        _ => (0x80 | bits & 0x7f).rotate_right(bits >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values are those of `objdump -d` for the same bytes.
    fn at_1000(bytes: &[u8]) -> Instruction {
        decode(bytes, 0x1000).expect("whole")
    }

    #[test]
    fn every_way_to_take_stack_is_seen_with_its_bytes() {
        for (bytes, taken) in [
            (&[0xf0, 0xb5][..], 20),           // push {r4, r5, r6, r7, lr}
            (&[0x84, 0xb0], 16),               // sub sp, #16
            (&[0x2d, 0xe9, 0xf0, 0x4f], 36),   // push.w {r4-r11, lr}
            (&[0x4d, 0xf8, 0x04, 0x8d], 4),    // str r8, [sp, #-4]!
            (&[0x6d, 0xe9, 0x02, 0x45], 8),    // strd r4, r5, [sp, #-8]!
            (&[0x2d, 0xed, 0x10, 0x8b], 64),   // vpush {d8-d15}
            (&[0xad, 0xf5, 0x80, 0x6d], 1024), // sub.w sp, sp, #1024
            (&[0xad, 0xf1, 0x80, 0x0d], 128),  // sub.w sp, sp, #128
            (&[0xad, 0xf6, 0x0c, 0x0d], 2060), // subw sp, sp, #2060
        ] {
            assert_eq!(at_1000(bytes).stack, Stack::Takes(taken), "{bytes:02x?}");
        }
        assert_eq!(at_1000(&[0xa5, 0x44]).stack, Stack::Unknown, "add sp, r4");
        assert_eq!(at_1000(&[0xbd, 0xf5, 0x44, 0xad]).stack, Stack::Same, "bvs.w");
        assert_eq!(at_1000(&[0x04, 0xb0]).stack, Stack::Same, "add sp, #16");
        assert_eq!(at_1000(&[0xf0, 0xbd]).stack, Stack::Same, "pop {{r4, r5, r6, r7, pc}}");
    }

    #[test]
    fn calls_and_jumps_lead_where_the_disassembler_says() {
        for (bytes, flow) in [
            (&[0x00, 0xf0, 0x00, 0xf8][..], Flow::Call(0x1004)),
            (&[0xff, 0xf7, 0xfe, 0xff], Flow::Call(0x1000)),
            (&[0xff, 0xf7, 0xfe, 0xbf], Flow::Jump(0x1000)),
            (&[0x00, 0xf0, 0x02, 0xb8], Flow::Jump(0x1008)),
            (&[0x3f, 0xf4, 0xfe, 0xaf], Flow::Jump(0x1000)), // beq.w
            (&[0xfe, 0xe7], Flow::Jump(0x1000)),
            (&[0xfe, 0xd0], Flow::Jump(0x1000)),
            (&[0x98, 0x47], Flow::CallRegister),
            (&[0x18, 0x47], Flow::JumpRegister),
            (&[0x70, 0x47], Flow::On),             // bx lr
            (&[0x00, 0xde], Flow::On),             // udf
            (&[0xdf, 0xe8, 0x00, 0xf0], Flow::On), // tbb [pc, r0]
        ] {
            assert_eq!(at_1000(bytes).flow, flow, "{bytes:02x?}");
        }
        assert_eq!(decode(&[0x00, 0xf0, 0x00], 0), None, "cut");
    }
}
