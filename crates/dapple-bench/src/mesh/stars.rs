//! Stars beside those of `spade`.
//!
//! `spade` gets for every site those around it, already looked up and projected, as few as make the star complete: within
//! 1.8 spacings, or 2.8 or 4 where that is too near. It triangulates them all at once and tells who is around the center.
//! Ours looks them up and projects them, too, and joins all stars to a graph. Where even that leaves an empty circle that
//! is too large, at sharp bends, ours connects by a rule of its own; those sites are not compared.

use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Must, Unit};
use anyhow::{Result, ensure};
use dapple_mesh::{
    Connected, HierarchyOptions, STAR_RADIUS, SiteGraph, SiteGrid, SiteIdx, Sites, Surface,
    hexagonal_spacing, models, nested_points,
};
use glam::{DVec2, DVec3};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

const STARS: Case = Case {
    group: "mesh",
    case: "star Delaunay, 65,536 sites",
    peer: "spade bulk_load, one for each site",
    unit: Unit::NsPerPoint,
    must: Must::CostAtMost(0.3),
    note: "the peer has its candidates looked up and projected outside of the clock",
};

/// How far to look for neighbors, in spacings: the next one where empty circles are larger.
const REACHES: [f64; 3] = [1.8, 2.8, 2.0 * STAR_RADIUS];

/// A site in the tangent plane of another one, as a vertex of `spade`.
#[derive(Clone, Copy)]
struct Near {
    at: Point2<f64>,
    site: u32,
}

impl HasPosition for Near {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&STARS) {
        return Ok(());
    }
    let n_sites = HierarchyOptions::default().n_sites;
    let surface = Surface::new(models::bunny(6000)?)?;
    let counts = [n_sites / 16, n_sites / 4, n_sites];
    let points = nested_points(&surface, &counts, crate::sets::SEED, 6);
    let sites = Sites::new(&surface, points);
    let spacing = hexagonal_spacing(surface.area(), n_sites);
    let (candidates, open) = candidates(&sites, spacing);
    let ours = Side::new(Connected::default(), |connected: &mut Connected| {
        *connected = Connected::new(sites.positions(), sites.normals(), spacing)
            .expect("the columns are of one length and the spacing is that of a surface");
    });
    let theirs = Side::new(Vec::new(), |edges: &mut Vec<[SiteIdx; 2]>| {
        edges.clear();
        for near in &candidates {
            star(near, |from, to| edges.push([SiteIdx(from), SiteIdx(to)]));
        }
    });
    bench.beside(&STARS, 5, ours, theirs, |ours, edges| {
        let theirs = SiteGraph::from_edges(n_sites, edges.iter().copied());
        let other = (0..n_sites as u32).map(SiteIdx);
        let other = other.filter(|&site| ours.graph.neighbors(site) != theirs.neighbors(site));
        // An edge is there if either end has it, so a site counts only if all around it have whole stars.
        let is_open = |site: &SiteIdx| open[site.index()];
        let n_other = other
            .filter(|site| !is_open(site) && !theirs.neighbors(*site).iter().any(is_open))
            .count();
        ensure!(n_other == 0, "{n_other} sites have other neighbors");
        Ok(Done::both(n_sites))
    })
}

/// For every site the sites that its star is among, itself first; and whether its empty circles are too large for ours.
fn candidates(sites: &Sites, spacing: f64) -> (Vec<Vec<Near>>, Vec<bool>) {
    let grid = SiteGrid::new(sites.positions(), 2.0 * spacing);
    let of = |center: SiteIdx| {
        for reach in REACHES {
            let near = within(sites, &grid, center, reach * spacing);
            if diameter(&near) <= reach * spacing {
                return (near, false);
            }
        }
        let reach = REACHES[REACHES.len() - 1];
        (within(sites, &grid, center, reach * spacing), true)
    };
    sites.iter().map(of).unzip()
}

/// The sites of the same sheet within a distance, projected so that they keep their distance in space.
fn within(sites: &Sites, grid: &SiteGrid, center: SiteIdx, reach: f64) -> Vec<Near> {
    let [position, normal] =
        [sites.positions(), sites.normals()].map(|of: &[DVec3]| of[center.index()]);
    let (x, y) = normal.any_orthonormal_pair();
    let mut near = vec![Near {
        at: Point2::new(0.0, 0.0),
        site: center.0,
    }];
    grid.visit(position, reach, |site| {
        let away = sites.positions()[site.index()] - position;
        let distance = away.length();
        let projected = DVec2::new(away.dot(x), away.dot(y));
        let same_sheet = sites.normals()[site.index()].dot(normal) >= 0.0;
        if distance > 0.0 && distance <= reach && same_sheet && projected.length() > 0.0 {
            let at = projected * (distance / projected.length());
            near.push(Near {
                at: Point2::new(at.x, at.y),
                site: site.0,
            });
        }
    });
    near
}

/// The diameter of the largest empty circle at the first of some sites; infinity if it is not surrounded.
fn diameter(near: &[Near]) -> f64 {
    let mut largest: f64 = 0.0;
    let triangulation = triangulate(near);
    for vertex in triangulation
        .vertices()
        .filter(|vertex| vertex.data().site == near[0].site)
    {
        for edge in vertex.out_edges() {
            let radius_sq = edge
                .face()
                .as_inner()
                .map_or(f64::INFINITY, |face| face.circumcircle().1);
            largest = largest.max(2.0 * radius_sq.sqrt());
        }
    }
    largest
}

/// Tells the neighbors of the first of some sites.
fn star(near: &[Near], mut neighbor: impl FnMut(u32, u32)) {
    let triangulation = triangulate(near);
    let center = near[0].site;
    if let Some(vertex) = triangulation
        .vertices()
        .find(|vertex| vertex.data().site == center)
    {
        for edge in vertex.out_edges() {
            neighbor(center, edge.to().data().site);
        }
    }
}

fn triangulate(near: &[Near]) -> DelaunayTriangulation<Near> {
    DelaunayTriangulation::bulk_load(near.to_vec())
        .expect("positions in a tangent plane are finite")
}
