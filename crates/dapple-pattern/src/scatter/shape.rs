//! Shapes of stamps, with their height profiles.
//!
//! The coordinates u and v along and across a shape are from −1 to 1 in its bounding box.

dapple_raster::named! {
    /// Shape of a stamp.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum StampShape {
        /// Half ellipsoid.
        #[default]
        Dome = "dome",
        /// Cone.
        Cone = "cone",
        /// Flat disk with a bevel.
        Disk = "disk",
        /// Flat rectangle with a bevel.
        Plate = "plate",
        /// Rectangle with a round end and a bevel, such as a roof slate or a fish scale.
        Slate = "slate",
        /// Stone with an irregular outline and a flattened top.
        Pebble = "pebble",
        /// Pointed leaf with a midrib and side veins.
        Leaf = "leaf",
        /// Bent blade of grass, which rises toward its tip.
        Blade = "blade",
        /// Line with round ends, such as a scratch or a fiber.
        Capsule = "capsule",
        /// Star with five round arms.
        Star = "star",
        /// Flake with six arms.
        Flake = "flake",
    }
}

/// Parameters of the outline of a stamp.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    /// Width relative to the length.
    pub(super) aspect: f32,
    /// Width of the bevel relative to half of the shape's width.
    pub(super) bevel: f32,
    /// Random numbers from 0 to below 1.
    pub(super) random: [f32; 4],
}

impl StampShape {
    /// Returns the distance from the outline, from 0 to 1 in the middle, and the height profile, from 0 to 1. `None`
    /// outside of the outline.
    pub(super) fn at(self, outline: &Outline, u: f32, v: f32) -> Option<(f32, f32)> {
        let square = u * u + v * v;
        let flat = |edge: f32| (edge >= 0.0).then(|| (edge, outline.bevel(edge)));
        match self {
            Self::Dome => (square <= 1.0).then(|| (1.0 - square.sqrt(), (1.0 - square).sqrt())),
            Self::Cone => flat(1.0 - square.sqrt()).map(|(edge, _)| (edge, edge)),
            Self::Disk => flat(1.0 - square.sqrt()),
            Self::Plate => {
                let along = (1.0 - u.abs()) / outline.aspect;
                flat(along.min(1.0 - v.abs()))
            }
            Self::Slate => flat(outline.slate(u, v)),
            Self::Pebble => {
                let part = outline.pebble(u, v, square);
                let square = part * part;
                (part <= 1.0).then(|| (1.0 - part, (1.0 - square * square).sqrt()))
            }
            Self::Leaf => outline.leaf(u, v),
            Self::Blade => outline.blade(u, v),
            Self::Capsule => {
                // Distance from the line between the centers of the round ends, in half widths
                let along = ((u.abs() - (1.0 - outline.aspect)) / outline.aspect).max(0.0);
                let square = along * along + v * v;
                (square <= 1.0).then(|| (1.0 - square.sqrt(), (1.0 - square).sqrt()))
            }
            Self::Star => {
                let [cos, _] = unit(u, v, square);
                // cos 5a
                let square_cos = cos * cos;
                let lobe = cos * (5.0 + square_cos * (16.0 * square_cos - 20.0));
                flat(1.0 - square.sqrt() / (0.7 + 0.3 * lobe))
            }
            Self::Flake => {
                let [cos, _] = unit(u, v, square);
                // cos 6a = 2 (cos 3a)² − 1
                let triple = cos * (4.0 * cos * cos - 3.0);
                let lobe = triple * triple;
                flat(1.0 - square.sqrt() / (0.25 + 0.75 * lobe * lobe))
            }
        }
    }
}

impl Outline {
    /// Returns the height of a flat shape with a rounded bevel.
    fn bevel(&self, edge: f32) -> f32 {
        if edge >= self.bevel {
            return 1.0;
        }
        let t = 1.0 - edge / self.bevel;
        (1.0 - t * t).max(0.0).sqrt()
    }

    /// Returns the distance from the outline of a slate, relative to half of its width.
    fn slate(&self, u: f32, v: f32) -> f32 {
        // The round end is half of an ellipse, a third of the length.
        let round = ((u - 1.0 / 3.0) * 1.5).max(0.0);
        let end = 1.0 - (round * round + v * v).sqrt();
        end.min((1.0 + u) / self.aspect)
    }

    /// Returns the distance from the center of a pebble, relative to the distance of its outline in the same
    /// direction.
    fn pebble(&self, u: f32, v: f32, square: f32) -> f32 {
        let [cos, sin] = unit(u, v, square);
        // The outline is a sum of the harmonics 2, 3 and 5 with random phases.
        let [cos2, sin2] = [cos * cos - sin * sin, 2.0 * cos * sin];
        let [cos3, sin3] = [cos * cos2 - sin * sin2, cos * sin2 + sin * cos2];
        let [cos5, sin5] = [cos2 * cos3 - sin2 * sin3, cos2 * sin3 + sin2 * cos3];
        let [a, b, c, d] = self.random.map(|random| 2.0 * random - 1.0);
        let wave = 0.08 * (a * cos2 + b * sin2)
            + 0.06 * (c * cos3 + d * sin3)
            + 0.04 * (b * cos5 + a * sin5);
        // The wave is at most 0.26.
        let radius = (0.8 + wave).min(1.0);
        square.sqrt() / radius
    }

    fn leaf(&self, u: f32, v: f32) -> Option<(f32, f32)> {
        // Half of the width along the leaf, whose maximum is 1 before the middle
        let width = (1.0 - u * u) * (1.0 - 0.35 * u) * 0.94;
        let across = v.abs();
        if across >= width {
            return None;
        }
        let edge = 1.0 - across / width;
        // The leaf is bent along the midrib, which stands out, and the side veins are grooves.
        let vein = 4.0 * (u - 0.6 * across) + self.random[0];
        let vein = (2.0 * (vein - vein.floor()) - 1.0).abs();
        let groove = 0.08 * ((vein - 0.8) * 5.0).max(0.0) * edge.min(0.5);
        let rib = 0.15 * (1.0 - across / (0.07 * (1.25 - u))).max(0.0);
        let sheet = 0.5 + 0.35 * (1.0 - edge) * (1.0 - edge) - groove + rib;
        Some((edge, sheet.min(1.0) * self.bevel(edge)))
    }

    fn blade(&self, u: f32, v: f32) -> Option<(f32, f32)> {
        // Parameter from 0 at the root to 1 at the tip
        let t = 0.5 + 0.5 * u;
        let bend = 0.65 * (2.0 * self.random[0] - 1.0) * t * t;
        let width = 0.35 * (1.0 - t * t).max(0.0);
        let across = (v - bend).abs();
        if across >= width {
            return None;
        }
        let edge = 1.0 - across / width;
        // The sides rise from a fold in the middle.
        let fold = 0.75 + 0.25 * (1.0 - edge);
        Some((edge, (0.15 + 0.85 * t) * fold))
    }
}

/// Returns the cosine and the sine of the direction of a vector, given its squared length.
fn unit(x: f32, y: f32, square: f32) -> [f32; 2] {
    let length = square.sqrt();
    if length > 0.0 {
        [x / length, y / length]
    } else {
        [1.0, 0.0]
    }
}
