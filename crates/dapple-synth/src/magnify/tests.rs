//! Tests magnification on the unit square, where the position in the exemplar is known for each texel.

use super::*;
use crate::detail::Detail;
use crate::places::Places;
use crate::shapes::{square, synthesizer};
use crate::{Edges, Exemplar, Options, Sources, SurfaceTexture, bake_colors, bake_values};
use dapple_color::LinearRgb;
use dapple_hash::{Seed, hash2, unit_f32};
use glam::DVec3;

/// Number of sites on the square; the spacing is 1/36.
const N: usize = 1500;
/// Side of exemplars, in pixels.
const SIDE: u32 = 48;

/// Returns the unit square with sites whose down direction is the map's.
fn plane(n_sites: usize) -> Synthesizer {
    synthesizer(square(), n_sites, |_, _| DVec3::NEG_Y)
}

/// Returns the atlas of the square as a single chart.
fn atlas(plane: &Synthesizer, side: u32) -> Atlas {
    let mesh = plane.surface().mesh();
    let uv = |at: DVec3| DVec2::new(at.x, 1.0 - at.y);
    let faces = mesh.faces().iter();
    let uvs: Vec<_> = faces
        .map(|face| face.map(|vertex| uv(mesh.positions()[vertex.index()])))
        .collect();
    Atlas::from_uvs(plane.surface(), &uvs, [side; 2], 0).unwrap()
}

/// Returns the position in an exemplar for a position on the square, whose upper left corner is at (2, 2).
fn place(plane: &Synthesizer, at: DVec3) -> Vec2 {
    let spacing = plane.hierarchy().levels()[0].spacing();
    Vec2::new(
        (at.x / spacing) as f32 + 2.0,
        ((1.0 - at.y) / spacing) as f32 + 2.0,
    )
}

/// Returns a texture whose sources are the pixels at the positions that `source` returns for the sites' own positions.
fn texture(plane: &Synthesizer, edges: Edges, source: impl Fn(Vec2) -> Vec2) -> SurfaceTexture {
    let image = Raster::filled([SIDE; 2], 0.0).unwrap();
    let exemplar = Exemplar::from_planes(&[(&image, 1.0)], edges).unwrap();
    let positions = plane.hierarchy().sites().positions().iter();
    let pixel = |&at: &DVec3| {
        let [x, y] = source(place(plane, at)).round().to_array();
        let [x, y] = [x, y].map(|at| (at as i32).rem_euclid(SIDE as i32) as u32);
        y * SIDE + x
    };
    let sources: Vec<u32> = positions.map(pixel).collect();
    let frames = Frames::new(plane, &[]);
    let places = Places::new(plane.hierarchy(), &frames, &exemplar, &sources);
    SurfaceTexture::new(&exemplar.pyramid(1).unwrap(), vec![sources], Some(places))
}

/// Returns the same texture with whole pixels as sources.
fn with_pixels(texture: &SurfaceTexture) -> SurfaceTexture {
    let mut texture = texture.clone();
    texture.places = None;
    texture
}

fn deviation(values: &[f32]) -> f64 {
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>();
    let n = values.len() as f64;
    let middle = mean(&mut values.iter().map(|&value| f64::from(value))) / n;
    let squares = &mut values
        .iter()
        .map(|&value| (f64::from(value) - middle) * (f64::from(value) - middle));
    (mean(squares) / n).sqrt()
}

#[test]
fn averaged_sources_are_where_the_sites_are() {
    let plane = plane(N);
    for edges in [Edges::Cut, Edges::Wrap] {
        // Positions past the lower right corner of an exemplar that wraps.
        let shift = if edges == Edges::Wrap { 30.0 } else { 0.0 };
        let texture = texture(&plane, edges, |place| place + shift);
        let places = texture.places.unwrap();
        let positions = plane.hierarchy().sites().positions();
        let off = places.of_site.iter().zip(positions).map(|(&found, &at)| {
            let off = places.difference(found, place(&plane, at) + shift);
            f64::from(off.length_squared())
        });
        let off = (off.sum::<f64>() / N as f64).sqrt();
        // Whole pixels would be off by the square root of a sixth, 0.41.
        assert!(off < 0.15, "{edges:?}: {off}");
    }
}

#[test]
fn texels_show_the_exemplar_between_its_pixels() {
    let plane = plane(N);
    let atlas = atlas(&plane, 150);
    let texture = texture(&plane, Edges::Cut, |place| place);
    let wave = |at: Vec2| libm::sinf(1.3 * at.x + 0.4 * at.y);
    let map = Raster::from_fn([SIDE; 2], |x, y| wave(Vec2::new(x as f32, y as f32))).unwrap();
    let [sharp, mixed] = [&texture, &with_pixels(&texture)].map(|texture| {
        let baked = bake_values(&plane, texture, &map, &atlas).unwrap();
        let off = (0..150 * 150).map(|at: u32| {
            let texel = [at % 150, at / 150];
            let point = atlas.point(plane.surface(), texel).unwrap();
            let want = wave(place(&plane, plane.surface().position(point)));
            f64::from((baked.row(texel[1])[texel[0] as usize] - want).abs())
        });
        off.sum::<f64>() / (150.0 * 150.0)
    });
    assert!(sharp < 0.1, "off by {sharp}");
    assert!(sharp < 0.4 * mixed, "off by {sharp} and {mixed}");
}

#[test]
fn border_of_two_pieces_is_a_third_of_a_pixel_wide() {
    let plane = plane(N);
    let atlas = atlas(&plane, 288);
    let shifted = |place: Vec2| {
        if place.x < 20.0 {
            place
        } else {
            place + Vec2::new(8.0, 0.0)
        }
    };
    let texture = texture(&plane, Edges::Cut, shifted);
    let map = Raster::from_fn([SIDE; 2], |x, _| f32::from(x > 24)).unwrap();
    let [sharp, mixed] = [&texture, &with_pixels(&texture)].map(|texture| {
        let baked = bake_values(&plane, texture, &map, &atlas).unwrap();
        let between = baked
            .pixels()
            .iter()
            .filter(|value| (0.05..0.95).contains(*value));
        // Eight texels per pixel, and a border of 36 pixels.
        between.count() as f64 / (64.0 * 36.0)
    });
    assert!(sharp < 0.35, "{sharp} pixels wide");
    assert!(mixed > 0.6, "{mixed} pixels wide");
}

#[test]
fn larger_map_shows_its_detail() {
    let plane = plane(N);
    let atlas = atlas(&plane, 8 * 36);
    let texture = texture(&plane, Edges::Wrap, |place| place);
    // Two waves per pixel of the exemplar.
    let wave = |x, _| libm::sinf(x as f32 * core::f32::consts::FRAC_PI_2);
    let map = Raster::from_fn([8 * SIDE; 2], wave).unwrap();
    let baked = bake_values(&plane, &texture, &map, &atlas).unwrap();
    let kept = deviation(baked.pixels()) / deviation(map.pixels());
    assert!((0.85..1.1).contains(&kept), "{kept} of the deviation");
    let other = Raster::filled([SIDE, 2 * SIDE], 0.0).unwrap();
    let refused = bake_values(&plane, &texture, &other, &atlas).unwrap_err();
    let message =
        "a map has 48 x 96 pixels, which is not the 48 x 48 of the exemplar times a whole number";
    assert_eq!(refused.to_string(), message);
}

#[test]
fn texels_larger_than_pixels_show_means() {
    let plane = plane(N);
    let texture = texture(&plane, Edges::Wrap, |place| place);
    let map = Raster::from_fn([SIDE; 2], |x, y| ((x + y) % 2) as f32).unwrap();
    let baked = bake_values(&plane, &texture, &map, &atlas(&plane, 8)).unwrap();
    assert!(
        baked
            .pixels()
            .iter()
            .all(|value| (value - 0.5).abs() < 0.01),
        "{baked:?}"
    );
}

/// Returns noise with features of a few pixels.
fn noise(side: u32) -> Raster<f32> {
    let at = |x: u32, y: u32| unit_f32((hash2(Seed(5), [x.into(), y.into()], 0) >> 32) as u32);
    let image = Raster::from_fn([side; 2], at).unwrap();
    let exemplar = Exemplar::from_planes(&[(&image, 1.0)], Edges::Wrap).unwrap();
    Raster::from_vec(
        [side; 2],
        exemplar.pyramid(1).unwrap().blurred(0.3).levels()[0]
            .pixels()
            .to_vec(),
    )
    .unwrap()
}

/// Returns the gradient lengths that half, a tenth and a hundredth of the pixels exceed.
fn gradients(image: &Raster<f32>) -> [f32; 3] {
    let [width, height] = image.size();
    let mut lengths: Vec<f32> = (1..height - 1)
        .flat_map(|y| (1..width as usize - 1).map(move |x| (x, y)))
        .map(|(x, y)| {
            let across = image.row(y)[x + 1] - image.row(y)[x - 1];
            let down = image.row(y + 1)[x] - image.row(y - 1)[x];
            (across * across + down * down).sqrt()
        })
        .collect();
    lengths.sort_unstable_by(f32::total_cmp);
    [2, 10, 100].map(|part| lengths[lengths.len() - lengths.len() / part])
}

#[test]
fn bake_is_as_sharp_as_the_exemplar() {
    let plane = plane(4000);
    let image = noise(32);
    let exemplar = Exemplar::from_planes(&[(&image, 1.0)], Edges::Wrap).unwrap();
    // Three texels per pixel.
    let side = (3.0 / plane.hierarchy().levels()[0].spacing()) as u32;
    let atlas = atlas(&plane, side);
    let detail = Detail::new(image.map(|&value| [value]), [32; 2], Edges::Wrap).unwrap();
    let enlarged = Raster::from_fn([96; 2], |x, y| {
        detail.sample(Vec2::new(x as f32, y as f32) / 3.0, 1.0 / 3.0)[0]
    });
    let want = gradients(&enlarged.unwrap());
    let ratios = [Sources::SubPixel, Sources::Pixel].map(|sources| {
        let options = Options {
            n_levels: 2,
            sources,
            ..Options::default()
        };
        let texture = plane.synthesize(&exemplar, &options).unwrap();
        let baked = bake_values(&plane, &texture, &image, &atlas).unwrap();
        let found = gradients(&baked);
        let kept = deviation(baked.pixels()) / deviation(image.pixels());
        ([0, 1, 2].map(|at| found[at] / want[at]), kept)
    });
    let [(sharp, kept), (mixed, mixed_kept)] = ratios;
    let near = |ratio: &f32| (0.9..1.1).contains(ratio);
    assert!(sharp[..2].iter().all(near), "{ratios:?}");
    // Pieces of noise do not fit together: the largest gradients are at their borders.
    assert!((0.9..1.3).contains(&sharp[2]), "{ratios:?}");
    assert!(kept > 0.95, "{ratios:?}");
    assert!(mixed[0] < 0.88 && mixed_kept < 0.9, "{ratios:?}");
}

#[test]
fn value_stability_magnify() {
    let plane = plane(N);
    let texture = texture(&plane, Edges::Wrap, |place| place * 0.9);
    let baked = bake_values(&plane, &texture, &noise(SIDE), &atlas(&plane, 90)).unwrap();
    let texels = [[3, 5], [40, 41], [88, 30]].map(|[x, y]: [u32; 2]| baked.row(y)[x as usize]);
    assert_eq!(
        texels.map(f32::to_bits),
        [1_056_483_936, 1_055_914_601, 1_057_176_652]
    );
}

#[cfg(feature = "rayon")]
#[test]
fn magnified_map_has_the_same_bits_on_any_number_of_threads() {
    let plane = plane(N);
    let atlas = atlas(&plane, 90);
    let map = noise(SIDE).map(|&value| LinearRgb::gray(value));
    let [one, two, seven] = crate::shapes::on_threads(|| {
        let texture = texture(&plane, Edges::Wrap, |place| place * 0.9);
        bake_colors(&plane, &texture, &map, &atlas).unwrap()
    });
    assert_eq!(one, two, "2 threads");
    assert_eq!(one, seven, "7 threads");
}
