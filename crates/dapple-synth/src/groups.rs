//! Sites in groups that can be visited at the same time.
//!
//! A site waits for all earlier sites of the sweep that it may read, and all later ones wait for it; what is left over is free.
//! So the groups give, one after the other, the same bits as the sites in the order of the sweep.

use crate::cells::Cells;

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

    /// Groups of sites that wait for those of the same and of nearby cells.
    pub(crate) fn by_cells(order: &[u32], cells: &Cells) -> Self {
        // The number of the next free group of each cell.
        let mut free = vec![0_u32; cells.n_cells()];
        let group_of: Vec<u32> = order
            .iter()
            .map(|&site| {
                let cell = cells.of_site(site);
                let near = cells
                    .near(cell)
                    .iter()
                    .flat_map(|near| &free[near.start as usize..near.end as usize]);
                let group = near.copied().max().unwrap_or(0);
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
