//! The oracle: equations 1 to 4 by their definitions, in double precision, over all control points and many images of
//! each.

use super::sets::{Case, cases, positions};
use dapple_graph::Axis;
use dapple_pups::{AxialWeight, PupsOptions};
use dapple_raster::FieldExt as _;
use glam::{DVec2, DVec3};

/// Returns the nonzero weights at a position, of all images of all control points, each with the index of its point.
pub(super) fn weights(case: &Case, position: DVec2) -> Vec<(usize, f64)> {
    let domain = case.points.domain();
    let position = domain.wrap(position);
    let reach = |axis: usize| if domain.wrap[axis] { 5 } else { 0 };
    let mut weights = Vec::new();
    for (point, center) in case.points.iter() {
        let exponents = exponents(case.graph.axes(point), case.options.fade);
        for row in -reach(1)..=reach(1) {
            for column in -reach(0)..=reach(0) {
                let center = center + domain.size * DVec2::new(f64::from(column), f64::from(row));
                let mut weight = 1.0;
                for (axis, exponent) in case.graph.axes(point).iter().zip(&exponents) {
                    let along = (position - center).dot(axis.vector) / axis.vector.length();
                    let length = axis.vector.length() * case.options.axis_scale;
                    let full = axial_weight(case.options.weight, (along / length).clamp(0.0, 1.0));
                    weight *= libm::pow(full, *exponent);
                }
                weight = shifted(&case.options, point.index(), weight, position - center);
                if weight > 0.0 {
                    weights.push((point.index(), weight));
                }
            }
        }
    }
    weights
}

/// Returns the exponents of a point's axes, `min(1, border / (fade · edge))`. The border of an axis is a very long
/// segment, clipped by all other axes at half their length.
fn exponents(axes: &[Axis], fade: f64) -> Vec<f64> {
    let border = |axis: &Axis| {
        let (middle, along) = (axis.vector * 0.5, axis.vector.perp().normalize());
        let mut ends = [-1e9, 1e9];
        for cut in axes.iter().filter(|&cut| cut != axis) {
            let rate = cut.vector.dot(along);
            let at = (0.5 * cut.vector.length_squared() - middle.dot(cut.vector)) / rate;
            if rate > 0.0 {
                ends[1] = at.min(ends[1]);
            } else if rate < 0.0 {
                ends[0] = at.max(ends[0]);
            } else if middle.dot(cut.vector) > 0.5 * cut.vector.length_squared() {
                return 0.0;
            }
        }
        (ends[1] - ends[0]).max(0.0)
    };
    let exponent = |axis: &Axis| {
        if fade == 0.0 {
            1.0
        } else {
            (border(axis) / (fade * axis.vector.length())).min(1.0)
        }
    };
    axes.iter().map(exponent).collect()
}

/// Returns the value of the texture by equation 3.
pub(super) fn texture(case: &Case, position: DVec2) -> f64 {
    let values = case.values();
    let weights = weights(case, position);
    let sum: f64 = weights
        .iter()
        .map(|&(point, weight)| f64::from(values[point]) * weight)
        .sum();
    let total: f64 = weights.iter().map(|&(_, weight)| weight).sum();
    sum / total
}

/// Returns the axial weight at the projection `p`, by equation 1 or its alternatives.
fn axial_weight(weight: AxialWeight, p: f64) -> f64 {
    let cubic = (1.0 - p) * (1.0 - p) * (1.0 + 2.0 * p);
    match weight {
        AxialWeight::Cubic => cubic,
        AxialWeight::Quintic => libm::pow(1.0 - p, 3.0) * (1.0 + 3.0 * p + 6.0 * p * p),
        AxialWeight::Oscillating { dips, depth } => {
            let swing = libm::cos(f64::from(dips) * libm::acos(1.0 - 2.0 * p));
            cubic * (1.0 - f64::from(depth) * libm::pow(1.0 - swing * swing, 2.0))
        }
        other => panic!("the oracle does not know {other:?}"),
    }
}

/// Returns a weight shifted by the point's orientation, by equation 4.
fn shifted(options: &PupsOptions, point: usize, weight: f64, offset: DVec2) -> f64 {
    let Some(orientation) = &options.orientation else {
        return weight;
    };
    if offset == DVec2::ZERO || weight == 0.0 {
        return weight;
    }
    let vector: DVec3 = orientation.vectors[point].normalize();
    let k = orientation.strength * offset.dot(vector.truncate()) / offset.length();
    if k >= 0.0 {
        libm::pow(weight, 1.0 - k)
    } else {
        libm::pow(weight, 1.0 / (1.0 + k))
    }
}

/// Returns the maximum error of a mean of values in `[0, 1]`, or of a weight.
///
/// Offsets, projections and weights have a few roundings of 6e-8 each, and powers have a relative error of about 4e-6.
/// Where supports barely overlap, weights are squares of small numbers, whose relative errors increase as the numbers
/// decrease.
fn tolerance(case: &Case) -> f64 {
    let power = if case.options.orientation.is_some() {
        1e-5
    } else {
        0.0
    };
    power
        + if case.options.axis_scale < 1.0 {
            1e-4
        } else {
            4e-6
        }
}

#[test]
fn textures_equal_the_equations() {
    for case in cases() {
        let texture = case.texture();
        for position in positions(case.points.domain(), 300) {
            let exact = self::texture(&case, position);
            let off = (f64::from(texture.sample(position)) - exact).abs();
            let tolerance = tolerance(&case);
            assert!(off < tolerance, "{}: off by {off} at {position}", case.name);
        }
    }
}

#[test]
fn the_strongest_point_has_the_largest_weight() {
    for case in cases() {
        let pups = case.pups();
        for position in positions(case.points.domain(), 100) {
            let strongest = pups.strongest(position).unwrap().index();
            let weights = weights(&case, position);
            let largest = weights
                .iter()
                .map(|&(_, weight)| weight)
                .fold(0.0, f64::max);
            let own = weights.iter().filter(|&&(point, _)| point == strongest);
            let own = own.map(|&(_, weight)| weight).fold(0.0, f64::max);
            // Rounding may turn a tie.
            assert!(
                own >= largest * (1.0 - 1e-4),
                "{}: {own} against {largest} at {position}",
                case.name
            );
        }
    }
}

#[test]
fn weights_are_those_of_the_equations() {
    for case in cases() {
        let pups = case.pups();
        for position in positions(case.points.domain(), 60) {
            let exact = weights(&case, position);
            let total: f64 = exact.iter().map(|&(_, weight)| weight).sum();
            let mut sums = vec![0.0; case.points.len()];
            exact
                .iter()
                .for_each(|&(point, weight)| sums[point] += weight / total);
            pups.weights(position)
                .iter()
                .for_each(|&(point, weight)| sums[point.index()] -= f64::from(weight));
            let off = sums.iter().map(|off| off.abs()).fold(0.0, f64::max);
            let tolerance = tolerance(&case);
            assert!(off < tolerance, "{}: off by {off} at {position}", case.name);

            for (point, _) in case.points.iter() {
                let own = exact.iter().filter(|&&(index, _)| index == point.index());
                let largest = own.map(|&(_, weight)| weight).fold(0.0, f64::max);
                let off = (f64::from(pups.weight(point, position)) - largest).abs();
                let name = &case.name;
                assert!(
                    off < tolerance,
                    "{name}: {point:?} off by {off} at {position}"
                );
            }
        }
    }
}
