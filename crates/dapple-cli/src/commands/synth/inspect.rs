//! Writes diagnostic images of a texture in the plane, which show its pieces, its differences from the example, and its
//! source examples.

use super::options::PlaneArgs;
use super::reading::Input;
use crate::encode::Format;
use crate::job::Job;
use crate::output::{OutputIdx, Target};
use anyhow::Result;
use dapple::color::LinearRgb;
use dapple::hash::{Seed, hash2};
use dapple::synth::PlaneTexture;
use dapple::tile::Map;

/// Gain applied to differences in the diagnostic image, so that a quarter of the maximum difference is white.
const LIGHTER: f32 = 4.0;

/// A kind of diagnostic image.
#[derive(Clone, Copy, Debug)]
enum View {
    Pieces,
    Differences,
    Origins,
}

/// A requested diagnostic image and its output file.
#[derive(Debug)]
pub(super) struct Inspection {
    view: View,
    output: OutputIdx,
    format: Format,
}

/// Claims the files of all requested diagnostic images.
pub(super) fn claim(args: &PlaneArgs, job: &mut Job<'_>) -> Result<Vec<Inspection>> {
    let mut inspections = Vec::new();
    for (view, path) in [
        (View::Pieces, &args.pieces),
        (View::Differences, &args.differences),
        (View::Origins, &args.origins),
    ] {
        if let Some(path) = path {
            let target = Target::from(path.as_path());
            inspections.push(Inspection {
                view,
                format: Format::choose(None, &target, Format::Png8)?,
                output: job.claim(&target)?,
            });
        }
    }
    Ok(inspections)
}

impl Inspection {
    /// Writes the diagnostic image. `last` is the index of the last example.
    pub(super) fn write(
        &self,
        texture: &PlaneTexture,
        input: &Input,
        last: usize,
        job: &mut Job<'_>,
    ) -> Result<()> {
        let map = match self.view {
            View::Pieces => Map::Color(texture.pieces()?.map(|&piece| color_of(piece))),
            View::Differences => {
                let differences = texture.differences(&input.exemplar)?;
                Map::Value(differences.map(|difference| LIGHTER * difference))
            }
            View::Origins => {
                let origin = |&source: &[u32; 2]| {
                    let image = input.layout.image_at(source).unwrap_or(0);
                    image as f32 / last.max(1) as f32
                };
                Map::Value(texture.sources().map(origin))
            }
        };
        job.write_map(self.output, &map, self.format)
    }
}

/// Returns a pseudorandom color for a piece.
fn color_of(piece: u32) -> LinearRgb {
    let bits = hash2(Seed(0), [i64::from(piece), 0], 0);
    LinearRgb::from_srgb([0, 8, 16].map(|shift| (bits >> shift) as u8))
}
