//! How large the texture is from place to place, so that what runs along the field need neither begin nor end.
//!
//! Where directions spread, rows of features of one size leave room for more, and where they meet, some have to end. Not so
//! where features grow as directions spread: a direction and a size at every place are the derivative of a conformal map to the
//! exemplar if the logarithm u of the size grows across the field by as much as that turns. Its derivative along P is minus the
//! rate at which O turns toward P along O, and that along O is the rate along P.
//!
//! Most fields ask for no such size everywhere. This one comes nearest: of all u it has the least sum
//! `Σ w_ij (u_j - u_i - g_ij)²` over the edges of the coarsest level, where `g_ij` is what its ends ask for on the average.
//! Around a singularity it falls or rises without end. So in each connected part all of u is moved until as many sites as can be
//! lie within the bounds, and ends there.
//!
//! Reference: our own, after the correction of curl of Nicolas Ray, Wan Chiu Li, Bruno Lévy, Alla Sheffer, Pierre Alliez,
//! "Periodic Global Parameterization", ACM Transactions on Graphics 25 (4), 2006, <https://doi.org/10.1145/1183287.1183297>.

use super::Orientation;
use crate::links::{Links, components};
use crate::mesh_ground::turn_rates;
use crate::solve::{System, conjugate_gradients};
use crate::{Hierarchy, SiteIdx, SynthError, columns};
use glam::DVec3;

/// The most steps, which bounds the time that a large coarsest level takes.
const STEPS_MAX: usize = 500;

/// Averaging once more would change no size by more than this part of it.
const TOLERANCE: f64 = 1e-3;

impl Orientation {
    /// A size for every site within bounds, the lower one first, both above 0.
    pub(crate) fn conformal_scales(
        &self,
        hierarchy: &Hierarchy,
        bounds: [f32; 2],
    ) -> Result<Vec<f32>, SynthError> {
        if bounds[0] == bounds[1] {
            return Ok(vec![bounds[0]; hierarchy.sites().len()]);
        }
        let coarsest = hierarchy.levels().len() - 1;
        let mut logs = self.growth(hierarchy, coarsest);
        let [least, most] = bounds.map(|bound| libm::log(bound.into()));
        let components = components(hierarchy.levels()[coarsest].graph());
        let shifts = shifts(&components, &logs, [least, most]);
        for (log, &component) in logs.iter_mut().zip(&components) {
            *log = (*log + shifts[component as usize]).clamp(least, most);
        }
        for level in (1..=coarsest).rev() {
            logs = hierarchy.upsample(level, &logs)?;
        }
        let size = |log| (libm::exp(log) as f32).clamp(bounds[0], bounds[1]);
        Ok(logs.into_iter().map(size).collect())
    }

    /// The logarithm of the conformal factor at the sites of a level; in each connected component plus some constant.
    fn growth(&self, hierarchy: &Hierarchy, level: usize) -> Vec<f64> {
        let system = Growth::new(hierarchy, self, level);
        let mut logs = vec![0.0; system.links.len()];
        conjugate_gradients(&system, &mut logs, STEPS_MAX);
        logs
    }
}

/// What is to be added to the values of each component, so that as many as can be lie within bounds.
fn shifts(components: &[u32], values: &[f64], [least, most]: [f64; 2]) -> Vec<f64> {
    let n_components = components.iter().max().map_or(0, |&last| last as usize + 1);
    let mut of_components = vec![Vec::new(); n_components];
    for (&component, &value) in components.iter().zip(values) {
        of_components[component as usize].push(value);
    }
    let shift = |mut values: Vec<f64>| {
        values.sort_unstable_by(f64::total_cmp);
        // Of the runs of sorted values that fit within the bounds, the longest.
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

/// Every value is the average of what its neighbors ask for.
struct Growth<'a> {
    links: Links<'a>,
    /// For each link how much larger the value at its far end is to be.
    steps: Vec<f64>,
}

impl<'a> Growth<'a> {
    fn new(hierarchy: &'a Hierarchy, orientation: &Orientation, level: usize) -> Self {
        let links = Links::new(hierarchy, level);
        let (positions, normals) = (hierarchy.sites().positions(), hierarchy.sites().normals());
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
