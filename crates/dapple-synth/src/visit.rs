//! One visit of all sites of a level.

mod order;

use crate::candidates;
use crate::ground::{Ground, Painted, Rows, Samples, Square, UNKNOWN};
use crate::kept::Kept;
use crate::matcher::Query;
use crate::neighborhood::{Pass, Reads, Shape};
use crate::options::CoherenceFactors;
use crate::{Candidates, Exemplar, Matcher, MatcherMemory, Options, Pyramid};
use core::sync::atomic::Ordering;

/// No row.
const NOWHERE: u32 = u32::MAX;

/// A pass with everything that it needs.
pub(crate) struct Visit<'a, G: Ground> {
    ground: &'a G,
    prepared: G::Prepared,
    level: usize,
    n_channels: usize,
    coarser_width: u32,
    pyramid: &'a [Exemplar],
    candidates: Candidates,
    matcher: Matcher,
    /// Whether sites that go on with what is around them keep their pixels.
    is_repair: bool,
    coherence: f32,
    /// 0 where uses do not count.
    evenness: f32,
    /// The factor of guides in a query.
    guide_scale: f32,
    /// Where the values of a query come from.
    terms: Vec<Term>,
    /// The squares that are read on the level itself and on the coarser one.
    same: Option<Half>,
    coarser: Option<Half>,
}

/// A square of samples, without its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Half {
    pub(crate) half: i32,
    pub(crate) rows: Rows,
}

/// One pixel of a neighborhood.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub(crate) reads: Reads,
    /// Its number in the square of samples.
    pub(crate) sample: usize,
    offset: [i32; 2],
    root_weight: f32,
}

/// Memory of a thread.
struct Worker<M> {
    same: Samples,
    coarser: Samples,
    query: Vec<f32>,
    coherent: Vec<u32>,
    matcher: MatcherMemory,
    ground: M,
}

/// The input of all threads; [`Painted`] of the level itself is also written.
#[derive(Clone, Copy)]
struct State<'a> {
    here: Painted<'a>,
    coarser: Option<Painted<'a>>,
    kept: &'a Kept,
    /// The factors of the rows' squared distances.
    factors: Option<&'a [f32]>,
}

impl<'a, G: Ground> Visit<'a, G> {
    /// Prepares a pass.
    pub(crate) fn new(
        ground: &'a G,
        pyramid: &'a Pyramid,
        candidates: Candidates,
        pass: &Pass,
        options: &Options,
        coherence: CoherenceFactors,
    ) -> Self {
        let exemplar = &pyramid.levels()[pass.level];
        let same = half_of(pass, Reads::Same);
        // All of it, since its middle says which pixels continue the coarser level.
        let coarser = half_of(pass, Reads::Coarser).map(|half| Half {
            rows: Rows::All,
            ..half
        });
        let terms = terms_of(
            pass,
            [same, coarser].map(|half| half.map_or(0, |half| half.half)),
        );
        let (coherence, evenness) = match coarser {
            // Where guides say which pixels there are, those are used unevenly.
            None if exemplar.n_guides() > 0 => (coherence.initial, 0.0),
            None => (coherence.initial, options.evenness),
            Some(_) => (coherence.finer, 0.0),
        };
        Self {
            ground,
            prepared: ground.prepare(
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
            is_repair: ground.start(pass.level).is_some(),
            coherence,
            evenness,
            guide_scale: candidates::guide_scale(pass),
            terms,
            same,
            coarser,
        }
    }

    /// Gives a site the pixel of the row that matches, and tells which one that is.
    fn visit(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) -> u32 {
        self.gather(site, worker, state);
        if self.is_repair
            && let Some(pixel) = self.pixel_of_piece(site, worker, state)
        {
            state.here.sources[site as usize].store(pixel, Ordering::Relaxed);
            return NOWHERE;
        }
        let row = self.best_row(worker, state.factors);
        // Without any row, which finite values do not lead to, the site keeps what it has.
        if let Some(&pixel) = self.candidates.pixels.get(row as usize) {
            // Turns of other threads that read it are ordered by the board.
            state.here.sources[site as usize].store(pixel, Ordering::Relaxed);
        }
        row
    }

    /// The pixel of a site all of whose neighborhood goes on with one piece of the exemplar: no other fits better.
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
        let mut piece = None;
        for term in self.terms.iter().filter(|term| term.reads == reads) {
            let nearest = samples.nearest[term.sample];
            if nearest == UNKNOWN {
                continue;
            }
            let source = painted.source(nearest as usize);
            let width = exemplar.size[0];
            let [x, y] = [source % width, source / width].map(i64::from);
            let [i, j] = term.offset.map(i64::from);
            let predicted = exemplar.pixel_at([x - i, y - j])?;
            if *piece.get_or_insert(predicted) != predicted {
                return None;
            }
        }
        let piece = piece? as u32;
        if reads == Reads::Same {
            return (painted.source(site as usize) == piece).then_some(piece);
        }
        let quarter = self.ground.quarter(self.level, site)?;
        let [x, y] = [piece % exemplar.size[0], piece / exemplar.size[0]].map(i64::from);
        let pixel = [2 * x + quarter[0], 2 * y + quarter[1]];
        Some(self.pyramid[self.level].pixel_at(pixel)? as u32)
    }

    /// Reads the neighborhood of a site, and gathers the rows that continue its neighbors.
    fn gather(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) {
        let Worker {
            same,
            coarser,
            query,
            coherent,
            ground,
            ..
        } = worker;
        let square = |reads, half: Half| Square {
            site,
            level: self.level,
            reads,
            half: half.half,
            rows: half.rows,
        };
        coherent.clear();
        if let Some(half) = self.same {
            let square = square(self.level, half);
            same.make_room(square.side(), self.n_channels);
            self.ground
                .read(square, &self.prepared, state.here, same, ground);
            self.continue_same(&square, same, &state.here, coherent);
        }
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            let square = square(self.level + 1, half);
            coarser.make_room(square.side(), self.n_channels);
            if !state.kept.paste(site, &square, coarser) {
                self.ground
                    .read(square, &self.prepared, painted, coarser, ground);
            }
            self.continue_coarser(&square, coarser, &painted, coherent);
        }
        query.clear();
        push_terms(&self.terms, [same, coarser], self.n_channels, query);
        if let Some(targets) = self.ground.targets() {
            let guides = targets.of(self.level, site).iter();
            query.extend(guides.map(|value| value * self.guide_scale));
        }
    }

    /// The rows of the pixels that lie beside the sources of the eight nearest samples, as this site lies beside them.
    fn continue_same(
        &self,
        square: &Square,
        samples: &Samples,
        painted: &Painted<'_>,
        coherent: &mut Vec<u32>,
    ) {
        for term in &self.terms {
            let [i, j] = term.offset;
            if term.reads != Reads::Same || i.abs() > 1 || j.abs() > 1 {
                continue;
            }
            let nearest = samples.nearest[term.sample];
            if nearest == square.site || nearest == UNKNOWN {
                continue;
            }
            let source = painted.source(nearest as usize);
            add_coherent(self.candidates.row_beside(source, [-i, -j]), coherent);
        }
    }

    /// The rows of the four pixels under the source of the coarser sample in the middle.
    fn continue_coarser(
        &self,
        square: &Square,
        samples: &Samples,
        painted: &Painted<'_>,
        coherent: &mut Vec<u32>,
    ) {
        let middle = (square.side() * square.side()) / 2;
        let source = painted.source(samples.nearest[middle] as usize);
        for offset in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let row = self
                .candidates
                .row_under(source, self.coarser_width, offset);
            add_coherent(row, coherent);
        }
    }

    /// The row that the site takes: the nearest one, or a coherent one that is not much farther.
    fn best_row(&self, worker: &mut Worker<G::Memory>, factors: Option<&[f32]>) -> u32 {
        let Worker {
            query,
            coherent,
            matcher,
            ..
        } = worker;
        let all = Query {
            values: query,
            below: f32::INFINITY,
            hint: None,
            factors,
        };
        let near = self.matcher.find_among(all, coherent, matcher);
        let (below, fallback) = match near {
            Some(near) if self.coherence > 0.0 => {
                (near.distance_sq / (1.0 + self.coherence), near.row)
            }
            _ => (f32::INFINITY, NOWHERE),
        };
        let query = Query {
            below,
            hint: near.map(|near| near.row),
            ..all
        };
        let found = self.matcher.find(query, matcher);
        found.map_or(fallback, |found| found.row)
    }
}

impl<M: Default> Default for Worker<M> {
    fn default() -> Self {
        Self {
            same: Samples::default(),
            coarser: Samples::default(),
            query: Vec::new(),
            coherent: Vec::new(),
            matcher: MatcherMemory::default(),
            ground: M::default(),
        }
    }
}

/// Adds a row, if there is one and it is not yet there.
fn add_coherent(row: Option<u32>, coherent: &mut Vec<u32>) {
    if let Some(row) = row
        && !coherent.contains(&row)
    {
        coherent.push(row);
    }
}

/// Appends the values of a neighborhood, from squares on the level itself and on the coarser one.
pub(crate) fn push_terms(
    terms: &[Term],
    squares: [&Samples; 2],
    n_channels: usize,
    target: &mut Vec<f32>,
) {
    for term in terms {
        let at = term.sample * n_channels;
        let values = &squares[term.reads.step()].values[at..at + n_channels];
        target.extend(values.iter().map(|value| value * term.root_weight));
    }
}

/// The square that holds all parts of a pass that read a level.
pub(crate) fn half_of(pass: &Pass, reads: Reads) -> Option<Half> {
    let parts = || pass.parts.iter().filter(|part| part.reads == reads);
    let side = parts().map(|part| part.side).max()?;
    let rows = |shape| match shape {
        Shape::Half => Rows::Above,
        Shape::HalfWithRow | Shape::Causal => Rows::AboveAndMiddle,
        Shape::Full => Rows::All,
    };
    Some(Half {
        half: side as i32 / 2,
        rows: parts().map(|part| rows(part.shape)).max()?,
    })
}

/// Where the values of a query come from, in the order of the candidates' rows; `halves` are those of the squares.
pub(crate) fn terms_of(pass: &Pass, halves: [i32; 2]) -> Vec<Term> {
    let mut terms = Vec::new();
    for part in &pass.parts {
        let half = match part.reads {
            Reads::Same => halves[0],
            Reads::Coarser => halves[1],
        };
        let side = 2 * half + 1;
        for offset in part.offsets() {
            terms.push(Term {
                reads: part.reads,
                sample: ((offset[1] + half) * side + offset[0] + half) as usize,
                offset,
                root_weight: part.weight.sqrt(),
            });
        }
    }
    terms
}
