//! Bakes all frames of a loop into one image for each map, as a grid.

use super::claim::claim;
use super::{Made, STILL, Work};
use crate::args::{Frame, Size};
use crate::baking::{self, GridWriter, advise};
use crate::error::{Hint, usage};
use crate::job::Job;
use crate::progress::Progress;
use anyhow::Result;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::Bake;

impl Work {
    /// Bakes a grid of frames, row by row, and returns the lit preview of the first frame if the options need one. The
    /// plans of a row are in memory together.
    ///
    /// # Errors
    ///
    /// If the grid has too many pixels, the recipe is invalid, or a file cannot be written.
    pub(super) fn bake_flipbook(
        &self,
        grid: Size,
        mut job: Job<'_>,
        made: &mut Made,
        progress: &Progress,
    ) -> Result<Option<Raster<LinearRgb>>> {
        let args = &self.args;
        let Size([columns, rows]) = grid;
        let claimed = claim(args, &self.files, self, &mut job)?;
        let options = args.options(claimed.map_kinds())?;
        let frame = options.region.map_or(options.size, |region| region.size);
        let size = size_of(frame, grid)?;
        let images = args.images_of(&self.recipe, &self.folder, &mut made.images)?;
        let mut writer = GridWriter::new(&job, claimed.files(), size)?;
        let cache = made.cache.as_ref();
        let mut frames = Frame::all(args.n_frames());
        for row in 0..rows {
            let plans = frames.by_ref().take(columns as usize).map(|frame| {
                let time = frame.map_or(0.0, Frame::time);
                self.plan(images, cache, time, progress)
            });
            let plans = plans.collect::<Result<Vec<_>>>()?;
            if row == 0 && !plans[0].moves() {
                job.note_work(STILL);
            }
            let bakes = plans.iter().map(|plan| Bake::new(plan, &options));
            let bakes = bakes.collect::<Result<Vec<_>, _>>();
            let bakes = bakes.map_err(|error| advise(error).wrong_value())?;
            writer.write(bakes, progress)?;
        }
        writer.finish(&mut job, claimed.files())?;
        self.finish(args, job, &claimed, images, 0.0)
    }
}

/// Maximum number of frames in a loop, equal to the limit of `--frames`.
const MOST_FRAMES: u64 = 100_000;

/// Returns the size of a grid of frames, in pixels. `frame` is the size of a frame in pixels; `grid` is the number of
/// frames across and down.
fn size_of(frame: [u32; 2], Size(grid): Size) -> Result<[u32; 2]> {
    let [width, height] = [0, 1].map(|axis| u64::from(frame[axis]) * u64::from(grid[axis]));
    if width.saturating_mul(height) > baking::MOST_PIXELS {
        let message = format!("a flipbook of {width} × {height} pixels has more than 2^30");
        return Err(usage(message).hint("take a smaller --size, or fewer frames"));
    }
    let count = u64::from(grid[0]) * u64::from(grid[1]);
    if count > MOST_FRAMES {
        let message =
            format!("a flipbook has at most {MOST_FRAMES} frames, and {count} are too many");
        return Err(usage(message).hint("take fewer columns or rows"));
    }
    // Sides of an image of at most 2^30 pixels fit.
    Ok([width as u32, height as u32])
}
