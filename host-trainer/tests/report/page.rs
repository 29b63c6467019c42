//! The pages as text.

use host_trainer::report::data::{Echo, ReportData};
use host_trainer::report::page;

use crate::fixture;

#[test]
fn five_drives_of_three_hundred_moves_fit_into_half_a_megabyte() {
    let mut report = fixture::report();
    report.drives = vec![fixture::wandering(); 5];
    assert_eq!(report.drives[0].outcome.steps, 300);
    let size = page::render(&report).len();
    assert!(size < 500_000, "{size} bytes");
}

#[test]
fn the_page_names_no_other_place() {
    let html = page::render(&fixture::report());
    let elsewhere = html.replace("http://www.w3.org/2000/svg", "");
    for trace in ["http:", "https:", "//cdn", "@import", "url(h", "src="] {
        assert!(!elsewhere.contains(trace), "{trace}");
    }
    assert!(html.contains("default-src 'none'"));
}

#[test]
fn the_same_report_gives_the_same_bytes() {
    let report = fixture::report();
    assert_eq!(page::render(&report), page::render(&report));
    assert_eq!(page::render_replay(&report), page::render_replay(&report));
}

#[test]
fn markup_and_slots_in_names_stay_text() {
    let trick = "</script><script>alert(1)</script>{{data}}<b>\"&'";
    let mut report = fixture::report();
    report.title = trick.to_owned();
    report.summary = trick.to_owned();
    report.scene.name = trick.to_owned();
    report.provenance = vec![(trick.to_owned(), trick.to_owned())];
    report.settings = serde_json::json!({ trick: { trick: trick } });
    let html = page::render(&report);
    assert!(!html.contains("<script>alert") && !html.contains("<b>"));
    // Title twice, summary once, scene once, provenance and settings twice and thrice.
    assert_eq!(html.matches("&lt;script&gt;alert(1)&lt;/script&gt;{{data}}").count(), 9);
    assert_eq!(html.matches("<script").count(), 2);
}

#[test]
fn parts_without_data_are_left_out() {
    let headings = |html: &str| -> Vec<String> {
        let titles = html.split("</h2>").filter_map(|s| s.rsplit_once('>'));
        let mut titles: Vec<String> = titles.map(|(_, title)| title.to_owned()).collect();
        titles.pop();
        titles
    };
    let full = fixture::report();
    assert_eq!(
        headings(&page::render(&full)),
        ["Replay", "Outcomes", "Paths", "Learning", "Settings", "Provenance"]
    );
    assert_eq!(headings(&page::render_replay(&full)), ["Replay", "Outcomes", "Provenance"]);
    let bare = ReportData {
        drives: Vec::new(),
        history: Vec::new(),
        settings: serde_json::Value::Null,
        provenance: Vec::new(),
        ..full
    };
    assert_eq!(headings(&page::render(&bare)), Vec::<String>::new());
}

#[test]
fn numbers_that_are_none_do_not_break_the_page() {
    let mut report = fixture::report();
    report.period = f32::NAN;
    report.beam_range = f32::INFINITY;
    for moment in &mut report.drives[0].moments {
        (moment.x, moment.heading) = (f32::NAN, f32::NAN);
        (moment.beams[0], moment.beams[1]) = (Echo::Wall(f32::INFINITY), Echo::Nothing);
    }
    let html = page::render(&report);
    let (_, data) = html.split_once("id=\"drives\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("its end");
    let data: serde_json::Value = serde_json::from_str(data).expect("JSON");
    assert_eq!(data["drives"][0]["x"][0], 0);
    assert_eq!(data["period"], 0.1);
}
