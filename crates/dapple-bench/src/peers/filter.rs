//! Runs the Gaussian blur of the crate `image`.

use texture_synthesis::image::{ImageBuffer, Luma, imageops};

/// A gray image.
pub(crate) type Gray = ImageBuffer<Luma<f32>, Vec<f32>>;

/// Creates a square gray image from its values, row by row.
pub(crate) fn image<'a>(side: u32, values: impl Iterator<Item = &'a f32>) -> Gray {
    let mut values = values.copied();
    Gray::from_fn(side, side, |_, _| Luma([values.next().unwrap_or(0.0)]))
}

/// Blurs an image with a Gaussian of the standard deviation `radius`, in pixels.
pub(crate) fn image_blur(image: &Gray, radius: f32) -> Vec<f32> {
    imageops::blur(image, radius).into_raw()
}
