//! Surface synthesis by correction in appearance space: on each level, every site is moved a few times to the exemplar
//! position whose surroundings are most similar to the site's surroundings.
//!
//! References: Sylvain Lefebvre and Hugues Hoppe, "Appearance-Space Texture Synthesis", SIGGRAPH 2006, DOI
//! 10.1145/1141911.1141921, and "Parallel Controllable Texture Synthesis", SIGGRAPH 2005, DOI 10.1145/1186822.1073261.
//!
//! Input: the sites of a [`Synthesizer`], an exemplar, guides, and the pixels that the first pass of [`engine`]
//! assigned to the coarsest sites. Output: for each site of each level, a pixel of the exemplar.
//!
//! The source of a site is a position in the exemplar, with subpixel precision. On every level it is a position in the
//! full-size exemplar. A feature vector describes the window around a pixel: the principal components of its colors
//! ([`stage`]). Neighborhoods are compared by the features on their four diagonals, which are as far apart as the sites
//! of the level. They have 32 values, whereas the two squares of colors in the paper's neighborhoods have 171. Features
//! are looked up at the positions that the neighbors predict; nothing is interpolated, so nothing is blurred.
//!
//! Steps on each level, from the coarsest:
//!
//! - Sites of the coarser level keep their exemplar positions. A new site takes the position that its nearest coarser
//!   neighbor predicts.
//! - Each site compares several candidates and takes the best ([`choose`]): the positions that its neighbors predict,
//!   positions half a pixel from the best of these, and the positions most similar to the predicted ones. All sites are
//!   corrected a few times in this way.
//!
//! Departures from the papers:
//!
//! - Sites are not pixels of a chart, so there are no jumps between charts. The offset of a neighbor in the exemplar is
//!   the average of two offsets, one in the frame of the site and one in the frame of the neighbor ([`links`]).
//! - Sites are corrected in classes, one class after the other. Sites of the same class are not connected. Classes
//!   depend on the graph alone.
//! - The coarsest level begins with the first pass of Turk's sweep (2001), in which large features grow from one side
//!   to the other.
//! - Parts of the exemplar that the texture uses too often cost more from pass to pass, as in endless textures.
//!
//! If the orientation field has a symmetry, the first pass determines the rotation of the exemplar at the coarsest
//! sites, and finer sites take the rotation of the nearest coarser site. A site continues only neighbors with the same
//! rotation; at the others it reads the features of the rotated exemplar.
//!
//! Guides are compared along with the features. The position predicted by the coarser level may have guides far from
//! the target guides, with no better position near it. So before correction, a site searches the whole exemplar if the
//! squared distance of its guides exceeds a fraction of the squared distance of its features ([`MISFIT`]).

mod links;

use crate::endless::evenness::Costs;
use crate::endless::level::{self, AppearanceLevel, DIAGONALS, N_FEATURES, narrow};
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

/// Number of subpixel bits of a position, which is in units of 1/8 pixel along each axis. With whole pixels, a
/// prediction would be off by up to half a pixel at every step, which would break up pieces of the exemplar.
///
/// Coordinates of 32 bits allow 2^29 pixels along a side. An image with at least five rows cannot have more.
const PART_BITS: u32 = 3;

/// Offset, in units of 1/8 pixel, of the additional positions that a site tries around the best one: half a pixel.
///
/// Measured on the six models of figure 5: 13 to 18 % of neighbors belong to other pieces, compared with 14 to 27 %
/// with whole pixels, and colors where pieces meet differ by 7 to 34 % less (mean squares over all neighbors). Without
/// this step pieces are larger still, but differ more where they meet; the same holds for an offset of a whole pixel.
const ASIDE: i64 = 1 << (PART_BITS - 1);

/// Number of correction passes per level; the coarsest level has twice as many.
const N_PASSES: usize = 3;

/// Minimum number of sites per task.
const TASK: usize = 64;

/// Maximum number of predicted positions that a site compares. Positions similar to the predicted ones are not counted.
const MAX_COHERENT: usize = 16;

/// Decrease per pass in the cost of a part that the texture does not use, in multiples of the mean squared distance.
const STEP: f32 = 0.8;

/// A site searches the whole exemplar if the squared distance of its guides, divided by the squared distance of its
/// features, exceeds this value.
///
/// Measured on leaves, guided by a soft and by a hard image: the brightness of the texture has a correlation of 0.42
/// and 0.41 with the brightness of the image, as in synthesis by colors, in the same time as with a value of 1 (0.40
/// and 0.39). Searching for every site gives 0.01 more and takes a quarter longer.
const MISFIT: f32 = 0.25;

/// Number of search tasks between two progress callbacks.
const TASKS: usize = 256;

/// Correction of the sites of a surface: the sites with their frames and guides, and all levels of the exemplar.
pub(crate) struct Appearance<'a> {
    hierarchy: &'a Hierarchy,
    targets: &'a Targets,
    /// Rotation of the exemplar at each site, in quarter turns; empty if the orientation field has no symmetry.
    pub(crate) quarters: Vec<u8>,
    frames: Frames,
    /// Levels of the exemplar, the finest first.
    stages: Vec<AppearanceLevel>,
    seed: Seed,
    /// Factor on the changes in costs; 0 if parts have no costs.
    evenness: f32,
}

/// A candidate position, in units of 1/8 pixel, and its score: the squared distance from the site in features and
/// guides, plus the cost of the position.
#[derive(Clone, Copy, Debug)]
struct Choice {
    place: [u32; 2],
    distance_sq: f32,
}

impl<'a> Appearance<'a> {
    /// Prepares the levels of an exemplar. `coarsest` is the rotation of the exemplar at each coarsest site, in quarter
    /// turns. `targets` has as many guides as the exemplar.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Masked`] if the mask allows no pixel.
    pub(crate) fn new(
        synthesizer: &'a Synthesizer,
        exemplar: &Exemplar,
        targets: &'a Targets,
        coarsest: &[u8],
        options: &Options,
    ) -> Result<Self, SynthError> {
        // Do not even out usage if the texture is smaller than the exemplar and cannot use all parts, if the exemplar
        // is regular and its parts are used evenly anyway, or if guides determine the parts.
        let [width, height] = exemplar.size.map(|side| side as usize);
        let quarters = quarters(synthesizer, coarsest, options.n_levels);
        let frames = Frames::new(synthesizer, &quarters);
        let is_uneven = frames.n_pixels() < (width * height) as f64
            || exemplar.n_guides() > 0
            || exemplar.regularity() > REGULAR;
        let symmetry = synthesizer.orientation().symmetry();
        let wanted = Wanted::new(&|| false);
        let mut stages = level::stages(
            exemplar,
            &exemplar.guides,
            symmetry,
            options.n_levels,
            &wanted,
        )?;
        for stage in &mut stages {
            stage.coherence = match options.coherence {
                // A factor of 2 measured better than smaller ones for regular exemplars, too.
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

    /// Corrects all levels. Returns the exemplar pixel of each site of each level, the finest level first. `coarsest`
    /// holds the initial pixels of the coarsest sites, as indices in the coarsest level of a pyramid.
    pub(crate) fn run(
        &mut self,
        coarsest: &[u32],
        callback: Callback<'_>,
    ) -> Result<Vec<Vec<[u32; 2]>>, SynthError> {
        let n_levels = self.stages.len();
        let mut levels: Vec<Vec<[u32; 2]>> = Vec::new();
        // Process the levels, the coarsest first.
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
            // Move sites with wrong guides, then correct all sites.
            self.apply_guides(level, &links, &mut places, &mut tell)?;
            self.correct(level, &links, n_passes, &mut places, &mut tell)?;
            levels.push(places);
        }
        // Convert positions to pixels.
        levels.reverse();
        let pixels = |places: Vec<[u32; 2]>| {
            let pixels = places.into_iter().map(|place| narrow(pixel(place)));
            pixels.collect()
        };
        Ok(levels.into_iter().map(pixels).collect())
    }

    /// Returns the initial positions of the coarsest sites. `pixels` are indices in the coarsest level of a pyramid.
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

    /// Returns the initial positions of a level. Sites of the coarser level keep their positions; a new site takes the
    /// position that its nearest coarser neighbor predicts.
    fn refine(&self, level: usize, coarser: &[[u32; 2]], links: &Links) -> Vec<[u32; 2]> {
        let stage = &self.stages[level];
        let n_sites = self.hierarchy.levels()[level].n_sites();
        parallel::map_at_least(TASK, n_sites, |site| {
            // Sites of the coarser level keep their position.
            if let Some(&place) = coarser.get(site) {
                return place;
            }
            // Find the nearest coarser neighbor with the same rotation.
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
            // Take the position that it predicts, or its own if that is not usable.
            let parent = coarser[link.site()];
            settled(stage, moved(parent, -link.way())).unwrap_or(parent)
        })
    }

    /// Returns a random usable position for `site`.
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

    /// Moves each site whose guides differ much from the targets to the exemplar position with the most similar
    /// features and guides.
    fn apply_guides(
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
                    // Search only if the guides differ much, compared with the features.
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

    /// Corrects all sites of a level `n_passes` times.
    fn correct(
        &mut self,
        level: usize,
        links: &Links,
        n_passes: usize,
        places: &mut [[u32; 2]],
        tell: &mut dyn FnMut(usize) -> Result<(), SynthError>,
    ) -> Result<(), SynthError> {
        let simd = simd::level();
        let AppearanceLevel { size, spacing, .. } = self.stages[level];
        // Start without costs. The target is even usage of the usable pixels.
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
                // Choose the positions of a class in parallel, then store them.
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
            // Raise the costs of parts that are used too often.
            if self.evenness > 0.0 {
                // Costs are in units of the mean score of the first pass.
                let scale = *scale.get_or_insert(sum / places.len().max(1) as f64) as f32;
                let shares = costs.shares(places.iter().map(|&place| narrow(pixel(place))));
                costs.change(&shares, &wanted, self.evenness * STEP * scale);
                self.stages[level].costs = costs.clone();
            }
        }
        Ok(())
    }
}

/// Returns the rotation of the exemplar at all sites, in quarter turns. `coarsest` holds the rotations at the coarsest
/// sites. Every other site has the rotation of the nearest coarser site among its neighbors.
fn quarters(synthesizer: &Synthesizer, coarsest: &[u8], n_levels: usize) -> Vec<u8> {
    if coarsest.is_empty() {
        return Vec::new();
    }
    let (hierarchy, orientation) = (synthesizer.hierarchy(), synthesizer.orientation());
    let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
    let mut quarters = coarsest.to_vec();
    // Propagate the rotations from level to level.
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

/// Returns the position with the lowest score for a site: squared distance in the features around the site, plus
/// squared distance in guides from `wanted`, plus cost. The first of equally good positions is returned.
#[inline(always)]
fn choose(
    stage: &AppearanceLevel,
    links: &Links,
    site: usize,
    places: &[[u32; 2]],
    wanted: &[f32],
) -> Choice {
    // Compare the position of the site itself.
    let around = around(stage, links, site, places);
    let mut best = Choice {
        place: places[site],
        distance_sq: f32::INFINITY,
    };
    let own = places[site];
    let mut coherent = [own; MAX_COHERENT];
    let mut n_coherent = 1;
    best.compare(stage, &around, wanted, own, 1.0);
    // Compare the positions that the neighbors predict.
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
    // Compare positions half a pixel from the best one. They let pieces stretch without a break.
    let found = best.place;
    for [x, y] in [[ASIDE, 0], [-ASIDE, 0], [0, ASIDE], [0, -ASIDE]] {
        let aside = [i64::from(found[0]) + x, i64::from(found[1]) + y];
        if let Some(place) = settled(stage, aside)
            && pixel(place) != pixel(found)
        {
            best.compare(stage, &around, wanted, place, 1.0);
        }
    }
    // Compare the positions most similar to the predicted ones, at a disadvantage.
    for &place in &coherent[..n_coherent] {
        if let Some(similar) = stage.similar(pixel(place)) {
            let similar = within(similar, place.map(i64::from));
            best.compare(stage, &around, wanted, similar, 1.0 + stage.coherence);
        }
    }
    best
}

impl Choice {
    /// Takes a position if its score is lower than the lowest so far. `factor` multiplies its squared distance, but not
    /// its cost.
    #[inline(always)]
    fn compare(
        &mut self,
        stage: &AppearanceLevel,
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

/// Returns the features on each diagonal of a site: the mean of the features that the sites near the diagonal predict.
/// `None` for a diagonal without sites, for example past an edge of the surface.
#[inline(always)]
fn around(
    stage: &AppearanceLevel,
    links: &Links,
    site: usize,
    places: &[[u32; 2]],
) -> [Option<[f32; N_FEATURES]>; 4] {
    // Average over the sites near this diagonal.
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
            // Offset from the linked site to the diagonal, in the frame of that site.
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

/// Returns the features on all diagonals; missing ones are replaced by the mean of the others. `None` if all are
/// missing.
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

/// Returns the squared distance between the features on the diagonals of a site and those on the diagonals of a pixel.
/// Missing diagonals are skipped.
#[inline(always)]
fn distance_sq(
    stage: &AppearanceLevel,
    around: &[Option<[f32; N_FEATURES]>; 4],
    place: [i64; 2],
) -> f32 {
    let known = around.iter().zip(DIAGONALS);
    let known = known.filter_map(|(own, diagonal)| Some((own.as_ref()?, diagonal)));
    stage.distance_sq_of(known, place)
}

/// Returns a position plus an offset in pixels. The result may be outside the exemplar.
#[inline(always)]
fn moved(place: [u32; 2], way: Vec2) -> [i64; 2] {
    let way = (way * (1 << PART_BITS) as f32).round();
    [
        i64::from(place[0]) + way.x as i64,
        i64::from(place[1]) + way.y as i64,
    ]
}

/// Returns `place` within the exemplar, wrapped if the exemplar wraps, or `None` if its pixel is not usable.
#[inline(always)]
fn settled(stage: &AppearanceLevel, place: [i64; 2]) -> Option<[u32; 2]> {
    let pixel = stage.usable(place.map(|at| at >> PART_BITS))?;
    Some(within(pixel, place))
}

/// Returns the position in `pixel` with the subpixel part of `place`.
#[inline(always)]
fn within(pixel: [i64; 2], place: [i64; 2]) -> [u32; 2] {
    let part = (1 << PART_BITS) - 1;
    [0, 1].map(|axis| (pixel[axis] << PART_BITS | place[axis] & part) as u32)
}

/// Returns the position of the center of `pixel`.
fn middle(pixel: [i64; 2]) -> [u32; 2] {
    within(pixel, [1 << (PART_BITS - 1); 2])
}

/// Returns the pixel that contains `place`.
#[inline(always)]
fn pixel(place: [u32; 2]) -> [i64; 2] {
    place.map(|at| i64::from(at >> PART_BITS))
}

#[cfg(test)]
mod tests;
