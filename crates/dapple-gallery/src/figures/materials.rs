//! The built-in materials, which reproduce no paper.

mod fig_01;
mod lit;

pub(crate) use lit::lit;

use crate::Paper;

/// The built-in materials, listed as if they were a paper.
pub(super) const PAPER: Paper = Paper {
    key: "materials",
    title: "Materials",
    reference: "The built-in recipes; each is a text file of nodes",
    figures: &[fig_01::FIGURE],
};
