//! Tests of blends: their formulas, and the contrast that they retain.

use super::{Blend, Layer, Mixing, blend, blend_by_tile};
use crate::gauss::blur;
use crate::{BlendMap, Map, Pyramid, TileErrorKind, Weighting, rank_equalize};
use dapple_color::{LinearRgb, Normal};
use dapple_hash::{Seed, hash2, unit_f64};
use dapple_raster::{Raster, Wrap};
use dapple_wavelet::Border;
use proptest::prelude::*;

/// Size of the images, with a ramp of 128 pixels between margins of 32.
const SIZE: [u32; 2] = [192, 128];

fn noise(size: [u32; 2], seed: u64) -> Raster<f32> {
    Raster::from_fn(size, |column, row| {
        unit_f64(hash2(Seed(seed), [column.into(), row.into()], 0)) as f32
    })
    .unwrap()
}

/// Returns noise with features some pixels wide, as ranks from 0 to 1.
fn soft_noise(seed: u64, sigma: f64) -> Raster<f32> {
    rank_equalize(&blur(&noise(SIZE, seed), sigma, [Wrap::Repeat; 2]).unwrap()).unwrap()
}

/// Returns the weights of two layers over a ramp.
fn ramp() -> [Raster<f32>; 2] {
    let right = |column: u32| ((column as f32 + 0.5 - 32.0) / 128.0).clamp(0.0, 1.0);
    [
        Raster::from_fn(SIZE, |column, _| 1.0 - right(column)).unwrap(),
        Raster::from_fn(SIZE, |column, _| right(column)).unwrap(),
    ]
}

/// Returns the root mean square difference of a pixel from its four neighbors, in the middle 32 columns.
fn fine_contrast(raster: &Raster<f32>) -> f64 {
    let mut sum = 0.0;
    for row in 1..i64::from(SIZE[1]) - 1 {
        for column in 80_i64..112 {
            let at = |x, y| f64::from(*raster.at(column + x, row + y, [Wrap::Clamp; 2]));
            let around = at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1);
            sum += (at(0, 0) - 0.25 * around) * (at(0, 0) - 0.25 * around);
        }
    }
    (sum / (32.0 * f64::from(SIZE[1] - 2))).sqrt()
}

/// Returns the fine contrast in the middle of a ramp between two different textures, as a fraction of the textures' own
/// contrast.
fn contrast_kept(weighting: Weighting, mixing: Mixing) -> f64 {
    let weights = ramp();
    let trials = 4;
    let kept = (0..trials).map(|trial| {
        let [grass, gravel] = [10, 20].map(|seed| noise(SIZE, seed + trial));
        let gravel = blur(&gravel, 0.8, [Wrap::Repeat; 2]).unwrap();
        // Scale to the contrast of the grass, so that the order of the two textures does not matter.
        let contrast = fine_contrast(&grass);
        let scale = (contrast / fine_contrast(&gravel)) as f32;
        let gravel = gravel.map(|value| 0.4 + scale * (value - 0.5));
        let heights = [30, 40].map(|seed| soft_noise(seed + trial, 3.0));
        let tile = soft_noise(50 + trial, 4.0);
        let maps = [[Map::Value(grass)], [Map::Value(gravel)]];
        let layers = [0, 1].map(|index| Layer {
            maps: &maps[index],
            weight: &weights[index],
            height: Some(&heights[index]),
        });
        let blended = blend_by_tile(&layers, &tile, &Blend::new(weighting, mixing)).unwrap();
        fine_contrast(&blended[0].planes()[0]) / contrast
    });
    kept.sum::<f64>() / f64::from(trials as u32)
}

#[test]
fn contrast_is_lost_and_kept_as_stated() {
    let pyramid = |sharpness| {
        Mixing::Pyramid(Pyramid {
            sharpness,
            ..Pyramid::default()
        })
    };
    let given = Weighting::Given;
    let height = |depth| Weighting::Height { depth };
    let mask = |gain| Weighting::Mask { gain };
    for (weighting, mixing, low, high) in [
        // The mean of two independent textures keeps sqrt(1/2) of the contrast; 3 % for the small sample.
        (given, Mixing::Linear, 0.69, 0.73),
        (given, Mixing::KeepVariance, 0.98, 1.02),
        // The sharper the transition, the fewer pixels are a blend of both. Measured: 1.01 and 0.92.
        (height(0.1), Mixing::Linear, 0.95, 1.05),
        (height(0.3), Mixing::Linear, 0.86, 0.96),
        // Measured: 0.97 and 1.05. The edges of the mask add as much contrast as transitions remove.
        (mask(4.0), Mixing::Linear, 0.92, 1.02),
        (mask(1e9), Mixing::Linear, 1.0, 1.1),
        // Bands without sharpening change nothing. With sharpening they keep 0.88, and 0.99 with a mask.
        (given, pyramid(0.0), 0.69, 0.73),
        (given, pyramid(8.0), 0.85, 0.92),
        (mask(4.0), pyramid(8.0), 0.95, 1.04),
    ] {
        let kept = contrast_kept(weighting, mixing);
        assert!(
            (low..high).contains(&kept),
            "{weighting:?}, {mixing:?}: {kept}"
        );
    }
}

/// Returns one map of every kind.
fn material(size: [u32; 2], seed: u64) -> Vec<Map> {
    let [height, r, g, b] = [0, 1, 2, 3].map(|part| noise(size, 10 * seed + part));
    let rg = r.zip_map(&g, |&r, &g| [r, g]).unwrap();
    let color = rg.zip_map(&b, |&[r, g], &b| LinearRgb::new(r, g, b));
    let normal = |x: f32, y: f32| {
        let z = (x * x + y * y + 1.0).sqrt().recip();
        Normal {
            x: x * z,
            y: y * z,
            z,
        }
    };
    let normals = r.zip_map(&g, |&x, &y| normal(x - 0.5, y - 0.5));
    vec![
        Map::Value(height),
        Map::Color(color.unwrap()),
        Map::Normal(normals.unwrap()),
    ]
}

fn all_mixings() -> [Mixing; 3] {
    let pyramid = Pyramid {
        levels: 2,
        ..Pyramid::default()
    };
    [
        Mixing::Linear,
        Mixing::KeepVariance,
        Mixing::Pyramid(pyramid),
    ]
}

/// Returns the maximum difference of two lists of maps.
fn difference(a: &[Map], b: &[Map]) -> f32 {
    let planes = |maps: &[Map]| maps.iter().flat_map(Map::planes).collect::<Vec<_>>();
    let pairs = planes(a).into_iter().zip(planes(b));
    let differences = pairs.map(|(a, b)| a.zip_map(&b, |a, b| (a - b).abs()).unwrap());
    differences
        .map(|raster| raster.statistics().max)
        .fold(0.0, f32::max)
}

#[test]
fn a_layer_that_is_alone_comes_back() {
    let size = [12, 8];
    let materials = [1, 2].map(|seed| material(size, seed));
    let weights = [0.0, 3.0].map(|weight| Raster::filled(size, weight).unwrap());
    let layers = [0, 1].map(|index| Layer {
        maps: &materials[index],
        weight: &weights[index],
        height: None,
    });
    for mixing in all_mixings() {
        let blended = blend(&layers, &Blend::new(Weighting::Given, mixing)).unwrap();
        if mixing == Mixing::Linear {
            assert_eq!(blended[..2], materials[1][..2], "bit for bit");
        }
        // Values of about 1; a pyramid rounds at each level, and slopes come from rounded normals.
        let off = difference(&blended, &materials[1]);
        assert!(off < 1e-6, "{mixing:?}: {off}");
    }
}

#[test]
fn equal_layers_stay_as_they_are() {
    let size = [12, 8];
    let maps = material(size, 1);
    let weights = [1, 2, 3].map(|seed| noise(size, seed));
    let layers = weights.each_ref().map(|weight| Layer {
        maps: &maps,
        weight,
        height: None,
    });
    let blended = blend(&layers, &Blend::default()).unwrap();
    // Three shares and three products are rounded.
    let off = difference(&blended, &maps);
    assert!(off < 1e-6, "{off}");
}

#[test]
fn the_linear_mix_stays_in_the_range_of_its_layers_to_the_last_bit() {
    let size = [9, 7];
    let weights: Vec<_> = (0..10)
        .map(|_| Raster::filled(size, 1.0).unwrap())
        .collect();
    for value in [f32::MAX, -f32::MAX, 1.0, 0.1, 1e-45] {
        let near = 0.999_999_9 * value;
        let maps = [value, near].map(|value| [Map::Value(Raster::filled(size, value).unwrap())]);
        // First all values are equal, then one is an ulp or two nearer to 0.
        for n_near in [0, 1] {
            let layers: Vec<_> = (weights.iter().enumerate())
                .map(|(index, weight)| Layer {
                    maps: &maps[usize::from(index < n_near)],
                    weight,
                    height: None,
                })
                .collect();
            let blended = blend(&layers, &Blend::default()).unwrap();
            let other = if n_near == 0 { value } else { near };
            let range = value.min(other)..=value.max(other);
            let planes = blended[0].planes();
            let inside = planes[0].pixels().iter().all(|v| range.contains(v));
            assert!(inside, "{value}: {}", planes[0].pixels()[0]);
        }
    }
}

#[test]
fn mixing_equals_the_formulas_pixel_by_pixel() {
    let size = [9, 7];
    let materials = [1, 2, 3].map(|seed| [Map::Value(noise(size, seed))]);
    let weights = [4, 5, 6].map(|seed| noise(size, seed));
    let layers = [0, 1, 2].map(|index| Layer {
        maps: &materials[index],
        weight: &weights[index],
        height: None,
    });
    let blended = [Mixing::Linear, Mixing::KeepVariance].map(|mixing| {
        let maps = blend(&layers, &Blend::new(Weighting::Given, mixing)).unwrap();
        maps[0].planes().swap_remove(0)
    });
    let means = [0, 1, 2].map(|layer| materials[layer][0].planes()[0].statistics().mean);
    for index in 0..63 {
        let at = |raster: &Raster<f32>| f64::from(raster.pixels()[index]);
        let x = [0, 1, 2].map(|layer| at(&materials[layer][0].planes()[0]));
        let w = [0, 1, 2].map(|layer| at(&weights[layer]));
        let w = w.map(|part| part / (w[0] + w[1] + w[2]));
        let sum = |term: &dyn Fn(usize) -> f64| (0..3).map(term).sum::<f64>();
        let length = sum(&|i| w[i] * w[i]).sqrt();
        let linear = sum(&|i| w[i] * x[i]);
        let keeping = sum(&|i| w[i] * means[i]) + sum(&|i| w[i] * (x[i] - means[i])) / length;
        for (blended, expected) in blended.iter().zip([linear, keeping]) {
            // Shares and sums are `f32`.
            assert!(
                (at(blended) - expected).abs() < 1e-6,
                "{} for {expected}",
                at(blended)
            );
        }
    }
}

#[test]
fn normals_are_mixed_as_slopes() {
    let size = [2, 2];
    let normals = |normal| [Map::Normal(Raster::filled(size, normal).unwrap())];
    let half = 0.5_f32.sqrt();
    let tilted = Normal {
        x: half,
        y: 0.0,
        z: half,
    };
    let weight = Raster::filled(size, 1.0).unwrap();
    let blend_of = |a: Normal, b: Normal| {
        let maps = [a, b].map(normals);
        let layers = maps.each_ref().map(|maps| Layer {
            maps,
            weight: &weight,
            height: None,
        });
        match &blend(&layers, &Blend::default()).unwrap()[0] {
            Map::Normal(raster) => raster.pixels()[0],
            map => panic!("{map:?} are no normals"),
        }
    };
    assert_eq!(blend_of(Normal::FLAT, Normal::FLAT), Normal::FLAT);
    let mixed = blend_of(Normal::FLAT, tilted);
    let length = (mixed.x * mixed.x + mixed.y * mixed.y + mixed.z * mixed.z).sqrt();
    // Half of the slope of 45 degrees, up to some roundings.
    assert!((mixed.x / mixed.z - 0.5).abs() < 1e-6, "{mixed:?}");
    assert!((length - 1.0).abs() < 1e-6, "{mixed:?}");
}

#[test]
fn all_maps_have_the_same_shares() {
    let size = [16, 16];
    let tile = rank_equalize(&noise(size, 9)).unwrap();
    let constant = |value: f32| {
        let height = Map::Value(Raster::filled(size, value).unwrap());
        let color = LinearRgb::new(value, value, value);
        [height, Map::Color(Raster::filled(size, color).unwrap())]
    };
    let [dark, light] = [0.0, 1.0].map(constant);
    let weight = noise(size, 3);
    let layers = [&dark, &light].map(|maps| Layer {
        maps,
        weight: &weight,
        height: None,
    });
    for mixing in all_mixings() {
        let how = Blend::new(Weighting::Mask { gain: 3.0 }, mixing);
        let blended = blend_by_tile(&layers, &tile, &how).unwrap();
        let height = blended[0].planes();
        for plane in blended[1].planes() {
            assert_eq!(plane, height[0], "{mixing:?}");
        }
    }
}

#[test]
fn values_are_the_same_at_any_number_of_threads() {
    let size = [50, 34];
    let materials = [1, 2].map(|seed| material(size, seed));
    let weights = [3, 4].map(|seed| noise(size, seed));
    let layers = [0, 1].map(|index| Layer {
        maps: &materials[index],
        weight: &weights[index],
        height: None,
    });
    let run = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n_threads)
            .build();
        pool.unwrap().install(|| {
            let map = BlendMap::new(9.0).apply(&weights[0]).unwrap();
            let tile = rank_equalize(&map).unwrap();
            let how = Blend::new(Weighting::Mask { gain: 4.0 }, all_mixings()[2]);
            (blend_by_tile(&layers, &tile, &how).unwrap(), tile)
        })
    };
    let [one, two, seven] = [1, 2, 7].map(run);
    assert_eq!(one, two);
    assert_eq!(one, seven);
}

#[test]
fn value_stability_blend() {
    let size = [8, 8];
    let materials = [1, 2].map(|seed| [Map::Value(noise(size, seed))]);
    let weights = [3, 4].map(|seed| noise(size, seed));
    let heights = [5, 6].map(|seed| noise(size, seed));
    let tile = rank_equalize(&noise(size, 7)).unwrap();
    let layers = [0, 1].map(|index| Layer {
        maps: &materials[index],
        weight: &weights[index],
        height: Some(&heights[index]),
    });
    let weightings = [
        Weighting::Given,
        Weighting::Height { depth: 0.2 },
        Weighting::Mask { gain: 4.0 },
    ];
    let values = weightings.map(|weighting| {
        all_mixings().map(|mixing| {
            let how = Blend::new(weighting, mixing);
            blend_by_tile(&layers, &tile, &how).unwrap()[0].planes()[0].row(5)[3]
        })
    });
    assert_eq!(
        values,
        [
            [0.42668942, 0.38936108, 0.69494],
            [0.68887955, 0.68887955, 0.7144778],
            [0.68887955, 0.68887955, 0.67985624]
        ]
    );
}

#[test]
fn blend_refuses_layers_that_do_not_belong_together() {
    let size = [8, 8];
    let materials = [1, 2].map(|seed| material(size, seed));
    let weight = noise(size, 3);
    let kind_of = |a: &[Map], b: &[Map], weight_of_b: &Raster<f32>| {
        let layers = [(a, &weight), (b, weight_of_b)].map(|(maps, weight)| Layer {
            maps,
            weight,
            height: None,
        });
        blend(&layers, &Blend::default())
            .unwrap_err()
            .kind()
            .clone()
    };
    let [a, b] = &materials;
    let count = |what, count, needed| TileErrorKind::Count {
        what,
        count,
        needed,
    };
    let needed = "as many as the first layer has";
    assert_eq!(kind_of(a, &b[..2], &weight), count("maps", 2, needed));
    assert_eq!(kind_of(&[], &[], &weight), count("maps", 0, "at least 1"));
    let none = blend(&[], &Blend::default()).unwrap_err();
    assert_eq!(none.kind(), &count("layers", 0, "at least 1"));
    let turned = [b[0].clone(), b[2].clone(), b[1].clone()];
    assert_eq!(
        kind_of(a, &turned, &weight),
        TileErrorKind::KindMismatch { map: 1 }
    );
    let larger = material([9, 8], 4);
    for kind in [
        kind_of(a, &larger, &weight),
        kind_of(a, b, &noise([8, 9], 5)),
    ] {
        assert!(matches!(kind, TileErrorKind::Raster(_)), "{kind:?}");
    }
    let mut bad = noise(size, 6);
    bad.pixels_mut()[10] = f32::INFINITY;
    let kind = kind_of(&a[..1], &[Map::Value(bad)], &weight);
    assert!(
        matches!(
            kind,
            TileErrorKind::NotFinite {
                column: 2,
                row: 1,
                ..
            }
        ),
        "{kind:?}"
    );
}

#[cfg(feature = "serde")]
#[test]
fn options_survive_being_written_and_read() {
    let how = Blend::new(
        Weighting::Mask { gain: 4.0 },
        Mixing::Pyramid(Pyramid {
            borders: [Border::Periodic, Border::Mirror],
            ..Pyramid::default()
        }),
    );
    let hard = Blend::new(Weighting::Mask { gain: 1e9 }, Mixing::Linear);
    for how in [how, hard] {
        let text = serde_json::to_string(&how).unwrap();
        assert_eq!(serde_json::from_str::<Blend>(&text).unwrap(), how);
    }
    assert_eq!(
        serde_json::from_str::<Blend>("{}").unwrap(),
        Blend::default()
    );
    let map: BlendMap = serde_json::from_str(r#"{"contrast": 2.0}"#).unwrap();
    assert_eq!(map, BlendMap::default().with_contrast(2.0));
}

proptest! {
    #[test]
    fn blends_of_any_size_have_that_size_or_are_refused(
        width in 1_u32..12,
        height in 1_u32..12,
        levels in 0_u32..5,
        periodic in any::<[bool; 2]>(),
        seed in any::<u64>(),
    ) {
        let size = [width, height];
        let materials = [seed, seed ^ 1].map(|seed| [Map::Value(noise(size, seed))]);
        let weight = noise(size, seed ^ 2).map(|weight| weight + 0.01);
        let layers = materials.each_ref().map(|maps| Layer { maps, weight: &weight, height: None });
        let borders = periodic.map(|is| if is { Border::Periodic } else { Border::Mirror });
        for mixing in [
            Mixing::Linear,
            Mixing::KeepVariance,
            Mixing::Pyramid(Pyramid { levels, borders, ..Pyramid::default() }),
        ] {
            match blend(&layers, &Blend::new(Weighting::Given, mixing)) {
                Ok(maps) => prop_assert_eq!(maps[0].size(), size),
                Err(error) => {
                    prop_assert!(matches!(error.kind(), TileErrorKind::Wavelet(_)), "{}", error);
                    prop_assert!(matches!(mixing, Mixing::Pyramid(_)), "{}", error);
                }
            }
        }
    }
}
