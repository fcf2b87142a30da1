//! The matcher on recorded neighborhoods, compared with an exhaustive search and with a k-d tree.
//!
//! The queries are the neighborhoods of the last pass, F(7,0) and F(3,1), on a tile of 320×320 pixels synthesized by
//! all earlier passes: 102,400 queries of 171 numbers each. Exemplars of 64×64 and 256×256 pixels have 3364 and
//! 62,500 candidates.
//!
//! Confirmed: every query finds the same row as brute force with the same distance function; ties go to the lower
//! index. Slow methods are timed on a subset of the queries, spread evenly.

#[cfg(feature = "peers")]
mod beside_kiddo;
mod brute_force;

use self::brute_force::BruteForce;
use super::scene::{Picture, exact, leaves};
use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use anyhow::{Context as _, Result, ensure};
use dapple_synth::{
    Candidates, CoarserCenter, Edges, Exemplar, Matcher, MatcherMemory, Options, Pass, Schedule,
    distance_sq, synthesize_plane,
};
use rayon::prelude::*;

const PLAIN_SMALL: Case = Case {
    group: "synth",
    case: "matcher, 3.4 k candidates",
    peer: "plain loop",
    unit: Unit::UsPerQuery,
    must: Goal::Faster(60.0),
    note: "102,400 queries, all with the same row as by brute force; the loop is timed on 512 of them",
};

const PLAIN_LARGE: Case = Case {
    case: "matcher, 62.5 k candidates",
    note: "102,400 queries, all with the same row as by brute force; ours is timed on 10,240 of them, the loop on 64",
    ..PLAIN_SMALL
};

/// An exemplar size, and how many queries are timed.
struct Setting {
    /// Width and height of the exemplar in pixels.
    side: u32,
    plain: Case,
    /// Strides of the timed queries, for our side, for a peer, and for the plain loop: every n-th query is timed.
    timed: [usize; 3],
}

const SETTINGS: [Setting; 2] = [
    Setting {
        side: 64,
        plain: PLAIN_SMALL,
        timed: [1, 10, 200],
    },
    Setting {
        side: 256,
        plain: PLAIN_LARGE,
        timed: [10, 100, 1600],
    },
];

/// Width and height in pixels of the tile whose neighborhoods are the queries.
const TILE: u32 = 320;

/// Number of queries that are compared with a block of rows while the block is in the cache.
const CONFIRMED_AT_ONCE: usize = 512;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    for setting in &SETTINGS {
        #[cfg(feature = "peers")]
        let others = beside_kiddo::cases(setting);
        #[cfg(not(feature = "peers"))]
        let others = [];
        if !bench.wants(&setting.plain) && !bench.wants_any(&others) {
            continue;
        }
        let recorded = Recorded::new(&leaves(setting.side)?)?;
        recorded.confirm()?;
        beside_plain(bench, setting, &recorded)?;
        #[cfg(feature = "peers")]
        beside_kiddo::run(bench, setting, &recorded)?;
    }
    Ok(())
}

fn beside_plain(bench: &mut Bench, setting: &Setting, recorded: &Recorded) -> Result<()> {
    let [every, _, theirs] = setting.timed;
    let plain = Side::new(Vec::new(), |found: &mut Vec<u32>| {
        found.clear();
        found.extend(
            recorded
                .queries(theirs)
                .map(|query| recorded.plain_loop(query)),
        );
    });
    bench.beside(
        &setting.plain,
        3,
        recorded.ours(every),
        plain,
        |ours, plain| recorded.done([every, theirs], &ours.found, plain),
    )
}

/// The recorded candidates and queries, with the matcher.
struct Recorded {
    dims: usize,
    rows: Vec<f32>,
    queries: Vec<f32>,
    matcher: Matcher,
}

/// State of our side: scratch memory of the matcher, and the indices of the found rows.
#[derive(Default)]
struct Found {
    memory: MatcherMemory,
    found: Vec<u32>,
}

impl Recorded {
    /// Synthesizes a tile by all passes except the last, and reads its neighborhoods.
    fn new(picture: &Picture) -> Result<Self> {
        let exemplar = picture.exemplar()?;
        let mut passes = Schedule::paper(3).passes;
        let last = passes.pop().context("the last pass")?;
        let options = Options {
            schedule: Some(Schedule { passes }),
            ..exact(3)
        };
        let tile = synthesize_plane(&exemplar, [TILE; 2], [Edges::Wrap; 2], &options)?;
        let tile = Exemplar::new(&tile.transfer(&picture.image)?, Edges::Wrap)?;
        let [(dims, rows), (_, queries)] = [
            neighborhoods(&exemplar, &last)?,
            neighborhoods(&tile, &last)?,
        ];
        ensure!(queries.len() >= 100_000 * dims, "there are too few queries");
        Ok(Self {
            dims,
            matcher: Matcher::new(dims, &rows),
            rows,
            queries,
        })
    }

    /// Iterates over every `every`-th query.
    fn queries(&self, every: usize) -> impl Iterator<Item = &[f32]> {
        self.queries.chunks_exact(self.dims).step_by(every)
    }

    /// Returns our side as a [`Side`] that matches every `every`-th query.
    fn ours(&self, every: usize) -> Side<'_, Found> {
        Side::new(Found::default(), move |state: &mut Found| {
            state.found.clear();
            for query in self.queries(every) {
                let nearest = self
                    .matcher
                    .nearest(query, f32::INFINITY, None, &mut state.memory);
                state
                    .found
                    .push(nearest.map_or(u32::MAX, |nearest| nearest.row));
            }
        })
    }

    /// Returns the index of the nearest row, found by comparing all rows component by component.
    fn plain_loop(&self, query: &[f32]) -> u32 {
        let (mut least, mut nearest) = (f32::INFINITY, 0);
        for (index, row) in self.rows.chunks_exact(self.dims).enumerate() {
            let mut distance_sq = 0.0;
            for (a, b) in query.iter().zip(row) {
                distance_sq += (a - b) * (a - b);
            }
            if distance_sq < least {
                (least, nearest) = (distance_sq, index as u32);
            }
        }
        nearest
    }

    /// Fails if the matcher's row for any query differs from the brute-force result, which is the first of the
    /// nearest rows.
    fn confirm(&self) -> Result<()> {
        let brute_force = BruteForce::new(self.dims, &self.rows);
        let queries: Vec<&[f32]> = self.queries(1).collect();
        let wrong = queries.par_chunks(CONFIRMED_AT_ONCE).map(|queries| {
            let mut memory = MatcherMemory::default();
            let mut nearest = |query| {
                self.matcher
                    .nearest(query, f32::INFINITY, None, &mut memory)
            };
            let found = queries
                .iter()
                .map(|query| nearest(query).map(|found| found.row));
            let found: Option<Vec<u32>> = found.collect();
            found.map_or(queries.len(), |found| brute_force.n_wrong(queries, &found))
        });
        let n_wrong: usize = wrong.sum();
        ensure!(
            n_wrong == 0,
            "{n_wrong} of {} queries have another row",
            queries.len()
        );
        Ok(())
    }

    /// Returns the number of queries that each side searched: every `ours`-th query on our side, and every `theirs`-th
    /// on the other one. Fails if the other side's rows are farther than ours.
    fn done(&self, [ours, theirs]: [usize; 2], found: &[u32], others: &[u32]) -> Result<Done> {
        let row = |row: u32| &self.rows[row as usize * self.dims..][..self.dims];
        let compared = found.iter().step_by(theirs / ours).zip(others);
        for (query, (&found, &other)) in self.queries(theirs).zip(compared) {
            let [found, other] = [found, other].map(|index| distance_sq(query, row(index)));
            // The loop sums the 171 terms in a different order.
            ensure!((found - other).abs() <= 1e-4 * found, "{found} and {other}");
        }
        Ok(Done {
            ours: found.len(),
            theirs: others.len(),
        })
    }
}

/// Returns the number of components of a neighborhood, and the concatenated neighborhoods of `image` that `pass`
/// compares.
fn neighborhoods(image: &Exemplar, pass: &Pass) -> Result<(usize, Vec<f32>)> {
    let candidates = Candidates::new(&image.pyramid(2)?, pass, CoarserCenter::Exact)?;
    let rows = (0..candidates.len()).flat_map(|row| candidates.row(row).iter().copied());
    Ok((candidates.dims(), rows.collect()))
}
