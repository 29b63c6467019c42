//! Whole maps: the shipped ones, PNG in every form, refusals, and random bytes.

use std::fs;
use std::io::Cursor;

use ::png::{BitDepth, ColorType};
use proptest::prelude::*;

use super::*;
use crate::failure::{Failure, FailureKind};

const YAML: &str = "\
image: map.pgm
resolution: 0.05
origin: [-1, 2.5, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
";

/// Grey values 0 to 100 as they are.
const AS_IS: CellRule =
    CellRule { mode: Mode::Raw, negate: false, free_thresh: 0.0, occupied_thresh: 1.0 };

/// A map file among those shipped with the program.
fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/worlds").join(name)
}

/// How many cells are unknown, free, occupied.
fn census(map: &OccupancyMap) -> [usize; 3] {
    [UNKNOWN, FREE, OCCUPIED].map(|kind| map.cells.iter().filter(|&&cell| cell == kind).count())
}

/// Writes a YAML and an image beside it, loads them, and hides the folder's name in a refusal.
fn loaded(yaml: &str, image: Option<&[u8]>) -> Result<OccupancyMap, (String, FailureKind)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.yaml");
    fs::write(&path, yaml).unwrap();
    if let Some(image) = image {
        fs::write(folder.path().join("map.pgm"), image).unwrap();
    }
    load(&path).map_err(|error| {
        let message = error.to_string().replace(folder.path().to_str().unwrap(), "…");
        (message, Failure::from(error).kind())
    })
}

#[test]
fn the_shipped_maps_have_the_cells_that_a_count_of_their_pixels_gives() {
    // Counted by a separate program from the PGM bytes and the YAML's thresholds.
    for (name, size, counted) in [
        ("nav2/depot", [604, 307], [0, 179_481, 5_947]),
        ("nav2/tb3_sandbox", [384, 384], [138_683, 7_903, 870]),
        ("barn/barn_000", [50, 105], [0, 5_041, 209]),
        ("barn/barn_264", [50, 105], [0, 4_977, 273]),
    ] {
        let map = load(&shipped(&format!("{name}.yaml"))).unwrap();
        assert_eq!(([map.width, map.height], census(&map)), (size, counted), "{name}");
        assert_eq!(map.unknown_keys, [], "{name}");
    }
}

#[test]
fn the_outlines_of_the_shipped_maps_are_as_long_as_their_obstacles_have_open_edges() {
    // Edges counted by the same separate program.
    for (name, edges) in
        [("nav2/depot", 9_184), ("nav2/tb3_sandbox", 1_294), ("barn/barn_264", 518)]
    {
        let map = load(&shipped(&format!("{name}.yaml"))).unwrap();
        let total: f64 = trace(&map, false, OCCUPIED as u8)
            .into_iter()
            .map(|[a, b]| f64::from((b[0] - a[0]).abs() + (b[1] - a[1]).abs()))
            .sum();
        let expected = f64::from(edges) * map.resolution;
        assert!((total - expected).abs() < 1e-3, "{name}: {total} m, expected {expected} m");
    }
}

#[test]
fn every_cylinder_of_a_barn_world_stands_in_an_occupied_cell() {
    for name in ["barn/barn_000", "barn/barn_264"] {
        let map = load(&shipped(&format!("{name}.yaml"))).unwrap();
        let centres = fs::read_to_string(shipped(&format!("{name}.csv"))).unwrap();
        for line in centres.lines().skip(1) {
            let (x, y) = line.split_once(',').unwrap();
            let centre = [x.parse().unwrap(), y.parse().unwrap()];
            let (column, row) = map.cell_at(centre).unwrap();
            assert_eq!(map.cell(column, row), Some(OCCUPIED), "{name}: {line}");
        }
    }
}

#[test]
fn png_images_of_every_form_give_the_same_cells_as_their_pixels() {
    let scale = CellRule { mode: Mode::Scale, free_thresh: 0.2, occupied_thresh: 0.8, ..AS_IS };
    let (u, f, o) = (UNKNOWN, FREE, OCCUPIED);
    let counting: Vec<i8> = (0..5).rev().flat_map(|row| row * 9..row * 9 + 9).collect();
    let cases: [(&str, CellRule, &[i8]); 15] = [
        ("grey8", AS_IS, &counting),
        ("grey8_interlaced", AS_IS, &counting),
        ("grey8_interlaced_narrow", AS_IS, &[2, 1, 0]),
        ("grey1", scale, &[o, f, o, o, f, f, o, f, f]),
        // 85 of 255 is an occupancy of 2/3, and (2/3 − 0.2) / 0.6 is 0.78.
        ("grey2", scale, &[o, 78, 22, f]),
        ("grey4_interlaced", AS_IS, &[0, 17, 85, u]),
        // 0x6400 / 65535 · 255 is 99.6.
        ("grey16", AS_IS, &[100, 0, 100, u]),
        ("palette2", AS_IS, &[20, 99, u, 99]),
        ("palette8_see_through", scale, &[o, u, f]),
        ("grey8_see_through", scale, &[o, u, f]),
        ("grey8_alpha", scale, &[o, u, f]),
        ("rgb8", AS_IS, &[20, 1, 85]),
        ("rgb16", AS_IS, &[20, 1]),
        ("rgba8", scale, &[o, u, f]),
        ("rgba16", scale, &[o, u, f]),
    ];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/png");
    for (name, rule, cells) in cases {
        let bytes = fs::read(folder.join(name).with_extension("png")).unwrap();
        assert_eq!(decode(Cursor::new(bytes), rule).unwrap().finish().unwrap(), cells, "{name}");
    }
}

#[test]
fn a_png_cut_anywhere_is_refused_and_never_read_as_a_smaller_map() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/png");
    for name in ["grey8.png", "grey8_interlaced.png", "palette2.png"] {
        let whole = fs::read(folder.join(name)).unwrap();
        // The last 12 bytes are the end marker, which adds nothing to the pixels.
        for length in 0..whole.len() - 12 {
            let result = decode(Cursor::new(&whole[..length]), AS_IS);
            assert!(result.is_err(), "{name} cut to {length} bytes");
        }
    }
}

#[test]
fn absurd_sizes_are_refused_from_the_header_alone() {
    let mut png = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut png, 1, 1);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    encoder.write_header().unwrap();
    png[16..24].fill(0x7f);
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&png[12..29]);
    png[29..33].copy_from_slice(&crc.to_be_bytes());
    for image in [png.as_slice(), b"P5 65536 1025 255\n"] {
        let (_, problem) = decode(Cursor::new(image), AS_IS).unwrap_err();
        assert!(matches!(problem, MapProblem::Size { .. }), "{problem}");
    }
}

#[test]
fn a_map_takes_its_place_from_the_yaml() {
    let map = loaded(YAML, Some(b"P2 2 1 255 0 254")).unwrap();
    assert_eq!((map.resolution, map.origin), (0.05, [-1.0, 2.5, 0.0]));
    assert_eq!(map.cells, [OCCUPIED, FREE]);
    assert_eq!(map.bounds(), Bounds { min: [-1.0, 2.5], max: [-0.9, 2.55] });
    assert_eq!(map.cell_at([-0.93, 2.51]), Some((1, 0)));
    assert_eq!(map.cell_at([-0.89, 2.51]), None);
}

#[test]
fn extra_keys_are_listed_and_modes_and_truth_values_are_read_as_map_server_does() {
    let yaml = YAML.replace("negate: 0", "negate: yes\nmode: RAW\nauthor: {name: me}");
    let map = loaded(&yaml, Some(b"P2 2 1 255 7 254")).unwrap();
    assert_eq!(map.cells, [7, UNKNOWN]);
    let listed: Vec<String> = map.unknown_keys.iter().map(ToString::to_string).collect();
    assert_eq!(listed, ["line 6: unknown key `author` ignored"]);
}

#[test]
fn yaml_refusals_name_the_place_what_was_found_and_what_was_expected() {
    let range = "expected metres per pixel, from 0.000001 to 1000000";
    let pose = "expected three finite numbers [x, y, yaw], metres and radians";
    let description =
        "expected the description of a map: image, resolution, origin and so on".to_owned();
    for (from, to, expected) in [
        ("0.05", "5 cm", format!("2:13: resolution: found `5 cm`, {range}")),
        ("0.05", ".nan", format!("2:13: resolution: found NaN, {range}")),
        ("0.05", "0", format!("2:13: resolution: found 0.0, {range}")),
        ("0.05", "-0.05", format!("2:13: resolution: found -0.05, {range}")),
        ("0.05", "", format!("2:11: resolution: found nothing, {range}")),
        ("[-1, 2.5, 0]", "[0, 0]", format!("3:9: origin: found 2 numbers, {pose}")),
        ("[-1, 2.5, 0]", "[0, 0, .inf]", format!("3:9: origin: found [0.0, 0.0, inf], {pose}")),
        ("[-1, 2.5, 0]", "[0, up, 0]", format!("3:13: origin: found `up, 0]`, {pose}")),
        (
            "negate: 0",
            "negate: 0.5",
            "4:9: negate: found \"0.5\", expected 0, 1, false or true".into(),
        ),
        ("0.65", "1.5", "5:18: occupied_thresh: found 1.5, expected a number from 0 to 1".into()),
        (
            "0.196",
            "0.7",
            "6:14: free_thresh 0.7 and occupied_thresh 0.65: expected free_thresh at or below \
             occupied_thresh"
                .into(),
        ),
        (
            "0.196",
            "0.65\nmode: scale",
            "6:14: free_thresh 0.65 and occupied_thresh 0.65: expected free_thresh below \
             occupied_thresh"
                .into(),
        ),
        (
            "0.196",
            "0.1\nmode: ternary",
            "7:7: mode: found \"ternary\", expected trinary, scale or raw".into(),
        ),
        (
            "map.pgm",
            "''",
            "1:8: image: found an empty name, expected the name of a PGM or PNG file".into(),
        ),
        ("negate: 0", "image: b.pgm", "4:1: `image: b.pgm`: this key stands here twice".into()),
        (YAML, "P5 1 1 255", format!("1:1: {description}")),
        (YAML, "[1, 2]", format!("1:1: {description}")),
        (
            "[-1, 2.5, 0]",
            "[5e6, 0, 0]",
            "3:9: the map reaches 5000000.05 m from zero, where 32-bit coordinates cannot tell \
             corners 0.05 m apart; expected an origin near the map"
                .into(),
        ),
    ] {
        let yaml = YAML.replacen(from, to, 1);
        let (message, kind) = loaded(&yaml, Some(b"P2 1 1 255 0")).unwrap_err();
        assert_eq!(message, format!("…/map.yaml:{expected}"));
        assert_eq!(kind, FailureKind::BadInput);
    }
}

#[test]
fn deep_or_multiplying_yaml_is_refused_within_bounds() {
    let deep = format!("{YAML}x: {}", "[".repeat(100_000));
    let mut multiplying = format!("{YAML}a: &a [1, 1, 1, 1, 1, 1, 1, 1]\n");
    for (from, to) in "abcdefgh".chars().zip("bcdefghi".chars()) {
        let copies = vec![format!("*{from}"); 8].join(", ");
        multiplying += &format!("{to}: &{to} [{copies}]\n");
    }
    for yaml in [deep, multiplying] {
        let error = Description::parse(yaml.as_bytes(), Path::new("map.yaml")).unwrap_err();
        assert!(matches!(error.problem, MapProblem::Yaml(_)), "{error}");
    }
}

#[test]
fn a_missing_key_is_refused_with_its_misspelling_or_with_the_list_of_keys() {
    let message = |yaml: &str| loaded(yaml, Some(b"P2 1 1 255 0")).unwrap_err().0;
    assert_eq!(
        message(&YAML.replace("occupied_thresh", "ocupied_thresh")),
        "…/map.yaml: missing key `occupied_thresh`; is `ocupied_thresh` a misspelling of it?"
    );
    assert_eq!(
        message(&YAML.replace("free_thresh: 0.196\n", "")),
        "…/map.yaml: missing key `free_thresh`; expected image, resolution, origin, negate, \
         occupied_thresh (map savers write 0.65) and free_thresh (0.196 in ROS 1, 0.25 in ROS 2)"
    );
    assert!(message("").starts_with("…/map.yaml: missing key `image`"));
}

#[test]
fn equal_thresholds_are_a_map_without_unknown_cells() {
    let yaml = YAML.replace("0.65", "0.5").replace("0.196", "0.5");
    assert_eq!(loaded(&yaml, Some(b"P2 2 1 255 0 254")).unwrap().cells, [OCCUPIED, FREE]);
}

#[test]
fn a_missing_or_foreign_image_is_bad_input_and_names_the_place_in_the_yaml() {
    let (message, kind) = loaded(YAML, None).unwrap_err();
    assert_eq!(message, "…/map.yaml:1:8: image: there is no file …/map.pgm (relative to the YAML)");
    assert_eq!(kind, FailureKind::BadInput);
    // No file can have these names.
    for name in [r#""a\0b.pgm""#, &"x".repeat(5000)] {
        let (message, kind) = loaded(&YAML.replace("map.pgm", name), None).unwrap_err();
        assert!(message.starts_with("…/map.yaml:1:8: image: there is no file "), "{message}");
        assert_eq!(kind, FailureKind::BadInput);
    }
    let (message, kind) = loaded(&YAML.replace("map.pgm", "."), None).unwrap_err();
    assert_eq!((message.as_str(), kind), ("…/.: not a regular file", FailureKind::BadInput));
    for (image, found) in [
        (b"".as_slice(), "an empty file"),
        (b"P6 1 1 255\n\0\0\0", "a PPM colour image"),
        (b"BM\0\0", "a BMP image"),
        (b"hello there", "`hello th`"),
    ] {
        let (message, _) = loaded(YAML, Some(image)).unwrap_err();
        let expected = "expected a PGM (P2 or P5) or PNG image";
        assert_eq!(message, format!("…/map.pgm: byte 0: found {found}, {expected}"));
    }
}

#[test]
fn a_missing_yaml_is_bad_input_and_an_unreadable_file_an_input_output_failure() {
    let missing = load(Path::new("no/such/map.yaml")).unwrap_err();
    assert_eq!(missing.to_string(), "no/such/map.yaml: no such file");
    assert_eq!(Failure::from(missing).kind(), FailureKind::BadInput);
    let denied = std::io::Error::from(ErrorKind::PermissionDenied);
    let denied = MapProblem::Read(denied).at(Path::new("map.pgm"), Place::File);
    assert_eq!(Failure::from(denied).kind(), FailureKind::InputOutput);
}

proptest! {
    #[test]
    fn no_bytes_make_the_yaml_reader_panic(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        from in 0..YAML.len(),
        length in 0..20usize,
        patch in "[ -~\n\t]{0,12}",
    ) {
        let path = Path::new("map.yaml");
        let _ = Description::parse(&bytes, path);
        let until = (from + length).min(YAML.len());
        let mut mutated = YAML.to_owned();
        mutated.replace_range(from..until, &patch);
        let _ = Description::parse(mutated.as_bytes(), path);
    }

    #[test]
    fn no_bytes_make_an_image_reader_panic(
        magic in prop::sample::select(vec!["", "P2 ", "P5 ", "P2 3 2 9 ", "P5 2 2 300\n"]),
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        text in "[ 0-9#\n-]{0,60}",
    ) {
        for tail in [bytes.as_slice(), text.as_bytes()] {
            let _ = decode(Cursor::new([magic.as_bytes(), tail].concat()), AS_IS);
        }
    }

    #[test]
    fn no_damage_to_a_png_makes_its_reader_panic(
        which in prop::sample::select(vec!["grey8_interlaced", "palette2", "rgba16", "grey1"]),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        repair in any::<bool>(),
    ) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/png");
        let mut bytes = fs::read(folder.join(which).with_extension("png")).unwrap();
        for (index, value) in changes {
            let index = index.index(bytes.len());
            bytes[index] = value;
        }
        if repair {
            repair_checksums(&mut bytes);
        }
        let _ = decode(Cursor::new(bytes), AS_IS).map(Canvas::finish);
    }
}

/// Makes a PNG's chunks pass their checksums, so that damage reaches what lies behind.
fn repair_checksums(png: &mut [u8]) {
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let mut start = 8;
    while let Some(length) = png.get(start..start + 4) {
        let length = u32::from_be_bytes(length.try_into().unwrap()) as usize;
        let Some(chunk) = png.get_mut(start + 4..start + 12 + length) else { break };
        let (data, checksum) = chunk.split_at_mut(4 + length);
        checksum.copy_from_slice(&crc.checksum(data).to_be_bytes());
        start += 12 + length;
    }
}
