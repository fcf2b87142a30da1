//! Tests of properties that all recipes share: they repeat, windows equal crops, sampling methods agree, and the
//! number of threads does not matter.

use dapple_hash::Seed;
use dapple_pups::*;
use dapple_pups::{ReferenceImage, Texture};
use dapple_raster::{Field, FieldExt as _, Raster, Window};
use glam::DVec2;

/// Returns a window of `size` × `size` pixels over the paper's torus.
pub(super) fn paper_window(size: u32) -> Window {
    Window::new(DVec2::NEG_ONE, DVec2::splat(2.0), [size; 2]).unwrap()
}

/// Returns a hash of all bits of a raster.
pub(super) fn digest(raster: &Raster<f32>) -> u64 {
    raster
        .pixels()
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |state: u64, value| {
            (state ^ u64::from(value.to_bits())).wrapping_mul(0x0100_0000_01b3)
        })
}

/// Returns a reference image with a gray ramp from top to bottom and back.
pub(super) fn reference() -> ReferenceImage {
    let triangle = |row: u32| row.min(31 - row) as f32 / 15.0;
    ReferenceImage::new(Raster::from_fn([1, 32], |_, row| triangle(row)).unwrap()).unwrap()
}

fn last_iteration(seed: Seed) -> Texture {
    let textures = iterated_reference(&reference(), &IteratedOptions::default(), seed);
    textures.unwrap().remove(3)
}

/// Returns every recipe on its default domain, as a field with a name.
fn recipes(seed: Seed) -> Vec<(&'static str, Box<dyn Field>)> {
    let rescaled = OctavesOptions {
        source: OctaveSource::Rescaled,
        ..OctavesOptions::default()
    };
    vec![
        (
            "noise",
            Box::new(noise(&NoiseOptions::default(), seed).unwrap()),
        ),
        (
            "octaves",
            Box::new(octaves(&OctavesOptions::default(), seed).unwrap()),
        ),
        (
            "rescaled octaves",
            Box::new(octaves(&rescaled, seed).unwrap()),
        ),
        (
            "turbulence",
            Box::new(turbulence(&OctavesOptions::default(), seed).unwrap()),
        ),
        (
            "cells",
            Box::new(cells(&CellsOptions::default(), seed).unwrap()),
        ),
        (
            "cells of three or four",
            Box::new(cells(&CellsOptions::of_three_or_four(), seed).unwrap()),
        ),
        ("cow", Box::new(cow(&CowOptions::default(), seed).unwrap())),
        (
            "cellular noise",
            Box::new(cellular_noise(&CellularNoiseOptions::default(), seed).unwrap()),
        ),
        (
            "space giraffe",
            Box::new(space_giraffe(&SpaceGiraffeOptions::default(), seed).unwrap()),
        ),
        (
            "reference",
            Box::new(reference_texture(&reference(), &ReferenceOptions::default(), seed).unwrap()),
        ),
        ("iterated reference", Box::new(last_iteration(seed))),
    ]
}

#[test]
fn recipes_repeat_and_their_doors_agree_bit_for_bit() {
    // 64 pixels over a period of 2, so that pixels and period are dyadic and the repeat is exact.
    let window = paper_window(64);
    let next = Window::new(DVec2::new(1.0, -3.0), DVec2::splat(2.0), [64; 2]).unwrap();
    for (name, field) in recipes(Seed(3)) {
        let whole = field.to_raster(&window).unwrap();
        assert_eq!(
            digest(&whole),
            digest(&field.to_raster(&next).unwrap()),
            "{name} has a seam"
        );
        let part = field
            .to_raster(&window.crop([-9, 31], [17, 40]).unwrap())
            .unwrap();
        for (column, row) in [(0, 0), (8, 3), (9, 39), (16, 20)] {
            let position = DVec2::from(window.position(0, 0))
                + DVec2::new(f64::from(column) - 9.0, f64::from(row) + 31.0)
                    * DVec2::from(window.pixel);
            assert_eq!(
                part.row(row)[column as usize],
                field.sample(position),
                "{name}, crop"
            );
        }
        for row in 0..33 {
            let [here, there] = [&part.row(row)[9..], &whole.row(row + 31)[..8]];
            assert_eq!(here, there, "{name}, row {row} of the crop");
        }
        for (column, row) in [(0, 0), (63, 63), (17, 40), (40, 17)] {
            let sample = field.sample(window.position(column, row));
            assert_eq!(
                sample,
                whole.row(row)[column as usize],
                "{name} at {column}, {row}"
            );
        }
        assert!(
            field.sample(DVec2::NAN).is_nan(),
            "{name} has a value nowhere"
        );
    }
}

#[test]
fn recipes_are_the_same_for_any_number_of_threads() {
    let digests = || -> Vec<u64> {
        let recipes = recipes(Seed(5)).into_iter();
        recipes
            .map(|(_, field)| digest(&field.to_raster(&paper_window(64)).unwrap()))
            .collect()
    };
    let expected = digests();
    #[cfg(feature = "rayon")]
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        assert_eq!(
            pool.unwrap().install(digests),
            expected,
            "{threads} threads"
        );
    }
    let mut distinct = expected.clone();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(
        distinct.len(),
        expected.len(),
        "two recipes are the same picture"
    );
}

#[test]
fn value_stability_recipes() {
    let window = paper_window(32);
    let digest_of = |(name, field): (&'static str, Box<dyn Field>)| {
        (name, digest(&field.to_raster(&window).unwrap()))
    };
    let digests: Vec<_> = recipes(Seed(7)).into_iter().map(digest_of).collect();
    assert_eq!(
        digests,
        [
            ("noise", 3568823462909858107),
            ("octaves", 11706274319335040841),
            ("rescaled octaves", 5112517512299127254),
            ("turbulence", 11831666416403925966),
            ("cells", 4851137778972051317),
            ("cells of three or four", 17659775131150400474),
            ("cow", 2292993172515091237),
            ("cellular noise", 11005285225756051155),
            ("space giraffe", 2937035135665074981),
            ("reference", 1735835802462090021),
            ("iterated reference", 274647018259932788)
        ]
    );
}
