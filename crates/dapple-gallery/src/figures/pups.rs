//! The figures of "Partition of Unity Parametrics for Texture Synthesis".

use crate::Paper;

/// The paper, with its figures in its own order.
pub(super) const PAPER: Paper = Paper {
    key: "pups",
    title: "Partition of Unity Parametrics for Texture Synthesis",
    reference: "Jack Caron and David Mould, Graphics Interface 2013",
    figures: &[],
};
