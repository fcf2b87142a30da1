//! Transformed solids.

use super::Solid;
use glam::{DQuat, DVec3};

/// A solid rotated around the origin, then translated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<S> {
    /// The solid before the transform.
    pub solid: S,
    /// The rotation, a unit quaternion.
    pub rotation: DQuat,
    /// The translation.
    pub offset: DVec3,
}

impl<S: Solid> Solid for Placed<S> {
    fn distance(&self, at: DVec3) -> f64 {
        self.solid
            .distance(self.rotation.conjugate() * (at - self.offset))
    }

    fn bounds(&self) -> [DVec3; 2] {
        around_corners(self.solid.bounds(), |corner| {
            self.rotation * corner + self.offset
        })
    }
}

/// A solid mirrored in x: x becomes -x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirrored<S>(pub S);

impl<S: Solid> Solid for Mirrored<S> {
    fn distance(&self, at: DVec3) -> f64 {
        self.0.distance(DVec3::new(-at.x, at.y, at.z))
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [low, high] = self.0.bounds();
        [
            DVec3::new(-high.x, low.y, low.z),
            DVec3::new(-low.x, high.y, high.z),
        ]
    }
}

/// A solid scaled along the axes about the origin.
///
/// Its distance is a lower bound of the true distance, and smaller where the scales differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled<S> {
    /// The solid before the transform.
    pub solid: S,
    /// The scale factors along the axes, above 0.
    pub scale: DVec3,
}

impl<S: Solid> Solid for Scaled<S> {
    fn distance(&self, at: DVec3) -> f64 {
        self.solid.distance(at / self.scale) * self.scale.min_element()
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.solid.bounds().map(|corner| corner * self.scale)
    }
}

/// A solid thickened by a layer of uniform thickness, which rounds its edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grown<S> {
    /// The solid without the layer.
    pub solid: S,
    /// Thickness of the layer.
    pub by: f64,
}

impl<S: Solid> Solid for Grown<S> {
    fn distance(&self, at: DVec3) -> f64 {
        self.solid.distance(at) - self.by
    }

    fn bounds(&self) -> [DVec3; 2] {
        let [low, high] = self.solid.bounds();
        [low - self.by, high + self.by]
    }
}

/// A solid whose sides are bent up: a position at x is lifted by `lift` x².
///
/// Its distance is a lower bound of the true distance, and smaller where the solid is bent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bent<S> {
    solid: S,
    lift: f64,
    bounds: [DVec3; 2],
    /// Factor applied to distances: a lower bound of their change caused by the bend.
    shrink: f64,
}

impl<S: Solid> Bent<S> {
    /// Bends a solid. `lift` is the height at x = 1; negative values bend down.
    #[must_use]
    pub fn new(solid: S, lift: f64) -> Self {
        let [low, high] = solid.bounds();
        let widest = low.x.abs().max(high.x.abs());
        let height = lift * widest * widest;
        let bounds = [
            low + DVec3::Y * height.min(0.0),
            high + DVec3::Y * height.max(0.0),
        ];
        // A shear by the slope s stretches by at most 1 + |s|.
        let shrink = 1.0 / (1.0 + 2.0 * (lift * widest).abs());
        Self {
            solid,
            lift,
            bounds,
            shrink,
        }
    }
}

impl<S: Solid> Solid for Bent<S> {
    fn distance(&self, at: DVec3) -> f64 {
        // Beyond the bounds, the bend continues linearly, so that its slope is bounded.
        let x = at.x.max(self.bounds[0].x).min(self.bounds[1].x);
        let lift = self.lift * x * (2.0 * at.x - x);
        self.solid.distance(at - DVec3::Y * lift) * self.shrink
    }

    fn bounds(&self) -> [DVec3; 2] {
        self.bounds
    }
}

/// Returns the bounding box of the corners of a box after the transform `moved`.
fn around_corners([low, high]: [DVec3; 2], moved: impl Fn(DVec3) -> DVec3) -> [DVec3; 2] {
    let corners = (0..8).map(|corner| {
        let part = DVec3::from_array([0, 1, 2].map(|axis| f64::from(corner >> axis & 1)));
        moved(low + (high - low) * part)
    });
    corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], at| {
        [low.min(at), high.max(at)]
    })
}
