//! The figures of "Partition of Unity Parametrics for Texture Synthesis".

mod fig_01a;
mod fig_01b;
mod fig_02;
mod fig_03;
mod fig_04;
mod fig_05;
mod weight;

use crate::Paper;
use dapple_pups::hash::{Seed, hash1, unit_f32};

/// The paper, with its figures in its own order.
pub(super) const PAPER: Paper = Paper {
    key: "pups",
    title: "Partition of Unity Parametrics for Texture Synthesis",
    reference: "Jack Caron and David Mould, Graphics Interface 2013",
    figures: &[
        fig_01a::FIGURE,
        fig_01b::FIGURE,
        fig_02::FIGURE,
        fig_03::FIGURE,
        fig_04::FIGURE,
        fig_05::FIGURE,
    ],
};

/// A random value in `[0, 1)` for each of `n` points.
fn random_values(n: usize, seed: Seed) -> Vec<f32> {
    let seed = seed.child("value", 0);
    let value = |point| unit_f32((hash1(seed, [point], 0) >> 32) as u32);
    (0..n as i64).map(value).collect()
}
