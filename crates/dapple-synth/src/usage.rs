//! How often each pixel of the exemplar was used, and what that costs it.
//!
//! Where the least distance alone decides, a few pixels are used again and again: those that are like everything a little.
//! Colors that are rare in the exemplar vanish. The remedy here is a penalty on pixels that were used, as Kaspar, Neubert,
//! Lischinski, Pauly and Kopf have it for patches ("Self Tuning Texture Optimization", Computer Graphics Forum 34, 2015).
//! Here it is one factor for each pixel: its squared distances are multiplied by 1, and by as much more as
//! [`Options::evenness`](crate::Options::evenness) says for each time that it was used.
//!
//! What is used depends on all sites before, so such a pass goes one site after the other on one thread. Only passes that
//! read no coarser level count, those of the coarsest level in the paper's schedule: the finer levels follow it.

/// The uses of the rows of a pass, and their factors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Usage {
    /// What one use adds to a factor.
    cost: f64,
    counts: Vec<u32>,
    /// At least 1 each; empty if nothing is counted.
    factors: Vec<f32>,
}

impl Usage {
    /// Nothing is used yet. `evenness` is what as many uses cost as each row has if all are used equally often.
    pub(crate) fn new(evenness: f32, n_rows: usize, n_sites: usize) -> Self {
        if evenness == 0.0 {
            return Self::default();
        }
        Self {
            cost: f64::from(evenness) * n_rows as f64 / n_sites.max(1) as f64,
            counts: vec![0; n_rows],
            factors: vec![1.0; n_rows],
        }
    }

    /// By how much the squared distances of the rows are multiplied, at least 1; none if nothing is counted.
    pub(crate) fn factors(&self) -> Option<&[f32]> {
        (!self.factors.is_empty()).then_some(&self.factors)
    }

    /// Counts rows that were used; what is no row does not count.
    pub(crate) fn add(&mut self, rows: &[u32]) {
        for &row in rows {
            let row = row as usize;
            if let Some(count) = self.counts.get_mut(row) {
                *count += 1;
                self.factors[row] = (1.0 + self.cost * f64::from(*count)) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Usage;

    #[test]
    fn factors_grow_by_the_evenness_per_mean_use() {
        // Each of 4 rows has 3 of 12 sites on the average.
        let mut usage = Usage::new(0.75, 4, 12);
        assert_eq!(usage.factors(), Some(&[1.0; 4][..]), "nothing is used");
        usage.add(&[2, 0, 2, 2, 2, u32::MAX]);
        assert_eq!(
            usage.factors(),
            Some(&[1.25, 1.0, 2.0, 1.0][..]),
            "one and four uses"
        );
    }

    #[test]
    fn nothing_is_counted_without_a_penalty() {
        let mut usage = Usage::new(0.0, 4, 12);
        usage.add(&[1, 3]);
        assert_eq!(usage.factors(), None, "no factors");
    }

    #[test]
    fn no_sites_and_no_rows_are_no_division_by_zero() {
        assert_eq!(
            Usage::new(1.0, 2, 0).factors(),
            Some(&[1.0; 2][..]),
            "no sites"
        );
        let mut usage = Usage::new(1.0, 0, 5);
        usage.add(&[0]);
        assert_eq!(usage.factors(), None, "no rows");
    }
}
