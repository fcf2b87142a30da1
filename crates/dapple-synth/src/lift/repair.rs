//! Repair on surfaces: synthesizes the masked part of a source's texture again and leaves the rest unchanged.
//!
//! A stain or a scar is replaced by texture from the rest of the surface, by lifting the surface onto itself. As in a
//! repair in the plane, all sites have a source before any is visited, and each compares its full neighborhood, several
//! times. Fixed sites are their own sources. On the coarsest level a hole starts as the piece of the surface that fits
//! its surroundings best. A hole larger than every piece starts with random sites. A pass proceeds from the
//! rim of a hole inward.
//!
//! Reference: our own. The passes are those of [`Schedule::repair_on_mesh`].

use super::origin::Place;
use super::{MeshExemplar, Origin};
use crate::domain::{Colors, Start, UNKNOWN};
use crate::engine::Progress;
use crate::mesh_domain::MeshDomain;
use crate::{Exemplar, Options, Schedule, SiteGraph, SiteIdx, SurfaceTexture, SynthError};
use core::ops::ControlFlow;
use dapple_raster::parallel;
use glam::Vec2;

/// Width of the compared ring around a hole, in edges. A neighborhood reaches as far.
const RING: u32 = 3;

/// Search radius for the site nearest to the end of a walk, in multiples of the site spacing.
const NEAR: f64 = 1.5;

impl MeshExemplar {
    /// Synthesizes the sites that the texture's [mask](Exemplar::with_mask) excludes. All other sites remain their own
    /// sources.
    ///
    /// The result is a texture for [`source`](Self::source) itself. Baked to a map in the exemplar's texture
    /// coordinates, it has the repaired colors of the excluded texels; all other texels need no change.
    ///
    /// If the options have no schedule, [`Schedule::repair_on_mesh`] is used. [`Options::evenness`] has no effect,
    /// because a small part need not use all of the texture.
    ///
    /// # Errors
    ///
    /// Same as [`Synthesizer::lift`](crate::Synthesizer::lift), except for errors about guides, which a repair does not
    /// use.
    pub fn repair(
        &self,
        options: &Options,
        mut callback: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<SurfaceTexture, SynthError> {
        let schedule = options.schedule.clone();
        let options = Options {
            schedule: Some(schedule.unwrap_or_else(|| Schedule::repair_on_mesh(options.n_levels))),
            evenness: 0.0,
            ..options.clone()
        };
        let starts = self.starts(self.levels(options.n_levels)?);
        let domain = MeshDomain {
            starts: &starts,
            ..self.source().domain(options.axes, false)
        };
        self.grow(self.source(), &domain, &options, &mut callback)
    }

    /// Returns the initial sources of the sites of each level.
    fn starts(&self, levels: &[Exemplar]) -> Vec<Start> {
        let start = |level: &Exemplar| {
            let n_sites = level.size[0];
            let is_kept = level.usable.clone();
            let is_kept = is_kept.unwrap_or_else(|| vec![true; n_sites as usize]);
            let own = (0..n_sites).zip(&is_kept);
            Start {
                pixels: own
                    .map(|(site, &is_kept)| if is_kept { site } else { UNKNOWN })
                    .collect(),
                is_kept,
            }
        };
        let mut starts: Vec<Start> = levels.iter().map(start).collect();
        // Fill the holes of the coarsest level with the pieces that fit best.
        if let (Some(start), Some(exemplar)) = (starts.last_mut(), levels.last()) {
            let level = levels.len() - 1;
            let graph = self.origin.hierarchy().levels()[level].graph();
            for hole in holes(&self.origin, graph, &start.is_kept) {
                let filler = Filler {
                    origin: &self.origin,
                    level,
                    exemplar,
                    is_kept: &start.is_kept,
                };
                if let Some(first) = filler.best(&hole) {
                    for &(site, way) in &hole.sites {
                        start.pixels[site as usize] = filler.site_at(first, way).unwrap_or(UNKNOWN);
                    }
                }
            }
        }
        starts
    }
}

/// Returns the sites to synthesize on a level, from the rims of holes inward. Sites at the same distance from the rim
/// stay in the given `order`.
pub(crate) fn order(start: &Start, graph: &SiteGraph, mut order: Vec<u32>) -> Vec<u32> {
    let rings = rings(graph, &start.is_kept);
    order.retain(|&site| !start.is_kept[site as usize]);
    // The sort is stable, so a ring stays in the order of the sweep.
    order.sort_by_key(|&site| rings[site as usize]);
    order
}

/// Returns the graph distance from each site to the nearest kept site, in edges; `u32::MAX` if unreachable.
fn rings(graph: &SiteGraph, is_kept: &[bool]) -> Vec<u32> {
    let mut rings: Vec<u32> = is_kept
        .iter()
        .map(|&is_kept| if is_kept { 0 } else { u32::MAX })
        .collect();
    let sites = 0..is_kept.len() as u32;
    let mut reached: Vec<u32> = sites.filter(|&site| is_kept[site as usize]).collect();
    let mut at = 0;
    // Search breadth first from all kept sites at once, so that the first visit of a site is along a shortest path.
    while let Some(&site) = reached.get(at) {
        for &near in graph.neighbors(SiteIdx(site)) {
            if rings[near.index()] == u32::MAX {
                rings[near.index()] = rings[site as usize] + 1;
                reached.push(near.0);
            }
        }
        at += 1;
    }
    rings
}

/// A hole: a connected group of sites to synthesize, and the ring of sites around it. Each site has its offset from a
/// middle site, in pixels.
struct Hole {
    sites: Vec<(u32, Vec2)>,
    ring: Vec<(u32, Vec2)>,
}

/// Finds the holes of a level, which are the connected groups of sites that are not kept.
fn holes(origin: &Origin, graph: &SiteGraph, is_kept: &[bool]) -> Vec<Hole> {
    let rings = rings(graph, is_kept);
    let mut is_found = is_kept.to_vec();
    let mut holes = Vec::new();
    for first in 0..is_kept.len() {
        if is_found[first] {
            continue;
        }
        is_found[first] = true;
        // Collect the connected sites.
        let mut sites = vec![first as u32];
        let mut at = 0;
        while let Some(&site) = sites.get(at) {
            for &near in graph.neighbors(SiteIdx(site)) {
                if !is_found[near.index()] {
                    is_found[near.index()] = true;
                    sites.push(near.0);
                }
            }
            at += 1;
        }
        // Lay out the hole from its innermost site; if there are several, from the first.
        let middle = sites
            .iter()
            .copied()
            .rev()
            .max_by_key(|&site| rings[site as usize]);
        holes.push(Hole::around(
            origin,
            graph,
            is_kept,
            middle.unwrap_or(first as u32),
        ));
    }
    holes
}

impl Hole {
    /// Lays out the hole around its middle site. Sites are visited breadth-first, and the offset of a site is the sum
    /// of the steps that lead to it.
    fn around(origin: &Origin, graph: &SiteGraph, is_kept: &[bool], middle: u32) -> Self {
        let mut hole = Self {
            sites: vec![(middle, Vec2::ZERO)],
            ring: Vec::new(),
        };
        let mut is_found = vec![false; is_kept.len()];
        is_found[middle as usize] = true;
        let mut reached = vec![(middle, Vec2::ZERO, 0)];
        let mut at = 0;
        while let Some(&(site, way, edges)) = reached.get(at) {
            at += 1;
            for &near in graph.neighbors(SiteIdx(site)) {
                let edges = if is_kept[near.index()] { edges + 1 } else { 0 };
                if is_found[near.index()] || edges > RING {
                    continue;
                }
                is_found[near.index()] = true;
                let way = way + origin.step(near.0, site);
                reached.push((near.0, way, edges));
                // Sites reached over kept ones form the ring.
                let list = if edges == 0 {
                    &mut hole.sites
                } else {
                    &mut hole.ring
                };
                list.push((near.0, way));
            }
        }
        hole
    }
}

/// Searches for the initial pieces of holes on a level.
struct Filler<'a> {
    origin: &'a Origin,
    level: usize,
    exemplar: &'a Exemplar,
    is_kept: &'a [bool],
}

impl Filler<'_> {
    /// Returns the middle site of the piece whose ring is most similar to the ring of `hole`. Among equal pieces the
    /// first wins. `None` if the hole is larger than every piece.
    fn best(&self, hole: &Hole) -> Option<u32> {
        const CHUNK: usize = 64;
        let n_sites = self.is_kept.len();
        let best_of = |chunk: usize| {
            let sites = chunk * CHUNK..((chunk + 1) * CHUNK).min(n_sites);
            let mut best = (f64::INFINITY, None);
            for site in sites.map(|site| site as u32) {
                if let Some(distance) = self.distance(hole, site, best.0) {
                    best = (distance, Some(site));
                }
            }
            best
        };
        // Search chunks in parallel; between chunks, the first of equal pieces wins.
        let found = parallel::map(n_sites.div_ceil(CHUNK), best_of);
        let mut best = (f64::INFINITY, None);
        for found in found {
            if found.0 < best.0 {
                best = found;
            }
        }
        best.1
    }

    /// Returns the sum of squared differences between the ring of `hole` and the ring of the piece around the middle
    /// site `first`. `None` if the sum is not below `limit`, or if a site of the piece is not kept.
    fn distance(&self, hole: &Hole, first: u32, limit: f64) -> Option<f64> {
        let mut distance = 0.0;
        let colors = self.exemplar.plain();
        for &(site, way) in &hole.ring {
            let other = self.site_at(first, way)?;
            let [own, other] = [site, other].map(|site| colors.of(site as usize));
            let squares = own.iter().zip(other);
            let squares = squares.map(|(a, b)| f64::from(a - b) * f64::from(a - b));
            distance += squares.sum::<f64>();
            // The sum only grows, so this piece cannot become the best.
            if distance >= limit {
                return None;
            }
        }
        // The piece also needs a kept site for each site of the hole.
        let mut sites = hole.sites.iter();
        let is_whole = sites.all(|&(_, way)| self.site_at(first, way).is_some());
        is_whole.then_some(distance)
    }

    /// Walks from `site` by the offset `off`, in pixels, and returns the nearest site. `None` if the walk meets a
    /// border, if no site is in reach, or if the nearest site is not kept.
    fn site_at(&self, site: u32, off: Vec2) -> Option<u32> {
        let walk = self.origin.walk(Place { site, off });
        if walk.left != 0.0 {
            return None;
        }
        let surface = self.origin.synthesizer.surface();
        let (at, out) = (
            surface.position(walk.point),
            surface.face_normal(walk.point.face),
        );
        let hierarchy = self.origin.hierarchy();
        let level = &hierarchy.levels()[self.level];
        let sites = hierarchy.sites();
        let mut nearest = (f64::INFINITY, u32::MAX);
        let reach = NEAR * level.spacing();
        // Skip sites on the opposite side of a thin sheet; of equally near ones take the lowest index.
        level.grid().visit(at, reach, |site| {
            let far = sites.positions()[site.index()].distance_squared(at);
            let is_opposed = sites.normals()[site.index()].dot(out) < 0.0;
            if !is_opposed && (far, site.0) < nearest {
                nearest = (far, site.0);
            }
        });
        let is_kept = self.is_kept.get(nearest.1 as usize);
        is_kept.copied().unwrap_or(false).then_some(nearest.1)
    }
}

#[cfg(test)]
mod tests;
