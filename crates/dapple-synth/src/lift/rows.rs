//! Gathers the neighborhoods of a source's sites as candidates.

use crate::candidates::{self, Beside};
use crate::domain::{Rows, Samples, Square, SynthesisDomain};
use crate::level_pass::{self, NeighborhoodHalf, Term};
use crate::mesh_domain::{MeshDomain, MeshMemory};
use crate::{Candidates, Options, Pass, Pyramid, Reads, SynthError, Synthesizer};
use dapple_raster::parallel;

/// Number of sites per parallel task.
const CHUNK: usize = 512;

/// Minimum distance between adjacent samples, in multiples of the site spacing. A smaller distance indicates a border
/// or a sharp fold.
const LEAST: f64 = 0.5;

/// Returns the neighborhoods of the sites of the pass's level that meet no border, fold or unusable site. If too few
/// remain, returns the neighborhoods of all usable sites.
pub(super) fn candidates(
    source: &Synthesizer,
    pyramid: &Pyramid,
    pass: &Pass,
    options: &Options,
) -> Result<Candidates, SynthError> {
    pass.check(pyramid.levels().len())?;
    let domain = source.domain(options.axes, false);
    let halves = [Reads::Same, Reads::Coarser].map(|reads| level_pass::half_of(pass, reads));
    let [same, coarser] = halves.map(|half| half.map(|half| half.half));
    let reader = Reader {
        prepared: domain.prepare(pass.level, same, coarser),
        beside: domain.prepare(pass.level, Some(1), None),
        domain: &domain,
        terms: level_pass::terms_of(pass, [same, coarser].map(Option::unwrap_or_default)),
        halves,
        level: pass.level,
        pyramid,
        guide_scale: candidates::guide_scale(pass),
    };
    let n_sites = domain.n_sites(pass.level);
    let chunks = parallel::map(n_sites.div_ceil(CHUNK), |chunk| {
        let first = chunk * CHUNK;
        reader.chunk(first..(first + CHUNK).min(n_sites))
    });
    // Leave out neighborhoods at borders and folds if enough others remain.
    let few = candidates::few(pass, options);
    let sites = chunks
        .iter()
        .flat_map(|chunk| chunk.are_whole.iter().zip(&chunk.are_usable));
    let n_whole = sites.filter(|(is_whole, is_usable)| **is_whole && **is_usable);
    let only_whole = n_whole.count() >= few;
    let level = &pyramid.levels()[pass.level];
    let dims = reader.dims();
    // Concatenate the chunks.
    let mut pixels = Vec::new();
    let mut rows = Vec::new();
    let mut beside = Vec::new();
    for (site, (chunk, at)) in chunks
        .iter()
        .flat_map(|chunk| (0..chunk.beside.len()).map(move |at| (chunk, at)))
        .enumerate()
    {
        beside.push(chunk.beside[at]);
        if chunk.are_usable[at] && (chunk.are_whole[at] || !only_whole) {
            pixels.push(site as u32);
            rows.extend_from_slice(&chunk.rows[at * dims..][..dims]);
        }
    }
    Candidates::of_sites(level, pass.level, rows, pixels, Beside(beside))
}

/// Neighborhoods of consecutive sites.
#[derive(Default)]
struct Chunk {
    rows: Vec<f32>,
    are_whole: Vec<bool>,
    are_usable: Vec<bool>,
    beside: Vec<[u32; 9]>,
}

/// Reads neighborhoods on the source, in the same way as on the target.
struct Reader<'a> {
    domain: &'a MeshDomain<'a>,
    prepared: <MeshDomain<'a> as SynthesisDomain>::Prepared,
    beside: <MeshDomain<'a> as SynthesisDomain>::Prepared,
    terms: Vec<Term>,
    /// Extents of the squares on the level itself and on the coarser level; `None` if the pass does not read that
    /// level.
    halves: [Option<NeighborhoodHalf>; 2],
    level: usize,
    pyramid: &'a Pyramid,
    guide_scale: f32,
}

impl Reader<'_> {
    /// Returns the number of values per neighborhood, guides included.
    fn dims(&self) -> usize {
        let level = &self.pyramid.levels()[self.level];
        self.terms.len() * level.n_channels + level.n_guides()
    }

    fn chunk(&self, sites: core::ops::Range<usize>) -> Chunk {
        let mut chunk = Chunk::default();
        let mut memory = MeshMemory::default();
        let [mut same, mut coarser] = [Samples::default(), Samples::default()];
        for site in sites.start as u32..sites.end as u32 {
            let [is_whole_same, is_whole_coarser] = [(0, &mut same), (1, &mut coarser)]
                .map(|(step, samples)| self.read(site, step, samples, &mut memory));
            let level = &self.pyramid.levels()[self.level];
            level_pass::push_terms(
                &self.terms,
                [&same, &coarser],
                level.n_channels,
                0,
                &mut chunk.rows,
            );
            // Append the guides after the colors.
            let guides = level.guides.of(site as usize).iter();
            chunk
                .rows
                .extend(guides.map(|value| value * self.guide_scale));
            chunk.are_whole.push(is_whole_same && is_whole_coarser);
            chunk
                .are_usable
                .push(self.is_usable(site, [&same, &coarser]));
            chunk.beside.push(self.read_beside(site, &mut memory));
        }
        chunk
    }

    /// Reads the square of `site` on the level that is `step` levels coarser than the site's own, if the pass reads
    /// that level. Returns whether the square meets no border or fold.
    fn read(&self, site: u32, step: usize, samples: &mut Samples, memory: &mut MeshMemory) -> bool {
        let Some(half) = self.halves[step] else {
            return true;
        };
        let reads = self.level + step;
        let square = Square {
            site,
            level: self.level,
            reads,
            half: half.half,
            rows: half.rows,
        };
        let colors = self.pyramid.levels()[reads].plain();
        samples.make_room(square.side(), colors.n_channels);
        self.domain
            .read(square, &self.prepared, colors, samples, memory);
        // At a border or a sharp fold, walks end early or bend back, and adjacent samples come close.
        memory.is_spread(LEAST * self.domain.hierarchy.levels()[reads].spacing())
    }

    /// Returns whether all sites in the neighborhood of `site` are usable.
    fn is_usable(&self, site: u32, samples: [&Samples; 2]) -> bool {
        let usable = |step: usize, site: u32| {
            self.pyramid.levels()[self.level + step].is_usable(site as usize)
        };
        usable(0, site)
            && self.terms.iter().all(|term| {
                let step = term.reads.step();
                usable(step, samples[step].nearest[term.samples[0]])
            })
    }

    /// Returns the 3 × 3 sites around `site`, row by row. `site` is in the center, and the others are the sites nearest
    /// to the ends of the eight steps.
    fn read_beside(&self, site: u32, memory: &mut MeshMemory) -> [u32; 9] {
        let square = Square {
            site,
            level: self.level,
            reads: self.level,
            half: 1,
            rows: Rows::All,
        };
        let mut samples = Samples::default();
        let colors = self.pyramid.levels()[self.level].plain();
        samples.make_room(square.side(), colors.n_channels);
        self.domain
            .read(square, &self.beside, colors, &mut samples, memory);
        let mut beside = [site; 9];
        beside.copy_from_slice(&samples.nearest);
        // The center is the site itself, even where another site is at the same position.
        beside[4] = site;
        beside
    }
}
