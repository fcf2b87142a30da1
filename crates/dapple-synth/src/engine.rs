//! The passes: every site of a level takes the pixel whose neighborhood is most like its own.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 5.

use crate::ground::Ground;
use crate::neighborhood::{Part, Pass, Reads};
use crate::visit::{Kept, Visit};
use crate::{Options, Pyramid, SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use dapple_hash::{Seed, hash1};

/// What is known at every site of a level.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LevelTexture {
    /// `n_channels` values for each site; empty if no pass visited the level.
    pub(crate) colors: Vec<f32>,
    /// The pixel that each site's color is from, as `row * width + column` of the same level of the pyramid.
    pub(crate) sources: Vec<u32>,
}

/// How far a synthesis has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The pass, from 0.
    pub pass: usize,
    /// The number of passes.
    pub n_passes: usize,
    /// The sites of this pass that have their color.
    pub done: usize,
    /// The sites of this pass.
    pub n_sites: usize,
}

/// What is called now and then on the way; it can stop the synthesis.
pub(crate) type Callback<'a> = &'a mut dyn FnMut(Progress) -> ControlFlow<()>;

/// Runs all passes; the textures of the levels, the finest first.
pub(crate) fn run<G: Ground>(
    ground: &G,
    pyramid: &Pyramid,
    options: &Options,
    callback: Callback<'_>,
) -> Result<Vec<LevelTexture>, SynthError> {
    let passes = options.passes()?.passes;
    let mut levels = vec![LevelTexture::default(); pyramid.levels().len()];
    let mut kept = Kept::default();
    let n_passes = passes.len();
    for (index, pass) in passes.iter().enumerate() {
        let reads_itself = pass.parts.iter().any(|part| part.reads == Reads::Same);
        if reads_itself && levels[pass.level].colors.is_empty() {
            fill_randomly(ground, pyramid, pass.level, options.seed, &mut levels);
        }
        let keep = side_to_keep(pass, passes.get(index + 1));
        let visit = Visit::new(ground, pyramid, pass, options)?;
        let mut tell = |done| {
            let progress = Progress {
                pass: index,
                n_passes,
                done,
                n_sites: ground.n_sites(pass.level),
            };
            match callback(progress) {
                ControlFlow::Continue(()) => Ok(()),
                ControlFlow::Break(()) => Err(SynthError::new(SynthErrorKind::Cancelled)),
            }
        };
        kept = visit.run(&mut levels, &kept, keep, &mut tell)?;
    }
    Ok(levels)
}

/// Gives every site of a level the color of a random pixel.
fn fill_randomly<G: Ground>(
    ground: &G,
    pyramid: &Pyramid,
    level: usize,
    seed: Seed,
    levels: &mut [LevelTexture],
) {
    let exemplar = &pyramid.levels()[level];
    let n_pixels = u64::from(exemplar.size[0]) * u64::from(exemplar.size[1]);
    let seed = seed.child("first colors", level as u64);
    let texture = &mut levels[level];
    for site in 0..ground.n_sites(level) as i64 {
        // The upper 32 bits of a product with a number below 2^32 are spread evenly over that number.
        let pixel = ((hash1(seed, [site], 0) >> 32) * n_pixels) >> 32;
        texture.sources.push(pixel as u32);
        let at = pixel as usize * exemplar.n_channels;
        texture
            .colors
            .extend_from_slice(&exemplar.pixels[at..at + exemplar.n_channels]);
    }
}

/// The side of the coarser square of the next pass, if that can be kept from this one: it is on the same level and no larger,
/// and nothing that it reads changes in between.
fn side_to_keep(pass: &Pass, next: Option<&Pass>) -> u32 {
    let coarser_side = |pass: &Pass| {
        let coarser = |part: &&Part| part.reads == Reads::Coarser;
        pass.parts
            .iter()
            .filter(coarser)
            .map(|part| part.side)
            .max()
            .unwrap_or(0)
    };
    let Some(next) = next.filter(|next| next.level == pass.level) else {
        return 0;
    };
    let side = coarser_side(next);
    if side <= coarser_side(pass) { side } else { 0 }
}

#[cfg(test)]
mod tests;
