//! Links of each site: the sites that it reads during correction. These are its neighbors in the graph, whose pieces it
//! continues, and the sites near its four diagonals, whose features it compares.
//!
//! Input: the graphs of a [`Hierarchy`] and the [`Frames`] of its sites. Output: for each site, its links in compressed
//! rows, and the classes of unconnected sites. The graph and the frames do not change, so links are computed once per
//! level.

use crate::endless::level::DIAGONALS;
use crate::orientation::offset_before;
use crate::places::Frames;
use crate::{Hierarchy, SiteGraph, SiteIdx};
use dapple_raster::parallel;
use glam::Vec2;

/// Center of the disk from which the sites of a diagonal are taken, along both axes, in multiples of the distance
/// between features. Values above 1 are beyond the diagonal, so a site reads more than its immediate neighbors.
///
/// Measured on hooks, text, leaves and bricks: windows of the texture are 2 to 5 % closer to windows of the exemplar
/// with 1.6 than with 1.0.
const CORNER: f32 = 1.6;

/// Radius of the disk at [`CORNER`], in multiples of the distance between features.
const REACH: f32 = 1.1;

/// Maximum distance between features, in multiples of the spacing of the sites that are read. Only on the coarsest
/// level are the exemplar's pixels larger than this. There, reading twelve rings of sites around each site would take
/// most of the time.
const MAX_SPACINGS: f32 = 3.0;

/// Number of sites that a task processes.
const TASK: usize = 256;

/// Number of tasks whose links are merged before the next ones run.
const TASKS: usize = 256;

/// Largest index of a class. More classes would only add synchronization.
const MAX_CLASSES: u32 = 63;

/// Another site and its offset. Links dominate memory use, so they are stored compactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Link {
    /// Index of the site in the lower [`SITE_BITS`] bits; above them, the rotation of the exemplar at that site
    /// relative to this one, in quarter turns.
    turned_site: u32,
    /// Offset from this site to the linked site, in pixels of the exemplar.
    way: [f32; 2],
}

/// Number of bits for the index of a site; there are at most 2^28 sites.
const SITE_BITS: u32 = 30;

/// Links of all sites of a level.
#[derive(Debug)]
pub(super) struct Links {
    links: Vec<Link>,
    /// Compressed rows: for each site, the start in `links` of its neighbors and of the sites near each of its four
    /// diagonals.
    rows: Vec<[u32; 5]>,
    /// Classes of sites. Classes are corrected sequentially; connected sites are in different classes.
    pub(super) classes: Vec<Vec<u32>>,
}

/// Links of one site.
#[derive(Clone, Copy, Debug)]
pub(super) struct SiteLinks<'a> {
    /// Neighbors of the site in the graph.
    pub(super) near: &'a [Link],
    /// Sites near each of [`DIAGONALS`].
    pub(super) corners: [&'a [Link]; 4],
}

impl Link {
    fn new(site: SiteIdx, quarters: u8, way: Vec2) -> Self {
        Self {
            turned_site: site.0 | u32::from(quarters) << SITE_BITS,
            way: way.to_array(),
        }
    }

    #[inline]
    pub(super) fn site(&self) -> usize {
        (self.turned_site & ((1 << SITE_BITS) - 1)) as usize
    }

    /// Returns the rotation of the exemplar at the linked site relative to this site, in quarter turns.
    #[inline]
    pub(super) fn quarters(&self) -> u8 {
        (self.turned_site >> SITE_BITS) as u8
    }

    #[inline]
    pub(super) fn way(&self) -> Vec2 {
        self.way.into()
    }
}

impl Links {
    pub(super) fn new(hierarchy: &Hierarchy, frames: &Frames, level: usize) -> Self {
        let n_sites = hierarchy.levels()[level].n_sites();
        let (mut links, mut rows) = (Vec::new(), Vec::with_capacity(n_sites + 1));
        // Links take most of the memory of a synthesis, so merge them in small blocks to avoid a second copy.
        for first in (0..n_sites).step_by(TASK * TASKS) {
            let n_tasks = (n_sites - first).div_ceil(TASK).min(TASKS);
            let pieces = parallel::map(n_tasks, |piece| {
                let mut part = (Vec::new(), Vec::new());
                let first = first + piece * TASK;
                for site in first..n_sites.min(first + TASK) {
                    add(hierarchy, frames, level, SiteIdx(site as u32), &mut part);
                }
                part
            });
            // Append the parts in order, with their starts shifted.
            for (part, ends) in pieces {
                let before = links.len() as u32;
                let ends = ends.into_iter();
                rows.extend(ends.map(|row: [u32; 5]| row.map(|at| before + at)));
                links.extend(part);
            }
        }
        rows.push([links.len() as u32; 5]);
        Self {
            links,
            rows,
            classes: classes(hierarchy, level),
        }
    }

    /// Returns the links of a site.
    #[inline]
    pub(super) fn of(&self, site: usize) -> SiteLinks<'_> {
        let [near, corners @ ..] = self.rows[site];
        let end = self.rows[site + 1][0];
        let [a, b, c, d] = corners;
        let part = |from: u32, until: u32| &self.links[from as usize..until as usize];
        SiteLinks {
            near: part(near, a),
            corners: [part(a, b), part(b, c), part(c, d), part(d, end)],
        }
    }
}

/// Appends the links of a site to `links`, and the start of each of its groups to `rows`.
fn add(
    hierarchy: &Hierarchy,
    frames: &Frames,
    level: usize,
    site: SiteIdx,
    (links, rows): &mut (Vec<Link>, Vec<[u32; 5]>),
) {
    let graph = hierarchy.levels()[level].graph();
    // Link the neighbors.
    let near = graph.neighbors(site);
    let begin = links.len() as u32;
    links.extend(
        near.iter()
            .filter_map(|&other| link(hierarchy, frames, site, other)),
    );
    // Link the sites around each diagonal: within a disk and in the quadrant of the diagonal.
    let mut row = [begin; 5];
    let scale = frames.of_site[site.index()].scale;
    let (found, unit) = around(hierarchy, level, site, scale);
    let found: Vec<Link> = found
        .into_iter()
        .filter_map(|other| link(hierarchy, frames, site, other))
        .collect();
    for (corner, diagonal) in DIAGONALS.iter().enumerate() {
        row[corner + 1] = links.len() as u32;
        let middle = Vec2::from(diagonal.map(|at| at as f32)) * CORNER * unit;
        let is_there = |link: &&Link| {
            let way = link.way() * scale;
            way.distance_squared(middle) < (REACH * unit) * (REACH * unit)
                && (way * middle).cmpgt(Vec2::ZERO).all()
        };
        links.extend(found.iter().filter(is_there));
    }
    rows.push(row);
}

/// Returns the sites that may be near the diagonals of a site, and the distance between features in multiples of the
/// finest spacing. `scale` is the size of a pixel of the exemplar, in the same unit.
///
/// If a pixel is large, it contains many sites. Sites of a coarser level are used then, because they carry the same
/// information. If a pixel is smaller than the spacing, the features are one spacing apart.
fn around(hierarchy: &Hierarchy, level: usize, site: SiteIdx, scale: f32) -> (Vec<SiteIdx>, f32) {
    let levels = hierarchy.levels();
    let mut found = levels[level].graph().neighbors(site).to_vec();
    let (mut read, mut spacings) = (level, scale);
    // While a pixel spans two spacings or more, continue on the next coarser level.
    while spacings >= 2.0 && read + 1 < levels.len() {
        add_ring(levels[read].graph(), site, &mut found);
        (read, spacings) = (read + 1, 0.5 * spacings);
        found.retain(|other| other.index() < levels[read].n_sites());
    }
    let spacings = spacings.clamp(1.0, MAX_SPACINGS);
    let n_rings = (2.0 * spacings).ceil() as usize;
    for _ in 1..n_rings {
        add_ring(levels[read].graph(), site, &mut found);
    }
    (found, spacings * (1_u64 << read) as f32)
}

/// Adds the neighbors of the sites in `found`, removes `site` and duplicates, and sorts by index.
fn add_ring(graph: &SiteGraph, site: SiteIdx, found: &mut Vec<SiteIdx>) {
    // The length is read once, so this adds a single ring.
    for at in 0..found.len() {
        found.extend(graph.neighbors(found[at]));
    }
    found.retain(|&other| other != site);
    found.sort_unstable();
    found.dedup();
}

/// Returns the link to another site, or `None` if it is on another sheet of the surface, that is, if the two normals
/// are more than a right angle apart.
fn link(hierarchy: &Hierarchy, frames: &Frames, from: SiteIdx, to: SiteIdx) -> Option<Link> {
    let (sites, [a, b]) = (hierarchy.sites(), [from, to].map(|site| site.index()));
    if sites.normals()[a].dot(sites.normals()[b]) < 0.0 {
        return None;
    }
    let way = (sites.positions()[b] - sites.positions()[a]).as_vec3();
    let quarters = frames.quarters_between(a, b);
    let [here, there] = [a, b].map(|site| frames.of_site[site].flat(way));
    // The frame changes along the offset; average the offsets in the frames of both ends.
    let way = 0.5 * (here + Vec2::from(offset_before(there.to_array(), quarters)));
    Some(Link::new(to, quarters, way))
}

/// Colors the graph: puts every site into the first class that contains none of its neighbors with a lower index.
fn classes(hierarchy: &Hierarchy, level: usize) -> Vec<Vec<u32>> {
    let graph = hierarchy.levels()[level].graph();
    let mut class_of = vec![0_u32; graph.len()];
    let mut classes: Vec<Vec<u32>> = Vec::new();
    for site in 0..graph.len() as u32 {
        let lower = graph.neighbors(SiteIdx(site)).iter();
        let lower = lower.take_while(|other| other.0 < site);
        let taken = lower.fold(0_u64, |taken, other| taken | 1 << class_of[other.index()]);
        // Greedy graph coloring: take the first class that no neighbor has so far.
        let class = taken.trailing_ones().min(MAX_CLASSES);
        class_of[site as usize] = class;
        if classes.len() <= class as usize {
            classes.push(Vec::new());
        }
        classes[class as usize].push(site);
    }
    classes
}
