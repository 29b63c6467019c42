use std::process::Command;

use ihex::Reader;
use tempfile::tempdir;

use super::*;
use crate::test_tools;

fn image(length: usize) -> Vec<u8> {
    (0..length).map(|index| (index * 7 + index / 256) as u8).collect()
}

/// The example of the format's article on Wikipedia has the same shape: `:02…04` sets the
/// upper half, `:10` is a full line, `:00000001FF` the end.
#[test]
fn lines_are_those_of_the_format() {
    let expected = ":02000004103FAB\n\
                    :1000000000070E151C232A31383F464D545B6269A8\n\
                    :0400100070777E8502\n\
                    :00000001FF\n";
    assert_eq!(encode(&image(20), 0x103f_0000).unwrap(), expected);
}

#[test]
fn every_64_kib_border_gets_its_own_address_record() {
    let text = encode(&image(24), 0x1000_fff8).unwrap();
    let records: Vec<Record> = Reader::new(&text).map(Result::unwrap).collect();
    let expected = [
        Record::ExtendedLinearAddress(0x1000),
        Record::Data { offset: 0xfff8, value: image(24)[..8].to_vec() },
        Record::ExtendedLinearAddress(0x1001),
        Record::Data { offset: 0, value: image(24)[8..].to_vec() },
        Record::EndOfFile,
    ];
    assert_eq!(records, expected);
}

#[test]
fn the_last_address_is_reached_and_not_passed() {
    assert!(encode(&image(16), 0xffff_fff0).unwrap().contains(":10FFF000"));
    assert!(encode(&image(17), 0xffff_fff0).is_err());
    assert!(encode(&image(16), 0x1000_0002).is_err());
}

#[test]
fn gnu_objcopy_reads_back_the_same_bytes_at_the_same_address() {
    let Some(objcopy) = test_tools::find("objcopy") else { return };
    let folder = tempdir().unwrap();
    for (length, address) in [(1, 0x103f_0000_u32), (1500, 0x103f_0000), (70_000, 0x0806_fff4)] {
        let (hex, bin) = (folder.path().join("a.hex"), folder.path().join("a.bin"));
        std::fs::write(&hex, encode(&image(length), address).unwrap()).unwrap();
        let run = Command::new(&objcopy)
            .args(["-I", "ihex", "-O", "binary"])
            .args([&hex, &bin])
            .status()
            .unwrap();
        assert!(run.success());
        assert!(std::fs::read(&bin).unwrap() == image(length), "{length} bytes at {address:#x}");

        // S-records state every address in full, so their first line shows where data starts.
        let srec = folder.path().join("a.srec");
        let run = Command::new(&objcopy)
            .args(["-I", "ihex", "-O", "srec", "--srec-forceS3"])
            .args([&hex, &srec])
            .status()
            .unwrap();
        assert!(run.success());
        let text = std::fs::read_to_string(&srec).unwrap();
        let first = text.lines().find(|line| line.starts_with("S3")).unwrap();
        assert_eq!(first[4..12], format!("{address:08X}"));
    }
}
