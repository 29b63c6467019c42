//! The file to drop onto a Pico 2's drive, read by a stranger: the formats' descriptions, in another language.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use equivalence_tests::checkout::Checkout;
use equivalence_tests::harness::{self, Test, Trouble};

/// Reads the ELF file and the UF2 file, compares, and says how many bytes the program has.
const READER: &str = r#"
import struct, sys
elf, uf2 = (open(name, "rb").read() for name in sys.argv[1:])

memory = {}
assert elf[:6] == b"\x7fELF\x01\x01"
headers, = struct.unpack_from("<I", elf, 28)
size, count = struct.unpack_from("<HH", elf, 42)
for number in range(count):
    kind, start, _, address, length = struct.unpack_from("<5I", elf, headers + size * number)
    if kind == 1:
        for offset in range(length):
            assert memory.setdefault(address + offset, elf[start + offset]) == elf[start + offset]

assert len(uf2) % 512 == 0
blocks = [uf2[at:at + 512] for at in range(0, len(uf2), 512)]
fields = [struct.unpack_from("<8I", block) for block in blocks]
assert all(block[508:] == b"\x30\x6f\xb1\x0a" for block in blocks)
assert all(field[:2] == (0x0A324655, 0x9E5D5157) for field in fields)

# Erratum RP2350-E10: one absolute block at the end of flash, number 0 of 2, which mended chips leave out.
assert fields[0][2:] == (0xA000, 0x103FFF00, 256, 0, 2, 0xE48BFF57), fields[0]
assert blocks[0][32:288] == b"\xef" * 256
assert blocks[0][288:296] == b"\x04\xe3\x57\x99" + bytes(4)

flash = b""
for number, (field, block) in enumerate(zip(fields[1:], blocks[1:])):
    expected = (0x2000, 0x10000000 + 256 * number, 256, number, len(blocks) - 1, 0xE48BFF59)
    assert field[2:] == expected, (field, expected)
    flash += block[32:288]
assert len(flash) % 4096 == 0 and 0x10000000 + len(flash) <= 0x103F0000
for address, byte in memory.items():
    assert flash[address - 0x10000000] == byte, hex(address)
for offset, byte in enumerate(flash):
    assert byte == 0xFF or memory.get(0x10000000 + offset) == byte, hex(0x10000000 + offset)

# The smallest Arm image of the data sheet's section 5.9.5, in the first 4 KiB; then the vector table.
block = struct.pack("<5I", 0xFFFFDED3, 0x10210142, 0x000001FF, 0, 0xAB123579)
at = flash.find(block)
assert 0 <= at <= 4096 - len(block) and at % 4 == 0, at
stack, reset = struct.unpack_from("<2I", flash)
assert 0x20000000 < stack <= 0x20082000 and reset & 1 and reset & ~1 in memory
print(len(memory))
"#;

fn main() -> ExitCode {
    let tests: &[Test] = &[
        ("the_file_for_the_drive_holds_the_program_byte_for_byte_and_would_boot", whole),
        ("a_file_or_program_with_one_byte_changed_is_noticed", changed),
    ];
    harness::main(tests)
}

fn whole() -> Result<(), Trouble> {
    let (elf, uf2) = build()?;
    let read = read(&elf, &uf2)?.map_err(Trouble::Failed)?;
    let bytes: usize = read.trim().parse().expect("the reader prints a number");
    if bytes > 10_000 { Ok(()) } else { Err(Trouble::Failed(format!("only {bytes} bytes"))) }
}

/// The reader has to be one that finds faults.
fn changed() -> Result<(), Trouble> {
    let (elf, uf2) = build()?;
    let good = std::fs::read(&uf2).expect("the file");
    let damaged = Path::new(env!("CARGO_TARGET_TMPDIR")).join("damaged.uf2");
    // A magic number, an address, a family, a byte of code, the waking block's tag, the last end marker.
    for place in [1, 512 + 12, 512 + 28, 512 + 32 + 200, 288, good.len() - 1] {
        let mut bytes = good.clone();
        bytes[place] ^= 1;
        std::fs::write(&damaged, &bytes).expect("a folder for tests");
        if read(&elf, &damaged)?.is_ok() {
            return Err(Trouble::Failed(format!("byte {place} was changed and nobody noticed")));
        }
    }
    std::fs::write(&damaged, &good[..good.len() - 512]).expect("a folder for tests");
    match read(&elf, &damaged)? {
        Ok(_) => Err(Trouble::Failed("the last block is missing and nobody noticed".into())),
        Err(_) => Ok(()),
    }
}

/// What the reader prints, or what it complains about.
fn read(elf: &Path, uf2: &Path) -> Result<Result<String, String>, Trouble> {
    let output = Command::new("python3")
        .args(["-c", READER])
        .args([elf, uf2])
        .output()
        .map_err(|error| Trouble::NotRun(format!("python3: {error}")))?;
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    Ok(if output.status.success() { Ok(text(&output.stdout)) } else { Err(text(&output.stderr)) })
}

/// The program and the file that `cargo xtask uf2` makes of it.
fn build() -> Result<(PathBuf, PathBuf), Trouble> {
    let uf2 = Checkout::compiled_in().made(&["uf2".as_ref(), "pico2".as_ref()])?;
    Ok((uf2.with_extension(""), uf2))
}
