//! Defines the values of `--alpha`, which keeps alpha, drops it, or composites the image over a color.

use super::ramp::color;
use dapple::recipe::ImageAlpha;
use serde::Serialize;
use std::str::FromStr;

/// The option of subcommands that make images from images.
#[derive(clap::Args, Clone, Copy, Debug, Serialize)]
pub(crate) struct AlphaArgs {
    /// Handling of transparency: keep it as a channel, drop it, or composite over a color such as `over:#888`.
    #[arg(long, value_name = "keep|drop|over:COLOR", default_value = "keep")]
    pub(crate) alpha: Alpha,
}

/// How to handle alpha.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase", untagged)]
pub(crate) enum Alpha {
    /// Process alpha like the color channels.
    #[serde(serialize_with = "keep")]
    Keep,
    /// Remove alpha, so that the result is opaque.
    Without(ImageAlpha),
}

fn keep<S: serde::Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str("keep")
}

impl FromStr for Alpha {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let without = |alpha| Ok(Self::Without(alpha));
        match text.split_once(':') {
            None if text == "keep" => Ok(Self::Keep),
            None if text == "drop" => without(ImageAlpha::Drop),
            Some(("over", background)) => match color(background) {
                Some(color) => without(ImageAlpha::Over(color)),
                None => Err(format!(
                    "{background:?} is not a color: give one such as #ff8000, black or white"
                )),
            },
            _ => Err(format!(
                "{text:?} is unknown: give keep, drop or over:COLOR"
            )),
        }
    }
}

/// Parses how to handle alpha where the image must be opaque. Accepts all values of [`Alpha`] except `keep`.
///
/// # Errors
///
/// If the text is `keep`, or not a value of [`Alpha`].
pub(crate) fn image_alpha(text: &str) -> Result<ImageAlpha, String> {
    match text.parse() {
        Ok(Alpha::Without(alpha)) => Ok(alpha),
        Ok(Alpha::Keep) => {
            Err("there is no alpha in the result; take drop or over:COLOR".to_owned())
        }
        Err(error) => Err(error.replace("keep, drop", "drop")),
    }
}

#[cfg(test)]
mod tests {
    use super::{Alpha, image_alpha};
    use dapple::color::LinearRgb;
    use dapple::recipe::ImageAlpha;

    #[test]
    fn alpha_is_kept_dropped_or_laid_over_a_color() {
        assert_eq!("keep".parse(), Ok(Alpha::Keep));
        assert_eq!("drop".parse(), Ok(Alpha::Without(ImageAlpha::Drop)));
        let over = ImageAlpha::Over(LinearRgb::WHITE);
        assert_eq!("over:white".parse(), Ok(Alpha::Without(over)));
        assert_eq!(image_alpha("over:white"), Ok(over));
        assert!(image_alpha("keep").unwrap_err().contains("drop or over"));
        for (alpha, json) in [
            (Alpha::Keep, "\"keep\""),
            (Alpha::Without(over), "\"over:#ffffff\""),
        ] {
            assert_eq!(serde_json::to_string(&alpha).unwrap(), json);
        }
        for text in ["", "over", "over:", "over:blueish", "keep:1"] {
            assert!(text.parse::<Alpha>().is_err(), "{text:?}");
        }
    }
}
