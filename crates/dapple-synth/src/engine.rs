//! Synthesis by neighborhood matching: every site of a level takes the pixel whose neighborhood in the exemplar is most
//! similar to its own.
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 5.
//!
//! Input: a [`SynthesisDomain`] (sites on several levels and how their neighborhoods are sampled), the [`Pyramid`] of the
//! exemplar, and [`Options`] with the schedule of passes. Each pass visits all sites of one level; coarser levels come
//! first. [`LevelPass`] implements a single pass. Output: [`Sources`] per level, with the exemplar pixel and the rotation
//! at each site.

use crate::domain::{Sources, SynthesisDomain, UNKNOWN};
use crate::grid;
use crate::guides::{self, Targets};
use crate::level_pass::LevelPass;
use crate::neighborhood::{Part, Pass, Reads};
use crate::sample_cache::SampleCache;
use crate::{Candidates, Exemplar, Options, Pyramid, Symmetry, SynthError, SynthErrorKind};
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering};
use dapple_hash::{Seed, hash1};

/// Progress of a synthesis, or of other work done in several passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Index of the current pass, from 0.
    pub pass: usize,
    /// Number of passes.
    pub n_passes: usize,
    /// Number of sites finished in this pass.
    pub done: usize,
    /// Number of sites in this pass.
    pub n_sites: usize,
}

impl Progress {
    /// Returns the completed fraction of the work, from 0 to 1, assuming that all passes take the same time.
    #[must_use]
    pub fn part(&self) -> f64 {
        let done = self.done as f64 / self.n_sites.max(1) as f64;
        (self.pass as f64 + done) / self.n_passes.max(1) as f64
    }
}

/// Progress callback; [`ControlFlow::Break`] stops the synthesis.
pub(crate) type Callback<'a> = &'a mut dyn FnMut(Progress) -> ControlFlow<()>;

/// Calls the progress callback, and fails with [`SynthErrorKind::Cancelled`] if it stops the synthesis.
pub(crate) fn report(callback: Callback<'_>, progress: Progress) -> Result<(), SynthError> {
    match callback(progress) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(SynthError::new(SynthErrorKind::Cancelled)),
    }
}

/// Cancellation token for the setup of a synthesis, polled on all threads.
pub(crate) struct Wanted<'a> {
    is_cancelled: &'a (dyn Fn() -> bool + Sync),
    is_over: AtomicBool,
}

impl<'a> Wanted<'a> {
    pub(crate) fn new(is_cancelled: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self {
            is_cancelled,
            is_over: AtomicBool::new(false),
        }
    }

    /// Returns true once the caller has asked to stop. Results computed after that are discarded and may be arbitrary.
    pub(crate) fn is_over(&self) -> bool {
        if !self.is_over.load(Ordering::Relaxed) && (self.is_cancelled)() {
            self.is_over.store(true, Ordering::Relaxed);
        }
        self.is_over.load(Ordering::Relaxed)
    }

    /// Fails with [`SynthErrorKind::Cancelled`] if the caller has asked to stop.
    pub(crate) fn check(&self) -> Result<(), SynthError> {
        match self.is_over() {
            true => Err(SynthError::new(SynthErrorKind::Cancelled)),
            false => Ok(()),
        }
    }
}

/// Runs the passes of the options. Returns, for each level from the finest, the exemplar pixel of each site, as
/// `row * width + column` in that level of the pyramid. A level that no pass visited has an empty list.
pub(crate) fn run<G: SynthesisDomain>(
    domain: &G,
    pyramid: &Pyramid,
    options: &Options,
    callback: Callback<'_>,
) -> Result<Vec<Vec<u32>>, SynthError> {
    let levels = run_turned(domain, pyramid, options, callback)?;
    Ok(Sources::pixels_and_quarters(levels).0)
}

/// Runs the passes of the options. Returns the exemplar pixel and the rotation (in quarter turns) at each site of each
/// level.
pub(crate) fn run_turned<G: SynthesisDomain>(
    domain: &G,
    pyramid: &Pyramid,
    options: &Options,
    callback: Callback<'_>,
) -> Result<Vec<Sources>, SynthError> {
    let passes = options.passes()?.passes;
    run_passes(domain, pyramid, &passes, options, callback)
}

/// Runs the given passes instead of the schedule in the options. Returns the same as [`run_turned`].
pub(crate) fn run_passes<G: SynthesisDomain>(
    domain: &G,
    pyramid: &Pyramid,
    passes: &[Pass],
    options: &Options,
    callback: Callback<'_>,
) -> Result<Vec<Sources>, SynthError> {
    // Match with a pyramid that is blurred as much as the samples of the domain.
    let seen = match domain.blur() {
        0.0 => None,
        blur => Some(pyramid.blurred(blur)),
    };
    let seen = seen.as_ref().unwrap_or(pyramid);
    // Gather the candidates. A repair treats neighborhoods that reach past an edge differently.
    let candidates = |pass: &Pass| match domain.start(pass.level) {
        Some(_) => Candidates::of_repair(seen, pass, options.center),
        None => Candidates::for_options(seen, pass, options),
    };
    run_with(domain, pyramid, passes, &candidates, options, callback)
}

/// Runs the given passes like [`run_passes`], with candidates computed by the callback `candidates`.
pub(crate) fn run_with<G: SynthesisDomain>(
    domain: &G,
    pyramid: &Pyramid,
    passes: &[Pass],
    candidates: &dyn Fn(&Pass) -> Result<Candidates, SynthError>,
    options: &Options,
    callback: Callback<'_>,
) -> Result<Vec<Sources>, SynthError> {
    let n_guides = domain.targets().map_or(0, Targets::len);
    guides::check_count(n_guides, pyramid.levels()[0].n_guides())?;
    let coherence = options.coherence.factors(&pyramid.levels()[0]);
    let mut levels: Vec<Sources> = Vec::new();
    levels.resize_with(pyramid.levels().len(), Sources::default);
    let (mut kept, mut visit) = (SampleCache::default(), None);
    let n_passes = passes.len();
    for (index, pass) in passes.iter().enumerate() {
        // Consecutive equal passes share their candidates.
        if index == 0 || passes[index - 1] != *pass {
            // Free the previous candidates and matcher first, to lower peak memory.
            drop(visit.take());
            // Initialize the level before its first pass.
            let candidates = candidates(pass)?;
            if levels[pass.level].pixels.is_empty() {
                let first = first_sources(domain, pyramid, pass, &candidates, options);
                if let (Some(start), Some(coarser)) =
                    (domain.start(pass.level), levels.get(pass.level + 1))
                {
                    go_on_with(coarser, &first, domain, pyramid, pass.level, &start.is_kept);
                }
                levels[pass.level] = first;
            }
            visit = Some(LevelPass::new(
                domain, pyramid, candidates, pass, options, coherence,
            ));
        }
        let Some(visit) = &visit else { continue };
        let n_sites = domain.n_sites(pass.level);
        let mut tell = |done| {
            let progress = Progress {
                pass: index,
                n_passes,
                done,
                n_sites,
            };
            report(callback, progress)
        };
        let keep = side_to_keep(pass, passes.get(index + 1));
        kept = visit.run(&levels, &kept, keep, &mut tell)?;
    }
    Ok(levels)
}

/// Returns the initial sources of a level: known pixels in a repair, random pixels or zeros elsewhere.
fn first_sources<G: SynthesisDomain>(
    domain: &G,
    pyramid: &Pyramid,
    pass: &Pass,
    candidates: &Candidates,
    options: &Options,
) -> Sources {
    let n_sites = domain.n_sites(pass.level);
    let start = domain.start(pass.level);
    let reads_itself = pass.parts.iter().any(|part| part.reads == Reads::Same);
    let mut first = if reads_itself || start.is_some() {
        // Section 5.2: start from random pixels of the same level of the pyramid.
        random_pixels(n_sites, pyramid, candidates, pass.level, options.seed)
    } else {
        // The pass reads only the coarser level, so these values are never read.
        vec![0; n_sites]
    };
    // Overwrite with the known pixels of a repair.
    let known = start.map_or(&[][..], |start| &start.pixels);
    for (first, &known) in first.iter_mut().zip(known) {
        if known != UNKNOWN {
            *first = known;
        }
    }
    let mut sources = Sources {
        pixels: first.into_iter().map(AtomicU32::new).collect(),
        ..Sources::default()
    };
    if domain.symmetry() != Symmetry::One {
        sources.quarters.resize_with(n_sites, AtomicU8::default);
    }
    sources
}

/// Initializes the sites of a repair that do not keep their pixel: each takes the pixel that continues its parent on
/// the coarser level. A site keeps its initial value if it has no parent or if that pixel is not usable.
fn go_on_with<G: SynthesisDomain>(
    coarser: &Sources,
    sources: &Sources,
    domain: &G,
    pyramid: &Pyramid,
    level: usize,
    is_kept: &[bool],
) {
    let [finer, wider] = [0, 1].map(|step| &pyramid.levels()[level + step]);
    let sites = (0..).zip(&sources.pixels).zip(is_kept);
    for ((site, source), _) in sites.filter(|(_, is_kept)| !**is_kept) {
        let pixel = domain.parent(level, site).and_then(|(parent, quarter)| {
            let coarser = coarser.pixels.get(parent as usize)?;
            // Of the four children of the coarser pixel, take the one at the site's place under its parent.
            let pixel = grid::over(coarser.load(Ordering::Relaxed), wider.size[0], quarter);
            let pixel = finer.pixel_at(pixel);
            pixel.filter(|&pixel| finer.is_usable(pixel))
        });
        if let Some(pixel) = pixel {
            source.store(pixel as u32, Ordering::Relaxed);
        }
    }
}

impl Sources {
    /// Returns the pixels of the sites of all levels, and the rotations (in quarter turns) of the sites of the finest
    /// level.
    pub(crate) fn pixels_and_quarters(mut levels: Vec<Self>) -> (Vec<Vec<u32>>, Vec<u8>) {
        let finest = levels.first_mut().map(|level| &mut level.quarters);
        let quarters = finest.map(core::mem::take).unwrap_or_default();
        let quarters = quarters.into_iter().map(AtomicU8::into_inner).collect();
        let pixels = |level: Self| {
            let pixels = level.pixels.into_iter();
            pixels.map(AtomicU32::into_inner).collect()
        };
        (levels.into_iter().map(pixels).collect(), quarters)
    }
}

/// Returns a random exemplar pixel for every site of a level. If the exemplar has a mask, only the pixels of candidates
/// are drawn.
fn random_pixels(
    n_sites: usize,
    pyramid: &Pyramid,
    candidates: &Candidates,
    level: usize,
    seed: Seed,
) -> Vec<u32> {
    let Exemplar { size, usable, .. } = &pyramid.levels()[level];
    let among = usable.as_ref().map(|_| &candidates.pixels);
    let n_pixels = among.map_or(u64::from(size[0]) * u64::from(size[1]), |among| {
        among.len() as u64
    });
    let seed = seed.child("first colors", level as u64);
    // Scale the upper 32 bits of the hash to 0..n_pixels: multiply and take the upper half of the product.
    let number = |site| (((hash1(seed, [site], 0) >> 32) * n_pixels) >> 32) as u32;
    let pixel = |number: u32| among.map_or(number, |among| among[number as usize]);
    (0..n_sites as i64)
        .map(|site| pixel(number(site)))
        .collect()
}

/// Returns the side of the coarser square to retain for the next pass, in samples, or 0. The square is retained if the
/// next pass is on the same level and its coarser square is not larger, since the coarser level does not change between
/// the two passes.
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
