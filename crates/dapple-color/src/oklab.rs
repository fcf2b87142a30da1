//! Oklab, a color space in which equal steps look about equal.
//!
//! Reference: Björn Ottosson, "A perceptual color space for image processing", 2020,
//! <https://bottosson.github.io/posts/oklab/>, with the 2021 matrices to and from linear sRGB. Lightness is 0 for
//! black and 1 for white; a (green to red) and b (blue to yellow) are 0 for grays. The cube roots come from `libm`.

use crate::LinearRgb;

impl LinearRgb {
    /// Converts the color, which may be outside a screen's gamut, to Oklab: lightness (0 for black, 1 for white), a and b.
    #[must_use]
    pub fn to_oklab(self) -> [f64; 3] {
        let [r, g, b] = self.to_array().map(f64::from);
        let l = libm::cbrt(0.412_221_470_8 * r + 0.536_332_536_3 * g + 0.051_445_992_9 * b);
        let m = libm::cbrt(0.211_903_498_2 * r + 0.680_699_545_1 * g + 0.107_396_956_6 * b);
        let s = libm::cbrt(0.088_302_461_9 * r + 0.281_718_837_6 * g + 0.629_978_700_5 * b);
        [
            0.210_454_255_3 * l + 0.793_617_785_0 * m - 0.004_072_046_8 * s,
            1.977_998_495_1 * l - 2.428_592_205_0 * m + 0.450_593_709_9 * s,
            0.025_904_037_1 * l + 0.782_771_766_2 * m - 0.808_675_766_0 * s,
        ]
    }
}

/// Converts lightness, a and b to a color.
pub(crate) fn linear_from_oklab([lightness, a, b]: [f64; 3]) -> LinearRgb {
    let cube = |root: f64| root * root * root;
    let l = cube(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cube(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cube(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    LinearRgb::new(
        (4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s) as f32,
        (-1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s) as f32,
        (-0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s) as f32,
    )
}

#[cfg(test)]
mod tests {
    use super::linear_from_oklab;
    use crate::LinearRgb;
    use proptest::prelude::*;

    /// Oracle: computes Oklab by its definition through CIE XYZ with D65, with the paper's matrices. The matrices
    /// from sRGB to XYZ are from IEC 61966-2-1.
    fn by_definition([r, g, b]: [f64; 3]) -> [f64; 3] {
        let rows = |matrix: [[f64; 3]; 3], [x, y, z]: [f64; 3]| {
            matrix.map(|row| row[0] * x + row[1] * y + row[2] * z)
        };
        let xyz = rows(
            [
                [0.412_456_4, 0.357_576_1, 0.180_437_5],
                [0.212_672_9, 0.715_152_2, 0.072_175_0],
                [0.019_333_9, 0.119_192_0, 0.950_304_1],
            ],
            [r, g, b],
        );
        let lms = rows(
            [
                [0.818_933_010_1, 0.361_866_742_4, -0.128_859_713_7],
                [0.032_984_543_6, 0.929_311_871_5, 0.036_145_638_7],
                [0.048_200_301_8, 0.264_366_269_1, 0.633_851_707_0],
            ],
            xyz,
        );
        rows(
            [
                [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
                [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
                [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
            ],
            lms.map(libm::cbrt),
        )
    }

    #[test]
    fn primaries_are_where_css_color_4_has_them() {
        // W3C, "CSS Color Module Level 4": its conversions of red, lime and blue, to five digits.
        for (color, expected) in [
            ([1.0, 0.0, 0.0], [0.627_96, 0.224_86, 0.125_85]),
            ([0.0, 1.0, 0.0], [0.866_44, -0.233_89, 0.179_50]),
            ([0.0, 0.0, 1.0], [0.452_01, -0.032_46, -0.311_53]),
            ([1.0, 1.0, 1.0], [1.0, 0.0, 0.0]),
        ] {
            let found = LinearRgb::from(color).to_oklab();
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 6e-6,
                    "{color:?}: {found} and {expected}"
                );
            }
        }
    }

    #[test]
    fn value_stability_oklab() {
        let lab = LinearRgb::new(0.25, 0.5, 0.75).to_oklab();
        assert_eq!(
            lab.map(f64::to_bits),
            [
                0x3fe8_b082_f285_1ae1,
                0xbfa2_d7b6_9fd3_b378,
                0xbfb0_d2d7_4443_00e0
            ],
            "{lab:?}"
        );
        let color = linear_from_oklab([0.5, 0.1, -0.05]).to_array();
        assert_eq!(
            color.map(f32::to_bits),
            [0x3e7d_0de2, 0x3d86_e32c, 0x3e55_303f],
            "{color:?}"
        );
    }

    proptest! {
        #[test]
        fn oklab_is_its_definition_and_leads_back(r in 0.0_f32..1.0, g in 0.0_f32..1.0, b in 0.0_f32..1.0) {
            let lab = LinearRgb::new(r, g, b).to_oklab();
            let expected = by_definition([r, g, b].map(f64::from));
            for (found, expected) in lab.iter().zip(expected) {
                // The matrices through XYZ have seven digits, and a cube root near black amplifies their rounding.
                prop_assert!((found - expected).abs() < 2e-3, "{found} and {expected}");
            }
            for (back, part) in linear_from_oklab(lab).to_array().into_iter().zip([r, g, b]) {
                // The matrices have ten digits.
                prop_assert!((back - part).abs() < 1e-6, "{back} and {part}");
            }
        }
    }
}
