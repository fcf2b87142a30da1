//! What becomes of the alpha of images that are partly transparent.

use super::ramp::color;
use dapple::color::LinearRgb;
use serde::Serialize;
use std::str::FromStr;

/// The option of subcommands that make images of images.
#[derive(clap::Args, Clone, Copy, Debug, Serialize)]
pub(crate) struct AlphaArgs {
    /// What becomes of transparency: `keep` treats it like another channel, `drop` shows the colors without it, and
    /// `over:COLOR` lays the image over a color, such as `over:#888`.
    #[arg(long, value_name = "keep|drop|over:COLOR", default_value = "keep")]
    pub(crate) alpha: Alpha,
}

/// What becomes of alpha.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Alpha {
    /// It goes the way of the colors.
    Keep,
    /// The colors alone are used.
    Drop,
    /// The colors are laid over this one, in linear light.
    Over(LinearRgb),
}

impl FromStr for Alpha {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            None if text == "keep" => Ok(Self::Keep),
            None if text == "drop" => Ok(Self::Drop),
            Some(("over", background)) => color(background).map(Self::Over).ok_or_else(|| {
                format!("{background:?} is no color; one is such as #ff8000, black or white")
            }),
            _ => Err(format!("{text:?} is none of keep, drop and over:COLOR")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Alpha;
    use dapple::color::LinearRgb;

    #[test]
    fn alpha_is_kept_dropped_or_laid_over_a_color() {
        assert_eq!("keep".parse(), Ok(Alpha::Keep));
        assert_eq!("drop".parse(), Ok(Alpha::Drop));
        assert_eq!("over:white".parse(), Ok(Alpha::Over(LinearRgb::WHITE)));
        for text in ["", "over", "over:", "over:blueish", "keep:1"] {
            assert!(text.parse::<Alpha>().is_err(), "{text:?}");
        }
    }
}
