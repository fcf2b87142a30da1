//! Figures of our own, which reproduce no paper.

mod fig_01;
mod fig_02;
mod lit;

pub(crate) use lit::lit;

use crate::Paper;

/// The workspace itself, listed as if it were a paper.
pub(super) const PAPER: Paper = Paper {
    key: "house",
    title: "The house",
    reference: "Not from a paper: what the drawing can do, and the built-in recipes",
    figures: &[fig_01::FIGURE, fig_02::FIGURE],
};
