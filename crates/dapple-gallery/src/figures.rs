//! Lists all figures, paper by paper.

mod fractal;
mod materials;
pub(crate) mod pups;
pub(crate) mod surface;
mod wavelet;
mod worley;

pub(crate) use materials::lit;

use crate::{Figure, Paper};

/// Returns the materials and the papers in page order.
// A function that is not inlined, because a unit test compiles everything that a `static` of its crate references, and
// every user of a `const` compiles it again.
#[inline(never)]
#[must_use]
pub fn papers() -> &'static [Paper] {
    &[
        materials::PAPER,
        surface::PAPER,
        worley::PAPER,
        pups::PAPER,
        wavelet::PAPER,
    ]
}

/// Iterates over all figures, in page order.
pub fn figures() -> impl Iterator<Item = &'static Figure> {
    papers().iter().flat_map(|paper| paper.figures)
}

/// Returns the figures whose name contains one of the filters, or all figures if there is no filter.
#[must_use]
pub fn select(filters: &[String]) -> Vec<&'static Figure> {
    figures()
        .filter(|figure| {
            let name = figure.name();
            filters.is_empty() || filters.iter().any(|filter| name.contains(filter.as_str()))
        })
        .collect()
}
