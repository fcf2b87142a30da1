//! Rotated and mirrored images, and textures made of them.

use super::Turned;
use crate::{Edges, Endless, EndlessOptions, Exemplar, SideBySide};
use core::ops::ControlFlow;
use dapple_color::{HeightPlane, Normal, NormalOptions, normal_map};
use dapple_raster::{Named as _, Raster};
use glam::DVec2;

/// The layout of one image with its rotations and reflections.
fn layout(size: [u32; 2], turned: Turned) -> SideBySide {
    let layout = SideBySide::new(&[size]).unwrap();
    layout.with_turned(turned).unwrap()
}

#[test]
fn each_part_is_the_image_as_it_lies_there() {
    let image = Raster::from_vec([2, 3], b"abcdef".to_vec()).unwrap();
    for (turned, expected) in [
        (Turned::None, ["ab", "cd", "ef"]),
        (Turned::Mirror, ["ab ba", "cd dc", "ef fe"]),
        (
            Turned::Quarters,
            ["ab eca fe bdf", "cd fdb dc ace", "ef     ba    "],
        ),
        (
            Turned::All,
            [
                "ab eca fe bdf ba fdb ef ace",
                "cd fdb dc ace dc eca cd bdf",
                "ef     ba     fe     ab    ",
            ],
        ),
    ] {
        let layout = layout([2, 3], turned);
        let expected = expected.concat().into_bytes();
        let joined = layout.join(&[&image], b' ').unwrap();
        assert_eq!(joined.pixels(), expected, "{turned}");
        let is_image: Vec<bool> = expected.iter().map(|&letter| letter != b' ').collect();
        assert_eq!(layout.mask().unwrap().pixels(), is_image, "{turned}");
        assert_eq!(layout.size_of(0), [2, 3], "that of the image itself");
    }
}

#[test]
fn all_ways_of_an_image_belong_to_it() {
    let layout = SideBySide::new(&[[2, 3], [4, 1]]).unwrap();
    let layout = layout.with_turned(Turned::Quarters).unwrap();
    // Versions of the first image are 2, 3, 2 and 3 columns wide, those of the second 4, 1, 4 and 1, with a column
    // between each two.
    assert_eq!(layout.size(), [10 + 10 + 7, 4]);
    let first_row: Vec<_> = (0..27).map(|x| layout.image_at([x, 0])).collect();
    let first = |n| vec![Some(0); n];
    let second = |n| vec![Some(1); n];
    let expected = [
        first(2),
        first(3),
        first(2),
        first(3),
        second(4),
        second(1),
        second(4),
        second(1),
    ];
    assert_eq!(first_row, expected.join(&None));
}

#[test]
fn normals_are_those_of_turned_heights() {
    let image = Raster::from_fn([5, 7], |x, y| ((x * 7 + y * y * 3 + x * y) % 11) as f32).unwrap();
    let normals = |height: &Raster<f32>| {
        let [width, height_px] = height.size().map(f64::from);
        let plane = HeightPlane {
            extent: DVec2::new(width, height_px),
            ..HeightPlane::default()
        };
        normal_map(height, &NormalOptions::from(plane)).unwrap()
    };
    for &turned in Turned::ALL {
        let layout = layout(image.size(), turned);
        let heights = layout.join(&[&image], 0.0).unwrap();
        let joined = layout.join_normals(&[&normals(&image)]).unwrap();
        let mut first = 0;
        for turn in turned.ways() {
            let size = turn.size(image.size());
            let expected = normals(&heights.crop([first, 0], size).unwrap());
            let part = joined.crop([first, 0], size).unwrap();
            for (a, b) in part.pixels().iter().zip(expected.pixels()) {
                let apart = (a.x - b.x).abs() + (a.y - b.y).abs() + (a.z - b.z).abs();
                // Tolerance: a sum of two squares in the other order.
                assert!(apart < 1e-6, "{turned}: {a:?} and {b:?}");
            }
            first += size[0] + 1;
        }
    }
}

#[test]
fn flat_normals_of_images_are_one_color_however_turned() {
    let of_8_bits = [[127, 127], [127, 128], [128, 127], [128, 128]]
        .map(|[x, y]: [u8; 2]| Normal::from_codes([x, y, 255]));
    let of_16_bits =
        [[32767, 32768], [32768, 32768]].map(|[x, y]: [u16; 2]| Normal::from_codes([x, y, 65535]));
    for flat in of_8_bits.into_iter().chain(of_16_bits) {
        let image = Raster::filled([6, 4], flat).unwrap();
        for &turned in Turned::ALL {
            let joined = layout(image.size(), turned)
                .join_normals(&[&image])
                .unwrap();
            for normal in joined.pixels() {
                match turned {
                    // Without rotations the normals do not change; pixels between images are flat.
                    Turned::None => assert!([flat, Normal::FLAT].contains(normal)),
                    _ => {
                        assert_eq!(normal.to_codes::<u8>(), [128, 128, 255]);
                        assert_eq!(normal.to_codes::<u16>(), [32768, 32768, 65535]);
                    }
                }
            }
        }
    }
}

#[test]
fn textures_have_pixels_of_all_ways() {
    // Upright bars of unequal widths and grays.
    let image = Raster::from_fn([48, 48], |x, _| {
        [0.0, 0.9, 0.4, 0.4, 1.0][(x * x / 3 % 5) as usize]
    })
    .unwrap();
    let layout = layout(image.size(), Turned::Quarters);
    let joined = layout.join(&[&image], 0.0).unwrap();
    let exemplar = Exemplar::from_planes(&[(&joined, 1.0)], Edges::Cut).unwrap();
    let exemplar = exemplar.with_mask(&layout.mask().unwrap()).unwrap();
    let texture = Endless::new(&exemplar, &EndlessOptions::default()).unwrap();
    let window = texture.window([0; 2], [96; 2], |_| ControlFlow::Continue(()));
    let window = window.unwrap();
    let mut counts = [0; 4];
    for source in window.sources().pixels() {
        assert_eq!(layout.image_at(*source), Some(0));
        counts[(source[0] / 49) as usize] += 1;
    }
    assert!(
        counts.iter().all(|&count| count > 96 * 96 / 16),
        "{counts:?}"
    );
}
