//! One visit of all sites of a level.

use crate::engine::LevelTexture;
use crate::ground::{Ground, Rows, Samples, Square};
use crate::groups::Groups;
use crate::matcher::Query;
use crate::neighborhood::{Pass, Reads, Shape};
use crate::usage::Usage;
use crate::{Candidates, Matcher, MatcherMemory, Options, Pyramid, SynthError, distance_sq};
use std::sync::{Mutex, PoisonError};

/// The most sites between two calls of the callback.
const STRETCH: usize = 1 << 14;
/// How many sites a thread takes at once, at the most and at the least.
const PIECE: [usize; 2] = [4, 256];
/// No pixel or no row.
const NOWHERE: u32 = u32::MAX;

/// A pass with everything that it needs.
pub(crate) struct Visit<'a, G: Ground> {
    ground: &'a G,
    prepared: G::Prepared,
    level: usize,
    n_channels: usize,
    width: u32,
    coarser_width: u32,
    pixels: &'a [f32],
    candidates: Candidates,
    matcher: Matcher,
    coherence: f32,
    /// 0 where uses do not count.
    evenness: f32,
    /// Where the values of a query come from.
    terms: Vec<Term>,
    /// The squares that are read on the level itself and on the coarser one.
    same: Option<Half>,
    coarser: Option<Half>,
}

/// A square of samples, without its place.
#[derive(Clone, Copy, Debug)]
struct Half {
    half: i32,
    rows: Rows,
}

/// One pixel of a neighborhood.
#[derive(Clone, Copy, Debug)]
struct Term {
    reads: Reads,
    /// Its number in the square of samples.
    sample: usize,
    offset: [i32; 2],
    root_weight: f32,
}

/// Samples of the coarser level that the next pass needs again: the middle of the squares of this one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kept {
    side: usize,
    values: Vec<f32>,
    nearest: Vec<u32>,
}

/// What a thread works in.
struct Worker<M> {
    same: Samples,
    coarser: Samples,
    query: Vec<f32>,
    coherent: Vec<u32>,
    matcher: MatcherMemory,
    ground: M,
}

/// What all threads read.
#[derive(Clone, Copy)]
struct State<'a> {
    here: &'a LevelTexture,
    coarser: Option<&'a LevelTexture>,
    kept: &'a Kept,
    /// What the rows' squared distances are multiplied by.
    factors: Option<&'a [f32]>,
}

/// What a thread writes for some sites: the row that matches, and what is kept.
struct Piece<'a> {
    sites: &'a [u32],
    rows: &'a mut [u32],
    keep: Option<KeptPiece<'a>>,
}

struct KeptPiece<'a> {
    side: usize,
    values: &'a mut [f32],
    nearest: &'a mut [u32],
}

impl<'a, G: Ground> Visit<'a, G> {
    /// Prepares a pass.
    pub(crate) fn new(
        ground: &'a G,
        pyramid: &'a Pyramid,
        pass: &Pass,
        options: &Options,
    ) -> Result<Self, SynthError> {
        let candidates = Candidates::for_options(pyramid, pass, options)?;
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
            None => (0.5 * options.coherence, options.evenness),
            Some(_) => (options.coherence, 0.0),
        };
        Ok(Self {
            ground,
            prepared: ground.prepare(
                pass.level,
                same.map(|half| half.half),
                coarser.map(|half| half.half),
            ),
            level: pass.level,
            n_channels: exemplar.n_channels,
            width: exemplar.size[0],
            coarser_width: pyramid
                .levels()
                .get(pass.level + 1)
                .map_or(1, |level| level.size[0]),
            pixels: &exemplar.pixels,
            matcher: Matcher::new(candidates.dims, &candidates.rows),
            candidates,
            coherence,
            evenness,
            terms,
            same,
            coarser,
        })
    }

    /// Visits all sites. `kept` is what the pass before kept; the result is what this one keeps of squares of the coarser
    /// level, `keep` samples wide.
    pub(crate) fn run(
        &self,
        levels: &mut [LevelTexture],
        kept: &Kept,
        keep: u32,
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<Kept, SynthError> {
        let n_sites = self.ground.n_sites(self.level);
        let (finer, coarser) = levels.split_at_mut(self.level + 1);
        let here = &mut finer[self.level];
        here.colors.resize(n_sites * self.n_channels, 0.0);
        here.sources.resize(n_sites, NOWHERE);
        let n_threads = n_threads();
        let mut workers = Vec::new();
        workers.resize_with(n_threads, || Mutex::new(Worker::<G::Memory>::default()));
        let mut usage = Usage::new(self.evenness, self.candidates.len(), n_sites);
        // Sites that read only the coarser level do not wait for each other, and may be visited in any order.
        let groups = match self.same {
            None => Groups::stretches(n_sites, STRETCH),
            Some(_) if n_threads == 1 || usage.factors().is_some() => {
                Groups::one_by_one(self.ground.order(self.level))
            }
            Some(_) => self.ground.groups(self.level, &self.prepared),
        };
        let side = if self.same.is_none() {
            keep as usize
        } else {
            0
        };
        let n_kept = side * side;
        let mut keeps = Kept {
            side,
            values: vec![0.0; n_sites * n_kept * self.n_channels],
            nearest: vec![0; n_sites * n_kept],
        };
        let mut rows = Vec::new();
        let mut done = 0;
        for group in groups.iter() {
            rows.clear();
            rows.resize(group.len(), NOWHERE);
            let state = State {
                here,
                coarser: coarser.first(),
                kept,
                factors: usage.factors(),
            };
            let pieces = pieces(
                group,
                &mut rows,
                &mut keeps,
                done,
                self.n_channels,
                n_threads,
            );
            self.visit_pieces(pieces, &workers, &state);
            self.write(group, &rows, here);
            usage.add(&rows, &self.candidates);
            let before = done / STRETCH;
            done += group.len();
            if done / STRETCH > before || done == n_sites {
                tell(done)?;
            }
        }
        Ok(keeps)
    }

    /// Gives sites the pixels of their rows.
    fn write(&self, sites: &[u32], rows: &[u32], here: &mut LevelTexture) {
        let n_channels = self.n_channels;
        for (&site, &row) in sites.iter().zip(rows) {
            let Some(&pixel) = self.candidates.pixels.get(row as usize) else {
                continue;
            };
            here.sources[site as usize] = pixel;
            let [to, from] = [site as usize, pixel as usize].map(|at| at * n_channels);
            here.colors[to..to + n_channels].copy_from_slice(&self.pixels[from..from + n_channels]);
        }
    }

    fn visit_pieces(
        &self,
        mut pieces: Vec<Piece<'_>>,
        workers: &[Mutex<Worker<G::Memory>>],
        state: &State<'_>,
    ) {
        #[cfg(feature = "rayon")]
        if pieces.len() > 1 {
            use rayon::prelude::*;
            pieces.into_par_iter().for_each(|piece| {
                // Each thread of the pool has a worker of its own, so that nobody waits.
                let thread = rayon::current_thread_index().unwrap_or(0) % workers.len();
                let mut worker = workers[thread]
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner);
                self.visit_piece(piece, &mut worker, state);
            });
            return;
        }
        let mut worker = workers[0].lock().unwrap_or_else(PoisonError::into_inner);
        for piece in pieces.drain(..) {
            self.visit_piece(piece, &mut worker, state);
        }
    }

    fn visit_piece(&self, piece: Piece<'_>, worker: &mut Worker<G::Memory>, state: &State<'_>) {
        let mut keep = piece.keep;
        for (at, (&site, row)) in piece.sites.iter().zip(piece.rows).enumerate() {
            self.gather(site, worker, state);
            if let Some(keep) = &mut keep {
                let half = self.coarser.map_or(0, |half| half.half);
                keep.copy(at, &worker.coarser, 2 * half as usize + 1, self.n_channels);
            }
            *row = self.best_row(worker, state.factors);
        }
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
                .read(square, &self.prepared, &state.here.colors, same, ground);
            self.continue_same(&square, same, &state.here.sources, coherent);
        }
        if let (Some(half), Some(texture)) = (self.coarser, state.coarser) {
            let square = square(self.level + 1, half);
            coarser.make_room(square.side(), self.n_channels);
            if !state.kept.paste(site, &square, coarser, self.n_channels) {
                self.ground
                    .read(square, &self.prepared, &texture.colors, coarser, ground);
            }
            self.continue_coarser(&square, coarser, &texture.sources, coherent);
        }
        query.clear();
        for term in &self.terms {
            let samples = match term.reads {
                Reads::Same => &*same,
                Reads::Coarser => &*coarser,
            };
            let at = term.sample * self.n_channels;
            let values = &samples.values[at..at + self.n_channels];
            query.extend(values.iter().map(|value| value * term.root_weight));
        }
    }

    /// The rows of the pixels that lie beside the sources of the eight nearest samples, as this site lies beside them.
    fn continue_same(
        &self,
        square: &Square,
        samples: &Samples,
        sources: &[u32],
        coherent: &mut Vec<u32>,
    ) {
        for term in &self.terms {
            let [i, j] = term.offset;
            if term.reads != Reads::Same || i.abs() > 1 || j.abs() > 1 {
                continue;
            }
            let nearest = samples.nearest[term.sample];
            if nearest == square.site {
                continue;
            }
            let source = sources[nearest as usize];
            if source != NOWHERE {
                let [x, y] = [source % self.width, source / self.width].map(i64::from);
                self.add_coherent([x - i64::from(i), y - i64::from(j)], coherent);
            }
        }
    }

    /// The rows of the four pixels under the source of the coarser sample in the middle.
    fn continue_coarser(
        &self,
        square: &Square,
        samples: &Samples,
        sources: &[u32],
        coherent: &mut Vec<u32>,
    ) {
        let middle = (square.side() * square.side()) / 2;
        let source = sources[samples.nearest[middle] as usize];
        if source == NOWHERE {
            return;
        }
        let [x, y] = [source % self.coarser_width, source / self.coarser_width].map(i64::from);
        for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            self.add_coherent([2 * x + i, 2 * y + j], coherent);
        }
    }

    /// Adds the row of a pixel, if there is one and it is not yet there.
    fn add_coherent(&self, pixel: [i64; 2], coherent: &mut Vec<u32>) {
        if let Some(row) = self.candidates.row_of_pixel(pixel)
            && !coherent.contains(&row)
        {
            coherent.push(row);
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
        let mut near: Option<(f32, u32)> = None;
        for &row in &*coherent {
            let factor = factors.map_or(1.0, |factors| factors[row as usize]);
            let distance_sq = factor * distance_sq(query, self.candidates.row(row as usize));
            let found = (distance_sq, row);
            if near.is_none_or(|near| found < near) {
                near = Some(found);
            }
        }
        let (below, fallback) = match near {
            Some((distance, row)) if self.coherence > 0.0 => {
                (distance / (1.0 + self.coherence), row)
            }
            _ => (f32::INFINITY, NOWHERE),
        };
        let query = Query {
            values: query,
            below,
            hint: near.map(|(_, row)| row),
            factors,
        };
        let found = self.matcher.find(query, matcher);
        found.map_or(fallback, |found| found.row)
    }
}

impl Kept {
    /// Puts what was kept of a site's square into samples; whether it was all of it.
    fn paste(&self, site: u32, square: &Square, samples: &mut Samples, n_channels: usize) -> bool {
        let n = self.side * self.side;
        if self.side != square.side() {
            return false;
        }
        let first = site as usize * n;
        samples
            .nearest
            .copy_from_slice(&self.nearest[first..first + n]);
        samples
            .values
            .copy_from_slice(&self.values[first * n_channels..(first + n) * n_channels]);
        true
    }
}

impl KeptPiece<'_> {
    /// Keeps the middle of a square `from` samples wide.
    fn copy(&mut self, at: usize, samples: &Samples, from: usize, n_channels: usize) {
        let margin = (from - self.side) / 2;
        for row in 0..self.side {
            let source = (row + margin) * from + margin;
            let target = (at * self.side + row) * self.side;
            let side = self.side;
            self.nearest[target..target + side]
                .copy_from_slice(&samples.nearest[source..source + side]);
            self.values[target * n_channels..(target + side) * n_channels].copy_from_slice(
                &samples.values[source * n_channels..(source + side) * n_channels],
            );
        }
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

/// The square that holds all parts of a pass that read a level.
fn half_of(pass: &Pass, reads: Reads) -> Option<Half> {
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
fn terms_of(pass: &Pass, halves: [i32; 2]) -> Vec<Term> {
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

/// Splits a group for the threads. What is kept is only for groups of consecutive sites, of which `first` is the first.
fn pieces<'a>(
    group: &'a [u32],
    rows: &'a mut [u32],
    keeps: &'a mut Kept,
    first: usize,
    n_channels: usize,
    n_threads: usize,
) -> Vec<Piece<'a>> {
    let length = match n_threads {
        1 => group.len().max(1),
        _ => (group.len() / (4 * n_threads)).clamp(PIECE[0], PIECE[1]),
    };
    let side = keeps.side;
    let n_kept = side * side;
    let from = first * n_kept;
    let mut values =
        keeps.values[from * n_channels..].chunks_mut((length * n_kept * n_channels).max(1));
    let mut nearest = keeps.nearest[from..].chunks_mut((length * n_kept).max(1));
    group
        .chunks(length)
        .zip(rows.chunks_mut(length))
        .map(|(sites, rows)| Piece {
            sites,
            rows,
            keep: values
                .next()
                .zip(nearest.next())
                .map(|(values, nearest)| KeptPiece {
                    side,
                    values,
                    nearest,
                }),
        })
        .collect()
}

fn n_threads() -> usize {
    #[cfg(feature = "rayon")]
    let n = rayon::current_num_threads();
    #[cfg(not(feature = "rayon"))]
    let n = 1;
    n
}
