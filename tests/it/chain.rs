//! Checks the whole chain, from a seed through points, graph and texture to the bytes of a file.

use crate::with_threads;
use dapple_hash::{Seed, hash2, unit_f32, unit_f64};
use dapple_image::{Transfer, encode_png};
use dapple_points::{Domain, PointSet};
use dapple_pups::{Pups, Texture};
use dapple_raster::{Field, Window, glam::DVec2};

/// Builds a texture from 200 random points on the unit torus, with random values.
fn texture(seed: Seed) -> Texture {
    let unit = |index: u32, purpose| unit_f64(hash2(seed, [i64::from(index), 0], purpose));
    let positions = (0..200)
        .map(|index| DVec2::new(unit(index, 0), unit(index, 1)))
        .collect();
    let points = PointSet::new(Domain::torus(DVec2::ZERO, DVec2::ONE), positions)
        .expect("points of the torus");
    let values = (0..200).map(|index| unit_f32(hash2(seed, [index, 1], 2) as u32));
    let pups = Pups::delaunay(&points).expect("a net");
    pups.texture(values.collect())
        .expect("a value for each point")
}

fn file(texture: &Texture, window: &Window) -> Vec<u8> {
    let raster = texture.to_raster(window).expect("a picture");
    let codes = raster.map(|&value| (value * 65535.0 + 0.5).floor() as u16);
    encode_png(codes.view(), Transfer::Data).expect("a file")
}

#[test]
fn files_are_identical_for_any_number_of_threads() {
    let window = Window::unit([200, 150]).expect("a window");
    let chain = || file(&texture(Seed(3)), &window);
    let expected = with_threads(1, chain);
    for n in [2, 7] {
        assert_eq!(with_threads(n, chain), expected, "with {n} threads");
    }
}

#[test]
fn windows_are_crops_of_the_whole_bit_for_bit() {
    let texture = texture(Seed(4));
    let whole = Window::unit([128, 96]).expect("a window");
    let part = whole.crop([37, 11], [50, 60]).expect("a part");
    let cut = texture
        .to_raster(&whole)
        .expect("a picture")
        .crop([37, 11], [50, 60])
        .expect("a crop");
    assert_eq!(texture.to_raster(&part).expect("a picture"), cut);
}

#[test]
fn another_seed_gives_another_file() {
    let window = Window::unit([32, 32]).expect("a window");
    let [a, b] = [5, 6].map(|seed| file(&texture(Seed(seed)), &window));
    assert_ne!(a, b);
}
