//! Corrections of all sites of a level at once, by what the exemplar looks like around the places that they are from.
//!
//! References: Sylvain Lefebvre and Hugues Hoppe, "Appearance-Space Texture Synthesis", SIGGRAPH 2006, DOI
//! 10.1145/1141911.1141921, and "Parallel Controllable Texture Synthesis", SIGGRAPH 2005, DOI 10.1145/1186822.1073261.
//!
//! A site is from a place in the exemplar, on all levels one between the pixels of its full size. What is compared are the principal
//! components of windows around such places ([`stage`]), as far apart as the sites of the level. A window is looked up where
//! a site around goes on to: nothing is interpolated, so nothing is blurred, and 32 numbers are compared, where two squares of
//! colors have 171. From level to level sites keep their places, and new ones go on from the nearest of those. Then every site takes a few times, of the places that its neighbors go on to and of those most like these, the one
//! around which the exemplar looks most like the texture around it.
//!
//! Departures from the papers: sites are not pixels of a chart, and there are no jumps between charts; what lies to which
//! side of a site follows from the field, half of it here and half there ([`links`]). Neighbors are corrected one after the
//! other, in classes of sites that are not connected, which depend on nothing but the graph. The coarsest level begins with
//! the paper's first pass of a sweep (Turk 2001), in which large features grow from one side to the other. Parts of the
//! exemplar that the texture has too often cost more from one pass to the next, as those of endless textures do.
//!
//! Where directions have a symmetry, the first pass says by how many quarter turns the exemplar lies turned at the coarsest
//! sites, and finer ones take this from the nearest of them. A site goes on with neighbors at which it lies the same; of
//! others it sees what the exemplar looks like when it is turned.
//!
//! Guides are compared beside the components. What a site goes on to from the coarser level may be far from what they ask
//! for, with nothing nearer around it: a site whose guides are off by a good part of how much its surroundings are
//! searches all of the exemplar before it is corrected.

mod links;

use crate::endless::evenness::Costs;
use crate::endless::stage::{self, DIAGONALS, N_FEATURES, Stage, narrow};
use crate::engine::{self, Callback, Progress, Wanted};
use crate::guides::Targets;
use crate::options::REGULAR;
use crate::orientation::offset_after;
use crate::places::Frames;
use crate::{
    Coherence, Exemplar, Hierarchy, MatcherMemory, Options, SiteIdx, SynthError, Synthesizer,
};
use dapple_hash::{Seed, hash1};
use dapple_raster::parallel;
use dapple_raster::simd::{self, dispatch};
use glam::Vec2;
use links::Links;

/// Places are counted in parts of a pixel, of which there are 2 to the power of this along each axis. With whole pixels what a site
/// goes on to is off by up to a half at every step, and pieces of the exemplar are cut up.
///
/// An exemplar may have 2^29 pixels along a side, more than those of five rows that an image can have.
const PART_BITS: u32 = 3;

/// How far beside the best place a site also looks: half of a pixel.
///
/// Measured on the six models of figure 5: of neighbors 13 to 18 % are of other pieces, in place of 14 to 27 % with whole pixels,
/// and where these meet colors differ by 7 to 34 % less (mean squares of all neighbors). Without a look aside pieces are larger
/// still, and differ more where they meet, as with a whole pixel.
const ASIDE: i64 = 1 << (PART_BITS - 1);

/// How often a level is corrected; the coarsest twice as often.
const N_PASSES: usize = 3;

/// Sites that one task corrects at least.
const TASK: usize = 64;

/// The most places that a site chooses from, but for those that are like them.
const MAX_COHERENT: usize = 16;

/// How much a cost changes after a pass, in mean squared distances, for a part that the texture never has.
const STEP: f32 = 0.8;

/// The squared distance of the guides of a site, in that of its surroundings, from which on it searches.
///
/// Measured on leaves after a soft and a hard picture: the light of the texture follows that of the picture (correlation) by
/// 0.42 and 0.41, as colors do, in the same time as with 1 (0.40 and 0.39); to search everywhere gives 0.01 more and takes
/// a quarter longer.
const MISFIT: f32 = 0.25;

/// Tasks that search before a callback hears of it.
const TASKS: usize = 256;

/// The sites of a surface with their directions and guides, and the exemplar on all levels.
pub(crate) struct Appearance<'a> {
    hierarchy: &'a Hierarchy,
    targets: &'a Targets,
    /// By how many quarter turns the exemplar lies turned at each site; nothing where directions have no symmetry.
    pub(crate) quarters: Vec<u8>,
    frames: Frames,
    /// The levels, the finest first.
    stages: Vec<Stage>,
    seed: Seed,
    /// How much costs change, and 0 where there are none.
    evenness: f32,
}

/// A place in parts of pixels, and how unlike the exemplar around it is to the texture around the site.
#[derive(Clone, Copy, Debug)]
struct Choice {
    place: [u32; 2],
    distance_sq: f32,
}

impl<'a> Appearance<'a> {
    /// Prepares the levels of an exemplar, which lies turned by these quarter turns at the coarsest sites; there are as many
    /// guides as it has.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Masked`] for a mask that leaves nothing.
    pub(crate) fn new(
        synthesizer: &'a Synthesizer,
        exemplar: &Exemplar,
        targets: &'a Targets,
        coarsest: &[u8],
        options: &Options,
    ) -> Result<Self, SynthError> {
        // What is smaller than the exemplar has not all of its parts; what repeats has all of them anyway; and guides say which.
        let [width, height] = exemplar.size.map(|side| side as usize);
        let quarters = quarters(synthesizer, coarsest, options.n_levels);
        let frames = Frames::new(synthesizer, &quarters);
        let is_uneven = frames.n_pixels() < (width * height) as f64
            || exemplar.n_guides() > 0
            || exemplar.regularity() > REGULAR;
        let symmetry = synthesizer.orientation().symmetry();
        let wanted = Wanted::new(&|| false);
        let mut stages = stage::stages(
            exemplar,
            &exemplar.guides,
            symmetry,
            options.n_levels,
            &wanted,
        )?;
        for stage in &mut stages {
            stage.coherence = match options.coherence {
                // Measured: also what repeats goes on better than with less.
                Coherence::Auto => 2.0,
                Coherence::Factor(factor) => factor,
            };
        }
        Ok(Self {
            hierarchy: synthesizer.hierarchy(),
            targets,
            frames,
            quarters,
            stages,
            seed: options.seed,
            evenness: if is_uneven { 0.0 } else { options.evenness },
        })
    }

    /// The pixel of the exemplar that each site of each level is from, the finest first, given those of the coarsest level
    /// of a pyramid that the coarsest sites begin with.
    pub(crate) fn run(
        &mut self,
        coarsest: &[u32],
        callback: Callback<'_>,
    ) -> Result<Vec<Vec<[u32; 2]>>, SynthError> {
        let n_levels = self.stages.len();
        let mut levels: Vec<Vec<[u32; 2]>> = Vec::new();
        for level in (0..n_levels).rev() {
            let links = Links::new(self.hierarchy, &self.frames, level);
            let mut places = match levels.last() {
                None => self.begin(level, coarsest),
                Some(coarser) => self.refine(level, coarser, &links),
            };
            let n_passes = if levels.is_empty() {
                2 * N_PASSES
            } else {
                N_PASSES
            };
            let n_sites = n_passes * places.len();
            let mut tell = |done| {
                let progress = Progress {
                    pass: n_levels - level,
                    n_passes: n_levels + 1,
                    done,
                    n_sites,
                };
                engine::report(callback, progress)
            };
            self.obey(level, &links, &mut places, &mut tell)?;
            self.correct(level, &links, n_passes, &mut places, &mut tell)?;
            levels.push(places);
        }
        levels.reverse();
        let pixels = |places: Vec<[u32; 2]>| {
            let pixels = places.into_iter().map(|place| narrow(pixel(place)));
            pixels.collect()
        };
        Ok(levels.into_iter().map(pixels).collect())
    }

    /// The places of the coarsest sites, which have these pixels of a pyramid.
    fn begin(&self, level: usize, pixels: &[u32]) -> Vec<[u32; 2]> {
        let stage = &self.stages[level];
        let width = ((stage.size[0] - 1) >> level) + 1;
        let place = |(site, &pixel): (usize, &u32)| {
            let place = [pixel % width, pixel / width].map(|at| i64::from(at) << level);
            stage
                .usable(place)
                .map_or_else(|| self.any(level, site), middle)
        };
        pixels.iter().enumerate().map(place).collect()
    }

    /// The places of the sites of a level before they are corrected: those of the coarser level keep theirs, and the others
    /// go on from the nearest of them.
    fn refine(&self, level: usize, coarser: &[[u32; 2]], links: &Links) -> Vec<[u32; 2]> {
        let stage = &self.stages[level];
        let n_sites = self.hierarchy.levels()[level].n_sites();
        parallel::map_at_least(TASK, n_sites, |site| {
            if let Some(&place) = coarser.get(site) {
                return place;
            }
            let near = links.of(site).near.iter();
            let parents = near.filter(|link| link.site() < coarser.len() && link.quarters() == 0);
            let nearest = parents.min_by(|a, b| {
                a.way()
                    .length_squared()
                    .total_cmp(&b.way().length_squared())
            });
            let Some(link) = nearest else {
                return self.any(level, site);
            };
            let parent = coarser[link.site()];
            settled(stage, moved(parent, -link.way())).unwrap_or(parent)
        })
    }

    /// A random place for a site.
    fn any(&self, level: usize, site: usize) -> [u32; 2] {
        let stage = &self.stages[level];
        let usable = stage.usable_pixels();
        let random = hash1(
            self.seed.child("appearance", level as u64),
            [site as i64],
            0,
        ) >> 32;
        let pixel = usable[((random * usable.len() as u64) >> 32) as usize];
        middle([pixel % stage.size[0], pixel / stage.size[0]].map(i64::from))
    }

    /// Moves sites whose guides are off to the places of the exemplar that are the most like these and their surroundings.
    fn obey(
        &self,
        level: usize,
        links: &Links,
        places: &mut [[u32; 2]],
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<(), SynthError> {
        if self.targets.len() == 0 {
            return Ok(());
        }
        let stage = &self.stages[level];
        let before = places.to_vec();
        for (block, places) in places.chunks_mut(TASK * TASKS).enumerate() {
            let memory = MatcherMemory::default;
            parallel::for_each_chunk_with(places, TASK, memory, |memory, task, places| {
                let first = (block * TASKS + task) * TASK;
                for (site, place) in (first..).zip(places) {
                    let wanted = self.targets.of(level, site as u32);
                    let own = pixel(*place);
                    let off = stage.guides_distance_sq(wanted, own);
                    let around = around(stage, links, site, &before);
                    if off <= MISFIT * distance_sq(stage, &around, own) {
                        continue;
                    }
                    let found =
                        filled(around).and_then(|around| stage.search(&around, wanted, memory));
                    *place = found.map_or(*place, middle);
                }
            });
            tell(0)?;
        }
        Ok(())
    }

    /// Corrects all sites of a level some times.
    fn correct(
        &mut self,
        level: usize,
        links: &Links,
        n_passes: usize,
        places: &mut [[u32; 2]],
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<(), SynthError> {
        let simd = simd::level();
        let Stage { size, spacing, .. } = self.stages[level];
        let mut costs = Costs::new(size, spacing as u32);
        let usable = self.stages[level].usable_pixels();
        let usable = usable
            .iter()
            .map(|pixel| [pixel % size[0], pixel / size[0]]);
        let wanted = costs.shares(usable);
        let (mut scale, mut done) = (None, 0);
        for _ in 0..n_passes {
            let mut sum = 0.0;
            for class in &links.classes {
                let choose = |at: usize| {
                    let site = class[at] as usize;
                    let wanted = self.targets.of(level, site as u32);
                    let stage = &self.stages[level];
                    dispatch!(simd, _simd => choose(stage, links, site, places, wanted))
                };
                let chosen = parallel::map_at_least(TASK, class.len(), choose);
                for (&site, choice) in class.iter().zip(chosen) {
                    places[site as usize] = choice.place;
                    sum += f64::from(choice.distance_sq);
                }
                done += class.len();
                tell(done)?;
            }
            if self.evenness > 0.0 {
                let scale = *scale.get_or_insert(sum / places.len().max(1) as f64) as f32;
                let shares = costs.shares(places.iter().map(|&place| narrow(pixel(place))));
                costs.change(&shares, &wanted, self.evenness * STEP * scale);
                self.stages[level].costs = costs.clone();
            }
        }
        Ok(())
    }
}

/// By how many quarter turns the exemplar lies turned at all sites, given those at the coarsest ones: each site goes on with
/// the nearest one of the coarser level that it is connected to.
fn quarters(synthesizer: &Synthesizer, coarsest: &[u8], n_levels: usize) -> Vec<u8> {
    if coarsest.is_empty() {
        return Vec::new();
    }
    let (hierarchy, orientation) = (synthesizer.hierarchy(), synthesizer.orientation());
    let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
    let mut quarters = coarsest.to_vec();
    for level in hierarchy.levels()[..n_levels - 1].iter().rev() {
        let n_coarser = quarters.len();
        for site in n_coarser..level.n_sites() {
            let near = level.graph().neighbors(SiteIdx(site as u32)).iter();
            let parents = near
                .map(|near| near.index())
                .filter(|&near| near < n_coarser);
            let distance_sq = |parent: usize| positions[parent].distance_squared(positions[site]);
            let nearest = parents.min_by(|&a, &b| distance_sq(a).total_cmp(&distance_sq(b)));
            let turned = |parent: usize| {
                orientation.quarters_toward(normals, site, parent, quarters[parent])
            };
            quarters.push(nearest.map_or(0, turned));
        }
    }
    quarters
}

/// The place around which the exemplar looks most like the texture around a site, with guides like the wanted ones. Of equally
/// good ones the first.
#[inline(always)]
fn choose(
    stage: &Stage,
    links: &Links,
    site: usize,
    places: &[[u32; 2]],
    wanted: &[f32],
) -> Choice {
    let around = around(stage, links, site, places);
    let mut best = Choice {
        place: places[site],
        distance_sq: f32::INFINITY,
    };
    let own = places[site];
    let mut coherent = [own; MAX_COHERENT];
    let mut n_coherent = 1;
    best.compare(stage, &around, wanted, own, 1.0);
    for link in links.of(site).near {
        if link.quarters() != 0 {
            continue;
        }
        if let Some(place) = settled(stage, moved(places[link.site()], -link.way()))
            && n_coherent < MAX_COHERENT
            && !coherent[..n_coherent]
                .iter()
                .any(|&other| pixel(other) == pixel(place))
        {
            coherent[n_coherent] = place;
            n_coherent += 1;
            best.compare(stage, &around, wanted, place, 1.0);
        }
    }
    // What lies a little beside the best, so that pieces can stretch and need not break.
    let found = best.place;
    for [x, y] in [[ASIDE, 0], [-ASIDE, 0], [0, ASIDE], [0, -ASIDE]] {
        let aside = [i64::from(found[0]) + x, i64::from(found[1]) + y];
        if let Some(place) = settled(stage, aside)
            && pixel(place) != pixel(found)
        {
            best.compare(stage, &around, wanted, place, 1.0);
        }
    }
    for &place in &coherent[..n_coherent] {
        if let Some(similar) = stage.similar(pixel(place)) {
            let similar = within(similar, place.map(i64::from));
            best.compare(stage, &around, wanted, similar, 1.0 + stage.coherence);
        }
    }
    best
}

impl Choice {
    /// Takes a place if it is better; its squared distance counts by a factor.
    #[inline(always)]
    fn compare(
        &mut self,
        stage: &Stage,
        around: &[Option<[f32; N_FEATURES]>; 4],
        wanted: &[f32],
        place: [u32; 2],
        factor: f32,
    ) {
        let at = pixel(place);
        let distance_sq = distance_sq(stage, around, at) + stage.guides_distance_sq(wanted, at);
        let distance_sq = factor * distance_sq + stage.costs.of(at);
        if distance_sq < self.distance_sq {
            *self = Self { place, distance_sq };
        }
    }
}

/// The features on the diagonals of a site: of each the mean of what the sites around it go on to there. Nothing where there
/// are none, as past an edge of the surface.
#[inline(always)]
fn around(
    stage: &Stage,
    links: &Links,
    site: usize,
    places: &[[u32; 2]],
) -> [Option<[f32; N_FEATURES]>; 4] {
    let corners = links.of(site).corners;
    let mut around = [None; 4];
    for corner in 0..4 {
        let links = corners[corner];
        if links.is_empty() {
            continue;
        }
        let [x, y] = DIAGONALS[corner];
        let diagonal = Vec2::new((x * stage.spacing) as f32, (y * stage.spacing) as f32);
        let mut sums = [0.0; N_FEATURES];
        for link in links {
            let way = offset_after((diagonal - link.way()).to_array(), link.quarters());
            let place = moved(places[link.site()], way.into()).map(|at| at >> PART_BITS);
            let features = stage.turned_features(place, link.quarters());
            for i in 0..N_FEATURES {
                sums[i] += features[i];
            }
        }
        for sum in &mut sums {
            *sum /= links.len() as f32;
        }
        around[corner] = Some(sums);
    }
    around
}

/// The features on all diagonals, with their mean in place of those that are missing; nothing if all are.
fn filled(around: [Option<[f32; N_FEATURES]>; 4]) -> Option<[[f32; N_FEATURES]; 4]> {
    let known: Vec<_> = around.into_iter().flatten().collect();
    if known.is_empty() {
        return None;
    }
    let mean = core::array::from_fn(|i| {
        known.iter().map(|features| features[i]).sum::<f32>() / known.len() as f32
    });
    Some(around.map(|features| features.unwrap_or(mean)))
}

/// The squared distance of features on the diagonals of a site from those on the diagonals of a place.
#[inline(always)]
fn distance_sq(stage: &Stage, around: &[Option<[f32; N_FEATURES]>; 4], place: [i64; 2]) -> f32 {
    let known = around.iter().zip(DIAGONALS);
    let known = known.filter_map(|(own, diagonal)| Some((own.as_ref()?, diagonal)));
    stage.distance_sq_of(known, place)
}

/// The place at the end of a way from another one, which may be outside of the exemplar.
#[inline(always)]
fn moved(place: [u32; 2], way: Vec2) -> [i64; 2] {
    let way = (way * (1 << PART_BITS) as f32).round();
    [
        i64::from(place[0]) + way.x as i64,
        i64::from(place[1]) + way.y as i64,
    ]
}

/// A place in the exemplar, if textures may go on there.
#[inline(always)]
fn settled(stage: &Stage, place: [i64; 2]) -> Option<[u32; 2]> {
    let pixel = stage.usable(place.map(|at| at >> PART_BITS))?;
    Some(within(pixel, place))
}

/// The place in a pixel that is where another one is in its pixel.
#[inline(always)]
fn within(pixel: [i64; 2], place: [i64; 2]) -> [u32; 2] {
    let part = (1 << PART_BITS) - 1;
    [0, 1].map(|axis| (pixel[axis] << PART_BITS | place[axis] & part) as u32)
}

/// The middle of a pixel.
fn middle(pixel: [i64; 2]) -> [u32; 2] {
    within(pixel, [1 << (PART_BITS - 1); 2])
}

/// The pixel that a place is in.
#[inline(always)]
fn pixel(place: [u32; 2]) -> [i64; 2] {
    place.map(|at| i64::from(at >> PART_BITS))
}

#[cfg(test)]
mod tests;
