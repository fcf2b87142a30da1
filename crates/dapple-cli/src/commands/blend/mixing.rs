//! Defines the options for weighting and mixing in `dapple blend`.

use crate::args::Axes;
use crate::error::{Hint, usage};
use crate::words::NamedValueParser;
use anyhow::Result;
use dapple::tile::{Blend, Mixing, Pyramid, Weighting};
use dapple::wavelet::Border;
use serde::Serialize;

dapple::raster::named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum WeightingName {
        /// The weights are the shares.
        Given = "given",
        /// The higher layer shows.
        Height = "height",
        /// The tile is cut at thresholds.
        Mask = "mask",
    }
}

dapple::raster::named! {
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum MixingName {
        /// The weighted mean.
        Linear = "linear",
        /// The contrast is kept; values may leave their range.
        KeepVariance = "keep-variance",
        /// In bands, with sharper transitions where details are finer.
        Pyramid = "pyramid",
    }
}

/// The options of weighting and mixing.
#[derive(clap::Args, Clone, Debug, Serialize)]
#[command(next_help_heading = "Weighting and mixing")]
pub(super) struct MixingArgs {
    /// Use of the weights; the default is described below.
    #[arg(long, value_name = "HOW", value_parser = NamedValueParser::<WeightingName>::all())]
    weighting: Option<WeightingName>,

    /// height: height difference over which layers mix, above 0: 0.1 is crisp, 0.3 soft [default: 0.2].
    #[arg(long, value_name = "N")]
    depth: Option<f64>,

    /// mask: sharpness of transitions, above 0 up to 1e9: 1 is soft, 1e9 is hard [default: 8].
    ///
    /// It is the reciprocal of the transition width, which is measured in tile values.
    #[arg(long, value_name = "N")]
    gain: Option<f64>,

    /// Mixing of the layers.
    #[arg(long, value_parser = NamedValueParser::<MixingName>::all(), default_value_t = MixingName::Linear)]
    mixing: MixingName,

    /// pyramid: number of bands, at most 30 [default: 4].
    #[arg(long, value_name = "N")]
    levels: Option<u32>,

    /// pyramid: transition sharpness of the finest band, at least 0 [default: 8].
    #[arg(long, value_name = "N")]
    sharpness: Option<f64>,

    /// pyramid: axes along which images and result repeat [default: none, mirrored past the edges].
    #[arg(long, value_name = "AXES", value_parser = NamedValueParser::<Axes>::all())]
    wrap: Option<Axes>,
}

impl MixingArgs {
    /// Returns the blend options. The default weighting is mask with a blend tile, otherwise height if a layer has a
    /// height, otherwise the given weights.
    ///
    /// # Errors
    ///
    /// If an option has no effect, or the mask weighting lacks a blend tile.
    pub(super) fn blend(&self, has_tile: bool, has_heights: bool) -> Result<Blend> {
        let weighting = self.weighting.unwrap_or(match (has_tile, has_heights) {
            (true, _) => WeightingName::Mask,
            (false, true) => WeightingName::Height,
            (false, false) => WeightingName::Given,
        });
        if weighting == WeightingName::Mask && !has_tile {
            return Err(usage("--weighting mask needs a blend tile").hint("add --tile IMAGE"));
        }
        let is_pyramid = self.mixing == MixingName::Pyramid;
        let is_height = weighting == WeightingName::Height;
        for (option, is_given, is_used, hint) in [
            (
                "depth",
                self.depth.is_some(),
                is_height,
                "--weighting height",
            ),
            (
                "gain",
                self.gain.is_some(),
                weighting == WeightingName::Mask,
                "--weighting mask",
            ),
            (
                "levels",
                self.levels.is_some(),
                is_pyramid,
                "--mixing pyramid",
            ),
            (
                "sharpness",
                self.sharpness.is_some(),
                is_pyramid,
                "--mixing pyramid",
            ),
            ("wrap", self.wrap.is_some(), is_pyramid, "--mixing pyramid"),
        ] {
            if is_given && !is_used {
                let message = format!("--{option} has no effect on this blend");
                return Err(usage(message).hint(format!("add {hint}")));
            }
        }
        Ok(Blend::new(self.weighting_of(weighting), self.mixing()))
    }

    fn weighting_of(&self, name: WeightingName) -> Weighting {
        match name {
            WeightingName::Given => Weighting::Given,
            WeightingName::Height => Weighting::Height {
                depth: self.depth.unwrap_or(0.2),
            },
            WeightingName::Mask => Weighting::Mask {
                gain: self.gain.unwrap_or(8.0),
            },
        }
    }

    fn mixing(&self) -> Mixing {
        let default = Pyramid::default();
        match self.mixing {
            MixingName::Linear => Mixing::Linear,
            MixingName::KeepVariance => Mixing::KeepVariance,
            MixingName::Pyramid => Mixing::Pyramid(Pyramid {
                levels: self.levels.unwrap_or(default.levels),
                sharpness: self.sharpness.unwrap_or(default.sharpness),
                borders: self
                    .wrap
                    .unwrap_or(Axes::None)
                    .flags()
                    .map(|repeats| match repeats {
                        true => Border::Periodic,
                        false => Border::Mirror,
                    }),
            }),
        }
    }
}
