//! Sites in groups that can be visited at the same time.
//!
//! A site waits for all earlier sites of the sweep that it may read, and all later ones wait for it; what is left over is free.
//! So the groups give, one after the other, the same bits as the sites in the order of the sweep.

use glam::DVec3;

/// The side of a cell in spacings: dependencies are kept between whole cells.
const CELL: f64 = 3.0;

/// Sites in an order in which they may be visited in groups: within a group none reads what another one writes.
///
/// Group after group gives the same bits as the sites in the order of the sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Groups {
    sites: Vec<u32>,
    /// Where the groups end in `sites`.
    ends: Vec<u32>,
}

impl Groups {
    /// All sites of a level in groups of one length, as good as any other order.
    pub(crate) fn stretches(n_sites: usize, length: usize) -> Self {
        Self {
            sites: (0..n_sites as u32).collect(),
            ends: (0..n_sites)
                .step_by(length)
                .map(|first| (first + length).min(n_sites) as u32)
                .collect(),
        }
    }

    /// Every site in a group of its own.
    pub(crate) fn one_by_one(sites: Vec<u32>) -> Self {
        Self {
            ends: (1..=sites.len() as u32).collect(),
            sites,
        }
    }

    /// The sites of `order` by the number of their group, from 0 on without gaps; each group in the order of the sweep.
    ///
    /// `group_of` holds a number for each place of `order`.
    pub(crate) fn by_number(order: &[u32], group_of: &[u32]) -> Self {
        let n_groups = group_of.iter().max().map_or(0, |&last| last as usize + 1);
        let mut ends = vec![0_u32; n_groups];
        for &group in group_of {
            ends[group as usize] += 1;
        }
        let mut first = 0;
        for end in &mut ends {
            (*end, first) = (first, first + *end);
        }
        let mut sites = vec![0; order.len()];
        for (&site, &group) in order.iter().zip(group_of) {
            let at = &mut ends[group as usize];
            sites[*at as usize] = site;
            *at += 1;
        }
        Self { sites, ends }
    }

    /// Groups of sites in space, where each reads sites that are nearer than `reach`.
    pub(crate) fn in_space(order: &[u32], positions: &[DVec3], reach: f64, spacing: f64) -> Self {
        let cells = Cells::new(positions, CELL * spacing, reach);
        // The number of the next free group of each cell.
        let mut free = vec![0_u32; cells.n_cells()];
        let group_of: Vec<u32> = order
            .iter()
            .map(|&site| {
                let cell = cells.of_site[site as usize] as usize;
                let near = cells.near(cell).iter();
                let group = near.map(|&near| free[near as usize]).max().unwrap_or(0);
                free[cell] = group + 1;
                group
            })
            .collect();
        Self::by_number(order, &group_of)
    }

    /// The groups, one after the other.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let mut first = 0;
        self.ends.iter().map(move |&end| {
            let group = &self.sites[first..end as usize];
            first = end as usize;
            group
        })
    }
}

/// Cells of a cubic grid that hold sites, and which of them are near each other.
struct Cells {
    of_site: Vec<u32>,
    offsets: Vec<u32>,
    near: Vec<u32>,
}

impl Cells {
    fn new(positions: &[DVec3], side: f64, reach: f64) -> Self {
        let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let cell_of = |position: &DVec3| {
            ((*position - low) / side)
                .to_array()
                .map(|part| part.min(f64::from(i32::MAX / 2)) as i32)
        };
        let mut cells: Vec<[i32; 3]> = positions.iter().map(cell_of).collect();
        cells.sort_unstable();
        cells.dedup();
        let number = |cell: [i32; 3]| cells.partition_point(|other| *other < cell) as u32;
        let of_site = positions.iter().map(|at| number(cell_of(at))).collect();
        let steps = (reach / side).ceil() as i32;
        let (mut offsets, mut near) = (vec![0], Vec::new());
        for &[x, y, z] in &cells {
            for dx in -steps..=steps {
                for dy in -steps..=steps {
                    let first = number([x + dx, y + dy, z - steps]) as usize;
                    let column = cells[first..].iter().zip(first as u32..);
                    near.extend(
                        column
                            .take_while(|([cx, cy, cz], _)| {
                                [*cx, *cy] == [x + dx, y + dy] && *cz <= z + steps
                            })
                            .filter(|([_, _, cz], _)| gap([dx, dy, cz - z], side) < reach)
                            .map(|(_, number)| number),
                    );
                }
            }
            offsets.push(near.len() as u32);
        }
        Self {
            of_site,
            offsets,
            near,
        }
    }

    fn n_cells(&self) -> usize {
        self.offsets.len() - 1
    }

    fn near(&self, cell: usize) -> &[u32] {
        &self.near[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }
}

/// The least distance between two cells that are this many cells apart.
fn gap(steps: [i32; 3], side: f64) -> f64 {
    let [x, y, z] = steps.map(|step| f64::from((step.abs() - 1).max(0)) * side);
    (x * x + y * y + z * z).sqrt()
}
