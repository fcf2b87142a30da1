//! Writes one image with lit previews of all baked recipes.

use super::FOLDER_HINT;
use crate::args::OutputArgs;
use crate::encode::Format;
use crate::error::{Hint, usage};
use crate::job::{Context, Job};
use crate::output::{OutputIdx, Target};
use anyhow::Result;
use dapple::color::{LinearRgb, TextureRaster};
use dapple::raster::Raster;
use dapple::tile::Map;
use serde_json::Value;

/// Width of the border around each preview, in pixels.
const GAP: u32 = 8;

/// Previews of the recipes baked so far, and the claimed file of their sheet.
pub(super) struct ContactSheet<'a> {
    job: Job<'a>,
    output: OutputIdx,
    previews: Vec<Raster<LinearRgb>>,
}

impl<'a> ContactSheet<'a> {
    /// Claims `contact_sheet.png` in the output directory.
    ///
    /// # Errors
    ///
    /// If the output is not a directory, or the file exists and must not be replaced.
    pub(super) fn claim(files: &'a OutputArgs, context: &'a Context) -> Result<Self> {
        let Some(folder) = files.folder(2) else {
            return Err(usage("a contact sheet needs a folder").hint(FOLDER_HINT));
        };
        let mut job = Job::new(context, "bake", files);
        let output = job.claim(&Target::Path(folder.join("contact_sheet.png")))?;
        Ok(Self {
            job,
            output,
            previews: Vec::new(),
        })
    }

    /// Adds a preview at half of its size.
    ///
    /// # Errors
    ///
    /// Same as [`mip_levels`](TextureRaster::mip_levels).
    pub(super) fn add(&mut self, preview: &Raster<LinearRgb>) -> Result<()> {
        let half = preview.mip_levels()?.into_iter().nth(1);
        self.previews.extend(half);
        Ok(())
    }

    /// Writes the sheet: rows of previews in the order in which they were added. Without previews, writes nothing.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub(super) fn write(mut self) -> Result<()> {
        if self.previews.is_empty() {
            return Ok(());
        }
        let sheet = arranged(&self.previews)?;
        self.job
            .write_map(self.output, &Map::Color(sheet), Format::Png8)?;
        self.job.finish(&Value::Null, Value::Null)
    }
}

/// Returns a roughly square grid of images of the same size, on a gray background.
fn arranged(images: &[Raster<LinearRgb>]) -> Result<Raster<LinearRgb>> {
    let count = images.len() as u32;
    let columns = (1..)
        .find(|&columns| columns * columns >= count)
        .unwrap_or(1);
    let rows = count.div_ceil(columns);
    let [width, height] = images[0].size().map(|side| side + GAP);
    let size = [columns * width + GAP, rows * height + GAP];
    Ok(Raster::from_fn(size, |x, y| {
        // Find the image of the grid's cell, and the position in it; gaps belong to no image.
        let (x, y) = (x.checked_sub(GAP), y.checked_sub(GAP));
        let color = x.zip(y).and_then(|(x, y)| {
            let index = (y / height * columns + x / width) as usize;
            let image = images.get(index)?;
            let row = (y % height < height - GAP).then(|| image.row(y % height))?;
            row.get((x % width) as usize).copied()
        });
        color.unwrap_or(LinearRgb::gray(0.5))
    })?)
}

#[cfg(test)]
mod tests {
    use super::{GAP, arranged};
    use dapple::color::LinearRgb;
    use dapple::raster::Raster;

    #[test]
    fn images_are_in_rows_with_gaps_around_them() {
        let image = |shade: f32| Raster::from_fn([3, 2], |_, _| LinearRgb::gray(shade)).unwrap();
        let sheet = arranged(&[0.1, 0.2, 0.3].map(image)).unwrap();
        assert_eq!(sheet.size(), [2 * 3 + 3 * GAP, 2 * 2 + 3 * GAP]);
        let at = |x: u32, y: u32| sheet.row(y)[x as usize].r;
        let (second, below) = (3 + 2 * GAP, 2 + 2 * GAP);
        assert_eq!(
            [at(GAP, GAP), at(second, GAP), at(GAP, below)],
            [0.1, 0.2, 0.3]
        );
        assert_eq!(
            [
                at(0, 0),
                at(GAP + 3, GAP),
                at(GAP, GAP + 2),
                at(second, below)
            ],
            [0.5; 4]
        );
    }
}
