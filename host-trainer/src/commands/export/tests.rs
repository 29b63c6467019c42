use std::fs;
use std::path::Path;

use clap::{Args, Command, FromArgMatches};
use controller_core::network::Feedforward;
use tempfile::{TempDir, tempdir};

use super::*;
use crate::fingerprint::sha256;
use crate::output::Page;
use crate::sample_blob::SampleBlob;

/// A folder with `champion.blob` in it, called `DIR` in what is printed.
struct Bench {
    folder: TempDir,
    blob: Vec<u8>,
}

/// What a call printed, and how it ended.
#[derive(Debug, PartialEq)]
struct Said {
    stdout: Vec<u8>,
    stderr: String,
    result: Result<(), (u8, String)>,
}

impl Bench {
    fn new() -> Self {
        let folder = tempdir().unwrap();
        let blob = SampleBlob::new::<Feedforward, 12, 1>(true).bytes();
        fs::write(folder.path().join("champion.blob"), &blob).unwrap();
        Self { folder, blob }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn neutral(&self, text: &str) -> String {
        text.replace(&self.folder.path().display().to_string(), "DIR")
    }

    /// Calls `export` with these words after the champion; `DIR` stands for the folder.
    fn export(&self, words: &str) -> Said {
        let folder = self.folder.path().display().to_string();
        let words = words.split_whitespace().map(|word| word.replace("DIR", &folder));
        let champion = self.path("champion.blob").display().to_string();
        let words = ["export".to_owned(), champion].into_iter().chain(words);
        let command = ExportArgs::augment_args(Command::new("export"));
        let matches = match command.try_get_matches_from(words) {
            Ok(matches) => matches,
            Err(error) => {
                let message = error.to_string();
                return Said {
                    stdout: Vec::new(),
                    stderr: String::new(),
                    result: Err((error.exit_code() as u8, message)),
                };
            }
        };
        let args = ExportArgs::from_arg_matches(&matches).unwrap();
        let (stdout, stderr) = (Page::default(), Page::default());
        let mut output = Output::to(args.json, stdout.clone(), stderr.clone());
        let result = run(&args, &mut output)
            .map_err(|failure| (failure.exit_code(), self.neutral(&failure.to_string())));
        output.finish().unwrap();
        Said { stdout: stdout.bytes(), stderr: self.neutral(&stderr.text()), result }
    }

    /// Calls `export`, which must succeed, and gives what it told people.
    fn told(&self, words: &str) -> String {
        let said = self.export(words);
        assert_eq!(said.result, Ok(()));
        self.neutral(&String::from_utf8(said.stdout).unwrap())
    }

    /// Calls `export`, which must refuse with exit code 2 and leave no file behind.
    fn refusal(&self, words: &str) -> String {
        let before = fs::read_dir(self.folder.path()).unwrap().count();
        let said = self.export(words);
        let (code, message) = said.result.unwrap_err();
        assert_eq!((code, said.stdout.as_slice()), (2, &b""[..]), "{message}");
        assert_eq!(fs::read_dir(self.folder.path()).unwrap().count(), before);
        message
    }
}

#[test]
fn each_format_tells_how_it_gets_onto_the_car() {
    let bench = Bench::new();
    let told: Vec<String> = ["bin", "hex", "uf2", "rs"]
        .into_iter()
        .map(|format| bench.told(&format!("--format {format}")))
        .collect();
    insta::assert_snapshot!(told.join("\n"));
    assert_eq!(fs::read(bench.path("champion.bin")).unwrap(), bench.blob);
    for name in ["champion.bin", "champion.hex", "champion.uf2", "champion.rs"] {
        let digest = sha256(&fs::read(bench.path(name)).unwrap());
        assert!(told.iter().any(|text| text.contains(&digest)), "{name}");
    }
}

#[test]
fn a_board_this_program_does_not_know_gets_other_advice() {
    let bench = Bench::new();
    let told = [
        bench.told("--format bin --chip STM32F411CEUx --address 0x0806_0000"),
        bench.told("--format uf2 --family nrf52840 --address 0xE0000"),
        bench.told("--format uf2 --family rp2040 --out DIR/pico.uf2"),
    ];
    insta::assert_snapshot!(told.join("\n"));
}

#[test]
fn a_named_chip_or_family_takes_weights_anywhere_in_its_flash() {
    let bench = Bench::new();
    bench.told("--format bin --chip RP235x --address 0x10200000");
    bench.told("--format uf2 --family rp2350-arm-s --address 0x10200000");
}

#[test]
fn a_champion_that_the_shipped_car_takes_is_exported_without_a_note() {
    let bench = Bench::new();
    assert!(bench.told("--format uf2").contains("\nnote: the car as shipped takes beams"));
    let mut fitting = SampleBlob::new::<Feedforward, 12, 1>(true);
    fitting.header.scaling.range = 1.2;
    fs::write(bench.path("champion.blob"), fitting.bytes()).unwrap();
    assert!(!bench.told("--format hex").contains("note:"));
    let json: serde_json::Value = serde_json::from_str(&bench.told("--format bin --json")).unwrap();
    assert_eq!(json["notes"], serde_json::json!([]));
}

#[test]
fn json_holds_what_a_machine_needs() {
    let bench = Bench::new();
    insta::assert_snapshot!(bench.told("--format hex --json"));
    let uf2: serde_json::Value = serde_json::from_str(&bench.told("--format uf2 --json")).unwrap();
    assert_eq!(uf2["family"], "absolute (0xe48bff57)");
    assert_eq!(uf2["bytes"], 8192);
    assert!(uf2["command"].is_null());
}

#[test]
fn standard_output_carries_the_bytes_alone() {
    let bench = Bench::new();
    let said = bench.export("--format bin --out -");
    assert_eq!(said.result, Ok(()));
    assert!(said.stdout == bench.blob);
    assert!(
        said.stderr.starts_with("standard output: 1500 bytes, format bin\n"),
        "{}",
        said.stderr
    );
    assert!(said.stderr.contains(" 0x103f0000 FILE\n"), "{}", said.stderr);
    assert_eq!(fs::read_dir(bench.folder.path()).unwrap().count(), 1);
    assert_eq!(
        bench.refusal("--format bin --out - --json"),
        "--json: standard output carries the file already; give --out a file name"
    );
}

#[test]
fn a_file_is_replaced_only_by_force_and_the_champion_never() {
    let bench = Bench::new();
    fs::write(bench.path("a.hex"), "precious").unwrap();
    assert_eq!(
        bench.refusal("--format hex --out DIR/a.hex"),
        "--out DIR/a.hex: exists already and is not replaced without --force"
    );
    assert_eq!(fs::read(bench.path("a.hex")).unwrap(), b"precious");
    bench.told("--format hex --out DIR/a.hex --force");
    assert!(fs::read(bench.path("a.hex")).unwrap().starts_with(b":02000004103F"));
    for spelling in ["DIR/champion.blob", "DIR/./champion.blob"] {
        assert_eq!(
            bench.refusal(&format!("--format hex --out {spelling} --force")),
            format!("--out {spelling}: the name of a file other than the champion expected")
        );
    }
    assert_eq!(fs::read(bench.path("champion.blob")).unwrap(), bench.blob);
}

#[test]
fn what_cannot_be_written_is_an_input_output_failure_without_a_partial_file() {
    let bench = Bench::new();
    let said = bench.export("--format bin --out DIR/none/a.bin");
    let (code, message) = said.result.unwrap_err();
    assert_eq!(code, 3);
    assert_eq!(message, "cannot write DIR/none/a.bin: the folder DIR/none does not exist");
    assert!(said.stdout.is_empty() && !bench.path("none").exists());
}

#[test]
fn impossible_requests_are_refused_by_option_with_what_was_expected() {
    let bench = Bench::new();
    let requests = [
        "--format bin --address 0x103f0002",
        "--format hex --address 0x103f0002",
        "--format uf2 --address 0x103f0080",
        "--format uf2 --address 0x08000000",
        "--format uf2 --address 0x10200000",
        "--format bin --address 0x103fef00",
        "--format hex --address 0xffff_ff00 --chip STM32F4",
        "--format uf2 --address 0xffff_ff00 --family stm32f4",
        "--format bin --chip nRF52840_xxAA",
        "--format uf2 --family nrf52840",
        "--format uf2 --family 7",
        "--format rs --address 0x10000000",
        "--format hex --family rp2040",
        "--format uf2 --chip RP235x",
        "--format rs --chip RP235x",
    ];
    let table: Vec<String> =
        requests.iter().map(|words| format!("{words}\n    {}", bench.refusal(words))).collect();
    insta::assert_snapshot!(table.join("\n"));
}

#[test]
fn values_that_cannot_be_read_are_refused_by_option() {
    let bench = Bench::new();
    let requests = [
        "--format elf",
        "--format hex --address 103f0000",
        "--format hex --address 0x1_0000_0000",
        "--format uf2 --family rp235",
        "--format uf2 --family 0xe48bff570",
        "",
    ];
    let table: Vec<String> =
        requests.iter().map(|words| format!("$ {words}\n{}", bench.refusal(words))).collect();
    insta::assert_snapshot!(table.join("\n"));
}

#[test]
fn an_address_inside_a_sector_warns_of_what_is_erased_before_it() {
    let bench = Bench::new();
    let said = bench.export("--format uf2 --address 0x103f_0100");
    assert_eq!(said.result, Ok(()));
    assert_eq!(
        said.stderr,
        "warning: --address 0x103f0100: also erases what lies before it, from 0x103f0000 on\n"
    );
    assert_eq!(fs::metadata(bench.path("champion.uf2")).unwrap().len(), 15 * 512);
}

#[test]
fn a_path_with_blanks_is_quoted_in_the_command() {
    let bench = Bench::new();
    let folder = bench.path("it's mine");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("champion.blob"), &bench.blob).unwrap();
    let args = ExportArgs {
        champion: folder,
        format: Format::Hex,
        out: None,
        address: None,
        family: None,
        chip: None,
        force: false,
        json: false,
    };
    let stdout = Page::default();
    let mut output = Output::to(false, stdout.clone(), Page::default());
    run(&args, &mut output).unwrap();
    let expected = r"hex 'DIR/it'\''s mine/champion.hex'";
    let text = bench.neutral(&stdout.text());
    assert!(text.contains(expected), "{text}");
}

#[test]
fn a_refused_blob_writes_nothing() {
    let bench = Bench::new();
    fs::write(bench.path("champion.blob"), &bench.blob[..1499]).unwrap();
    assert_eq!(
        bench.refusal("--format bin"),
        "DIR/champion.blob is refused: 1499 bytes, a blob of 1500 bytes expected"
    );
    assert!(!Path::new(&bench.path("champion.bin")).exists());
}

#[test]
fn the_help_names_every_format_and_default() {
    let mut command = ExportArgs::augment_args(Command::new("export"));
    insta::assert_snapshot!(command.render_long_help());
}
