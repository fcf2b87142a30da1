//! Estimates the work for a bake before it begins, in pixels, bytes and time.

use crate::baking::{MOST_PIXELS, advise};
use crate::error::Hint;
use crate::job::Job;
use crate::layers::Image;
use anyhow::{Result, anyhow};
use dapple::recipe::{Bake, BakeMemory, BakeOptions, Plan};
use indicatif::{DecimalBytes, HumanDuration};
use std::time::{Duration, Instant};

/// Minimum number of pixels for which the estimate is printed, which is 8192 × 8192.
const TOLD_PIXELS: u64 = 1 << 26;
/// Columns and rows of the small bake that measures the time per pixel.
const PROBE: [u32; 2] = [256; 2];

/// Prints an estimate of the work for a large bake.
///
/// # Errors
///
/// If the bake has more than [`MOST_PIXELS`] and is not banded, or if the recipe fails.
pub(crate) fn print_estimate(
    plan: &Plan,
    options: &BakeOptions,
    images: &[Image],
    job: &Job<'_>,
) -> Result<()> {
    let size = options.region.map_or(options.size, |region| region.size);
    let pixels = n_pixels(size);
    if pixels < TOLD_PIXELS {
        return Ok(());
    }
    let pace = probe(plan, options)?;
    let work = work(size, images, pace);
    if pixels > MOST_PIXELS && options.memory == BakeMemory::Whole {
        let error =
            anyhow!("without --banded at most 32768 × 32768 pixels are baked, and this is {work}");
        let hint = "add --banded to bake it anyway, or bake a part with --region";
        return Err(error.hint(hint).wrong_value());
    }
    job.note_work(&format!("baking {work}"));
    Ok(())
}

/// Returns the time per pixel, in seconds, measured with a small bake of the whole tile.
#[expect(
    clippy::disallowed_methods,
    reason = "the time is told to the user, and no value depends on it"
)]
fn probe(plan: &Plan, options: &BakeOptions) -> Result<f64> {
    let small = BakeOptions {
        size: PROBE,
        region: None,
        ..options.clone()
    };
    let start = Instant::now();
    for band in Bake::new(plan, &small).map_err(advise)? {
        band.map_err(advise)?;
    }
    Ok(start.elapsed().as_secs_f64() / n_pixels(PROBE) as f64)
}

/// Formats the estimate as text. `pace` is in seconds per pixel.
fn work([width, height]: [u32; 2], images: &[Image], pace: f64) -> String {
    let pixels = n_pixels([width, height]);
    let bytes = images.iter().map(n_bytes);
    let bytes = DecimalBytes(pixels.saturating_mul(bytes.sum()));
    let time = Duration::try_from_secs_f64(pixels as f64 * pace).unwrap_or(Duration::MAX);
    let maps = match images.len() {
        1 => "1 map".to_owned(),
        count => format!("{count} maps"),
    };
    let time = HumanDuration(time);
    format!("{maps} of {width} × {height} pixels: {bytes} before compression, about {time}")
}

fn n_pixels(size: [u32; 2]) -> u64 {
    u64::from(size[0]) * u64::from(size[1])
}

/// Returns the size of an image without compression, in bytes per pixel.
fn n_bytes(image: &Image) -> u64 {
    image.layers.n_channels() * image.format.depth().0
}

#[cfg(test)]
mod tests {
    use super::n_bytes;
    use crate::encode::Format;
    use crate::layers::{Image, Layers};
    use dapple::recipe::MapKind;

    #[test]
    fn bytes_are_those_of_all_channels() {
        let image = |kind, format| Image {
            layers: Layers::Map(kind),
            format,
        };
        assert_eq!(n_bytes(&image(MapKind::Height, Format::Png8)), 1);
        assert_eq!(n_bytes(&image(MapKind::Normal, Format::Png16)), 6);
        assert_eq!(n_bytes(&image(MapKind::Albedo, Format::Exr)), 12);
    }
}
