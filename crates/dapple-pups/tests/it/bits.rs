//! Tests that all sampling methods, SIMD levels, numbers of threads and windows give equal bits.

use super::sets::{Case, cases, values};
use dapple_hash::Seed;
use dapple_points::{Domain, PointIdx, poisson_disk, white_noise};
use dapple_pups::Pups;
use dapple_raster::simd::for_every_level;
use dapple_raster::{Field, FieldExt as _, Raster, Window};
use glam::DVec2;

/// Returns a window across the borders of the domain.
fn window(case: &Case) -> Window {
    let Domain { origin, size, .. } = *case.points.domain();
    Window::new(origin - size * 0.3, size * 1.7, [53, 37]).unwrap()
}

fn bits(raster: &Raster<f32>) -> Vec<u32> {
    raster
        .pixels()
        .iter()
        .map(|value| value.to_bits())
        .collect()
}

#[test]
fn render_equals_sample_bit_for_bit() {
    for case in cases() {
        let texture = case.texture();
        let window = window(&case);
        let flipped = Window {
            pixel: window.pixel.map(|side| -side),
            first: [-53, -37],
            ..window
        };
        for window in [window, flipped] {
            let sampled =
                Raster::from_window(&window, |position| texture.sample(position)).unwrap();
            assert_eq!(
                bits(&texture.to_raster(&window).unwrap()),
                bits(&sampled),
                "{}",
                case.name
            );
        }
    }
}

#[test]
fn strongest_points_are_the_same_through_both_doors() {
    for case in cases() {
        let pups = case.pups();
        let window = window(&case);
        let labels: Vec<PointIdx> = case.points.iter().map(|(point, _)| point).collect();
        let sampled =
            Raster::from_window(&window, |position| pups.strongest(position).unwrap()).unwrap();
        assert_eq!(
            pups.label_raster(&window, &labels).unwrap(),
            sampled,
            "{}",
            case.name
        );
    }
}

#[test]
fn vectors_are_scalars_side_by_side() {
    for case in cases() {
        // Numbers are drawn three or one at a time.
        vectors_are_scalars::<1>(&case);
        vectors_are_scalars::<2>(&case);
        vectors_are_scalars::<3>(&case);
        vectors_are_scalars::<5>(&case);
    }
}

fn vectors_are_scalars<const N: usize>(case: &Case) {
    let pups = case.pups();
    let scalars = case.values();
    let vectors: Vec<[f32; N]> = scalars
        .iter()
        .map(|&value| {
            core::array::from_fn(|channel| {
                [value, 1.0 - value, value * value][channel % 3] + channel as f32
            })
        })
        .collect();
    let window = window(case);
    let texture = pups.vector_texture(vectors.clone()).unwrap();
    let raster = texture.to_raster(&window).unwrap();
    for channel in 0..N {
        let column = vectors.iter().map(|vector| vector[channel]).collect();
        let expected = pups.texture(column).unwrap().to_raster(&window).unwrap();
        assert_eq!(
            bits(&raster.map(|vector| vector[channel])),
            bits(&expected),
            "{}, {channel} of {N}",
            case.name
        );
    }
    let vector = texture.sample(window.position(9, 8));
    assert_eq!(vector, raster.row(8)[9], "{}", case.name);
}

#[test]
fn every_simd_level_gives_the_same_bits() {
    for case in cases() {
        let texture = case.texture();
        let window = window(&case);
        let reference = bits(&texture.to_raster(&window).unwrap());
        for_every_level(|level| {
            let raster = texture.to_raster(&window).unwrap();
            assert_eq!(bits(&raster), reference, "{} at {level:?}", case.name);
        });
    }
}

#[test]
fn supports_of_any_size_in_pixels_give_the_bits_of_single_positions() {
    let points = poisson_disk(Domain::paper_torus(), 0.25, Seed(11)).unwrap();
    let texture = Pups::delaunay(&points)
        .unwrap()
        .texture(values(points.len()))
        .unwrap();
    // Supports are some 3, 19 and 150 pixels wide: few tiles, many small ones, and many large ones.
    for side in [12, 75, 600] {
        let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [side, side / 2]).unwrap();
        let sampled = Raster::from_window(&window, |position| texture.sample(position)).unwrap();
        for_every_level(|level| {
            let raster = texture.to_raster(&window).unwrap();
            assert_eq!(bits(&raster), bits(&sampled), "side {side} at {level:?}");
        });
    }
}

#[test]
fn windows_are_crops_of_the_whole() {
    for case in cases() {
        let texture = case.texture();
        let whole = window(&case);
        let all = texture.to_raster(&whole).unwrap();
        for (first, size) in [
            ([0, 0], [1, 1]),
            ([5, 3], [17, 30]),
            ([40, 0], [13, 37]),
            ([1, 36], [52, 1]),
        ] {
            let part = whole.crop(first.map(i64::from), size).unwrap();
            let crop = all.crop(first, size).unwrap();
            assert_eq!(
                bits(&texture.to_raster(&part).unwrap()),
                bits(&crop),
                "{}",
                case.name
            );
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let points = poisson_disk(Domain::paper_torus(), 0.05, Seed(1)).unwrap();
    let texture = Pups::delaunay(&points)
        .unwrap()
        .texture(values(points.len()))
        .unwrap();
    let window = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [200, 150]).unwrap();
    let rendered = [1, 2, 7].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        bits(&pool.install(|| texture.to_raster(&window)).unwrap())
    });
    assert_eq!(rendered[0], rendered[1]);
    assert_eq!(rendered[0], rendered[2]);
}

#[test]
fn a_torus_repeats_exactly() {
    let points = poisson_disk(Domain::paper_torus(), 0.2, Seed(2)).unwrap();
    let texture = Pups::delaunay(&points)
        .unwrap()
        .texture(values(points.len()))
        .unwrap();
    let tile = Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [32, 64]).unwrap();
    let tiled = texture.to_raster(&tile).unwrap().tile([3, 2]).unwrap();
    let wide = tile.crop([-32, 64], [96, 128]).unwrap();
    assert_eq!(bits(&texture.to_raster(&wide).unwrap()), bits(&tiled));
}

#[test]
fn far_from_the_origin_the_picture_is_as_sharp() {
    let near = poisson_disk(Domain::torus(DVec2::ZERO, DVec2::splat(64.0)), 5.0, Seed(3)).unwrap();
    let far = DVec2::new(1e9, -3e9);
    let moved = near
        .positions()
        .iter()
        .map(|&position| position + far)
        .collect();
    let moved =
        dapple_points::PointSet::new(Domain::torus(far, DVec2::splat(64.0)), moved).unwrap();
    let [near, far] = [&near, &moved].map(|points| {
        let texture = Pups::delaunay(points)
            .unwrap()
            .texture(values(points.len()))
            .unwrap();
        let domain = points.domain();
        texture
            .to_raster(&Window::new(domain.origin, domain.size, [64, 64]).unwrap())
            .unwrap()
    });
    // Moving the points rounds their positions to 5e-7; values change by up to about 1 per unit.
    let off = near
        .zip_map(&far, |a, b| (a - b).abs())
        .unwrap()
        .statistics()
        .max;
    assert!(off < 5e-6, "off by {off}");
}

#[test]
fn value_stability_texture() {
    let points = white_noise(Domain::paper_torus(), 40, Seed(4)).unwrap();
    let texture = Pups::delaunay(&points)
        .unwrap()
        .texture(values(points.len()))
        .unwrap();
    let sampled = [0.0, 0.3, -0.7].map(|x| texture.sample(DVec2::new(x, 0.1)).to_bits());
    assert_eq!(sampled, [1053576653, 1056549107, 1060078959]);
}
