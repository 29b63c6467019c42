use super::*;
use crate::elf::Segment;

fn drive() -> &'static Drive {
    &boards::REAL[0].drive
}

fn program(bytes: &[u8]) -> Image {
    let segment = Segment { address: 0x1000_0000, bytes };
    Image::of(&[segment], &drive().flash).expect("it fits")
}

#[test]
fn a_block_has_the_published_layout() {
    let file = encode(&program(b"program"), drive());
    // Copied from the table in the format's description, field by field.
    let header = [
        b'U', b'F', b'2', b'\n', 0x57, 0x51, 0x5d, 0x9e, // magic numbers
        0x00, 0x20, 0x00, 0x00, // flags: family id present
        0x00, 0x00, 0x00, 0x10, // address
        0x00, 0x01, 0x00, 0x00, // bytes of payload
        0x00, 0x00, 0x00, 0x00, // number of this block
        0x10, 0x00, 0x00, 0x00, // number of blocks: a sector
        0x59, 0xff, 0x8b, 0xe4, // family id
    ];
    let block = &file[BLOCK..2 * BLOCK];
    assert_eq!(block[..32], header);
    assert_eq!(&block[32..39], b"program");
    assert!(block[39..288].iter().all(|byte| *byte == 0xff));
    assert!(block[288..508].iter().all(|byte| *byte == 0));
    assert_eq!(block[508..], [0x30, 0x6f, 0xb1, 0x0a]);
}

#[test]
fn the_first_block_is_the_cure_for_rp2350_e10_as_the_data_sheet_has_it() {
    let file = encode(&program(b"program"), drive());
    let block = &file[..BLOCK];
    let header = [
        b'U', b'F', b'2', b'\n', 0x57, 0x51, 0x5d, 0x9e, // magic numbers
        0x00, 0xa0, 0x00, 0x00, // flags: family id and extension tags present
        0x00, 0xff, 0x3f, 0x10, // address: the last page of 4 MiB
        0x00, 0x01, 0x00, 0x00, // bytes of payload
        0x00, 0x00, 0x00, 0x00, // number of this block
        0x02, 0x00, 0x00, 0x00, // number of blocks, one of which never comes
        0x57, 0xff, 0x8b, 0xe4, // family id: absolute
    ];
    assert_eq!(block[..32], header);
    // The tag has 4 bytes and no data; a length of 0 ends the list.
    assert_eq!(block[288..296], [0x04, 0xe3, 0x57, 0x99, 0, 0, 0, 0]);
    assert_eq!(block[508..], [0x30, 0x6f, 0xb1, 0x0a]);
}

#[test]
fn blocks_are_numbered_through_and_cover_flash_without_a_gap() {
    let file = encode(&program(&[7; 5000]), drive());
    assert_eq!(file.len(), (1 + 32) * BLOCK);
    for (number, block) in file.chunks(BLOCK).skip(1).enumerate() {
        let word = |at: usize| u32::from_le_bytes(block[at..at + 4].try_into().expect("4 bytes"));
        let number = number as u32;
        assert_eq!((word(12), word(20), word(24)), (0x1000_0000 + 256 * number, number, 32));
    }
}

#[test]
fn only_real_boards_have_such_a_drive() {
    let options = |board: &str| Options::parse(vec!["uf2".into(), board.into()]).expect("valid");
    assert_eq!(boards::chosen_real(&options("pico2")).expect("known"), [&boards::REAL[0]]);
    let failure = boards::chosen_real(&options("microbit")).expect_err("emulated");
    assert_eq!(failure.to_string(), "no real board `microbit`; expected one of: pico2");
}
