//! The pages as a browser shows them, and as a reader uses them.

use std::path::PathBuf;

use host_trainer::report::data::{Moment, ReportData};
use host_trainer::report::{page, plots, scene_svg};
use serde_json::json;

use crate::fixture;
use crate::webdriver::Browser;

const END: &str = "\u{e010}";
const LEFT: &str = "\u{e012}";
const RIGHT: &str = "\u{e014}";

/// Defines `data`, the canvas's pixels, read from a copy: Chromium grumbles on the console
/// about a canvas that is read often.
const PIXELS: &str = "
    const canvas = document.getElementById('canvas');
    const copy = new OffscreenCanvas(canvas.width, canvas.height);
    const context = copy.getContext('2d', { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const data = context.getImageData(0, 0, canvas.width, canvas.height).data;";

/// Sums up the canvas, so that a change of any part shows.
const FINGERPRINT: &str = "let sum = 7;
    for (let i = 0; i < data.length; i += 4)
        sum = (sum * 31 + data[i] * 65536 + data[i + 1] * 256 + data[i + 2]) % 9007199254;
    return sum;";

/// A page in a folder of its own, opened.
struct Opened {
    browser: Browser,
    file: PathBuf,
    _folder: tempfile::TempDir,
}

fn open(html: &str) -> Option<Opened> {
    let browser = Browser::start()?;
    let folder = tempfile::tempdir().expect("a folder for the page");
    let file = folder.path().join("page.html");
    std::fs::write(&file, html).expect("the page is written");
    let opened = Opened { browser, file, _folder: folder };
    opened.at("");
    Some(opened)
}

impl Opened {
    /// Opens the page at an address within it.
    fn at(&self, fragment: &str) {
        self.browser.open(&format!("file://{}{fragment}", self.file.display()));
    }

    fn state(&self, name: &str) -> i64 {
        let value = self.browser.run(&format!("return window.evosteer.{name}"));
        value.as_i64().expect("a whole number")
    }

    fn fingerprint(&self) -> serde_json::Value {
        self.browser.run(&format!("{PIXELS}{FINGERPRINT}"))
    }

    /// How many pixels of the canvas have a colour of the palette, and their middle.
    fn pixels_of(&self, colour: &str) -> (i64, [f64; 2]) {
        let found = self.browser.run(&format!(
            "{PIXELS}
             const name = getComputedStyle(document.documentElement).getPropertyValue('--{colour}');
             const want = [1, 3, 5].map((i) => parseInt(name.trim().slice(i, i + 2), 16));
             let [count, x, y] = [0, 0, 0];
             for (let i = 0; i < data.length; i += 4)
                 if (want.every((part, j) => Math.abs(data[i + j] - part) < 3)) {{
                     count += 1;
                     x += (i / 4) % canvas.width;
                     y += Math.floor(i / 4 / canvas.width);
                 }}
             return [count, x / count || 0, y / count || 0];"
        ));
        let number = |index: usize| found[index].as_f64().expect("a number");
        (number(0) as i64, [number(1), number(2)])
    }

    fn assert_no_complaints(&self) {
        assert_eq!(self.browser.complaints(), Vec::<serde_json::Value>::new());
        let fetched = self.browser.run("return performance.getEntriesByType('resource').length");
        assert_eq!(fetched, json!(0), "the page must load nothing but itself");
    }
}

#[test]
fn play_moves_the_car_until_it_is_paused() {
    let Some(page) = open(&page::render(&fixture::report())) else { return };
    let before = page.fingerprint();
    assert_eq!((page.state("drive"), page.state("step")), (0, 0));
    assert_eq!(page.browser.text("#play"), "Play");
    page.browser.click("#play");
    page.browser.wait_for("window.evosteer.step >= 3");
    page.browser.click("#play");
    assert_eq!(page.browser.text("#play"), "Play");
    let paused = page.state("step");
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(page.state("step"), paused);
    assert_ne!(page.fingerprint(), before);
    page.assert_no_complaints();
}

#[test]
fn a_fast_replay_runs_to_the_end_stops_there_and_starts_over() {
    let Some(page) = open(&page::render_replay(&fixture::report())) else { return };
    page.browser.run(
        "const s = document.getElementById('speed'); s.value = '16';
        s.dispatchEvent(new Event('change'));",
    );
    page.browser.click("#play");
    page.browser.wait_for("!window.evosteer.playing && window.evosteer.step > 0");
    let moves = fixture::clean().outcome.steps;
    assert_eq!(page.browser.text("#clock"), format!("{moves} / {moves}"));
    page.browser.click("#play");
    assert!(page.state("step") < i64::from(moves));
    page.assert_no_complaints();
}

#[test]
fn scrubber_and_keys_show_any_moment_with_its_readings() {
    let Some(page) = open(&page::render(&fixture::report())) else { return };
    let drive = fixture::clean();
    let position = |moment: &Moment| format!("{:.2}, {:.2} m", moment.x, moment.y);
    let before = page.fingerprint();
    page.browser.type_into("#scrub", END);
    assert_eq!(page.state("step"), i64::from(drive.outcome.steps));
    assert_ne!(page.fingerprint(), before);
    let last = drive.moments.last().expect("moments");
    assert_eq!(page.browser.text("#position"), position(last));
    page.browser.type_into("#scrub", &LEFT.repeat(3));
    page.browser.type_into("body", RIGHT);
    page.browser.click("#back");
    let expected = drive.moments.len() - 1 - 3;
    assert_eq!(page.state("step"), expected as i64);
    assert_eq!(page.browser.text("#position"), position(&drive.moments[expected]));
    page.browser.type_into("body", " ");
    page.browser.wait_for(&format!("window.evosteer.step > {expected}"));
    page.assert_no_complaints();
}

#[test]
fn the_car_is_drawn_where_it_is_the_right_way_up() {
    let Some(page) = open(&page::render_replay(&fixture::report())) else { return };
    let canvas = page.browser.run("return [canvas.width, canvas.height]");
    let [width, height] = [0, 1].map(|i| canvas[i].as_f64().expect("a size"));
    // The room is 10 m square and fills 97 % of the shorter side.
    let scale = 0.97 * width.min(height) / 10.0;
    for step in [0, 40, 110] {
        page.browser.run(&format!("window.evosteer.seek({step})"));
        let moment = &fixture::clean().moments[step];
        let back = fixture::BODY.front_overhang - fixture::BODY.length / 2.0;
        let middle = [
            moment.x + back * libm::cosf(moment.heading),
            moment.y + back * libm::sinf(moment.heading),
        ]
        .map(f64::from);
        let expected =
            [width / 2.0 + (middle[0] - 5.0) * scale, height / 2.0 - (middle[1] - 5.0) * scale];
        let (count, found) = page.pixels_of("body");
        assert!(count > 20, "move {step}: {count} pixels of body");
        let off = libm::hypot(found[0] - expected[0], found[1] - expected[1]);
        assert!(off < 0.1 * scale, "move {step}: drawn at {found:?}, is at {expected:?}");
    }
}

#[test]
fn drives_can_be_chosen_and_their_endings_are_told() {
    let Some(page) = open(&page::render(&fixture::report())) else { return };
    page.browser.click("#choices label:nth-of-type(3)");
    assert_eq!(page.state("drive"), 2);
    let verdict = page.browser.text("#verdict");
    assert!(verdict.starts_with("Drive 3: not reached, loop of 64 moves."), "{verdict}");
    assert!(verdict.contains("periodic loop"), "{verdict}");
    assert!(
        page.browser.run("return document.querySelector('#verdict').className") == json!("loop")
    );
    page.browser.run("window.evosteer.seek(300)");
    assert!(page.pixels_of("loop").0 > 200, "the loop is not highlighted");
    page.browser.type_into("body", "1");
    assert_eq!(page.state("drive"), 0);
    page.browser.run("window.evosteer.seek(100)");
    assert_eq!(page.pixels_of("loop").0, 0);
    page.browser.click("#outcomes tbody tr:nth-child(4) a");
    page.browser.wait_for("window.evosteer.drive === 3");
    page.at("#drive=2&move=40");
    assert_eq!((page.state("drive"), page.state("step")), (1, 40));
    page.assert_no_complaints();
}

#[test]
fn a_collision_flashes_and_leaves_a_mark() {
    let Some(page) = open(&page::render(&fixture::report())) else { return };
    let drive = fixture::scraping();
    let first = drive.moments.iter().position(|m| m.collided).expect("a collision");
    let last = drive.moments.iter().rposition(|m| m.collided).expect("a collision");
    page.browser.run(&format!("window.evosteer.choose(1); window.evosteer.seek({})", first - 1));
    assert_eq!(page.pixels_of("collision").0, 0);
    assert_eq!(page.browser.text("#collisions"), "0");
    page.browser.run(&format!("window.evosteer.seek({first})"));
    let flash = page.pixels_of("collision").0;
    page.browser.run(&format!("window.evosteer.seek({})", last + 10));
    let mark = page.pixels_of("collision").0;
    assert!(flash > 2 * mark && mark > 5, "flash {flash}, mark {mark} pixels");
    assert_eq!(page.browser.text("#collisions"), drive.outcome.collisions.to_string());
}

#[test]
fn every_picture_is_well_formed() {
    let Some(browser) = Browser::start() else { return };
    let mut report = fixture::report();
    report.scene.name = "a < b & \"c\"\u{1}".to_owned();
    let path = plots::trajectory_svg(&report.scene, &report.body, &report.drives[1], "<&>");
    let pictures = [
        plots::fitness_svg(&report.history),
        plots::criteria_svg(&report.history),
        plots::fitness_svg(&[]),
        scene_svg(&report.scene),
        path,
    ];
    browser.open("about:blank");
    for svg in pictures {
        let root = browser.run(&format!(
            "return new DOMParser().parseFromString({}, 'image/svg+xml').documentElement.outerHTML
                .slice(0, 300)",
            json!(svg)
        ));
        let root = root.as_str().expect("text");
        assert!(root.starts_with("<svg") && !root.contains("parsererror"), "{root}");
    }
}

#[test]
fn dark_screens_and_narrow_screens_are_served() {
    let Some(page) = open(&page::render(&fixture::report())) else { return };
    let light = page.pixels_of("paper").0;
    assert!(light > 10_000);
    for (width, scheme, paper) in [(1280, "dark", "#171b21"), (360, "light", "#fefefe")] {
        page.browser.pretend(width, 800, scheme);
        page.browser.wait_for(&format!(
            "getComputedStyle(document.documentElement).getPropertyValue('--paper').trim() === '{paper}'"
        ));
        page.browser.wait_for("document.documentElement.scrollWidth <= window.innerWidth");
        page.browser.wait_for("canvas.clientWidth > 250");
        assert!(page.pixels_of("paper").0 > 10_000, "{width} {scheme}");
        let ink = page.browser.run(
            "return getComputedStyle(document.querySelector('#learning svg text')).fill
                !== getComputedStyle(document.querySelector('#learning svg rect')).fill",
        );
        assert_eq!(ink, json!(true), "writing on its own colour");
    }
    page.assert_no_complaints();
}

#[test]
fn a_world_of_a_hundred_thousand_edges_still_plays() {
    let Some(page) = open(&page::render(&crowded())) else { return };
    page.browser.click("#play");
    page.browser.wait_for("window.evosteer.step >= 2");
    // Whoever strokes a ready-made path draws the world; once is enough for many frames.
    let drawn = page.browser.run(
        "let worlds = 0;
        const { stroke } = CanvasRenderingContext2D.prototype;
        CanvasRenderingContext2D.prototype.stroke = function (...path) {
            worlds += path.length;
            stroke.apply(this, path);
        };
        for (let k = 0; k < 50; k++) window.evosteer.seek(k);
        return worlds;",
    );
    assert_eq!(drawn, json!(0), "the world was drawn anew");
    page.browser.click("#follow");
    page.browser.run("window.evosteer.seek(60)");
    assert!(page.pixels_of("body").0 > 200, "following shows the car larger");
    page.assert_no_complaints();
}

/// The usual drives among a hundred thousand tiny walls.
fn crowded() -> ReportData {
    let mut report = fixture::report();
    report.scene.segments = (0..100_000)
        .map(|i| {
            let (column, row) = ((i % 400) as f32, (i / 400) as f32);
            let (x, y) = (0.05 + column * 0.02475, 0.05 + row * 0.0396);
            [x, y, x + 0.01, y + 0.008]
        })
        .collect();
    report
}
