//! The sites around a site, in columns that are read from one end to the other.
//!
//! Positions are kept in `f32`, relative to the middle of all sites: rounding is below 1e-4 of a spacing for a thousand
//! million sites.

use crate::cells::Cells;
use dapple_mesh::{Hierarchy, Sites};
use glam::{DVec3, Vec3};

/// The side of a cell in spacings.
const CELL: f64 = 3.0;

/// The sites that may be near each site of a level.
#[derive(Clone, Debug)]
pub(crate) struct Neighborhoods {
    cells: Cells,
    /// Where the sites that are read begin in each cell.
    first: Vec<u32>,
    records: Vec<Record>,
    /// The positions of the sites in the middle.
    centers: Vec<Vec3>,
    reach_sq: f32,
}

/// A site that is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Record {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) site: u32,
}

/// The sites near one site, relative to it.
#[derive(Debug, Default)]
pub(crate) struct Nearby {
    pub(crate) records: Vec<Record>,
}

impl Neighborhoods {
    /// The neighborhoods of the first `n_sites` sites among the first `n_reads`, which are `spacing` apart.
    pub(crate) fn new(
        sites: &Sites,
        [n_sites, n_reads]: [usize; 2],
        spacing: f64,
        reach: f64,
    ) -> Self {
        let positions = &sites.positions()[..n_sites];
        let cells = Cells::new(positions, CELL * spacing, reach);
        let [low, high] = [
            (DVec3::INFINITY, DVec3::min as fn(DVec3, DVec3) -> DVec3),
            (DVec3::NEG_INFINITY, DVec3::max),
        ]
        .map(|(start, pick)| positions.iter().copied().fold(start, pick));
        let middle = low * 0.5 + high * 0.5;
        let mut first = vec![0_u32; cells.n_cells() + 1];
        for site in 0..n_reads as u32 {
            first[cells.of_site(site) + 1] += 1;
        }
        for cell in 0..cells.n_cells() {
            first[cell + 1] += first[cell];
        }
        let centers: Vec<Vec3> = positions
            .iter()
            .map(|&at| (at - middle).as_vec3())
            .collect();
        let empty = Record {
            position: [0.0; 3],
            normal: [0.0; 3],
            site: 0,
        };
        let mut records = vec![empty; n_reads];
        let mut next = first.clone();
        for site in 0..n_reads {
            let to = &mut next[cells.of_site(site as u32)];
            records[*to as usize] = Record {
                position: centers[site].to_array(),
                normal: sites.normals()[site].as_vec3().to_array(),
                site: site as u32,
            };
            *to += 1;
        }
        Self {
            cells,
            first,
            records,
            centers,
            reach_sq: (reach * reach) as f32,
        }
    }

    /// The cells, between which dependencies are kept.
    pub(crate) fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Takes the sites in the ball of a site; a small piece of the surface that has no site of a coarse level takes the
    /// nearest one of all.
    #[inline]
    pub(crate) fn collect(&self, site: u32, nearby: &mut Nearby) {
        let center = self.centers[site as usize].to_array();
        nearby.records.clear();
        for cells in self.cells.near(self.cells.of_site(site)) {
            let [from, until] = [cells.start, cells.end].map(|cell| self.first[cell as usize]);
            for record in &self.records[from as usize..until as usize] {
                let position = core::array::from_fn(|part| record.position[part] - center[part]);
                if length_sq(position) < self.reach_sq {
                    nearby.records.push(Record {
                        position,
                        ..*record
                    });
                }
            }
        }
        if nearby.records.is_empty() {
            nearby.records.extend(self.nearest(center));
        }
    }

    /// The site nearest to a position, relative to it; of several the first.
    #[cold]
    fn nearest(&self, center: [f32; 3]) -> Option<Record> {
        let relative = self.records.iter().map(|record| Record {
            position: core::array::from_fn(|part| record.position[part] - center[part]),
            ..*record
        });
        relative.min_by(|a, b| {
            let [from_a, from_b] = [a, b].map(|record| length_sq(record.position));
            from_a.total_cmp(&from_b).then(a.site.cmp(&b.site))
        })
    }
}

#[inline(always)]
fn length_sq([x, y, z]: [f32; 3]) -> f32 {
    x * x + y * y + z * z
}

impl Nearby {
    /// Takes the sites of a level in a ball; if there are none, in the next larger one of twice the radius that has some.
    pub(crate) fn collect_ball(
        &mut self,
        hierarchy: &Hierarchy,
        level: usize,
        center: DVec3,
        reach: f64,
    ) {
        let sites = hierarchy.sites();
        let mut reach = reach;
        self.records.clear();
        while self.records.is_empty() && reach.is_finite() {
            let reach_sq = reach * reach;
            hierarchy.levels()[level]
                .grid()
                .visit(center, reach, |site| {
                    let from = sites.positions()[site.index()] - center;
                    if from.length_squared() < reach_sq {
                        self.records.push(Record {
                            position: from.as_vec3().to_array(),
                            normal: sites.normals()[site.index()].as_vec3().to_array(),
                            site: site.0,
                        });
                    }
                });
            reach *= 2.0;
        }
    }
}
