//! Low-pass filter for columns of values at sites (equations 2 to 4).
//!
//! Reference: Greg Turk, "Texture Synthesis on Surfaces", SIGGRAPH 2001, doi 10.1145/383259.383297, section 3.2. The
//! smoothing is from Gabriel Taubin, "A Signal Processing Approach to Fair Surface Design", SIGGRAPH 1995, doi
//! 10.1145/218380.218473. Each step moves the value of a site by a fraction t toward the weighted mean of its
//! neighbors. The weights are the inverse lengths of the edges, divided by their sum:
//!
//! `C' = C + t Σ wᵢ (Cᵢ - C)`
//!
//! All sites move at once, from the values before the step (Jacobi iteration). Differences are summed in the order of
//! the neighbors, so that a constant column does not change in a single bit. On evenly spaced sites a step adds
//! `t r² / 2` to the variance of a spot along each axis, with r the spacing.

use crate::{Blend, SiteGraph, SiteIdx, SynthError, SynthErrorKind};
use dapple_raster::parallel;
use glam::DVec3;

/// Number of sites in one parallel task.
const CHUNK: usize = 2048;

/// A low-pass filter for columns of values at the sites of a graph.
///
/// The weights are computed once and reused for any number of columns. A site without neighbors keeps its value.
///
/// # Examples
///
/// ```
/// use dapple_mesh::glam::DVec3;
/// use dapple_synth::{LowPass, SiteGraph, SiteIdx};
///
/// let path = SiteGraph::from_edges(3, [[SiteIdx(0), SiteIdx(1)], [SiteIdx(1), SiteIdx(2)]]);
/// let positions = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
/// let mut column = [0.0, 1.0, 0.0];
/// LowPass::new(&path, &positions)?.apply(&mut column, 0.5, 1)?;
/// assert_eq!(column, [0.5, 0.5, 0.5]);
/// # Ok::<(), dapple_synth::SynthError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LowPass<'a> {
    graph: &'a SiteGraph,
    /// Weights of the neighbors of all sites, in the order of the graph's rows.
    weights: Vec<f64>,
}

impl<'a> LowPass<'a> {
    /// Creates the filter for a graph of sites at `positions`.
    ///
    /// Edge lengths are clamped to at least a millionth of the longest edge of the site, so that weights stay finite
    /// where sites coincide.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless `positions` has one position for each site.
    pub fn new(graph: &'a SiteGraph, positions: &[DVec3]) -> Result<Self, SynthError> {
        check_length("positions", positions.len(), graph.len())?;
        let chunk = |index: usize| {
            let sites = index * CHUNK..((index + 1) * CHUNK).min(graph.len());
            let mut weights = Vec::with_capacity(7 * CHUNK);
            for site in sites {
                push_weights(graph, positions, SiteIdx(site as u32), &mut weights);
            }
            weights
        };
        let weights = parallel::map(graph.len().div_ceil(CHUNK), chunk).concat();
        Ok(Self { graph, weights })
    }

    /// Returns the weights of the neighbors of `site`, in the order of the neighbors. They sum to 1 up to rounding.
    ///
    /// # Panics
    ///
    /// If the graph does not have the site.
    #[inline]
    #[must_use]
    pub fn weights(&self, site: SiteIdx) -> &[f64] {
        &self.weights[self.graph.row(site)]
    }

    /// Filters `column` in `steps` steps of strength `t`, from 0 to 1 (equation 3). The paper uses a `t` of 0.1.
    ///
    /// If `t` is at most 0.99, no value leaves the range of the values of the site and its neighbors, not even by
    /// rounding.
    ///
    /// # Errors
    ///
    /// [`SynthErrorKind::Count`] unless `column` has one value for each site, and [`SynthErrorKind::Range`] if `t` is
    /// outside 0 to 1.
    pub fn apply<T: Blend>(
        &self,
        column: &mut [T],
        t: f64,
        steps: usize,
    ) -> Result<(), SynthError> {
        // Alternate between the two columns.
        let mut other = column.to_vec();
        let mut from_column = true;
        for _ in 0..steps {
            if from_column {
                self.step(column, &mut other, t)?;
            } else {
                self.step(&other, column, t)?;
            }
            from_column = !from_column;
        }
        if !from_column {
            column.copy_from_slice(&other);
        }
        Ok(())
    }

    /// Applies one step to the column `from` and writes the result to `to`, for callers that change values between
    /// steps.
    ///
    /// # Errors
    ///
    /// Same as [`apply`](Self::apply).
    pub fn step<T: Blend>(&self, from: &[T], to: &mut [T], t: f64) -> Result<(), SynthError> {
        for column in [from.len(), to.len()] {
            check_length("values", column, self.graph.len())?;
        }
        SynthError::check(
            (0.0..=1.0).contains(&t),
            "part t of a step",
            t,
            "from 0 to 1",
        )?;
        parallel::for_each_chunk(to, CHUNK, |chunk, to| {
            for (site, new) in (chunk * CHUNK..).zip(to) {
                let site = SiteIdx(site as u32);
                let row = self.graph.row(site);
                let value = from[site.index()];
                let mut change = T::ZERO;
                for (neighbor, &weight) in self.graph.neighbors(site).iter().zip(&self.weights[row])
                {
                    let difference = from[neighbor.index()].add_scaled(value, -1.0);
                    change = change.add_scaled(difference, weight);
                }
                // Equation 3: C' = C + t Σ wᵢ (Cᵢ - C)
                *new = value.add_scaled(change, t);
            }
        });
        Ok(())
    }
}

/// Returns an error if `count`, the length of a column, differs from the number of sites.
pub(crate) fn check_length(
    what: &'static str,
    count: usize,
    n_sites: usize,
) -> Result<(), SynthError> {
    let needed = "one for each site";
    if count == n_sites {
        return Ok(());
    }
    Err(SynthError::new(SynthErrorKind::Count {
        what,
        count,
        needed,
    }))
}

/// Appends the weights of the neighbors of `site` to `weights`.
fn push_weights(graph: &SiteGraph, positions: &[DVec3], site: SiteIdx, weights: &mut Vec<f64>) {
    let first = weights.len();
    let at = positions[site.index()];
    let length = |to: &SiteIdx| positions[to.index()].distance(at);
    // Store the edge lengths, replace them by clamped inverses, and normalize these to a sum of 1.
    weights.extend(graph.neighbors(site).iter().map(length));
    let longest = weights[first..].iter().copied().fold(0.0, f64::max);
    let mut sum = 0.0;
    for weight in &mut weights[first..] {
        // If all lengths are zero, the ratio is NaN, and `max` returns the other operand, 1e-6.
        *weight = 1.0 / (*weight / longest).max(1e-6);
        sum += *weight;
    }
    for weight in &mut weights[first..] {
        *weight /= sum;
    }
}

#[cfg(test)]
mod tests;
