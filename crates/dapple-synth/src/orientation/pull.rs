//! Pull: assigns the user's directions to sites, and downsamples them to the coarsest level.

use super::{flat_part, tangent};
use crate::links::LEAST_LENGTH;
use crate::{Direction, Hierarchy, Level, SiteIdx, Symmetry, SynthError, SynthErrorKind, columns};
use glam::DVec3;

/// Number of low-pass steps before a level is downsampled. Together they have the variance of the filter 1-4-6-4-1 of
/// image pyramids.
const BLUR_STEPS: usize = 20;
/// Strength t of a low-pass step (equation 3).
const BLUR_STRENGTH: f64 = 0.1;
/// Extent of the blur around a known site, in edges. Less than 1e-7 of the weight would spread farther.
const BLUR_RINGS: usize = 8;
/// Minimum weight of a known site. After the blur, a coarse site within its spacing of a direction has a weight of at
/// least 0.05.
const LEAST_WEIGHT: f64 = 0.01;
/// Factor on the weights when a level is downsampled. The coarser level has a quarter of the sites, so the sum of
/// weights stays the same.
const THINNING: f64 = 4.0;
/// Minimum length of a sum of directions, relative to the sum of their weights. Shorter sums count as canceled.
const LEAST_PART: f64 = 1e-3;

/// Radius of the grid search for the site nearest to a direction, in multiples of the site spacing.
const SEARCH_RADIUS: f64 = 4.0;

/// Known direction of a site: the mean of the directions given there, and its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known {
    pub(super) site: usize,
    /// Direction, as a unit tangent vector.
    pub(super) vector: DVec3,
    /// Weight, from 0 to 1; 1 where a direction was given.
    pub(super) weight: f64,
}

/// Assigns directions to the nearest sites of the finest level. Returns one known direction per such site, in ascending
/// order of the site.
pub(super) fn known(
    hierarchy: &Hierarchy,
    directions: &[Direction],
    symmetry: Symmetry,
) -> Result<Vec<Known>, SynthError> {
    let sites = hierarchy.sites();
    let mut given: Vec<(usize, DVec3)> = Vec::with_capacity(directions.len());
    for (number, direction) in directions.iter().enumerate() {
        let refused = SynthError::new(SynthErrorKind::Direction { direction: number });
        if !direction.at.is_finite() {
            return Err(refused);
        }
        let Some(site) = nearest_site(hierarchy, 0, direction.at) else {
            continue;
        };
        let Some(vector) = tangent(direction.vector, sites.normals()[site]) else {
            return Err(refused);
        };
        given.push((site, vector));
    }
    Ok(means(given, sites.normals(), symmetry))
}

/// Averages the directions at each site, in ascending order of the site. Sites whose directions cancel are dropped.
fn means(mut given: Vec<(usize, DVec3)>, normals: &[DVec3], symmetry: Symmetry) -> Vec<Known> {
    // Stable sort: the directions at each site are added in the caller's order.
    given.sort_by_key(|&(site, _)| site);
    let mean = |group: &[(usize, DVec3)]| {
        let (site, first) = group[0];
        // Rotate equivalent directions toward the first one before adding them.
        let turns = group
            .iter()
            .map(|&(_, vector)| symmetry.nearest(vector, normals[site], first));
        summed(site, turns.sum(), group.len() as f64)
    };
    given.chunk_by(|a, b| a.0 == b.0).filter_map(mean).collect()
}

/// Downsamples known directions repeatedly. Returns the known directions of every level, finest first.
pub(super) fn pull(hierarchy: &Hierarchy, finest: Vec<Known>) -> Vec<Vec<Known>> {
    let mut levels = vec![finest];
    for pair in hierarchy.levels().windows(2) {
        let coarser = down(hierarchy, [&pair[0], &pair[1]], &levels[levels.len() - 1]);
        levels.push(coarser);
    }
    levels
}

/// Returns the known directions on every level, finest first, for a field with a symmetry. On a coarser level each
/// direction moves to the nearest site and retains its full weight, since directions that are known only up to a
/// rotation cannot be blurred.
pub(super) fn pull_nearest(
    hierarchy: &Hierarchy,
    finest: Vec<Known>,
    symmetry: Symmetry,
) -> Vec<Vec<Known>> {
    let sites = hierarchy.sites();
    let mut levels = vec![finest];
    for level in 1..hierarchy.levels().len() {
        let mut given = Vec::new();
        for known in &levels[0] {
            let near = nearest_site(hierarchy, level, sites.positions()[known.site]);
            let there =
                near.and_then(|site| Some((site, tangent(known.vector, sites.normals()[site])?)));
            given.extend(there);
        }
        levels.push(means(given, sites.normals(), symmetry));
    }
    levels
}

/// Returns the known direction of `site` from the sum of vectors there and the sum of their weights. `None` if the
/// vectors cancel.
fn summed(site: usize, sum: DVec3, weight: f64) -> Option<Known> {
    let length = sum.length();
    (length > LEAST_PART * weight).then(|| Known {
        site,
        vector: sum / length,
        weight: weight.min(1.0),
    })
}

/// Downsamples the known directions of a level: blurs them, and retains the results at sites of the coarser level.
fn down(hierarchy: &Hierarchy, [finer, coarser]: [&Level; 2], known: &[Known]) -> Vec<Known> {
    let near = BlurSubgraph::new(hierarchy, finer, known);
    let mut kept: Vec<Known> = Vec::new();
    for (&site, (vector, weight)) in near.sites.iter().zip(near.blur(known)) {
        let weight = weight * THINNING;
        // Retain the sites of the coarser level, which come first, if enough weight has reached them.
        if site < coarser.n_sites() && weight >= LEAST_WEIGHT {
            let vector = flat_part(vector, hierarchy.sites().normals()[site]);
            kept.extend(summed(site, vector * THINNING, weight));
        }
    }
    kept.sort_by_key(|known| known.site);
    kept
}

/// Subgraph of the sites around the known sites, which is the part of a level that the blur changes.
struct BlurSubgraph {
    /// Indices of the sites; known sites come first.
    sites: Vec<usize>,
    /// For each site, its neighbors as indices in `sites`, with normalized weights.
    edges: Vec<Vec<(usize, f64)>>,
}

impl BlurSubgraph {
    fn new(hierarchy: &Hierarchy, level: &Level, known: &[Known]) -> Self {
        const NONE: usize = usize::MAX;
        let graph = level.graph();
        let mut places = vec![NONE; level.n_sites()];
        let mut sites: Vec<usize> = known.iter().map(|known| known.site).collect();
        for (place, &site) in sites.iter().enumerate() {
            places[site] = place;
        }
        let mut ring = 0;
        // Add rings of neighbors breadth first.
        for _ in 0..BLUR_RINGS {
            let end = sites.len();
            for at in ring..end {
                for other in graph.neighbors(SiteIdx(sites[at] as u32)) {
                    if places[other.index()] == NONE {
                        places[other.index()] = sites.len();
                        sites.push(other.index());
                    }
                }
            }
            ring = end;
        }
        let positions = hierarchy.sites().positions();
        let least = LEAST_LENGTH * level.spacing();
        let edges = sites.iter().map(|&site| {
            let neighbors = graph.neighbors(SiteIdx(site as u32));
            let weigh = |other: &SiteIdx| {
                1.0 / positions[site]
                    .distance(positions[other.index()])
                    .max(least)
            };
            let sum: f64 = neighbors.iter().map(weigh).sum();
            // Sites outside of the subgraph contribute nothing, but their weights count in the normalization.
            let place = |other: &SiteIdx| (places[other.index()], weigh(other) / sum);
            neighbors
                .iter()
                .map(place)
                .filter(|&(place, _)| place != NONE)
                .collect()
        });
        Self {
            edges: edges.collect(),
            sites,
        }
    }

    /// Blurs the known directions by all steps of equation 3. Returns the weighted sum of vectors and the sum of
    /// weights at each site.
    fn blur(&self, known: &[Known]) -> Vec<(DVec3, f64)> {
        let mut values: Vec<(DVec3, f64)> = known
            .iter()
            .map(|known| (known.vector * known.weight, known.weight))
            .collect();
        values.resize(self.sites.len(), (DVec3::ZERO, 0.0));
        for _ in 0..BLUR_STEPS {
            values = columns::column(values.len(), |at| step(&values, at, &self.edges[at]));
        }
        values
    }
}

/// Computes one step of equation 3 for a single site.
fn step(values: &[(DVec3, f64)], at: usize, edges: &[(usize, f64)]) -> (DVec3, f64) {
    if edges.is_empty() {
        return values[at];
    }
    let (mut vector, mut weight) = (DVec3::ZERO, 0.0);
    for &(place, part) in edges {
        vector += values[place].0 * part;
        weight += values[place].1 * part;
    }
    // Equation 3 with weights that sum to 1: v + t Σ wᵢ (vᵢ - v) = (1 - t) v + t Σ wᵢ vᵢ.
    let kept = 1.0 - BLUR_STRENGTH;
    (
        values[at].0 * kept + vector * BLUR_STRENGTH,
        values[at].1 * kept + weight * BLUR_STRENGTH,
    )
}

/// Returns the site of `level` nearest to the position `at`; ties go to the lowest index. `None` only if there are no
/// sites.
fn nearest_site(hierarchy: &Hierarchy, level: usize, at: DVec3) -> Option<usize> {
    let level = hierarchy.levels().get(level)?;
    let positions = &hierarchy.sites().positions()[..level.n_sites()];
    let mut nearest = (f64::INFINITY, u32::MAX);
    let mut visit = |site: SiteIdx| {
        let found = (positions[site.index()].distance(at), site.0);
        if found < nearest {
            nearest = found;
        }
    };
    // If the ball has a site, all sites outside of it are farther away.
    let radius = SEARCH_RADIUS * level.spacing();
    level.grid().visit(at, radius, &mut visit);
    if nearest.0 > radius {
        // The position is far from the surface: search all sites.
        nearest = (f64::INFINITY, u32::MAX);
        for (site, position) in (0..).zip(positions) {
            let found = (position.distance(at), site);
            if found < nearest {
                nearest = found;
            }
        }
    }
    (nearest.1 != u32::MAX).then_some(nearest.1 as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::links::Links;
    use crate::shapes::{sites_on, sphere};

    #[test]
    fn down_is_the_low_pass_of_the_whole_level() {
        let hierarchy = sites_on(sphere(), 1200, 2);
        let [finer, coarser] = [&hierarchy.levels()[0], &hierarchy.levels()[1]];
        let normals = hierarchy.sites().normals();
        let known = [17, 800].map(|site| Known {
            site,
            vector: tangent(DVec3::new(1.0, 0.5, 0.2), normals[site]).unwrap(),
            weight: 1.0,
        });
        // Oracle: equation 3 on every site.
        let links = Links::new(&hierarchy, 0);
        let mut weights = vec![0.0; finer.n_sites()];
        let mut vectors = vec![DVec3::ZERO; finer.n_sites()];
        for known in known {
            (weights[known.site], vectors[known.site]) = (1.0, known.vector);
        }
        for _ in 0..BLUR_STEPS {
            let before = (weights.clone(), vectors.clone());
            for site in (0..finer.n_sites()).filter(|&site| links.sums()[site] > 0.0) {
                let (mut weight, mut vector) = (0.0, DVec3::ZERO);
                for (other, part) in links.neighbors(site).iter().zip(links.weights(site)) {
                    let part = part / links.sums()[site];
                    weight += (before.0[other.index()] - before.0[site]) * part;
                    vector += (before.1[other.index()] - before.1[site]) * part;
                }
                weights[site] += BLUR_STRENGTH * weight;
                vectors[site] += BLUR_STRENGTH * vector;
            }
        }
        let found = down(&hierarchy, [finer, coarser], &known);
        let kept = |site: &usize| weights[*site] * THINNING >= LEAST_WEIGHT;
        let wanted: Vec<usize> = (0..coarser.n_sites()).filter(kept).collect();
        assert!(wanted.len() > 2, "the blur reaches some coarse sites");
        assert_eq!(
            found.iter().map(|known| known.site).collect::<Vec<_>>(),
            wanted
        );
        for known in found {
            // The difference is the weight that is cut off beyond the eighth ring.
            let off = known.weight - (weights[known.site] * THINNING).min(1.0);
            assert!(off.abs() < 1e-6, "site {}: weight off by {off}", known.site);
            let vector = tangent(vectors[known.site], normals[known.site]).unwrap();
            assert!(
                known.vector.distance(vector) < 1e-4,
                "site {}: {vector}",
                known.site
            );
        }
    }

    #[test]
    fn nearest_site_is_that_of_a_search_through_all() {
        let hierarchy = sites_on(sphere(), 500, 1);
        let positions = hierarchy.sites().positions();
        for i in 0..200 {
            let part = f64::from(i % 20) * 0.15;
            let at = DVec3::new(
                f64::from(i % 7) - 3.0,
                f64::from(i % 5) - 2.0,
                f64::from(i % 3) - 1.0,
            ) * part;
            let distance = |site: &usize| (positions[*site].distance(at), *site);
            let wanted = (0..500).min_by(|a, b| distance(a).partial_cmp(&distance(b)).unwrap());
            assert_eq!(nearest_site(&hierarchy, 0, at), wanted, "{at}");
        }
        assert!(
            nearest_site(&hierarchy, 0, DVec3::splat(1e200)).is_some(),
            "however far"
        );
    }
}
