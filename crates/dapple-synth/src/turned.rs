//! Rotations and reflections of images, for exemplars whose features may have any direction.

use dapple_color::Normal;

dapple_raster::named! {
    /// Orientations of each image in a [layout](crate::SideBySide). A texture from the layout has the content of the
    /// images in all of these orientations.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Turned {
        /// Unchanged image only.
        #[default]
        None = "none",
        /// Unchanged image, and its left-right mirror image.
        Mirror = "mirror",
        /// Unchanged image, and rotations by one, two and three quarter turns.
        Quarters = "quarters",
        /// Rotations by quarter turns, and their mirror images: eight orientations.
        All = "all",
    }
}

/// A symmetry of the pixel grid: an optional left-right reflection, followed by a clockwise rotation in quarter turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Turn {
    is_mirrored: bool,
    quarters: u8,
}

impl Turned {
    /// Returns the symmetries of this choice, the identity first.
    pub(crate) fn ways(self) -> Vec<Turn> {
        let (is_mirrored, quarters): (&[bool], _) = match self {
            Self::None => (&[false], 0..1),
            Self::Mirror => (&[false, true], 0..1),
            Self::Quarters => (&[false], 0..4),
            Self::All => (&[false, true], 0..4),
        };
        let ways = is_mirrored.iter().flat_map(|&is_mirrored| {
            quarters.clone().map(move |quarters| Turn {
                is_mirrored,
                quarters,
            })
        });
        ways.collect()
    }
}

impl Turn {
    /// Returns the size of a rotated image, given its original size.
    pub(crate) fn size(self, [width, height]: [u32; 2]) -> [u32; 2] {
        match self.quarters % 2 {
            0 => [width, height],
            _ => [height, width],
        }
    }

    /// Returns the pixel of the original image that is shown at a pixel of the rotated one. `[width, height]` is the
    /// size of the original.
    pub(crate) fn pixel(self, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> [u32; 2] {
        // Invert the turn: undo the rotation, then the reflection.
        let [column, row] = match self.quarters {
            0 => [x, y],
            1 => [y, height - 1 - x],
            2 => [width - 1 - x, height - 1 - y],
            _ => [width - 1 - y, x],
        };
        match self.is_mirrored {
            true => [width - 1 - column, row],
            false => [column, row],
        }
    }

    /// Rotates and mirrors a normal. Green points up.
    pub(crate) fn normal(self, Normal { x, y, z }: Normal) -> Normal {
        // Reflect, then rotate.
        let x = if self.is_mirrored { -x } else { x };
        let [x, y] = match self.quarters {
            0 => [x, y],
            1 => [y, -x],
            2 => [-x, -y],
            _ => [-y, x],
        };
        Normal { x, y, z }
    }
}

#[cfg(test)]
mod tests;
