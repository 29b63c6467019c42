//! What a report over many runs is made from: sections of text, tables and pictures.

/// A page.
#[derive(Clone, Debug, Default)]
pub struct Study {
    /// Its heading.
    pub title: String,
    /// What it is, above the heading: `reproduction`.
    pub kind: &'static str,
    /// A sentence or two under the heading; may be empty.
    pub summary: String,
    /// Its sections, in order.
    pub sections: Vec<Section>,
    /// Where the result comes from, as name and value.
    pub provenance: Vec<(String, String)>,
}

/// A part of the page with a heading.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Its place in the page's address; letters, digits and `-`.
    pub id: String,
    /// Its heading.
    pub heading: String,
    /// What is in it.
    pub parts: Vec<Part>,
}

/// What a section is made of.
#[derive(Clone, Debug)]
pub enum Part {
    /// A heading within the section.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// A table.
    Table(Table),
    /// A table that is shown when its summary is clicked.
    Folded {
        /// What is clicked.
        summary: String,
        /// What is shown.
        table: Table,
    },
    /// A picture as wide as the page.
    Picture {
        /// SVG.
        svg: String,
        /// What there is to see.
        caption: String,
    },
    /// Small pictures side by side.
    Maps {
        /// SVG.
        svgs: Vec<String>,
        /// What there is to see.
        caption: String,
    },
}

/// Text in rows and columns; the first column names its row.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Heading of each column, and whether it holds numbers.
    pub columns: Vec<(&'static str, bool)>,
    /// The cells of each row, one per column.
    pub rows: Vec<Vec<String>>,
}
