//! Repair: the masked part of a source's texture again, with everything else as it was.
//!
//! A stain or a scar on a surface is covered with the texture around it: the surface is lifted onto itself. As in a repair in
//! the plane, all sites have a source before any is visited, and each compares with all of its neighborhood, several times.
//! Those that are kept are from where they are. What a hole begins with on the coarsest level is the piece of the surface that
//! fits what is around it best; where no piece is as large as the hole, random sites. A pass goes from the rim of a hole
//! inward.
//!
//! Reference: our own; the passes are those of [`Schedule::repair_on_mesh`].

use super::origin::Place;
use super::{MeshExemplar, Origin};
use crate::engine::Progress;
use crate::ground::{Colors, Start, UNKNOWN};
use crate::mesh_ground::MeshGround;
use crate::{Exemplar, Options, Schedule, SiteGraph, SiteIdx, SurfaceTexture, SynthError};
use core::ops::ControlFlow;
use dapple_raster::parallel;
use glam::Vec2;

/// How many edges around a hole sites are compared to find what it begins with: as far as a neighborhood reaches.
const RING: u32 = 3;

/// How far from the end of a way the nearest site may be, in spacings.
const NEAR: f64 = 1.5;

impl MeshExemplar {
    /// Makes the sites again that the [mask](Exemplar::with_mask) of the texture leaves out, and keeps all others where they
    /// are.
    ///
    /// The texture is for [`source`](Self::source) itself. Baked to a map at the texture coordinates of the example, it is
    /// what belongs at the texels that the mask leaves out; all others need no change.
    ///
    /// Without a schedule in the options it is [`Schedule::repair_on_mesh`]. [`Options::evenness`] has no effect: a small
    /// part need not use all of the texture.
    ///
    /// # Errors
    ///
    /// Those of [`Synthesizer::lift`](crate::Synthesizer::lift) without guides, which a repair has none of.
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
        let ground = MeshGround {
            starts: &starts,
            ..self.source().ground(options.axes, false)
        };
        self.grow(self.source(), &ground, &options, &mut callback)
    }

    /// What the sites of each level begin with.
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

/// The sites of a level that are made again, from the rims of holes inward; those of a ring in the given order.
pub(crate) fn order(start: &Start, graph: &SiteGraph, mut order: Vec<u32>) -> Vec<u32> {
    let rings = rings(graph, &start.is_kept);
    order.retain(|&site| !start.is_kept[site as usize]);
    order.sort_by_key(|&site| rings[site as usize]);
    order
}

/// How many edges each site is from one that is kept; the largest number where there is none.
fn rings(graph: &SiteGraph, is_kept: &[bool]) -> Vec<u32> {
    let mut rings: Vec<u32> = is_kept
        .iter()
        .map(|&is_kept| if is_kept { 0 } else { u32::MAX })
        .collect();
    let sites = 0..is_kept.len() as u32;
    let mut reached: Vec<u32> = sites.filter(|&site| is_kept[site as usize]).collect();
    let mut at = 0;
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

/// Sites beside each other that are made again, and those around them, each with the way to it from one in the middle.
struct Hole {
    sites: Vec<(u32, Vec2)>,
    ring: Vec<(u32, Vec2)>,
}

/// The holes of a level.
fn holes(origin: &Origin, graph: &SiteGraph, is_kept: &[bool]) -> Vec<Hole> {
    let rings = rings(graph, is_kept);
    let mut is_found = is_kept.to_vec();
    let mut holes = Vec::new();
    for first in 0..is_kept.len() {
        if is_found[first] {
            continue;
        }
        is_found[first] = true;
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
        // The innermost site, the first of several.
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
    /// The hole of a site, laid out from it on: the way to a site is that to the one by which it was reached, and from there.
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

/// Looks for what holes of a level begin with.
struct Filler<'a> {
    origin: &'a Origin,
    level: usize,
    exemplar: &'a Exemplar,
    is_kept: &'a [bool],
}

impl Filler<'_> {
    /// The site that takes the place of the middle of a hole in the piece whose surroundings are most like those of the hole,
    /// the first of several; nothing if no piece is as large.
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
        let found = parallel::map(n_sites.div_ceil(CHUNK), best_of);
        let mut best = (f64::INFINITY, None);
        for found in found {
            if found.0 < best.0 {
                best = found;
            }
        }
        best.1
    }

    /// How unlike the surroundings of a hole are those of the piece with a site in the middle, if that is below a limit and
    /// all of the piece is kept.
    fn distance(&self, hole: &Hole, first: u32, limit: f64) -> Option<f64> {
        let mut distance = 0.0;
        let colors = self.exemplar.plain();
        for &(site, way) in &hole.ring {
            let other = self.site_at(first, way)?;
            let [own, other] = [site, other].map(|site| colors.of(site as usize));
            let squares = own.iter().zip(other);
            let squares = squares.map(|(a, b)| f64::from(a - b) * f64::from(a - b));
            distance += squares.sum::<f64>();
            if distance >= limit {
                return None;
            }
        }
        let mut sites = hole.sites.iter();
        let is_whole = sites.all(|&(_, way)| self.site_at(first, way).is_some());
        is_whole.then_some(distance)
    }

    /// The site that is kept nearest to the end of a way from a site.
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
