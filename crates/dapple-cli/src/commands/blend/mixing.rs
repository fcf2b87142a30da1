//! The options for weighting and mixing in `dapple blend`.

use crate::args::Axes;
use crate::error::{Hint, usage};
use crate::node::{Flag, NodeArgs, NodeFlags};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::tile::{Blend, Mixing};
use dapple::wavelet::Border;
use serde::Serialize;

/// The options of weighting and mixing.
#[derive(clap::Args, Clone, Debug, Serialize)]
pub(super) struct MixingArgs {
    #[command(flatten)]
    #[serde(flatten)]
    node: NodeArgs<MixingFlags>,

    /// pyramid: axes along which images and result repeat [default: none, mirrored past the edges].
    #[arg(long, value_name = "AXES", value_parser = NamedValueParser::<Axes>::all(), help_heading = MixingFlags::HEADING)]
    wrap: Option<Axes>,
}

/// Marker for the flags that come from the recipe node `blend`.
#[derive(Clone, Debug)]
struct MixingFlags;

impl NodeFlags for MixingFlags {
    const KIND: &'static str = "blend";
    const HEADING: Option<&'static str> = Some("Weighting and mixing");
    const FLAGS: &'static [Flag] = &[
        Flag::new("weighting", "weighting").without_default(),
        Flag::new("weighting/height/depth", "depth").only_with("weighting", &["height"]),
        Flag::new("weighting/mask/gain", "gain").only_with("weighting", &["mask"]),
        Flag::new("mixing", "mixing"),
        Flag::new("mixing/pyramid/levels", "levels").only_with("mixing", &["pyramid"]),
        Flag::new("mixing/pyramid/sharpness", "sharpness").only_with("mixing", &["pyramid"]),
        Flag::none("layers"),
        Flag::none("mask"),
    ];
}

impl MixingArgs {
    /// Returns the blend options. The default weighting is by mask with a blend tile, otherwise by height if a layer
    /// has a height, otherwise by the given weights.
    ///
    /// # Errors
    ///
    /// If an option has no effect, or the mask weighting lacks a blend tile.
    pub(super) fn blend(&self, has_tile: bool, has_heights: bool) -> Result<Blend> {
        let given: Option<String> = self.node.get("weighting")?;
        let weighting = given.as_deref().unwrap_or(match (has_tile, has_heights) {
            (true, _) => "mask",
            (false, true) => "height",
            (false, false) => "given",
        });
        if weighting == "mask" && !has_tile {
            return Err(usage("--weighting mask needs a blend tile").hint("add --tile IMAGE"));
        }
        let mixing: String = self.node.get("mixing")?.unwrap_or_default();
        let chosen = [("weighting", weighting), ("mixing", mixing.as_str())];
        self.node.check_used("blend", &chosen)?;
        let mut blend: Blend = self.node.read(&chosen)?;
        match (&mut blend.mixing, self.wrap) {
            (Mixing::Pyramid(pyramid), Some(wrap)) => {
                pyramid.borders = wrap.choose(Border::Periodic, Border::Mirror);
            }
            (_, Some(_)) => {
                let error = usage("--wrap has no effect on this blend");
                return Err(error.hint("add --mixing pyramid"));
            }
            (_, None) => {}
        }
        Ok(blend)
    }
}
