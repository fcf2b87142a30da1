//! Which sites of a level read which: the neighbors of each, which it goes on with, and the sites on its diagonals, which
//! say what is there.

use crate::endless::stage::DIAGONALS;
use crate::orientation::offset_before;
use crate::places::Frames;
use crate::{Hierarchy, SiteGraph, SiteIdx};
use dapple_raster::parallel;
use glam::Vec2;

/// How far along both axes the middle of the sites is that tell of a diagonal, in those of a window: beyond the corner, so that a site
/// sees more than its neighbors.
///
/// Measured on hooks, text, leaves and bricks: with 1.6 windows of the texture are 2 to 5 % nearer to those of the exemplar
/// than with 1.0.
const CORNER: f32 = 1.6;

/// How far from there they are at most.
const REACH: f32 = 1.1;

/// The most spacings of the sites that are read between those of a window. Only the coarsest level has more to a large pixel, and
/// twelve rings of sites around each would be most of the time.
const MAX_SPACINGS: f32 = 3.0;

/// Sites that one task links at least.
const TASK: usize = 256;

/// Tasks whose links are put together before others begin.
const TASKS: usize = 256;

/// The most classes; more would only wait for each other.
const MAX_CLASSES: u32 = 63;

/// Another site, and where it lies. There are so many that every byte counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Link {
    /// The site, and above [`SITE_BITS`] by how many quarter turns the exemplar lies turned there, seen from here.
    turned_site: u32,
    /// The way to it in pixels of the exemplar.
    way: [f32; 2],
}

/// The bits of a link that say which site it is; there are at most 2^28.
const SITE_BITS: u32 = 30;

/// The sites that each site of a level reads.
#[derive(Debug)]
pub(super) struct Links {
    links: Vec<Link>,
    /// Where the neighbors of each site begin, and those of its diagonals, one after the other.
    rows: Vec<[u32; 5]>,
    /// The sites in classes that are corrected one after the other; no two of one class are connected.
    pub(super) classes: Vec<Vec<u32>>,
}

/// What a site reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around<'a> {
    /// The sites that it is connected to.
    pub(super) near: &'a [Link],
    /// The sites on each of [`DIAGONALS`].
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

    /// By how many quarter turns the exemplar lies turned at the site, seen from the one that it is linked to.
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
        // Links take most of the memory of a synthesis: few of them are there twice.
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

    /// What a site reads.
    #[inline]
    pub(super) fn of(&self, site: usize) -> Around<'_> {
        let [near, corners @ ..] = self.rows[site];
        let end = self.rows[site + 1][0];
        let [a, b, c, d] = corners;
        let part = |from: u32, until: u32| &self.links[from as usize..until as usize];
        Around {
            near: part(near, a),
            corners: [part(a, b), part(b, c), part(c, d), part(d, end)],
        }
    }
}

/// Appends the links of a site, and where they begin.
fn add(
    hierarchy: &Hierarchy,
    frames: &Frames,
    level: usize,
    site: SiteIdx,
    (links, rows): &mut (Vec<Link>, Vec<[u32; 5]>),
) {
    let graph = hierarchy.levels()[level].graph();
    let near = graph.neighbors(site);
    let begin = links.len() as u32;
    links.extend(
        near.iter()
            .filter_map(|&other| link(hierarchy, frames, site, other)),
    );
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

/// The sites that may tell of the diagonals of a site where a pixel is `scale` spacings large, and how far apart those are that
/// a window compares, in spacings of the finest level.
///
/// Of the many sites within large pixels, those of a coarser level say as much. Pixels smaller than the spacing are seen through
/// sites a spacing apart.
fn around(hierarchy: &Hierarchy, level: usize, site: SiteIdx, scale: f32) -> (Vec<SiteIdx>, f32) {
    let levels = hierarchy.levels();
    let mut found = levels[level].graph().neighbors(site).to_vec();
    let (mut read, mut spacings) = (level, scale);
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

/// Adds the sites that those found are connected to, without the site around which they lie, in their order.
fn add_ring(graph: &SiteGraph, site: SiteIdx, found: &mut Vec<SiteIdx>) {
    for at in 0..found.len() {
        found.extend(graph.neighbors(found[at]));
    }
    found.retain(|&other| other != site);
    found.sort_unstable();
    found.dedup();
}

/// The way to another site; nothing if it is on another sheet.
fn link(hierarchy: &Hierarchy, frames: &Frames, from: SiteIdx, to: SiteIdx) -> Option<Link> {
    let (sites, [a, b]) = (hierarchy.sites(), [from, to].map(|site| site.index()));
    if sites.normals()[a].dot(sites.normals()[b]) < 0.0 {
        return None;
    }
    let way = (sites.positions()[b] - sites.positions()[a]).as_vec3();
    let quarters = frames.quarters_between(a, b);
    let [here, there] = [a, b].map(|site| frames.of_site[site].flat(way));
    // Frames turn on the way: the mean of both ends is that of its middle.
    let way = 0.5 * (here + Vec2::from(offset_before(there.to_array(), quarters)));
    Some(Link::new(to, quarters, way))
}

/// Puts every site into the first class that none of its neighbors with a lower number is in.
fn classes(hierarchy: &Hierarchy, level: usize) -> Vec<Vec<u32>> {
    let graph = hierarchy.levels()[level].graph();
    let mut class_of = vec![0_u32; graph.len()];
    let mut classes: Vec<Vec<u32>> = Vec::new();
    for site in 0..graph.len() as u32 {
        let lower = graph.neighbors(SiteIdx(site)).iter();
        let lower = lower.take_while(|other| other.0 < site);
        let taken = lower.fold(0_u64, |taken, other| taken | 1 << class_of[other.index()]);
        let class = taken.trailing_ones().min(MAX_CLASSES);
        class_of[site as usize] = class;
        if classes.len() <= class as usize {
            classes.push(Vec::new());
        }
        classes[class as usize].push(site);
    }
    classes
}
