//! What every wrong command line and every wrong file is answered with: read the snapshots as
//! a user would.

use std::fs;

use super::bench::Bench;

/// A bench with one finished run and files that are wrong in every way.
fn with_bad_files() -> Bench {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let blob = fs::read(bench.path("run/champion.blob")).unwrap();
    bench.file("champion.blob", &blob);
    bench.file("short.blob", &blob[..100]);
    bench.file("long.blob", [&blob[..], b"x"].concat());
    bench.file("empty.blob", "");
    bench.file("text.blob", "hello, this is no blob at all, but a text of some length\n".repeat(9));
    let changed = |offset: usize, byte: u8| {
        let mut blob = blob.clone();
        blob[offset] = byte;
        blob
    };
    // Bytes 8 and 9 are the version (docs/weight-blob.md).
    bench.file("future.blob", changed(8, 9));
    bench.file("flipped.blob", changed(700, blob[700] ^ 1));
    bench.file("big.blob", vec![0; (1 << 20) + 1]);
    fs::create_dir(bench.path("folder")).unwrap();

    let walls = "[world]\nboxes = [[2, 2, 4, 4]]\n";
    let pair = |start: &str, goal: &str| {
        format!("{walls}\n[[pairs.list]]\nstart = [{start}]\ngoal = [{goal}]\n")
    };
    bench.file("start_in_wall.toml", pair("3, 3, 0", "8, 8"));
    bench.file("goal_in_wall.toml", pair("1, 1, 0", "3, 3"));
    bench.file("outside.toml", pair("1, 1, 0", "18, 8"));
    let closed = "[world]\nwalls = [{ points = [[0, 5], [10, 5]], thickness_m = 0.2 }]\n\n\
                  [[pairs.list]]\nstart = [1, 1, 0]\ngoal = [8, 8]\n";
    bench.file("unreachable.toml", closed);
    bench.file("zero_wall.toml", "[world]\nwalls = [{ points = [[1, 1], [1, 1]] }]\n");
    bench.file("nan.toml", "[vehicle]\nwidth_m = nan\n");
    bench.file("huge.toml", "[world]\nmax_m = [1e30, 10]\n");
    bench.file("syntax.toml", "[world\n");
    bench.file("unknown.toml", "[world]\ntarget_radius = 0.4\n");
    bench.file("binary.toml", b"name = \"\xff\"\n");
    bench.file("no_map.toml", "[world.map]\nyaml = \"none.yaml\"\n");
    bench.file("bad_map.toml", "[world.map]\nyaml = \"bad.yaml\"\n");
    bench.file(
        "bad.yaml",
        "image: bad.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n\
         occupied_thresh: 0.65\nfree_thresh: 0.196\n",
    );
    bench.file("bad.pgm", "P5\n100 100\n255\nonly a few");
    bench.file("zero_map.toml", "[world.map]\nyaml = \"zero.yaml\"\n");
    bench.file(
        "zero.yaml",
        "image: bad.pgm\nresolution: 0\norigin: [0, 0, 0]\nnegate: 0\n\
         occupied_thresh: 0.65\nfree_thresh: 0.196\n",
    );
    bench.file("full.toml", "[world]\nboxes = [[0.2, 0.2, 9.8, 9.8]]\n");
    bench.file("manifest/manifest.toml", "seed = 1\n");
    bench
}

const COMMAND_LINES: &[&str] = &[
    "trian",
    "train open complex",
    "train --generation 3",
    "train opne",
    "train barn",
    "train --seed x",
    "train --seed -1",
    "train --seed 1.5",
    "train --seed 18446744073709551616",
    "train --seed=",
    "train --threads 0",
    "train --threads 1025",
    "train --threads many",
    "train --population 0",
    "train --population 1",
    "train --population -80",
    "train --population 4294967297",
    "train --generations 0",
    "train --generations 1000001",
    "train --generations 1e3",
    "train --checkpoint-every 0.5",
    "train --preset papr",
    "train --set",
    "train --set foo",
    "train --set episode.steplimit=400",
    "train --set episode.step_limit=many",
    "train --set episode.step_limit=1000000",
    "train --set vehicle.width_m=nan",
    "train --set vehicle.step_m=0.5",
    "train --set pairs.count=0",
    "train --set training.ga.mutation_rate=2",
    "train open --population 1000000",
    "train open --population 20000 --set training.islands=64",
    "train open --set pairs.count=100000 --population 200",
    "train open --set pairs.min_distance_m=13",
    "train open --from depot",
    "train open --from run --preset robust --set network.recurrence=feedforward",
    "train open --from run --set sensors.type_code=any",
    "train open --from run --set training.weight_bound=0.01",
    "train --json=yes",
    "evaluate",
    "evaluate run",
    "evaluate run nowhere",
    "evaluate run open --pairs 0",
    "evaluate run open --pairs 10000001",
    "evaluate run open --pairs -5",
    "evaluate run open --seed one",
    "evaluate run open --listed",
    "evaluate run open --listed --pairs 5",
    "evaluate run open --set vehicle.width_m=0.05",
    "evaluate run open --out curves.svg",
    "evaluate run open --pairs 20 --drivable --set episode.step_limit=3",
    "replay run open --pairs 101",
    "replay run open --out",
    "demo medium_maze",
    "demo --seed one",
    "export run",
    "export run --format elf",
    "inspect",
];

const FILES: &[&str] = &[
    "train nowhere/room.toml",
    "train champion.blob/room.toml",
    "train folder",
    "train champion.blob",
    "train syntax.toml",
    "train unknown.toml",
    "train binary.toml",
    "train nan.toml",
    "train huge.toml",
    "train zero_wall.toml",
    "train start_in_wall.toml",
    "train goal_in_wall.toml",
    "train outside.toml",
    "train unreachable.toml",
    "train full.toml",
    "train no_map.toml",
    "train bad_map.toml",
    "train zero_map.toml",
    "train open --from nowhere",
    "train open --from folder",
    "train open --from manifest",
    "train open --from short.blob",
    "train --resume run --from run",
    "train open --out run",
    "train open --out champion.blob",
    "train --resume nowhere",
    "train --resume folder",
    "train --resume champion.blob",
    "train --resume manifest",
    "train --resume run --seed 2",
    "train --resume run --generations 1",
    "train --resume run --generations 0",
    "evaluate nowhere open",
    "evaluate folder open",
    "evaluate manifest open",
    "evaluate empty.blob open",
    "evaluate short.blob open",
    "evaluate long.blob open",
    "evaluate big.blob open",
    "evaluate text.blob open",
    "evaluate future.blob open",
    "evaluate flipped.blob open",
    "evaluate run champion.blob",
    "evaluate run manifest",
    "evaluate run full.toml",
    "evaluate run open --stress --out folder",
    "replay nowhere open",
    "replay run open --out folder",
    "replay run unreachable.toml --listed",
    "demo --out folder",
    "demo --out champion.blob",
    "export short.blob --format hex",
    "inspect nowhere",
    "inspect folder",
];

fn answers(lines: &[&str]) -> String {
    let bench = with_bad_files();
    // A folder that is looked at has been locked.
    let files = || {
        let mut files = bench.all_files("");
        files.retain(|name, _| !name.ends_with("lock"));
        files
    };
    let before = files();
    let here = fs::canonicalize(bench.path("")).unwrap().display().to_string();
    let mut table = Vec::new();
    for line in lines {
        let done = bench.say(line).ends_in(2);
        assert_eq!(done.stdout, "", "{line}");
        assert!(done.stderr.starts_with("error: "), "{line}\n{}", done.stderr);
        table.push(format!("$ evosteer {line}\n{}", done.stderr.replace(&here, "DIR")));
    }
    assert!(before == files(), "a refusal changed a file");
    table.join("\n")
}

#[test]
fn every_wrong_command_line_is_answered_with_what_was_expected() {
    insta::assert_snapshot!("command_lines", answers(COMMAND_LINES));
}

#[test]
fn every_wrong_file_is_answered_with_its_place() {
    insta::assert_snapshot!("files", answers(FILES));
}

#[test]
fn a_blob_that_is_refused_is_described_and_refused() {
    let bench = with_bad_files();
    for blob in ["short", "long", "empty", "text", "future", "flipped"] {
        let done = bench.say(&format!("inspect {blob}.blob")).ends_in(2);
        let described = format!("{blob}.blob: no usable weight blob\n");
        assert!(done.stdout.starts_with(&described), "{}", done.stdout);
        let refused = format!("error: {blob}.blob is refused: ");
        assert!(done.stderr.starts_with(&refused), "{}", done.stderr);
    }
}

/// The scenario alone would do, and the champion alone too.
#[test]
fn a_champion_whose_steps_are_too_long_for_the_body_is_refused_before_it_drives() {
    let bench = with_bad_files();
    let done = bench.say("evaluate run open --set vehicle.length_m=0.05").ends_in(2);
    assert!(done.stderr.contains("the car could jump through a wall"), "{}", done.stderr);
    // 0.1 m per step is the champion's, whatever the scenario says.
    let line = "evaluate run open --set vehicle.length_m=0.06 --set vehicle.width_m=0.06 \
                --set vehicle.step_m=0.01 --set vehicle.front_overhang_m=0 \
                --set vehicle.wheelbase_m=0.05";
    let done = bench.say(line).ends_in(2);
    assert!(done.stderr.contains("the car of run/champion.blob:"), "{}", done.stderr);
}

/// The blob says nothing about the body: the scenario's must have room for the champion's axles.
#[test]
fn a_champion_whose_wheels_would_lie_outside_the_body_is_refused() {
    let bench = with_bad_files();
    let line = "evaluate run open --set vehicle.length_m=0.2 --set vehicle.wheelbase_m=0.15";
    let done = bench.say(line).ends_in(2);
    assert!(done.stderr.contains("the rear axle lies behind the body"), "{}", done.stderr);
    assert!(done.stderr.contains("the car of run/champion.blob:"), "{}", done.stderr);
}

#[test]
fn a_world_without_a_pair_is_refused_alike_by_every_verb() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let full = "[world]\nboxes = [[2, 0, 10, 10]]\n[pairs]\nmin_distance_m = 11\n";
    fs::write(bench.path("full-room.toml"), full).unwrap();
    let said = |line: &str| bench.say(line).ends_in(2).stderr;
    let checked = said("scenario check full-room.toml");
    assert!(checked.contains("--> full-room.toml:4:18"), "{checked}");
    assert!(checked.contains("= help: lower"), "{checked}");
    for verb in ["train", "evaluate run", "replay run"] {
        assert_eq!(said(&format!("{verb} full-room.toml")), checked, "{verb}");
    }
    // What `--set` asks for has its place there.
    let asked = said("evaluate run full-room.toml --set pairs.min_distance_m=10.5");
    assert!(asked.contains("--> --set"), "{asked}");
}

#[cfg(unix)]
#[test]
fn names_that_are_no_unicode_do_not_matter_to_files_and_are_refused_as_scenarios() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let bench = Bench::new();
    let odd = OsStr::from_bytes(b"r\xffn");
    let mut train = bench.program(["train", "open", "--out"]);
    train.arg(odd).args(super::bench::TINY);
    assert_eq!(train.output().unwrap().status.code(), Some(0));
    let mut again = bench.program(["train", "open", "--out=again", "--from"]);
    again.arg(odd).args(super::bench::TINY);
    assert_eq!(again.output().unwrap().status.code(), Some(0));
    let evaluate = |champion: &OsStr, scenario: &OsStr| {
        let words = [OsStr::new("evaluate"), champion, scenario, OsStr::new("--pairs=3")];
        bench.program(words).output().unwrap().status.code()
    };
    assert_eq!(evaluate(odd, OsStr::new("open")), Some(0));
    assert_eq!(evaluate(odd, odd), Some(2));
}
