//! The page of a study: no replay, no script.

use std::fmt::Write;

use super::{PAGE, STYLE, fill, section, settings};
use crate::report::palette;
use crate::report::study::{Part, Section, Study, Table};
use crate::report::svg::escape;

/// One self-contained page; a list of its sections leads it where there are several.
pub fn render_study(study: &Study) -> String {
    let summary = match study.summary.as_str() {
        "" => String::new(),
        text => format!("<p>{}</p>\n", escape(text)),
    };
    let sections: String = study.sections.iter().map(whole).collect();
    let main = contents(&study.sections) + &sections + &settings::provenance(&study.provenance);
    let slots = [
        ("title", escape(&study.title)),
        ("kind", study.kind.to_owned()),
        ("style", palette::style_sheet() + STYLE),
        ("summary", summary),
        ("main", main),
        ("data", "null".to_owned()),
    ];
    fill(PAGE, &slots)
}

fn contents(sections: &[Section]) -> String {
    if sections.len() < 2 {
        return String::new();
    }
    let mut links = String::new();
    for section in sections {
        let (id, heading) = (escape(&section.id), escape(&section.heading));
        let _ = writeln!(links, "<li><a href=\"#{id}\">{heading}</a></li>");
    }
    format!("<nav aria-label=\"Sections\"><ul class=\"legend\">\n{links}</ul></nav>\n")
}

fn whole(part: &Section) -> String {
    let content: String = part.parts.iter().map(html).collect();
    section(&escape(&part.id), &escape(&part.heading), &content)
}

fn html(part: &Part) -> String {
    match part {
        Part::Heading(text) => format!("<h3>{}</h3>\n", escape(text)),
        Part::Text(text) => format!("<p class=\"hint\">{}</p>\n", escape(text)),
        Part::Table(table) => rows(table),
        Part::Folded { summary, table } => {
            let summary = escape(summary);
            format!("<details><summary>{summary}</summary>\n{}</details>\n", rows(table))
        }
        Part::Picture { svg, caption } => figure("wide", svg, caption),
        Part::Maps { svgs, caption } => {
            let maps: String = svgs.iter().map(|svg| figure("", svg, "")).collect();
            let caption = escape(caption);
            format!("<div class=\"figures\">\n{maps}</div>\n<p class=\"hint\">{caption}</p>\n")
        }
    }
}

fn figure(class: &str, svg: &str, caption: &str) -> String {
    let caption = match caption {
        "" => String::new(),
        text => format!("<figcaption>{}</figcaption>", escape(text)),
    };
    format!("<figure class=\"{class}\">{svg}{caption}</figure>\n")
}

fn rows(table: &Table) -> String {
    let class = |number: bool| if number { " class=\"n\"" } else { "" };
    let mut html = String::from("<div class=\"scroll\"><table>\n<thead><tr>");
    for (name, number) in &table.columns {
        let _ = write!(html, "<th scope=\"col\"{}>{}</th>", class(*number), escape(name));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for row in &table.rows {
        html.push_str("<tr>");
        for (place, (cell, (_, number))) in row.iter().zip(&table.columns).enumerate() {
            let (cell, class) = (escape(cell), class(*number));
            let _ = match place {
                0 => write!(html, "<th scope=\"row\"{class}>{cell}</th>"),
                _ => write!(html, "<td{class}>{cell}</td>"),
            };
        }
        html.push_str("</tr>\n");
    }
    html + "</tbody></table></div>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(parts: Vec<Part>) -> String {
        let section = Section { id: "a".to_owned(), heading: "A & B".to_owned(), parts };
        let study = Study { sections: vec![section.clone(), section], ..Study::default() };
        render_study(&study)
    }

    #[test]
    fn text_from_outside_stays_text() {
        let table = Table { columns: vec![("<n>", true)], rows: vec![vec!["<x>".to_owned()]] };
        let text = "<script>".to_owned();
        let page = page(vec![
            Part::Text(text.clone()),
            Part::Heading(text.clone()),
            Part::Folded { summary: text.clone(), table },
            Part::Maps { svgs: vec!["<svg/>".to_owned()], caption: text },
        ]);
        assert_eq!(page.matches("<script").count(), 2, "those of the page itself");
        assert!(page.contains("A &amp; B") && page.contains("<th scope=\"row\" class=\"n\">&lt;x"));
    }

    #[test]
    fn every_slot_of_the_page_is_filled() {
        assert!(!page(Vec::new()).contains("{{"));
    }
}
