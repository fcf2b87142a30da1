//! The figures of "Wavelet and Blend maps for texture synthesis".

mod fig_extra_materials;
mod functions;
mod grass;
mod lump;
mod patch;
mod pebble;
mod perlin;
mod soil;
mod stone;

use crate::Paper;

/// The paper, with its figures in its own order.
pub(super) const PAPER: Paper = Paper {
    key: "wavelet",
    title: "Wavelet and Blend maps for texture synthesis",
    reference: "Du Jin-Lian, Wang Song and Meng Xianhai, Beijing University of Technology",
    figures: &[fig_extra_materials::FIGURE],
};

#[cfg(test)]
mod tests {
    use super::patch::{Edges, Material};
    use super::{grass::grass, pebble::pebble, perlin::perlin, soil::soil, stone::stone};
    use crate::draw::shrink;
    use dapple_points::hash::Seed;
    use dapple_raster::Raster;

    type Make = fn(u32, Seed, Edges) -> anyhow::Result<Material>;

    const MATERIALS: [(&str, Make); 4] = [
        ("stone", stone),
        ("pebble", pebble),
        ("grass", grass),
        ("soil", soil),
    ];

    /// The mean difference between the last and the first column, over that between other neighbors.
    fn seam_ratio(raster: &Raster<f32>) -> f64 {
        let [width, height] = raster.size();
        let difference = |left: u32, right: u32| -> f64 {
            let rows = (0..height).map(|row| raster.row(row));
            rows.map(|row| f64::from((row[left as usize] - row[right as usize]).abs()))
                .sum()
        };
        let inside: f64 = (1..width)
            .map(|column| difference(column - 1, column))
            .sum();
        difference(width - 1, 0) * f64::from(width - 1) / inside
    }

    #[test]
    fn heights_and_gaps_stay_in_their_range() {
        for (name, make) in MATERIALS {
            for seed in 1..4 {
                let made = make(96, Seed(seed), Edges::Cropped).unwrap();
                let [height, gap] = [&made.height, &made.gap].map(Raster::statistics);
                assert!(height.min > -0.2 && height.max < 1.2, "{name}: {height:?}");
                assert!(gap.min >= 0.0 && gap.max <= 1.0, "{name}: {gap:?}");
                assert!(gap.mean > 0.005 && gap.mean < 0.5, "{name}: {gap:?}");
            }
        }
    }

    #[test]
    fn borders_fit_only_where_the_material_repeats() {
        for (name, make) in MATERIALS {
            let ratio = |edges| seam_ratio(&make(256, Seed(1), edges).unwrap().height);
            let [repeating, cropped] = [Edges::Repeating, Edges::Cropped].map(ratio);
            // One column of 256 pixels with features of some ten pixels varies by a fifth or so.
            assert!((0.5..1.5).contains(&repeating), "{name}: {repeating}");
            assert!(cropped > 1.5, "{name}: {cropped}");
        }
    }

    #[test]
    fn a_small_picture_shows_the_same_as_a_large_one() {
        for (name, make) in [("stone", stone as Make), ("pebble", pebble)] {
            let [small, large] =
                [64, 256].map(|size| make(size, Seed(1), Edges::Cropped).unwrap().gap);
            let large = shrink(&large, 4).unwrap();
            let apart = small.zip_map(&large, |a, b| (a - b).abs()).unwrap();
            // Samples of edges and their means differ in the pixels on an edge.
            let mean = apart.statistics().mean;
            assert!(mean < 0.15, "{name}: {mean}");
        }
    }

    #[test]
    fn perlin_tiles_are_centered_and_have_a_seam() {
        let tile = perlin(128, 4.0, 5, Seed(5)).unwrap();
        let range = tile.statistics();
        assert!((range.mean - 0.5).abs() < 0.1, "{range:?}");
        assert!(range.min >= 0.0 && range.max <= 1.0, "{range:?}");
        assert!(range.deviation > 0.1, "{range:?}");
        assert!(seam_ratio(&tile) > 3.0, "no seam");
    }
}
