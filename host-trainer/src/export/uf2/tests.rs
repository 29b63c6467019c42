use std::io::Write;
use std::process::{Command, Stdio};

use super::*;
use crate::test_tools;

fn image(length: usize) -> Vec<u8> {
    (0..length).map(|index| (index * 7 + index / 256) as u8).collect()
}

#[test]
fn a_block_has_the_published_layout() {
    let file = encode(b"weights", 0x103f_0000, Family::ABSOLUTE, PAYLOAD).unwrap();
    assert_eq!(file.len(), 512);
    // Copied from the table in the format's description, field by field.
    let header = [
        b'U', b'F', b'2', b'\n', 0x57, 0x51, 0x5d, 0x9e, // magic numbers
        0x00, 0x20, 0x00, 0x00, // flags: family id present
        0x00, 0x00, 0x3f, 0x10, // address
        0x00, 0x01, 0x00, 0x00, // bytes of payload
        0x00, 0x00, 0x00, 0x00, // number of this block
        0x01, 0x00, 0x00, 0x00, // number of blocks
        0x57, 0xff, 0x8b, 0xe4, // family id
    ];
    assert_eq!(file[..32], header);
    assert_eq!(&file[32..39], b"weights");
    assert!(file[39..508].iter().all(|byte| *byte == 0xff));
    assert_eq!(file[508..], [0x30, 0x6f, 0xb1, 0x0a]);
}

#[test]
fn the_last_sector_is_filled_with_what_erased_flash_holds() {
    let blocks = |length, address, unit| {
        encode(&image(length), address, Family::ABSOLUTE, unit).unwrap().len() / BLOCK
    };
    assert_eq!(blocks(1500, 0x103f_0000, PAYLOAD), 6);
    assert_eq!(blocks(1500, 0x103f_0000, 4096), 16);
    assert_eq!(blocks(4096, 0x103f_0000, 4096), 16);
    assert_eq!(blocks(4097, 0x103f_0000, 4096), 32);
    assert_eq!(blocks(256, 0x103f_0f00, 4096), 1, "up to the end of its sector");
}

#[test]
fn addresses_between_pages_and_past_the_end_are_refused() {
    let refusal = |length, address, unit| {
        encode(&image(length), address, Family::ABSOLUTE, unit).unwrap_err().to_string()
    };
    assert_eq!(
        refusal(1, 0x103f_0080, PAYLOAD),
        "a multiple of 256 expected, since a UF2 block holds one page of flash"
    );
    assert_eq!(
        refusal(257, 0xffff_ff00, PAYLOAD),
        "512 bytes from there end past 0xffffffff, the last address"
    );
    assert!(encode(&image(256), 0xffff_ff00, Family::ABSOLUTE, 4096).is_ok());
}

/// Reads the description of the format anew, in another language, strictly.
const DECODER: &str = r#"
import struct, sys
data = sys.stdin.buffer.read()
assert len(data) % 512 == 0
memory = {}
for number in range(len(data) // 512):
    block = data[512 * number:512 * (number + 1)]
    m0, m1, flags, address, size, index, count, family = struct.unpack_from("<8I", block)
    (end,) = struct.unpack_from("<I", block, 508)
    assert (m0, m1, end) == (0x0A324655, 0x9E5D5157, 0x0AB16F30)
    assert flags == 0x2000 and size == 256 and address % 256 == 0
    assert index == number and count == len(data) // 512
    assert address not in memory
    memory[address] = block[32:32 + size]
start = min(memory)
assert sorted(memory) == list(range(start, start + 256 * len(memory), 256))
sys.stdout.write(f"{start:#x} {family:#x} {b''.join(memory[a] for a in sorted(memory)).hex()}")
"#;

#[test]
fn a_decoder_in_python_finds_the_image_at_its_address() {
    let Some(python) = test_tools::find("python3") else { return };
    let family: Family = "rp2040".parse().unwrap();
    for (length, unit, filled) in [(1, 256, 256), (1500, 4096, 4096), (5000, 256, 5120)] {
        let mut child = Command::new(&python)
            .args(["-c", DECODER])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let file = encode(&image(length), 0x101f_0000, family, unit).unwrap();
        child.stdin.take().unwrap().write_all(&file).unwrap();
        let run = child.wait_with_output().unwrap();
        assert!(run.status.success());

        let mut expected = image(length);
        expected.resize(filled, 0xff);
        let hex: String = expected.iter().map(|byte| format!("{byte:02x}")).collect();
        let said = String::from_utf8(run.stdout).unwrap();
        assert!(said == format!("0x101f0000 0xe48bff56 {hex}"), "{length} bytes: {said}");
    }
}
