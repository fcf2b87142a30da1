//! A creature between a lizard and an alligator, built from blended cones, which replaces Richard Payne's Gator.
//!
//! It faces +x, stands on the plane y = 0 and is about 8 units long.

use dapple_models::solid::Solid;
use glam::DVec3;

/// Part of the creature that a point belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Hide,
    Tongue,
    Eye,
    Tooth,
}

/// The creature as a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Creature;

/// Position of the left eye's center.
pub(super) const EYE: DVec3 = DVec3::new(1.86, 1.50, 0.27);

/// A cone with round ends, given by the centers and radii of the ends as `[x, y, z, radius]`.
type Cone = [[f64; 4]; 2];

/// Cones along the middle of the body.
const TRUNK: [Cone; 8] = [
    [[-1.30, 0.74, 0.0, 0.50], [0.20, 0.84, 0.0, 0.58]],
    [[0.20, 0.84, 0.0, 0.56], [1.05, 0.98, 0.0, 0.44]],
    [[1.05, 0.98, 0.0, 0.44], [1.65, 1.12, 0.0, 0.40]],
    // The tail, around a bend.
    [[-1.30, 0.72, 0.0, 0.48], [-2.30, 0.52, 0.15, 0.34]],
    [[-2.30, 0.52, 0.15, 0.34], [-3.20, 0.32, 0.60, 0.23]],
    [[-3.20, 0.32, 0.60, 0.23], [-3.80, 0.20, 1.30, 0.14]],
    [[-3.80, 0.20, 1.30, 0.14], [-3.80, 0.12, 2.00, 0.08]],
    [[-3.80, 0.12, 2.00, 0.08], [-3.40, 0.08, 2.45, 0.03]],
];

/// Cones of one side of the creature, which are mirrored to the other.
const SIDES: [Cone; 18] = [
    // Snout, nostril, cheek, lower jaw, brow.
    [[1.75, 1.16, 0.15, 0.27], [2.95, 1.30, 0.11, 0.15]],
    [[2.90, 1.42, 0.10, 0.08], [2.98, 1.42, 0.10, 0.07]],
    [[1.45, 1.02, 0.22, 0.26], [1.85, 0.98, 0.24, 0.18]],
    [[1.60, 0.86, 0.17, 0.20], [2.72, 0.50, 0.10, 0.11]],
    [[1.62, 1.44, 0.22, 0.15], [1.92, 1.44, 0.24, 0.11]],
    // The front leg and its toes.
    [[0.55, 0.72, 0.42, 0.26], [0.20, 0.50, 0.98, 0.18]],
    [[0.20, 0.50, 0.98, 0.18], [0.50, 0.12, 1.20, 0.13]],
    [[0.50, 0.10, 1.20, 0.11], [0.88, 0.05, 1.02, 0.05]],
    [[0.50, 0.10, 1.20, 0.11], [0.94, 0.05, 1.24, 0.05]],
    [[0.50, 0.10, 1.20, 0.11], [0.84, 0.05, 1.46, 0.05]],
    // The hind leg and its toes.
    [[-1.30, 0.70, 0.38, 0.34], [-0.80, 0.52, 1.05, 0.22]],
    [[-0.80, 0.52, 1.05, 0.22], [-1.25, 0.14, 1.30, 0.14]],
    [[-1.25, 0.10, 1.30, 0.12], [-0.82, 0.05, 1.12, 0.05]],
    [[-1.25, 0.10, 1.30, 0.12], [-0.76, 0.05, 1.36, 0.05]],
    [[-1.25, 0.10, 1.30, 0.12], [-0.86, 0.05, 1.60, 0.05]],
    // Ridges along the back.
    [[-1.20, 1.22, 0.16, 0.06], [0.10, 1.38, 0.17, 0.07]],
    [[-2.20, 0.86, 0.20, 0.03], [-1.20, 1.22, 0.16, 0.06]],
    [[0.10, 1.38, 0.17, 0.07], [0.95, 1.38, 0.14, 0.04]],
];

/// Cones of the tongue, on both sides of its furrow.
const TONGUE: [Cone; 3] = [
    [[1.90, 0.84, 0.07, 0.11], [2.60, 0.78, 0.07, 0.09]],
    [[2.60, 0.78, 0.07, 0.09], [3.08, 0.66, 0.06, 0.08]],
    [[3.08, 0.66, 0.06, 0.08], [3.36, 0.72, 0.05, 0.06]],
];

/// First and last tooth of the upper and the lower jaw, each as a cone from root to tip.
const TEETH: [[Cone; 2]; 2] = [
    [
        [[2.00, 0.96, 0.30, 0.05], [2.01, 0.82, 0.30, 0.012]],
        [[2.98, 1.18, 0.15, 0.045], [3.00, 1.02, 0.15, 0.010]],
    ],
    [
        [[2.08, 0.80, 0.26, 0.04], [2.08, 0.92, 0.26, 0.012]],
        [[2.72, 0.58, 0.14, 0.04], [2.74, 0.72, 0.14, 0.010]],
    ],
];

/// Number of teeth in a row.
const N_TEETH: u32 = 6;

impl Creature {
    /// Returns the part of the creature that a point on the surface belongs to.
    pub(super) fn part(self, position: DVec3) -> Part {
        let at = DVec3::new(position.x, position.y, position.z.abs());
        let parts = [
            (Part::Hide, hide(position)),
            (Part::Tongue, tongue(at)),
            (Part::Eye, eye(at)),
            (Part::Tooth, teeth(at)),
        ];
        let nearest = parts.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map_or(Part::Hide, |(part, _)| part)
    }
}

impl Solid for Creature {
    fn distance(&self, position: DVec3) -> f64 {
        let at = DVec3::new(position.x, position.y, position.z.abs());
        hide(position).min(tongue(at)).min(eye(at)).min(teeth(at))
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::new(-4.2, -0.1, -1.8), DVec3::new(3.6, 1.8, 2.7)]
    }
}

fn hide(position: DVec3) -> f64 {
    let at = DVec3::new(position.x, position.y, position.z.abs());
    let trunk = TRUNK.iter().map(|cone| (cone, position));
    let sides = SIDES.iter().map(|cone| (cone, at));
    trunk
        .chain(sides)
        .fold(f64::INFINITY, |distance, (cone, at)| {
            let [[.., a], [.., b]] = *cone;
            blend(distance, cone_distance(cone, at), 0.4 * a.max(b))
        })
}

fn tongue(at: DVec3) -> f64 {
    let distances = TONGUE.iter().map(|cone| cone_distance(cone, at));
    distances.fold(f64::INFINITY, |distance, cone| blend(distance, cone, 0.05))
}

fn eye(at: DVec3) -> f64 {
    (at - EYE).length() - 0.12
}

fn teeth(at: DVec3) -> f64 {
    let mut nearest = f64::INFINITY;
    for [first, last] in TEETH {
        for tooth in 0..N_TEETH {
            let part = f64::from(tooth) / f64::from(N_TEETH - 1);
            let mix = |end: usize, number: usize| {
                first[end][number] + (last[end][number] - first[end][number]) * part
            };
            let tooth = [0, 1].map(|end| [0, 1, 2, 3].map(|number| mix(end, number)));
            nearest = nearest.min(cone_distance(&tooth, at));
        }
    }
    nearest
}

/// Returns the approximate distance to a cone: the distance to the nearest point on its axis, minus the radius there.
fn cone_distance(cone: &Cone, at: DVec3) -> f64 {
    let [[ax, ay, az, a], [bx, by, bz, b]] = *cone;
    let (from, to) = (DVec3::new(ax, ay, az), DVec3::new(bx, by, bz));
    let (along, reach) = (to - from, at - from);
    let part = (reach.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (reach - along * part).length() - (a + (b - a) * part)
}

/// Returns the smaller of two distances, blended smoothly if they differ by less than `width`.
///
/// Reference: Inigo Quilez, "Smooth minimum", 2013, <https://iquilezles.org/articles/smin/>, the quadratic version.
fn blend(a: f64, b: f64, width: f64) -> f64 {
    let overlap = (width - (a - b).abs()).max(0.0);
    let smaller = a.min(b);
    if overlap > 0.0 {
        smaller - overlap * overlap / (4.0 * width)
    } else {
        smaller
    }
}
