//! Defines options for reading images, such as the layer and the handling of NaN and infinite values.

use crate::words::NamedValueParser;
use dapple::raster::Named as _;
use serde::Serialize;

/// The options of subcommands that read images.
#[derive(clap::Args, Clone, Debug, Default, Serialize)]
pub(crate) struct ReadArgs {
    /// Layer to read from OpenEXR images with several, such as `ViewLayer.DiffCol`.
    ///
    /// By default the one without a name, `Combined`, `rgba` or `beauty`; of several views the first.
    #[arg(long, value_name = "NAME", hide_short_help = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) layer: Option<String>,

    /// Whether a file without the layer is refused, and not read as it is.
    #[arg(skip)]
    #[serde(skip)]
    pub(crate) needs_layer: bool,

    #[command(flatten)]
    #[serde(flatten)]
    pub(crate) finite: FiniteArgs,
}

/// The option shared by all subcommands that read images, whether given on the command line or named in a recipe.
#[derive(clap::Args, Clone, Copy, Debug, Default, Serialize)]
#[group(skip)]
pub(crate) struct FiniteArgs {
    /// Handling of OpenEXR numbers that are NaN or infinite.
    #[arg(long, value_name = "HOW", hide_short_help = true, value_parser = NamedValueParser::<NonFinite>::all(), default_value_t = NonFinite::Error)]
    pub(crate) nonfinite: NonFinite,
}

impl FiniteArgs {
    /// Formats the option as a command-line argument; `None` if it has its default value.
    pub(crate) fn word(self) -> Option<String> {
        let is_default = self.nonfinite == NonFinite::default();
        (!is_default).then(|| format!("--nonfinite={}", self.nonfinite.name()))
    }
}

dapple::raster::named! {
    /// The handling of numbers that are NaN or infinite.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub(crate) enum NonFinite {
        /// An error that names the file, the channel and the pixel.
        #[default]
        Error = "error",
        /// The mean of the finite pixels around.
        Repair = "repair",
        /// Zero.
        Zero = "zero",
    }
}
