//! Named color ramps.
//!
//! The colors are original and were chosen by eye for the gallery's textures. Each list goes from the color of low
//! values to the color of high values.

use crate::{ColorRamp, LinearRgb};

dapple_raster::named! {
    /// Named list of colors.
    ///
    #[cfg_attr(doc, doc = include_str!("../docs/palette.md"))]
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_color::Palette;
    ///
    /// let ramp = Palette::Giraffe.ramp();
    /// assert_eq!(ramp.stops().len(), Palette::Giraffe.colors().len());
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Palette {
        /// Black to white.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-gray.md"))]
        Gray = "gray",
        /// Deep blue through teal and green to pale yellow. Lightness increases throughout, so the palette reads as
        /// height.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-lagoon.md"))]
        Lagoon = "lagoon",
        /// Black through dark red and orange to pale yellow. Lightness increases throughout.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-ember.md"))]
        Ember = "ember",
        /// Sea floor, shallows, beach, meadow, forest, rock and snow.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-terrain.md"))]
        Terrain = "terrain",
        /// White and black, as on a cow.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-cow.md"))]
        Cow = "cow",
        /// Cream and browns, as between and on the spots of a giraffe.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-giraffe.md"))]
        Giraffe = "giraffe",
        /// Eight easily distinguished colors, for labels.
        ///
        #[cfg_attr(doc, doc = include_str!("../docs/palette-labels.md"))]
        Labels = "labels",
    }
}

impl Palette {
    /// Returns the colors, from low values to high values.
    #[must_use]
    pub fn colors(self) -> Vec<LinearRgb> {
        let codes = self.codes().iter();
        codes.map(|&codes| LinearRgb::from_srgb(codes)).collect()
    }

    /// Returns a ramp through the colors, equally spaced from 0 to 1.
    #[must_use]
    pub fn ramp(self) -> ColorRamp {
        ColorRamp::even_unchecked(&self.colors())
    }

    /// Returns the color of a label. Labels beyond the last color start again at the first.
    #[must_use]
    pub fn color(self, label: u32) -> LinearRgb {
        let codes = self.codes();
        LinearRgb::from_srgb(codes[label as usize % codes.len()])
    }

    /// Returns the colors as sRGB codes.
    const fn codes(self) -> &'static [[u8; 3]] {
        match self {
            Self::Gray => &[[0, 0, 0], [255, 255, 255]],
            Self::Lagoon => &[
                [10, 20, 58],
                [17, 62, 104],
                [20, 114, 128],
                [62, 164, 122],
                [156, 208, 116],
                [246, 244, 176],
            ],
            Self::Ember => &[
                [8, 4, 12],
                [66, 12, 30],
                [148, 28, 26],
                [220, 88, 22],
                [250, 172, 60],
                [255, 242, 190],
            ],
            Self::Terrain => &[
                [22, 46, 92],
                [62, 128, 168],
                [214, 198, 146],
                [116, 154, 70],
                [48, 92, 48],
                [122, 110, 98],
                [244, 246, 250],
            ],
            Self::Cow => &[[240, 234, 224], [32, 26, 24]],
            Self::Giraffe => &[
                [240, 218, 172],
                [198, 134, 66],
                [150, 84, 36],
                [104, 54, 24],
            ],
            Self::Labels => &[
                [38, 84, 156],
                [232, 136, 32],
                [52, 150, 84],
                [204, 52, 60],
                [132, 90, 168],
                [242, 206, 74],
                [86, 180, 200],
                [226, 136, 172],
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Palette;
    use dapple_raster::Named;

    #[test]
    fn ramps_reach_the_first_and_the_last_color() {
        for palette in Palette::ALL {
            let (ramp, colors) = (palette.ramp(), palette.colors());
            let ends = [ramp.at(0.0), ramp.at(1.0)];
            assert_eq!(ends, [colors[0], colors[colors.len() - 1]], "{palette:?}");
            assert_eq!(palette.color(colors.len() as u32), colors[0], "{palette:?}");
        }
    }

    #[test]
    fn palettes_for_heights_grow_lighter_all_the_way() {
        for palette in [Palette::Gray, Palette::Lagoon, Palette::Ember] {
            let ramp = palette.ramp();
            let light = |step: u16| ramp.at(f32::from(step) / 100.0).luminance();
            for step in 0..100 {
                assert!(
                    light(step) < light(step + 1),
                    "{palette:?} at {step} of 100"
                );
            }
        }
    }
}
