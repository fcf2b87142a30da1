//! One image of a figure, and its bytes in an image file.

use dapple_color::{Code, LinearRgb};
use dapple_raster::Raster;

/// One image of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Label that distinguishes the image from the figure's other images; empty if there is only one.
    pub label: String,
    /// Measurements of the image, as text in columns; empty if there are none. The page shows the note below the
    /// image, and the lock ignores it.
    pub note: String,
    /// Whether copies of the image tile seamlessly along x and y. The page shows such images tiled, and the lock
    /// ignores this field.
    pub repeats: [bool; 2],
    /// Pixels of the image.
    pub picture: Picture,
}

/// The pixels of a panel.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// Shades from 0 (black) to 1 (white), stored in the file without a transfer function (`round(255 · value)`).
    Gray(Raster<f32>),
    /// Linear color, converted to sRGB in the file.
    Color(Raster<LinearRgb>),
}

impl Panel {
    /// Creates a panel from shades of gray, from 0 (black) to 1 (white).
    #[must_use]
    pub fn gray(label: impl Into<String>, raster: Raster<f32>) -> Self {
        Self {
            label: label.into(),
            note: String::new(),
            repeats: [false; 2],
            picture: Picture::Gray(raster),
        }
    }

    /// Creates a panel from linear color.
    #[must_use]
    pub fn color(label: impl Into<String>, raster: Raster<LinearRgb>) -> Self {
        Self {
            label: label.into(),
            note: String::new(),
            repeats: [false; 2],
            picture: Picture::Color(raster),
        }
    }

    /// Replaces the label.
    #[must_use]
    pub fn with_label(self, label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..self
        }
    }

    /// Sets the note with measurements.
    #[must_use]
    pub fn with_note(self, note: impl ToString) -> Self {
        Self {
            note: note.to_string(),
            ..self
        }
    }

    /// Marks the image as tiling along both axes.
    #[must_use]
    pub fn repeating(self) -> Self {
        self.repeating_along([true; 2])
    }

    /// Sets whether the image tiles along x and y.
    #[must_use]
    pub fn repeating_along(self, repeats: [bool; 2]) -> Self {
        Self { repeats, ..self }
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match &self.picture {
            Picture::Gray(raster) => raster.size(),
            Picture::Color(raster) => raster.size(),
        }
    }

    /// Returns the number of bytes per pixel, 1 or 3.
    #[must_use]
    pub fn n_channels(&self) -> u8 {
        match self.picture {
            Picture::Gray(_) => 1,
            Picture::Color(_) => 3,
        }
    }

    /// Returns the pixels as in an 8-bit file, row by row from the top.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        match &self.picture {
            Picture::Gray(raster) => raster
                .pixels()
                .iter()
                .map(|&value| u8::from_unit(value))
                .collect(),
            Picture::Color(raster) => raster
                .pixels()
                .iter()
                .flat_map(|color| color.to_srgb())
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Panel;
    use dapple_color::LinearRgb;
    use dapple_raster::Raster;

    #[test]
    fn bytes_are_linear_for_gray_and_srgb_for_color() {
        let shades = Raster::from_vec([4, 1], vec![-1.0, 0.5, 2.0, f32::NAN]).unwrap();
        assert_eq!(Panel::gray("", shades).bytes(), [0, 128, 255, 0]);
        let color = Raster::filled([1, 1], LinearRgb::new(0.0, 0.5, 1.0)).unwrap();
        assert_eq!(Panel::color("", color).bytes(), [0, 188, 255]);
    }
}
