//! Spheres and tori as solids, intersected with rays as intervals inside the solid.
//!
//! A ray intersects a torus at the roots of a quartic. Measured from the point of the ray nearest to the center, the
//! quartic has no cubic term. The roots of its derivatives isolate its roots. Each root is found by Newton steps that
//! stay within a bracket with a change of sign: Cem Yuksel, "High-Performance Polynomial Root Finding for Graphics",
//! Proceedings of the ACM on Computer Graphics and Interactive Techniques 5(3), 2022, doi 10.1145/3543865. The only
//! operations are `+ − × ÷ sqrt`. Where a ray is tangent to the torus, at a double root, rounding decides. Either
//! result is an interval of nearly zero length.

use super::cut::Wedge;
use crate::ray::Ray;
use crate::surface::{Chart, Part};
use glam::DVec3;

/// Maximum number of steps in the search for a root. Bisection narrows any bracket of a torus to neighboring numbers in
/// fewer steps.
const ROOT_STEPS_MAX: u32 = 128;

/// A closed surface that bounds a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Skin {
    Sphere { radius: f64 },
    Torus { major: f64, minor: f64 },
}

/// A solid with an optional cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solid {
    pub(crate) skin: Skin,
    pub(crate) wedge: Option<Wedge>,
}

/// The surface that a ray crosses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Face {
    Skin,
    /// A face of the wedge.
    Cut(usize),
}

/// The point where a ray enters or leaves a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Boundary {
    pub(crate) distance: f64,
    pub(crate) face: Face,
}

/// An interval of a ray inside a solid, of positive length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stretch {
    pub(crate) enter: Boundary,
    pub(crate) exit: Boundary,
}

impl Stretch {
    fn checked(self) -> Option<Self> {
        (self.enter.distance < self.exit.distance).then_some(self)
    }

    /// Returns the part of the interval before `end`, or `None` if it is empty.
    pub(crate) fn before(mut self, end: Boundary) -> Option<Self> {
        if end.distance < self.exit.distance {
            self.exit = end;
        }
        self.checked()
    }

    /// Returns the part of the interval after `start`, or `None` if it is empty.
    pub(crate) fn after(mut self, start: Boundary) -> Option<Self> {
        if start.distance > self.enter.distance {
            self.enter = start;
        }
        self.checked()
    }

    /// Returns the intersection of two intervals, or `None` if they are disjoint.
    pub(crate) fn and(self, other: Self) -> Option<Self> {
        self.after(other.enter)?.before(other.exit)
    }
}

impl Solid {
    /// Returns the first boundary of the solid along `ray` at a distance above zero.
    pub(crate) fn hit(&self, ray: &Ray) -> Option<Boundary> {
        let stretches = self.skin.stretches(ray);
        let stretches = match &self.wedge {
            Some(wedge) if stretches[0].is_some() => wedge.apply(ray, stretches),
            _ => [stretches[0], stretches[1], None, None],
        };
        // The intervals are sorted and disjoint.
        let boundaries = stretches.iter().flatten().flat_map(|s| [s.enter, s.exit]);
        boundaries
            .into_iter()
            .find(|boundary| boundary.distance > 0.0)
    }

    /// Returns the unit normal, the part of the shape, and the chart at `position`. The normal is outward on the skin
    /// and may point to either side on a cut.
    pub(crate) fn detail(&self, position: DVec3, face: Face) -> (DVec3, Part, Chart) {
        match (face, &self.wedge) {
            (Face::Cut(index), Some(wedge)) => (wedge.normal(index), Part::Cut, Chart::None),
            _ => {
                let (normal, chart) = self.skin.detail(position);
                (normal, Part::Skin, chart)
            }
        }
    }
}

impl Skin {
    /// Returns the intervals of a ray inside the solid, in order, including those behind the origin.
    fn stretches(&self, ray: &Ray) -> [Option<Stretch>; 2] {
        // Measure distances from the point of the ray nearest to the center, which keeps them small.
        let middle = -ray.origin.dot(ray.direction);
        let nearest = ray.at(middle);
        let stretch = |[enter, exit]: [f64; 2]| {
            let at = |distance: f64| Boundary {
                distance: middle + distance,
                face: Face::Skin,
            };
            let stretch = Stretch {
                enter: at(enter),
                exit: at(exit),
            };
            stretch.checked()
        };
        match *self {
            Self::Sphere { radius } => {
                let half_sq = radius * radius - nearest.length_squared();
                let half = half_sq.max(0.0).sqrt();
                [stretch([-half, half]), None]
            }
            Self::Torus { major, minor } => {
                let nearest = Ray {
                    origin: nearest,
                    direction: ray.direction,
                };
                torus_stretches(&nearest, major, minor).map(|ends| stretch(ends?))
            }
        }
    }

    fn detail(&self, position: DVec3) -> (DVec3, Chart) {
        match *self {
            Self::Sphere { .. } => (position.normalize_or(DVec3::Y), Chart::Sphere),
            Self::Torus { major, .. } => {
                let outward = DVec3::new(position.x, 0.0, position.z).normalize_or(DVec3::X);
                let normal = (position - outward * major).normalize_or(DVec3::Y);
                let major_radius = major;
                (normal, Chart::Torus { major_radius })
            }
        }
    }
}

/// Returns the intervals of a ray inside a torus. The ray starts at its point nearest to the center.
fn torus_stretches(nearest: &Ray, major: f64, minor: f64) -> [Option<[f64; 2]>; 2] {
    let [origin, direction] = [nearest.origin, nearest.direction];
    // Scale lengths by the outer radius, the radius of the enclosing sphere.
    let unit = major + minor;
    if origin.length_squared() >= unit * unit {
        return [None; 2];
    }
    let (origin, major, minor) = (origin / unit, major / unit, minor / unit);
    let reach_sq = 1.0 - origin.length_squared();
    if reach_sq <= 0.0 {
        return [None; 2];
    }
    let reach = reach_sq.sqrt();
    // Skip rays that stay above or below the torus within the enclosing sphere.
    if (origin.y.abs() - direction.y.abs() * reach) > minor {
        return [None; 2];
    }
    // Find the roots between the turning points of the quartic. They are entries and exits in turn.
    let quartic = Quartic::of_torus(origin, direction, [major, minor]);
    let mut ends = [[0.0; 2]; 2];
    let (mut count, mut from) = (0, -reach);
    // Due to rounding, a ray that touches the enclosing sphere may begin inside.
    let mut enter = (quartic.at(from) < 0.0).then_some(from);
    for to in quartic.turns(reach).into_iter().chain([reach]) {
        let root = quartic.root([from, to]);
        match (enter, root) {
            (None, Some(root)) => enter = Some(root),
            (Some(start), Some(root)) if count < 2 => {
                ends[count] = [start, root];
                count += 1;
                enter = None;
            }
            _ => {}
        }
        from = to;
    }
    // Due to rounding, a ray that touches the enclosing sphere may end inside.
    if let Some(start) = enter
        && count < 2
    {
        ends[count] = [start, reach];
        count += 1;
    }
    let end = |index: usize| (index < count).then(|| ends[index].map(|end| end * unit));
    [end(0), end(1)]
}

/// The polynomial `t⁴ + c[2] t² + c[1] t + c[0]`.
#[derive(Clone, Copy, Debug)]
struct Quartic {
    c: [f64; 3],
}

impl Quartic {
    /// Returns the quartic that is negative where the ray `origin + t direction` is inside a torus. The ray starts at
    /// its point nearest to the center.
    ///
    /// A point is inside if `(|p|² + R² - r²)² < 4 R² (x² + z²)`, and `|p|² = |o|² + t²` since o and d are
    /// perpendicular.
    fn of_torus(origin: DVec3, direction: DVec3, [major, minor]: [f64; 2]) -> Self {
        let four_major_sq = 4.0 * major * major;
        let a = origin.length_squared() + (major - minor) * (major + minor);
        let level = direction.x * direction.x + direction.z * direction.z;
        let outward_sq = origin.x * origin.x + origin.z * origin.z;
        Self {
            c: [
                a * a - four_major_sq * outward_sq,
                2.0 * four_major_sq * origin.y * direction.y,
                2.0 * a - four_major_sq * level,
            ],
        }
    }

    fn at(&self, t: f64) -> f64 {
        let [c0, c1, c2] = self.c;
        ((t * t + c2) * t + c1) * t + c0
    }

    fn slope(&self, t: f64) -> f64 {
        let [_, c1, c2] = self.c;
        (4.0 * t * t + 2.0 * c2) * t + c1
    }

    /// Returns the turning points of the quartic between `-reach` and `reach`, sorted. The quartic is monotonic between
    /// them.
    fn turns(&self, reach: f64) -> [f64; 3] {
        let [_, _, c2] = self.c;
        // The slope has its extrema where 12 t² + 2 c2 is zero.
        let turn = (-c2 / 6.0).max(0.0).sqrt().min(reach);
        let slope = |t: f64| (self.slope(t), 12.0 * t * t + 2.0 * c2);
        let [mut turns, brackets] = [[-reach, 0.0, reach], [-reach, -turn, turn]];
        let ends = [-turn, turn, reach];
        for (place, (from, to)) in turns.iter_mut().zip(brackets.into_iter().zip(ends)) {
            // Without a root of the slope in this bracket, the quartic is monotonic there and any point of the
            // bracket will do.
            *place = bracketed_root([from, to], slope).unwrap_or(from);
        }
        turns
    }

    /// Returns the root in `bracket`, where the quartic must be monotonic, or `None` if there is no root.
    fn root(&self, bracket: [f64; 2]) -> Option<f64> {
        bracketed_root(bracket, |t| (self.at(t), self.slope(t)))
    }
}

/// Returns the root of `function` between `low` and `high`, or `None` if the sign does not change between them.
/// `function` returns its value and its slope.
///
/// Takes Newton steps. Bisects if a step would leave the bracket, and at every eighth step so that the bracket
/// shrinks.
fn bracketed_root([low, high]: [f64; 2], function: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
    let [mut low, mut high] = [low, high];
    let [at_low, at_high] = [low, high].map(|t| function(t).0);
    if (at_low < 0.0) == (at_high < 0.0) {
        return None;
    }
    // Narrow the bracket to the side with the change of sign, then step.
    let rises = at_low < 0.0;
    let mut t = 0.5 * (low + high);
    for step in 0..ROOT_STEPS_MAX {
        let (value, slope) = function(t);
        if (value < 0.0) == rises {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        // The condition also fails for a zero slope, which gives infinity or NaN.
        let inside = newton > low && newton < high;
        let next = if inside && step % 8 != 7 {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - t).abs() <= 1e-15 || value == 0.0 {
            return Some(if value == 0.0 { t } else { next });
        }
        t = next;
    }
    Some(t)
}
