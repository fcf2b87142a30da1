//! Conformal scales: local texture scales for which features that run along the field neither begin nor end.
//!
//! Where directions diverge, rows of features of constant size leave gaps, and where they converge, some rows must end.
//! This does not happen if features grow as directions diverge. Let u be the logarithm of the size. Direction and size
//! are the derivative of a conformal map to the exemplar if u grows across the field at the rate at which the field
//! rotates. The derivative of u along P is minus the rate at which O rotates toward P along O. The derivative of u
//! along O is the rate at which O rotates toward P along P.
//!
//! For most fields no size satisfies this everywhere, so a least-squares solution is computed. It minimizes
//! `Σ w_ij (u_j - u_i - g_ij)²` over the edges of the coarsest level, where `g_ij` is the mean of the differences that
//! the two ends predict. Near a singularity, u is unbounded. In each connected component a constant is therefore added
//! to u that brings as many sites as possible within the bounds, and u is clamped to them.
//!
//! Reference: our own, after the correction of curl of Nicolas Ray, Wan Chiu Li, Bruno Lévy, Alla Sheffer, Pierre
//! Alliez, "Periodic Global Parameterization", ACM Transactions on Graphics 25 (4), 2006,
//! <https://doi.org/10.1145/1183287.1183297>.

use super::Orientation;
use crate::links::{Links, components};
use crate::mesh_domain::turn_rates;
use crate::solve::{System, conjugate_gradients};
use crate::{Hierarchy, SiteIdx, SynthError, columns};
use glam::DVec3;

/// Maximum number of solver steps. It bounds the time if the coarsest level is large.
const STEPS_MAX: usize = 500;

/// Solver tolerance, relative to the size. The solver stops when another averaging step would change no size by more.
const TOLERANCE: f64 = 1e-3;

impl Orientation {
    /// Computes a scale for every site. `bounds` are the lower and upper bound of the scales, both above 0.
    pub(crate) fn conformal_scales(
        &self,
        hierarchy: &Hierarchy,
        bounds: [f32; 2],
    ) -> Result<Vec<f32>, SynthError> {
        if bounds[0] == bounds[1] {
            return Ok(vec![bounds[0]; hierarchy.sites().len()]);
        }
        let coarsest = hierarchy.levels().len() - 1;
        // Solve on the coarsest level, and shift each component into the bounds.
        let mut logs = self.growth(hierarchy, coarsest);
        let [least, most] = bounds.map(|bound| libm::log(bound.into()));
        let components = components(hierarchy.levels()[coarsest].graph());
        let shifts = shifts(&components, &logs, [least, most]);
        for (log, &component) in logs.iter_mut().zip(&components) {
            *log = (*log + shifts[component as usize]).clamp(least, most);
        }
        // Interpolate down to the finest level.
        for level in (1..=coarsest).rev() {
            logs = hierarchy.upsample(level, &logs)?;
        }
        let size = |log| (libm::exp(log) as f32).clamp(bounds[0], bounds[1]);
        Ok(logs.into_iter().map(size).collect())
    }

    /// Returns the logarithm of the conformal factor at the sites of `level`. In each connected component it is
    /// determined up to a constant.
    fn growth(&self, hierarchy: &Hierarchy, level: usize) -> Vec<f64> {
        let system = Growth::new(hierarchy, self, level);
        let mut logs = vec![0.0; system.links.len()];
        conjugate_gradients(&system, &mut logs, STEPS_MAX);
        logs
    }
}

/// Returns, for each component, the offset that brings the maximum number of its values between `least` and `most`.
fn shifts(components: &[u32], values: &[f64], [least, most]: [f64; 2]) -> Vec<f64> {
    let n_components = components.iter().max().map_or(0, |&last| last as usize + 1);
    let mut of_components = vec![Vec::new(); n_components];
    for (&component, &value) in components.iter().zip(values) {
        of_components[component as usize].push(value);
    }
    let shift = |mut values: Vec<f64>| {
        values.sort_unstable_by(f64::total_cmp);
        // Find the longest run of sorted values that fits within the bounds, and center it.
        let (mut longest, mut middle, mut end) = (0, 0.0, 0);
        for (start, &first) in values.iter().enumerate() {
            while end < values.len() && values[end] - first <= most - least {
                end += 1;
            }
            if end - start > longest {
                (longest, middle) = (end - start, 0.5 * (first + values[end - 1]));
            }
        }
        0.5 * (least + most) - middle
    };
    of_components.into_iter().map(shift).collect()
}

/// Linear system of the least-squares problem. At the solution, every value is the weighted average of the values that
/// its neighbors predict.
struct Growth<'a> {
    links: Links<'a>,
    /// For each link, the wanted difference: the value at the far end minus the value at the near end.
    steps: Vec<f64>,
}

impl<'a> Growth<'a> {
    fn new(hierarchy: &'a Hierarchy, orientation: &Orientation, level: usize) -> Self {
        let links = Links::new(hierarchy, level);
        let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
        // Gradient of u at each site, from the rates at which the field rotates.
        let gradients: Vec<DVec3> = columns::column(links.len(), |site| {
            let rates = turn_rates(hierarchy, orientation, SiteIdx(site as u32), level);
            let [along_right, along_down] = rates.unwrap_or_default();
            let down = orientation.vectors()[site];
            down * along_right - normals[site].cross(down) * along_down
        });
        let step = |site: usize, other: usize| {
            0.5 * (gradients[site] + gradients[other]).dot(positions[other] - positions[site])
        };
        let steps = (0..links.len()).flat_map(|site| {
            let others = links.neighbors(site).iter();
            others.map(move |other| step(site, other.index()))
        });
        Self {
            steps: steps.collect(),
            links,
        }
    }
}

impl System<f64> for Growth<'_> {
    #[inline]
    fn row(&self, column: &[f64], row: usize) -> f64 {
        let others = self.links.neighbors(row).iter();
        let others = others.zip(self.links.weights(row));
        others
            .map(|(other, weight)| weight * (column[row] - column[other.index()]))
            .sum()
    }

    fn right(&self, row: usize) -> f64 {
        // Where the sum of squares is least, Σ w_ij (u_i - u_j) = -Σ w_ij g_ij at each site i.
        let steps = self.steps[self.links.row(row)].iter();
        let steps = steps.zip(self.links.weights(row));
        -steps.map(|(step, weight)| weight * step).sum::<f64>()
    }

    fn diagonal(&self, row: usize) -> f64 {
        self.links.sums()[row]
    }

    fn is_near(&self, _value: f64, change: f64) -> bool {
        change.abs() <= TOLERANCE
    }
}

#[cfg(test)]
mod tests;
