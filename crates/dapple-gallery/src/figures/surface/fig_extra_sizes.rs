//! Features whose sizes follow the directions: they grow where directions spread and shrink where they meet. Rows of
//! scales, lines of text and pieces of a puzzle therefore continue at positions where they begin and end in figure 5,
//! whose features are all the same size.

use super::subject::{BUNNY, ELEPHANT, Subject, ZEBRA};
use crate::figure::source;
use crate::{Figure, Panel};

pub(super) const FIGURE: Figure = Figure {
    number: "extra",
    parameters: &[
        ("points", "96,000"),
        ("sizes", "from 0.35 to 1.05 distances of points"),
    ],
    source: source!(),
    render,
};

fn render(size: u32) -> anyhow::Result<Vec<Panel>> {
    let panel = |mut subject: Subject| {
        subject.n_sites = 96_000;
        subject.sizes = Some([0.35, 1.05]);
        Ok(Panel::color(subject.name, subject.picture(size)?.0))
    };
    [BUNNY, ZEBRA, ELEPHANT].map(panel).into_iter().collect()
}
