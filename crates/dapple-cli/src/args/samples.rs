//! Defines the option for sample positions, which are pixel centers or grid corners.

use super::Size;
use crate::error::{Hint, usage};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::raster::Named;
use dapple::recipe::Samples;
use serde::Serialize;

/// The option of all subcommands that draw or bake.
#[derive(clap::Args, Clone, Copy, Debug, Default, Serialize)]
#[group(skip)]
pub(crate) struct SamplesArgs {
    /// Sample positions: pixel centers, or corners that reach the sides of the tile, as for terrain.
    ///
    /// On corners the last column and row equal the first ones where the tile repeats.
    #[arg(long, value_name = "WHERE", value_parser = NamedValueParser::<Samples>::all(), default_value_t = Samples::Centers)]
    pub(crate) samples: Samples,
}

impl SamplesArgs {
    /// Returns the number of sample spacings from one side of the tile to the other, along each axis. It equals the
    /// number of samples for pixel centers, and is one less for corners.
    ///
    /// # Errors
    ///
    /// If a side has a single corner.
    pub(crate) fn spaces(self, size: Size) -> Result<Size> {
        if self.samples == Samples::Centers {
            return Ok(size);
        }
        if size.0.contains(&1) {
            let error = usage(format!(
                "--samples corners needs at least 2 samples along each side, and --size is {size}"
            ));
            return Err(error.hint("take 2^n + 1 of them, such as --size 1025"));
        }
        Ok(Size(size.0.map(|side| side - 1)))
    }

    /// Formats the option as a command-line argument; `None` if it has its default value.
    pub(crate) fn word(self) -> Option<String> {
        let is_default = self.samples == Samples::default();
        (!is_default).then(|| format!("--samples={}", self.samples.name()))
    }
}
