//! Runs one pass of neighborhood matching: visits all sites of a level and assigns each the best candidate.
//!
//! Steps for a site (Turk 2001, section 5):
//!
//! - Sample its neighborhood, on its own level and on the next coarser one ([`LevelPass::read`]).
//! - Form the query vector, and the coherent candidates: pixels that continue the source pixels of the neighbors
//!   (Ashikhmin, "Synthesizing Natural Textures", I3D 2001).
//! - Take the nearest candidate, or a coherent one that is not much farther ([`LevelPass::best_row`]).
//! - If the orientation field has a symmetry, repeat this for each rotation found among the neighbors
//!   ([`LevelPass::best_turned`]).
//!
//! A row is a candidate's index in [`Candidates`]. The order of the sites and the threads are in `visit/order.rs`.

mod order;

use crate::candidates;
use crate::domain::{LevelState, Rows, Samples, Square, SynthesisDomain, UNKNOWN};
use crate::grid;
use crate::matcher::Query;
use crate::neighborhood::{Pass, Reads, Shape};
use crate::options::CoherenceFactors;
use crate::orientation::offset_before;
use crate::sample_cache::SampleCache;
use crate::{Candidates, Exemplar, Matcher, MatcherMemory, Options, Pyramid, Symmetry};
use core::sync::atomic::Ordering;

/// Marks a missing row: no candidate was chosen.
const NOWHERE: u32 = u32::MAX;

/// A pass with its tables: candidates, matcher, and sampling tables of the domain.
pub(crate) struct LevelPass<'a, G: SynthesisDomain> {
    domain: &'a G,
    prepared: G::Prepared,
    level: usize,
    n_channels: usize,
    coarser_width: u32,
    pyramid: &'a [Exemplar],
    candidates: Candidates,
    matcher: Matcher,
    /// Whether the pass is part of a repair. If so, a site keeps its pixel if its whole neighborhood continues one
    /// piece of the exemplar.
    is_repair: bool,
    /// Preference for coherent candidates: one is chosen if its squared distance is at most `1 + coherence` times the
    /// minimum.
    coherence: f32,
    /// [`Options::evenness`]; 0 in passes that do not count usage.
    evenness: f32,
    /// Factor on the guide values in a query.
    guide_scale: f32,
    /// Pixels of a neighborhood, in the order of a query's values.
    terms: Vec<Term>,
    /// Symmetry of the orientation field; [`Symmetry::One`] if a part is not a full square, which cannot be rotated.
    symmetry: Symmetry,
    /// Squares sampled on the level itself (`same`) and on the next coarser one (`coarser`); `None` if the pass does
    /// not read that level.
    same: Option<NeighborhoodHalf>,
    coarser: Option<NeighborhoodHalf>,
}

/// Extent of a square of samples, from `-half` to `half`, and the rows of it that are needed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NeighborhoodHalf {
    pub(crate) half: i32,
    pub(crate) rows: Rows,
}

/// One pixel of a neighborhood, as an offset from its center.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub(crate) reads: Reads,
    /// Index in the square of the pixel's sample, for each rotation of the exemplar (0 to 3 quarter turns).
    pub(crate) samples: [usize; 4],
    offset: [i32; 2],
    root_weight: f32,
}

/// Scratch memory of a thread.
struct Worker<M> {
    /// Rotation of the exemplar in `query` and `coherent`, in quarter turns.
    quarters: u8,
    same: Samples,
    coarser: Samples,
    query: Vec<f32>,
    coherent: Vec<u32>,
    matcher: MatcherMemory,
    domain: M,
}

/// Shared input of all threads. The sources in `here` are also written.
#[derive(Clone, Copy)]
struct State<'a> {
    here: LevelState<'a>,
    coarser: Option<LevelState<'a>>,
    kept: &'a SampleCache,
    /// Factor on the squared distance of each row; see [`Query::factors`].
    factors: Option<&'a [f32]>,
}

impl<'a, G: SynthesisDomain> LevelPass<'a, G> {
    /// Sets up a pass: builds the sampling tables, the search index over the candidates, and the list of pixels that
    /// make up a query.
    pub(crate) fn new(
        domain: &'a G,
        pyramid: &'a Pyramid,
        candidates: Candidates,
        pass: &Pass,
        options: &Options,
        coherence: CoherenceFactors,
    ) -> Self {
        let exemplar = &pyramid.levels()[pass.level];
        let same = half_of(pass, Reads::Same);
        // Read all rows of the coarser square, because its middle sample determines the coherent rows.
        let coarser = half_of(pass, Reads::Coarser).map(|half| NeighborhoodHalf {
            rows: Rows::All,
            ..half
        });
        let terms = terms_of(
            pass,
            [same, coarser].map(|half| half.map_or(0, |half| half.half)),
        );
        let (coherence, evenness) = match coarser {
            // Guides determine which pixels are used, so usage cannot be evened out.
            None if exemplar.n_guides() > 0 => (coherence.initial, 0.0),
            None => (coherence.initial, options.evenness),
            Some(_) => (coherence.finer, 0.0),
        };
        Self {
            domain,
            prepared: domain.prepare(
                pass.level,
                same.map(|half| half.half),
                coarser.map(|half| half.half),
            ),
            level: pass.level,
            n_channels: exemplar.n_channels,
            coarser_width: pyramid
                .levels()
                .get(pass.level + 1)
                .map_or(1, |level| level.size[0]),
            pyramid: pyramid.levels(),
            matcher: if evenness > 0.0 {
                Matcher::with_factors(candidates.dims, &candidates.rows)
            } else {
                Matcher::new(candidates.dims, &candidates.rows)
            },
            candidates,
            is_repair: domain.start(pass.level).is_some(),
            symmetry: match pass.parts.iter().all(|part| part.shape == Shape::Full) {
                true => domain.symmetry(),
                // If the square is rotated, the rows above the center do not contain the sites visited earlier.
                false => Symmetry::One,
            },
            coherence,
            evenness,
            guide_scale: candidates::guide_scale(pass),
            terms,
            same,
            coarser,
        }
    }

    /// Assigns a site the pixel of the best row, and returns the row's index.
    fn visit(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) -> u32 {
        self.read(site, worker, state);
        let sources = state.here.sources;
        // In a repair, keep a pixel whose whole neighborhood continues one piece of the exemplar.
        if self.is_repair
            && let Some(pixel) = self.pixel_of_piece(site, worker, state)
        {
            sources.pixels[site as usize].store(pixel, Ordering::Relaxed);
            return NOWHERE;
        }
        let row = if self.symmetry == Symmetry::One {
            self.gather(site, worker, state);
            self.best_row(worker, state.factors).row
        } else {
            let (best, quarters) = self.best_turned(site, worker, state);
            sources.quarters[site as usize].store(quarters, Ordering::Relaxed);
            best.row
        };
        // The row is missing only if values are not finite. The site then keeps its pixel.
        if let Some(&pixel) = self.candidates.pixels.get(row as usize) {
            // Relaxed ordering suffices: the schedule orders this write before reads by other threads.
            sources.pixels[site as usize].store(pixel, Ordering::Relaxed);
        }
        row
    }

    /// Returns the best row and rotation among the rotations of the neighbors.
    fn best_turned(
        &self,
        site: u32,
        worker: &mut Worker<G::Memory>,
        state: &State<'_>,
    ) -> (Best, u8) {
        let wanted = self.quarters_around(site, worker, state);
        let mut best = (Best::NONE, 0);
        let turns = self.symmetry.quarters().iter().copied();
        for quarters in turns.filter(|&quarters| wanted[usize::from(quarters)]) {
            worker.quarters = quarters;
            self.gather(site, worker, state);
            let found = self.best_row(worker, state.factors);
            if best.0.row == NOWHERE || found.distance_sq < best.0.distance_sq {
                best = (found, quarters);
            }
        }
        worker.quarters = 0;
        best
    }

    /// Returns which rotations (in quarter turns) occur at a site's eight neighbors and in the middle of its coarser
    /// square.
    fn quarters_around(
        &self,
        site: u32,
        worker: &Worker<G::Memory>,
        state: &State<'_>,
    ) -> [bool; 4] {
        let mut found = [false; 4];
        let mut add = |painted: &LevelState<'_>, nearest: u32| {
            if nearest != site && nearest != UNKNOWN {
                found[usize::from(self.quarters_of(site, nearest, painted))] = true;
            }
        };
        // Middle of the coarser square.
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            let side = 2 * half.half as usize + 1;
            add(&painted, worker.coarser.nearest[side * side / 2]);
        }
        // Eight neighbors on the level itself.
        for term in self.terms.iter().filter(|term| term.is_beside()) {
            add(&state.here, worker.same.nearest[term.samples[0]]);
        }
        // Without neighbors, use the site's own rotation.
        if found == [false; 4] {
            found[usize::from(state.here.quarters(site as usize))] = true;
        }
        found
    }

    /// Returns the rotation of the exemplar at `site`, in quarter turns, if it continues the rotation at `other`.
    #[inline]
    fn quarters_of(&self, site: u32, other: u32, painted: &LevelState<'_>) -> u8 {
        let quarters = painted.quarters(other as usize);
        self.domain.quarters_toward(site, other, quarters)
    }

    /// Returns the pixel of a site if its whole neighborhood continues one piece of the exemplar. No candidate fits
    /// better.
    fn pixel_of_piece(
        &self,
        site: u32,
        worker: &Worker<G::Memory>,
        state: &State<'_>,
    ) -> Option<u32> {
        let (reads, samples, painted) = match self.same {
            Some(_) => (Reads::Same, &worker.same, state.here),
            None => (Reads::Coarser, &worker.coarser, state.coarser?),
        };
        let exemplar = &self.pyramid[self.level + reads.step()];
        // All samples must predict the same pixel at the center.
        let mut piece = None;
        for term in self.terms.iter().filter(|term| term.reads == reads) {
            let nearest = samples.nearest[term.samples[0]];
            if nearest == UNKNOWN {
                continue;
            }
            // Predict the pixel at the center: the source of the sample minus its offset.
            let source = painted.source(nearest as usize);
            let width = exemplar.size[0];
            let [x, y] = [source % width, source / width].map(i64::from);
            let [i, j] = term.offset.map(i64::from);
            let predicted = exemplar.pixel_at([x - i, y - j])?;
            if *piece.get_or_insert(predicted) != predicted {
                return None;
            }
        }
        // On its own level, the site must already have this pixel; otherwise take the child of the coarser pixel.
        let piece = piece? as u32;
        if reads == Reads::Same {
            return (painted.source(site as usize) == piece).then_some(piece);
        }
        let (_, quarter) = self.domain.parent(self.level, site)?;
        let pixel = grid::over(piece, self.coarser_width, quarter);
        Some(self.pyramid[self.level].pixel_at(pixel)? as u32)
    }

    /// Samples the neighborhood of a site on both levels. Coarser samples that the previous pass retained are reused.
    fn read(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) {
        let Worker {
            same,
            coarser,
            domain,
            ..
        } = worker;
        let square = |reads, half: NeighborhoodHalf| Square {
            site,
            level: self.level,
            reads,
            half: half.half,
            rows: half.rows,
        };
        // Sample the square on the level itself.
        if let Some(half) = self.same {
            let square = square(self.level, half);
            same.make_room(square.side(), self.n_channels);
            self.domain
                .read(square, &self.prepared, state.here, same, domain);
        }
        // Sample the square on the coarser level, or reuse the samples of the previous pass.
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            let square = square(self.level + 1, half);
            coarser.make_room(square.side(), self.n_channels);
            if !state.kept.paste(site, &square, coarser) {
                self.domain
                    .read(square, &self.prepared, painted, coarser, domain);
            }
        }
    }

    /// Assembles the query from the samples, and collects the coherent rows, which continue the sources of the
    /// neighbors.
    fn gather(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) {
        let Worker {
            quarters,
            same,
            coarser,
            query,
            coherent,
            ..
        } = worker;
        let center = Center {
            site,
            quarters: *quarters,
        };
        // Collect the coherent rows.
        coherent.clear();
        if self.same.is_some() {
            self.continue_same(center, same, &state.here, coherent);
        }
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            self.continue_coarser(center, half, coarser, &painted, coherent);
        }
        // Append the weighted samples, then the guides.
        query.clear();
        let squares = [&*same, &*coarser];
        push_terms(
            &self.terms,
            squares,
            self.n_channels,
            center.quarters,
            query,
        );
        if let Some(targets) = self.domain.targets() {
            let guides = targets.of(self.level, site).iter();
            query.extend(guides.map(|value| value * self.guide_scale));
        }
    }

    /// Adds the coherent rows of the level itself. Each of the eight neighboring samples predicts its source pixel plus
    /// the offset from the sample to this site.
    fn continue_same(
        &self,
        center: Center,
        samples: &Samples,
        painted: &LevelState<'_>,
        coherent: &mut Vec<u32>,
    ) {
        for term in self.terms.iter().filter(|term| term.is_beside()) {
            let [i, j] = term.offset;
            let nearest = samples.nearest[term.samples[usize::from(center.quarters)]];
            if nearest == center.site || nearest == UNKNOWN {
                continue;
            }
            if self.quarters_of(center.site, nearest, painted) != center.quarters {
                // A neighbor continues its piece of the exemplar only under the piece's own rotation.
                continue;
            }
            let source = painted.source(nearest as usize);
            // The neighbor at (i, j) has `source`, so `source` minus (i, j) continues its piece here (Ashikhmin).
            add_coherent(self.candidates.row_beside(source, [-i, -j]), coherent);
        }
    }

    /// Adds the coherent candidates of the coarser level: the four children of the pixel that the neighborhood's center
    /// sample was copied from.
    fn continue_coarser(
        &self,
        center: Center,
        half: NeighborhoodHalf,
        samples: &Samples,
        painted: &LevelState<'_>,
        coherent: &mut Vec<u32>,
    ) {
        let side = 2 * half.half as usize + 1;
        let nearest = samples.nearest[side * side / 2];
        if self.quarters_of(center.site, nearest, painted) != center.quarters {
            return;
        }
        let source = painted.source(nearest as usize);
        for offset in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            // Four pixels share a parent; each of them could continue the coarser piece.
            let row = self
                .candidates
                .row_under(source, self.coarser_width, offset);
            add_coherent(row, coherent);
        }
    }

    /// Returns the nearest row, or a coherent one whose squared distance is at most `1 + coherence` times as large.
    fn best_row(&self, worker: &mut Worker<G::Memory>, factors: Option<&[f32]>) -> Best {
        let Worker {
            query,
            coherent,
            matcher,
            ..
        } = worker;
        // Find the nearest coherent row. If coherence counts, other rows have to be nearer by its factor.
        let all = Query {
            values: query,
            below: f32::INFINITY,
            hint: None,
            factors,
        };
        let near = self.matcher.find_among(all, coherent, matcher);
        let fallback = match near {
            Some(near) if self.coherence > 0.0 => Best {
                row: near.row,
                distance_sq: near.distance_sq / (1.0 + self.coherence),
            },
            _ => Best::NONE,
        };
        // Find a row that is nearer than this fallback.
        let query = Query {
            below: fallback.distance_sq,
            hint: near.map(|near| near.row),
            ..all
        };
        let found = self.matcher.find(query, matcher);
        found.map_or(fallback, |found| Best {
            row: found.row,
            distance_sq: found.distance_sq,
        })
    }
}

/// Best row for a query.
#[derive(Clone, Copy, Debug)]
struct Best {
    row: u32,
    /// Squared distance of the row, divided by `1 + coherence` if the row is coherent.
    distance_sq: f32,
}

impl Best {
    /// State before any row is found.
    const NONE: Self = Self {
        row: NOWHERE,
        distance_sq: f32::INFINITY,
    };
}

/// Center of a neighborhood: its site, and the rotation of the exemplar at the site, in quarter turns.
#[derive(Clone, Copy, Debug)]
struct Center {
    site: u32,
    quarters: u8,
}

impl Term {
    /// Returns whether the pixel is one of the eight neighbors on the level itself.
    fn is_beside(&self) -> bool {
        self.reads == Reads::Same && self.offset.iter().all(|at| at.abs() <= 1)
    }
}

impl<M: Default> Default for Worker<M> {
    fn default() -> Self {
        Self {
            quarters: 0,
            same: Samples::default(),
            coarser: Samples::default(),
            query: Vec::new(),
            coherent: Vec::new(),
            matcher: MatcherMemory::default(),
            domain: M::default(),
        }
    }
}

/// Adds a row unless it is `None` or already present.
fn add_coherent(row: Option<u32>, coherent: &mut Vec<u32>) {
    if let Some(row) = row
        && !coherent.contains(&row)
    {
        coherent.push(row);
    }
}

/// Appends the values of a neighborhood to `target`, each multiplied by the square root of its weight. `squares` are
/// the samples on the level itself and on the coarser one; `quarters` is the rotation of the exemplar in quarter turns.
pub(crate) fn push_terms(
    terms: &[Term],
    squares: [&Samples; 2],
    n_channels: usize,
    quarters: u8,
    target: &mut Vec<f32>,
) {
    for term in terms {
        let at = term.samples[usize::from(quarters)] * n_channels;
        let values = &squares[term.reads.step()].values[at..at + n_channels];
        target.extend(values.iter().map(|value| value * term.root_weight));
    }
}

/// Returns the smallest square that contains all parts of a pass that read the level `reads`, or `None` if no part
/// reads it.
pub(crate) fn half_of(pass: &Pass, reads: Reads) -> Option<NeighborhoodHalf> {
    let parts = || pass.parts.iter().filter(|part| part.reads == reads);
    let side = parts().map(|part| part.side).max()?;
    let rows = |shape| match shape {
        Shape::Half => Rows::Above,
        Shape::HalfWithRow | Shape::Causal => Rows::AboveAndMiddle,
        Shape::Full => Rows::All,
    };
    Some(NeighborhoodHalf {
        half: side as i32 / 2,
        rows: parts().map(|part| rows(part.shape)).max()?,
    })
}

/// Returns the pixels of a neighborhood in the order of a candidate's values. `halves` are the half-side lengths of the
/// squares on the level itself and on the coarser one.
pub(crate) fn terms_of(pass: &Pass, halves: [i32; 2]) -> Vec<Term> {
    let mut terms = Vec::new();
    for part in &pass.parts {
        let half = match part.reads {
            Reads::Same => halves[0],
            Reads::Coarser => halves[1],
        };
        let side = 2 * half + 1;
        for offset in part.offsets() {
            // The exemplar is rotated by `quarters`, so look up the sample at the offset before the rotation.
            let sample = |quarters| {
                let [i, j] = offset_before(offset, quarters);
                ((j + half) * side + i + half) as usize
            };
            terms.push(Term {
                reads: part.reads,
                samples: [0, 1, 2, 3].map(sample),
                offset,
                root_weight: part.weight.sqrt(),
            });
        }
    }
    terms
}
