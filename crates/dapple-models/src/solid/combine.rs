//! Blends solids into each other.

use super::{Solid, box_distance};
use core::fmt;
use glam::DVec3;

/// Solids joined in order, each with a rounded seam to the previous ones.
pub struct Blend {
    parts: Vec<Part>,
}

struct Part {
    solid: Box<dyn Solid + Send>,
    width: f64,
    bounds: [DVec3; 2],
}

impl Blend {
    /// Starts a blend with a single solid.
    #[must_use]
    pub fn of(solid: impl Solid + Send + 'static) -> Self {
        Self { parts: Vec::new() }.with(solid, 0.0)
    }

    /// Joins a solid. The seam is rounded where the distances to the two sides differ by less than `width`, and is
    /// thicker by at most a sixth of `width`. A width of 0 gives a sharp seam.
    #[must_use]
    pub fn with(mut self, solid: impl Solid + Send + 'static, width: f64) -> Self {
        let bounds = solid.bounds();
        let solid = Box::new(solid);
        self.parts.push(Part {
            solid,
            width,
            bounds,
        });
        self
    }

    /// Joins a solid and its mirror image in x.
    #[must_use]
    pub fn with_pair(self, solid: impl Solid + Send + Clone + 'static, width: f64) -> Self {
        self.with(solid.clone(), width)
            .with(super::Mirrored(solid), width)
    }
}

impl Solid for Blend {
    fn distance(&self, at: DVec3) -> f64 {
        let mut distance = f64::INFINITY;
        for part in &self.parts {
            let least = box_distance(part.bounds, at);
            // Parts farther away have no effect and are skipped. The distance to the box is a lower bound; a smaller
            // value would make the result discontinuous where a part is skipped.
            if least < distance + part.width {
                distance = blend(distance, part.solid.distance(at).max(least), part.width);
            }
        }
        distance
    }

    fn bounds(&self) -> [DVec3; 2] {
        // A seam protrudes by at most a sixth of its width.
        let around = |[low, high]: [DVec3; 2], part: &Part| {
            let seam = part.width / 6.0;
            [
                low.min(part.bounds[0]) - seam,
                high.max(part.bounds[1]) + seam,
            ]
        };
        let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        self.parts.iter().fold(nothing, around)
    }
}

impl fmt::Debug for Blend {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Blend")
            .field("parts", &self.parts.len())
            .finish()
    }
}

/// Returns the minimum of two distances, rounded where they differ by less than `width`.
///
/// Reference: Inigo Quilez, "Smooth minimum", 2013, <https://iquilezles.org/articles/smin/>: the cubic version, whose
/// curvature is continuous.
fn blend(a: f64, b: f64, width: f64) -> f64 {
    let smaller = a.min(b);
    let overlap = width - (a - b).abs();
    if overlap > 0.0 {
        smaller - overlap * overlap * overlap / (6.0 * width * width)
    } else {
        smaller
    }
}
