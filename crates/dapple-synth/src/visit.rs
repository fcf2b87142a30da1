//! One visit of all sites of a level.

mod order;

use crate::candidates;
use crate::grid;
use crate::ground::{Ground, Painted, Rows, Samples, Square, UNKNOWN};
use crate::kept::Kept;
use crate::matcher::Query;
use crate::neighborhood::{Pass, Reads, Shape};
use crate::options::CoherenceFactors;
use crate::orientation::offset_before;
use crate::{Candidates, Exemplar, Matcher, MatcherMemory, Options, Pyramid, Symmetry};
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
    /// The symmetry of directions, if squares have all samples that turned ones need.
    symmetry: Symmetry,
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
    /// Its number in the square of samples, for each number of quarter turns that the exemplar lies turned.
    pub(crate) samples: [usize; 4],
    offset: [i32; 2],
    root_weight: f32,
}

/// Memory of a thread.
struct Worker<M> {
    /// By how many quarter turns the exemplar lies turned in `query` and `coherent`.
    quarters: u8,
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
            symmetry: match pass.parts.iter().all(|part| part.shape == Shape::Full) {
                true => ground.symmetry(),
                // The rows above after a turn are not those that were made before.
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

    /// Gives a site the pixel of the row that matches, and tells which one that is.
    fn visit(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) -> u32 {
        self.read(site, worker, state);
        let sources = state.here.sources;
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
        // Without any row, which finite values do not lead to, the site keeps what it has.
        if let Some(&pixel) = self.candidates.pixels.get(row as usize) {
            // Turns of other threads that read it are ordered by the board.
            sources.pixels[site as usize].store(pixel, Ordering::Relaxed);
        }
        row
    }

    /// The best row of those that are the best with the exemplar turned as it lies at a neighbor, and how it lies there.
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

    /// How the exemplar lies at the eight neighbors of a site, and on the coarser level in its middle.
    fn quarters_around(
        &self,
        site: u32,
        worker: &Worker<G::Memory>,
        state: &State<'_>,
    ) -> [bool; 4] {
        let mut found = [false; 4];
        let mut add = |painted: &Painted<'_>, nearest: u32| {
            if nearest != site && nearest != UNKNOWN {
                found[usize::from(self.quarters_of(site, nearest, painted))] = true;
            }
        };
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            let side = 2 * half.half as usize + 1;
            add(&painted, worker.coarser.nearest[side * side / 2]);
        }
        for term in self.terms.iter().filter(|term| term.is_beside()) {
            add(&state.here, worker.same.nearest[term.samples[0]]);
        }
        // A site that is its own neighbor everywhere, or stands alone.
        if found == [false; 4] {
            found[usize::from(state.here.quarters(site as usize))] = true;
        }
        found
    }

    /// By how many quarter turns the exemplar lies turned at a site that goes on with another one.
    #[inline]
    fn quarters_of(&self, site: u32, other: u32, painted: &Painted<'_>) -> u8 {
        let quarters = painted.quarters(other as usize);
        self.ground.quarters_toward(site, other, quarters)
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
            let nearest = samples.nearest[term.samples[0]];
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
        let (_, quarter) = self.ground.parent(self.level, site)?;
        let pixel = grid::over(piece, self.coarser_width, quarter);
        Some(self.pyramid[self.level].pixel_at(pixel)? as u32)
    }

    /// Reads the neighborhood of a site.
    fn read(&self, site: u32, worker: &mut Worker<G::Memory>, state: &State<'_>) {
        let Worker {
            same,
            coarser,
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
        if let Some(half) = self.same {
            let square = square(self.level, half);
            same.make_room(square.side(), self.n_channels);
            self.ground
                .read(square, &self.prepared, state.here, same, ground);
        }
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            let square = square(self.level + 1, half);
            coarser.make_room(square.side(), self.n_channels);
            if !state.kept.paste(site, &square, coarser) {
                self.ground
                    .read(square, &self.prepared, painted, coarser, ground);
            }
        }
    }

    /// Gathers the query of a neighborhood that was read, and the rows that continue its neighbors.
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
        coherent.clear();
        if self.same.is_some() {
            self.continue_same(center, same, &state.here, coherent);
        }
        if let (Some(half), Some(painted)) = (self.coarser, state.coarser) {
            self.continue_coarser(center, half, coarser, &painted, coherent);
        }
        query.clear();
        let squares = [&*same, &*coarser];
        push_terms(
            &self.terms,
            squares,
            self.n_channels,
            center.quarters,
            query,
        );
        if let Some(targets) = self.ground.targets() {
            let guides = targets.of(self.level, site).iter();
            query.extend(guides.map(|value| value * self.guide_scale));
        }
    }

    /// The rows of the pixels that lie beside the sources of the eight nearest samples, as this site lies beside them.
    fn continue_same(
        &self,
        center: Center,
        samples: &Samples,
        painted: &Painted<'_>,
        coherent: &mut Vec<u32>,
    ) {
        for term in self.terms.iter().filter(|term| term.is_beside()) {
            let [i, j] = term.offset;
            let nearest = samples.nearest[term.samples[usize::from(center.quarters)]];
            if nearest == center.site || nearest == UNKNOWN {
                continue;
            }
            if self.quarters_of(center.site, nearest, painted) != center.quarters {
                continue;
            }
            let source = painted.source(nearest as usize);
            add_coherent(self.candidates.row_beside(source, [-i, -j]), coherent);
        }
    }

    /// The rows of the four pixels under the source of the coarser sample in the middle.
    fn continue_coarser(
        &self,
        center: Center,
        half: Half,
        samples: &Samples,
        painted: &Painted<'_>,
        coherent: &mut Vec<u32>,
    ) {
        let side = 2 * half.half as usize + 1;
        let nearest = samples.nearest[side * side / 2];
        if self.quarters_of(center.site, nearest, painted) != center.quarters {
            return;
        }
        let source = painted.source(nearest as usize);
        for offset in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let row = self
                .candidates
                .row_under(source, self.coarser_width, offset);
            add_coherent(row, coherent);
        }
    }

    /// The row that the site takes: the nearest one, or a coherent one that is not much farther.
    fn best_row(&self, worker: &mut Worker<G::Memory>, factors: Option<&[f32]>) -> Best {
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
        let fallback = match near {
            Some(near) if self.coherence > 0.0 => Best {
                row: near.row,
                distance_sq: near.distance_sq / (1.0 + self.coherence),
            },
            _ => Best::NONE,
        };
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

/// The row that a site takes.
#[derive(Clone, Copy, Debug)]
struct Best {
    row: u32,
    /// Its squared distance; of a row that goes on with a neighbor, what another one has to be below.
    distance_sq: f32,
}

impl Best {
    /// No row.
    const NONE: Self = Self {
        row: NOWHERE,
        distance_sq: f32::INFINITY,
    };
}

/// A site in the middle of a neighborhood, and by how many quarter turns the exemplar lies turned there.
#[derive(Clone, Copy, Debug)]
struct Center {
    site: u32,
    quarters: u8,
}

impl Term {
    /// Whether the pixel is one of the eight neighbors on the level itself.
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

/// Appends the values of a neighborhood, from squares on the level itself and on the coarser one, with the exemplar turned by
/// some quarter turns.
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
