//! Stripes along a direction field, with measured directions and widths.

use super::*;
use crate::shapes::{cap, synthesizer};
use crate::{Edges, Matching, bake_values};
use core::f32::consts::FRAC_PI_2;
use dapple_raster::RasterError;

/// The period of the stripes, in rows.
const PERIOD: u32 = 8;
const SIZE: [u32; 2] = [72, 60];

fn stripes() -> Raster<f32> {
    let light = |_, y| 0.5 + 0.5 * libm::sinf(core::f32::consts::TAU * y as f32 / PERIOD as f32);
    Raster::from_fn([32, 32], light).unwrap()
}

fn filled(value: f32) -> Raster<f32> {
    Raster::filled(SIZE, value).unwrap()
}

fn along(directions: &Raster<f32>, scales: &Raster<f32>) -> Result<PlaneAlong, SynthError> {
    along_with(directions, PlaneScales::Plane(scales))
}

fn along_with(directions: &Raster<f32>, scales: PlaneScales<'_>) -> Result<PlaneAlong, SynthError> {
    let exemplar = Exemplar::from_planes(&[(&stripes(), 1.0)], Edges::Wrap)?;
    let options = Options {
        n_levels: 2,
        ..Options::default()
    };
    let go_on = |_| ControlFlow::Continue(());
    synthesize_plane_along(&exemplar, directions, scales, &options, go_on)
}

fn image(along: &PlaneAlong) -> Raster<f32> {
    bake_values(&along.synthesizer, &along.texture, &stripes(), &along.atlas).unwrap()
}

/// Number of crossings of the value 0.5 per pixel, along the rows or the columns of a part of an image.
fn passes(image: &Raster<f32>, from: [u32; 2], until: [u32; 2], axis: usize) -> f64 {
    let (mut count, mut all) = (0.0, 0.0);
    for y in from[1]..until[1] - 1 {
        for x in from[0]..until[0] - 1 {
            let here = image.row(y)[x as usize];
            let next = match axis {
                0 => image.row(y)[x as usize + 1],
                _ => image.row(y + 1)[x as usize],
            };
            count += f64::from(u8::from((here > 0.5) != (next > 0.5)));
            all += 1.0;
        }
    }
    count / all
}

#[test]
fn stripes_follow_directions_and_scales() {
    let down = image(&along(&filled(0.0), &filled(1.0)).unwrap());
    let right = image(&along(&filled(FRAC_PI_2), &filled(1.0)).unwrap());
    let wide = image(&along(&filled(-FRAC_PI_2), &filled(2.0)).unwrap());
    for (name, image, axis, period) in [
        ("down", down, 1, 8.0),
        ("right", right, 0, 8.0),
        ("wide", wide, 0, 16.0),
    ] {
        let [along, across] = [axis, 1 - axis].map(|axis| passes(&image, [4; 2], [68, 56], axis));
        assert!(
            (along * period / 2.0 - 1.0).abs() < 0.15,
            "{name}: {along} passes a pixel"
        );
        assert!(across < 0.3 * along, "{name}: {across} beside {along}");
    }
}

#[test]
fn stripes_grow_with_the_scale() {
    let scales = Raster::from_fn(SIZE, |x, _| 1.0 + x as f32 / 72.0).unwrap();
    let image = image(&along(&filled(0.0), &scales).unwrap());
    for (from, until) in [(0, 18), (27, 45), (54, 72)] {
        let period = 8.0 * (1.0 + f64::from(from + until) / 144.0);
        let found = passes(&image, [from, 2], [until, 58], 1);
        assert!(
            (found * period / 2.0 - 1.0).abs() < 0.25,
            "from {from}: {found} passes a pixel"
        );
    }
}

#[test]
fn scales_along_rays_are_as_large_as_they_are_far_from_the_middle() {
    let rays =
        Raster::from_fn(SIZE, |x, y| libm::atan2f(x as f32 + 60.5, y as f32 - 29.5)).unwrap();
    let along = along_with(&rays, PlaneScales::Conformal([0.25, 4.0])).unwrap();
    let positions = along.synthesizer.hierarchy().sites().positions();
    let ratios = positions.iter().enumerate().map(|(site, at)| {
        let distance = at.distance(DVec3::new(-60.0, -30.0, 0.0));
        f64::from(along.synthesizer.scale(site)) / distance
    });
    let (least, most) = ratios.fold((f64::INFINITY, 0.0_f64), |(least, most), ratio| {
        (least.min(ratio), most.max(ratio))
    });
    assert!(most < 1.15 * least, "{least} to {most} for a pixel");
}

#[test]
fn scales_of_one_are_as_none() {
    let plain = synthesizer(cap(), 1500, |_, _| DVec3::NEG_Y);
    let scaled = plain.clone().with_scales(vec![1.0; 1500]).unwrap();
    let exemplar = Exemplar::from_planes(&[(&stripes(), 1.0)], Edges::Wrap).unwrap();
    for matching in [Matching::Colors, Matching::Appearance] {
        let options = Options {
            n_levels: 2,
            matching,
            ..Options::default()
        };
        let [plain, scaled] = [&plain, &scaled].map(|sites| {
            let texture = sites.synthesize(&exemplar, &options).unwrap();
            let atlas = Atlas::uniform(sites.surface(), 256).unwrap();
            (
                bake_values(sites, &texture, &stripes(), &atlas).unwrap(),
                texture,
            )
        });
        assert_eq!(plain, scaled, "{matching:?}");
    }
}

#[test]
fn bad_fields_are_refused() {
    let other = Raster::filled([72, 61], 1.0).unwrap();
    assert!(along(&filled(0.0), &other).is_err(), "sizes");
    for angle in [f32::NAN, f32::INFINITY] {
        assert!(
            along(&filled(angle), &filled(1.0)).is_err(),
            "an angle of {angle}"
        );
    }
    for scale in [0.0, -1.0, 0.124, 8.01, f32::NAN, f32::INFINITY] {
        assert!(
            along(&filled(0.0), &filled(scale)).is_err(),
            "a scale of {scale}"
        );
    }
    let plain = synthesizer(cap(), 200, |_, _| DVec3::NEG_Y);
    assert!(
        plain.clone().with_scales(vec![1.0; 199]).is_err(),
        "too few"
    );
    for bounds in [
        [0.1, 1.0],
        [1.0, 9.0],
        [1.0, 0.5],
        [f32::NAN, 1.0],
        [1.0, f32::NAN],
    ] {
        assert!(
            plain.clone().with_conformal_scales(bounds).is_err(),
            "{bounds:?}"
        );
    }
    let none: Result<Raster<f32>, RasterError> = Raster::filled([0, 0], 0.0);
    if let Ok(none) = none {
        assert!(along(&none, &none).is_err(), "no pixels");
    }
}
