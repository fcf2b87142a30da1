//! Items sorted by group, in compressed rows (CSR).

use core::ops::Range;

/// Items of numbered groups. The items of a group are contiguous, in ascending order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    /// Index of the first item of each group in [`items`](Self::items), followed by the number of items.
    pub starts: Vec<u32>,
    /// Items, sorted by group.
    pub items: Vec<u32>,
}

impl Groups {
    /// Sorts the items 0, 1, 2, … by group, with a stable counting sort. `groups` has the group of each item, below
    /// `n_groups`.
    #[must_use]
    pub fn sort(n_groups: usize, groups: &[u32]) -> Self {
        let mut starts = vec![0_u32; n_groups + 1];
        // Count the items of each group, then sum up the counts to the end of each group.
        for &group in groups {
            starts[group as usize] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        // Fill each group from its end, last item first: items keep their order, and each end becomes a start.
        let mut items = vec![0; groups.len()];
        for (item, &group) in groups.iter().enumerate().rev() {
            let start = &mut starts[group as usize];
            *start -= 1;
            items[*start as usize] = item as u32;
        }
        Self { starts, items }
    }

    /// Returns the range of a group in [`items`](Self::items).
    #[must_use]
    #[inline]
    pub fn range(&self, group: usize) -> Range<usize> {
        self.starts[group] as usize..self.starts[group + 1] as usize
    }

    /// Returns the items of a group.
    #[must_use]
    #[inline]
    pub fn of(&self, group: usize) -> &[u32] {
        &self.items[self.range(group)]
    }
}

#[cfg(test)]
mod tests;
