//! The figures of "Texture Synthesis on Surfaces".

mod bricks;
mod checker;
pub(crate) mod exemplar;
mod fig_01;
mod fig_02;
mod fig_03;
mod fig_04;
mod fig_05;
mod fig_extra_along;
mod fig_extra_charts;
mod fig_extra_exemplars;
mod fig_extra_guides;
mod fig_extra_repair;
mod fig_extra_sharp;
mod fig_extra_sizes;
mod fig_extra_symmetry;
mod hooks;
mod letter;
mod puzzle;
mod scales;
pub(crate) mod stage;
mod stripes;
pub(crate) mod subject;
mod suckers;
mod text;
mod textured;
mod wobble;

use crate::Paper;

/// The paper, with its figures in order.
pub(super) const PAPER: Paper = Paper {
    key: "surface",
    title: "Texture Synthesis on Surfaces",
    reference: "Greg Turk, Georgia Institute of Technology, SIGGRAPH 2001, doi 10.1145/383259.383297",
    figures: &[
        fig_01::FIGURE,
        fig_02::FIGURE,
        fig_03::FIGURE,
        fig_04::FIGURE,
        fig_05::FIGURE,
        fig_extra_along::FIGURE,
        fig_extra_charts::FIGURE,
        fig_extra_exemplars::FIGURE,
        fig_extra_guides::FIGURE,
        fig_extra_repair::FIGURE,
        fig_extra_sharp::FIGURE,
        fig_extra_sizes::FIGURE,
        fig_extra_symmetry::FIGURE,
    ],
};
