//! Figures of our own, which no paper has.

mod fig_01;

use crate::Paper;

/// The workspace itself, in the place of a paper.
pub(super) const PAPER: Paper = Paper {
    key: "house",
    title: "The house",
    reference: "Not from a paper: what the frame of the gallery can draw",
    figures: &[fig_01::FIGURE],
};
