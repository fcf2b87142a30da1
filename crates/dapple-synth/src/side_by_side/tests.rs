//! Layouts of images, and textures of them.

use super::SideBySide;
use crate::{Edges, Exemplar, Options, SynthErrorKind, synthesize_plane, synthesize_plane_guided};
use core::ops::ControlFlow;
use dapple_hash::{Seed, hash2, unit_f32};
use dapple_raster::Raster;

#[test]
fn each_image_is_at_its_place() {
    let [low, wide, high] = [[3, 2], [5, 4], [1, 6]];
    let layout = SideBySide::new(&[low, wide, high]).unwrap();
    assert_eq!(layout.size(), [3 + 1 + 5 + 1 + 1, 6]);
    let image = |size, first: u32| Raster::from_fn(size, |x, y| first + 10 * y + x).unwrap();
    let images = [image(low, 100), image(wide, 200), image(high, 300)];
    let joined = layout.join(&images.each_ref(), 7).unwrap();
    let mask = layout.mask().unwrap();
    for [x, y] in (0..6).flat_map(|y| (0..11).map(move |x| [x, y])) {
        let expected = match x {
            0..=2 if y < 2 => Some((0, 100 + 10 * y + x)),
            4..=8 if y < 4 => Some((1, 200 + 10 * y + x - 4)),
            10 => Some((2, 300 + 10 * y)),
            _ => None,
        };
        let at = format!("column {x} and row {y}");
        assert_eq!(
            layout.image_at([x, y]),
            expected.map(|(image, _)| image),
            "{at}"
        );
        assert_eq!(
            joined.row(y)[x as usize],
            expected.map_or(7, |(_, value)| value),
            "{at}"
        );
        assert_eq!(mask.row(y)[x as usize], expected.is_some(), "{at}");
        for image in 0..3 {
            let is_member = expected.is_some_and(|(of, _)| of == image);
            let membership = layout.membership(image).unwrap();
            assert_eq!(membership.row(y)[x as usize], f32::from(is_member), "{at}");
        }
    }
    assert_eq!(layout.image_at([11, 0]), None, "past the last");
}

#[test]
fn bad_images_are_refused() {
    let kind = |sizes: &[[u32; 2]]| SideBySide::new(sizes).unwrap_err().kind().clone();
    assert!(
        matches!(kind(&[]), SynthErrorKind::Count { count: 0, .. }),
        "none"
    );
    assert!(
        matches!(kind(&[[0, 4]]), SynthErrorKind::Range { .. }),
        "no columns"
    );
    assert!(
        matches!(kind(&[[u32::MAX, 4]; 2]), SynthErrorKind::Range { .. }),
        "too wide"
    );
    let layout = SideBySide::new(&[[4, 4], [2, 2]]).unwrap();
    let [large, small] = [[4, 4], [2, 2]].map(|size| Raster::filled(size, 0_u8).unwrap());
    let refused = |images: &[&Raster<u8>]| layout.join(images, 0).unwrap_err().kind().clone();
    assert!(
        matches!(refused(&[&large]), SynthErrorKind::Count { count: 1, .. }),
        "one of two"
    );
    assert!(
        matches!(refused(&[&small, &large]), SynthErrorKind::Raster(_)),
        "exchanged"
    );
}

/// A layout of two images of noise, with wide grains in one and tall grains in the other.
fn two() -> (SideBySide, Exemplar) {
    let noise = |size, grain: [u32; 2]| {
        let value = |x: u32, y: u32| {
            let place = [x / grain[0], y / grain[1]].map(i64::from);
            unit_f32((hash2(Seed(4), place, 0) >> 32) as u32)
        };
        Raster::from_fn(size, value).unwrap()
    };
    let images = [noise([40, 48], [3, 1]), noise([48, 36], [1, 3])];
    let layout = SideBySide::new(&images.each_ref().map(Raster::size)).unwrap();
    let both = layout.join(&images.each_ref(), 0.0).unwrap();
    let exemplar = Exemplar::from_planes(&[(&both, 1.0)], Edges::Cut).unwrap();
    let exemplar = exemplar.with_mask(&layout.mask().unwrap()).unwrap();
    (layout, exemplar)
}

#[test]
fn textures_have_pixels_of_all_images_and_of_nothing_between() {
    let (layout, exemplar) = two();
    let texture =
        synthesize_plane(&exemplar, [64; 2], [Edges::Wrap; 2], &Options::default()).unwrap();
    let mut counts = [0, 0];
    for &source in texture.sources().pixels() {
        counts[layout.image_at(source).unwrap()] += 1;
    }
    assert!(
        counts.iter().all(|&count| count > 64 * 64 / 8),
        "{counts:?}"
    );
}

#[test]
fn guides_choose_the_image() {
    let (layout, exemplar) = two();
    let members = [0, 1].map(|image| layout.membership(image).unwrap());
    let exemplar = exemplar
        .with_guides(&members.each_ref().map(|member| (member, 1.0)))
        .unwrap();
    let is_second = |x: u32, y: u32| x + y > 70;
    let targets = [false, true].map(|second| {
        Raster::from_fn([64; 2], |x, y| f32::from(is_second(x, y) == second)).unwrap()
    });
    let texture = synthesize_plane_guided(
        &exemplar,
        &targets.each_ref(),
        [Edges::Cut; 2],
        &Options::default(),
        |_| ControlFlow::Continue(()),
    );
    let texture = texture.unwrap();
    let places = (0..64).flat_map(|y| (0..64).map(move |x| [x, y]));
    for ([x, y], &source) in places.zip(texture.sources().pixels()) {
        let image = layout.image_at(source);
        assert_eq!(image, Some(usize::from(is_second(x, y))), "{x} {y}");
    }
}
