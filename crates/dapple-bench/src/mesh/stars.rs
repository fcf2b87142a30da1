//! Our stars (the Delaunay neighbors of each site) compared with the stars of `spade`.
//!
//! Both sides get positions, normals and a spacing. They find the sites around every site with our grid, project them
//! to its tangent plane, find its star, and join all stars into a graph. `spade` gets as few sites as a complete star
//! needs: those within 1.8 spacings, or within 2.8 or 4 if a smaller radius is not enough. It triangulates them all
//! at once and returns the neighbors of the center.
//!
//! Confirmed: both find the same neighbors. At sharp bends even 4 spacings can leave an empty circle that is too
//! large. There our side connects sites by a separate rule, and these sites are not compared.

use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use anyhow::{Result, ensure};
use dapple_mesh::Surface;
use dapple_models as models;
use dapple_synth::{
    Connected, HierarchyOptions, STAR_RADIUS, SiteGraph, SiteGrid, SiteIdx, Sites,
    hexagonal_spacing, nested_points,
};
use glam::{DVec2, DVec3};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

const STARS: Case = Case {
    group: "mesh",
    case: "star Delaunay, 65,536 sites",
    peer: "spade bulk_load, one for each site",
    unit: Unit::NsPerPoint,
    must: Goal::CostAtMost(0.3),
    note: "both look the sites around each site up with our grid, project them, and join the stars to a graph",
};

/// Search radii for neighbors, in multiples of the site spacing. The next radius is tried if an empty circle is too
/// large.
const REACHES: [f64; 3] = [1.8, 2.8, 2.0 * STAR_RADIUS];

/// A site, projected to another site's tangent plane, as a vertex for `spade`.
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

/// The graph of neighbors that `spade` finds.
#[derive(Default)]
struct Theirs {
    graph: SiteGraph,
    /// For each site, whether an empty circle around it exceeds the limit of our method.
    open: Vec<bool>,
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
    let ours = Side::new(Connected::default(), |connected: &mut Connected| {
        *connected = Connected::new(sites.positions(), sites.normals(), spacing)
            .expect("the columns are of one length and the spacing is that of a surface");
    });
    let theirs = Side::new(Theirs::default(), |theirs: &mut Theirs| {
        *theirs = Theirs::new(&sites, spacing);
    });
    bench.beside(&STARS, 5, ours, theirs, |ours, theirs| {
        let neighbors = |site| theirs.graph.neighbors(site);
        // Either end can contribute an edge, so a site is compared only if all sites around it have complete stars.
        let is_open = |site: &SiteIdx| theirs.open[site.index()];
        let counts = |site: &SiteIdx| !is_open(site) && !neighbors(*site).iter().any(is_open);
        let compared: Vec<SiteIdx> = sites.iter().filter(counts).collect();
        ensure!(
            compared.len() > n_sites - n_sites / 100,
            "only {} sites can be compared",
            compared.len()
        );
        let other = |site: &&SiteIdx| ours.graph.neighbors(**site) != neighbors(**site);
        let n_other = compared.iter().filter(other).count();
        ensure!(n_other == 0, "{n_other} sites have other neighbors");
        Ok(Done::both(n_sites))
    })
}

impl Theirs {
    fn new(sites: &Sites, spacing: f64) -> Self {
        let grid = SiteGrid::new(sites.positions(), 2.0 * spacing);
        let (mut edges, mut open) = (Vec::new(), Vec::with_capacity(sites.len()));
        for center in sites.iter() {
            let (around, is_open) = star(sites, &grid, center, spacing);
            edges.extend(around.into_iter().map(|to| [center, SiteIdx(to)]));
            open.push(is_open);
        }
        Self {
            graph: SiteGraph::from_edges(sites.len(), edges),
            open,
        }
    }
}

/// Returns the neighbors of a site, and whether an empty circle between them exceeds the limit.
fn star(sites: &Sites, grid: &SiteGrid, center: SiteIdx, spacing: f64) -> (Vec<u32>, bool) {
    let mut around = Vec::new();
    for reach in REACHES.map(|reach| reach * spacing) {
        around.clear();
        let near = within(sites, grid, center, reach);
        let triangulation = DelaunayTriangulation::<Near>::bulk_load(near)
            .expect("positions in a tangent plane are finite");
        let mut largest_sq: f64 = 0.0;
        let mut vertices = triangulation.vertices();
        let vertex = vertices.find(|vertex| vertex.data().site == center.0);
        for edge in vertex.iter().flat_map(|vertex| vertex.out_edges()) {
            around.push(edge.to().data().site);
            let face = edge.face();
            let radius_sq = face
                .as_inner()
                .map_or(f64::INFINITY, |face| face.circumcircle().1);
            largest_sq = largest_sq.max(4.0 * radius_sq);
        }
        if !around.is_empty() && largest_sq <= reach * reach {
            return (around, false);
        }
    }
    (around, true)
}

/// Returns the sites of the same sheet within `reach` of the center, projected to its tangent plane. Projected
/// positions are scaled so that their distance to the center equals the distance in space.
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
