//! Tests of PNG files with several strips. An independent decoder must return their pixels. Their bytes must be the
//! same on any number of threads and at every SIMD level.

use dapple_image::{Limits, PngPixel, PngPixels, Transfer, decode_png, encode_png};
use dapple_raster::Raster;
use dapple_raster::simd::for_every_level;
use proptest::prelude::*;

/// Size of an image of three and a half strips, with three 16-bit samples per pixel.
const SIZE: [u32; 2] = [401, 763];

/// Returns a pseudorandom number for a pixel.
fn noise(x: u32, y: u32) -> u32 {
    let number = (x ^ y.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
    (number ^ number >> 15).wrapping_mul(0xc2b2_ae35) >> 8
}

fn encode<P: PngPixel>(raster: &Raster<P>) -> Vec<u8> {
    encode_png(raster.view(), Transfer::Data).unwrap()
}

fn decode(bytes: &[u8]) -> PngPixels {
    decode_png(bytes, &Limits::default()).unwrap().pixels
}

/// Returns the pixel of an image with all kinds of rows: noise, gradients, constant areas, and noise that repeats
/// within a row and between rows.
fn mixed(x: u32, y: u32) -> [u16; 3] {
    let noise = noise(x, y) as u16;
    match (y / 100 + x / 200) % 5 {
        0 => [noise, noise >> 4, noise >> 12],
        1 => [(x * 40) as u16, (y * 40) as u16, (x * y) as u16],
        2 => [9; 3],
        3 => [noise; 3],
        _ => [(x * 7919) as u16, 0, (y * 31) as u16],
    }
}

#[test]
fn strips_are_the_same_on_any_number_of_threads_and_at_every_level() {
    let raster = Raster::from_fn(SIZE, mixed).unwrap();
    let expected = encode(&raster);
    assert_eq!(decode(&expected), PngPixels::Rgb16(raster.clone()));
    for_every_level(|level| assert!(encode(&raster) == expected, "{level:?}"));
    for n_threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads);
        let bytes = pool.build().unwrap().install(|| encode(&raster));
        assert!(bytes == expected, "{n_threads} threads");
    }
}

#[test]
fn strips_of_eight_bits_come_back() {
    let narrow = |x, y| mixed(x, y).map(|code| (code >> 8) as u8);
    let raster = Raster::from_fn([701, 911], narrow).unwrap();
    assert_eq!(decode(&encode(&raster)), PngPixels::Rgb8(raster));
}

#[test]
fn rows_longer_than_a_strip_come_back() {
    let raster = Raster::from_fn([300_001, 3], |x, y| noise(x, y) as u16).unwrap();
    assert_eq!(decode(&encode(&raster)), PngPixels::Gray16(raster));
}

/// Tests byte frequencies that halve from one byte value to the next. The optimal codes of the rarest bytes exceed the
/// maximum code length.
#[test]
fn rare_bytes_come_back() {
    let rare = |x, y| (noise(x, y) | 1 << 20).trailing_zeros() as u8;
    let raster = Raster::from_fn([2048, 1024], rare).unwrap();
    let bytes = encode(&raster);
    // Two bits each are the least, without a filter.
    assert!(bytes.len() < 2048 * 1024 / 2, "{}", bytes.len());
    assert_eq!(decode(&bytes), PngPixels::Gray8(raster));
}

#[test]
fn flat_and_repeated_parts_take_little() {
    let flat = encode(&Raster::filled([1024, 1024], [7_u16, 500, 60_000]).unwrap());
    assert!(flat.len() < 1024 * 1024 * 6 / 100, "{} flat", flat.len());
    let gray = Raster::from_fn([512, 512], |x, y| noise(x, y) as u16).unwrap();
    let n_gray = encode(&gray).len();
    let n_color = encode(&gray.map(|&code| [code; 3])).len();
    assert!(n_color < 2 * n_gray, "{n_gray} gray, {n_color} in color");
    let n_noise = 512 * 512 * 2;
    assert!(n_gray < n_noise + n_noise / 100, "{n_gray} of {n_noise}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn runs_of_any_length_come_back(
        width in 1_u32..700,
        runs in proptest::collection::vec((any::<u16>(), 1_usize..700), 1..20),
    ) {
        let mut codes: Vec<u16> = runs.iter().flat_map(|&(code, n)| vec![code; n]).collect();
        let height = codes.len().div_ceil(width as usize);
        codes.resize(height * width as usize, 3);
        let raster = Raster::from_vec([width, height as u32], codes).unwrap();
        prop_assert_eq!(decode(&encode(&raster)), PngPixels::Gray16(raster));
    }
}
