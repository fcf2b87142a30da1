//! Parses color ramps on the command line, given as the name of a palette or as comma-separated colors.

use dapple::color::{ColorRamp, LinearRgb, Palette};
use dapple::raster::Named;
use serde::{Serialize, Serializer};
use std::str::FromStr;

/// A color ramp with its text as typed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RampArg {
    text: String,
    /// The colors of the ramp from low to high, at least one.
    pub(crate) colors: Vec<LinearRgb>,
    /// The ramp, with the colors evenly spaced and interpolated in Oklab.
    pub(crate) ramp: ColorRamp,
}

impl FromStr for RampArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let colors = match Palette::from_name(&text.to_ascii_lowercase()) {
            Some(palette) => palette.colors(),
            None => {
                let colors = text
                    .split(',')
                    .map(|text| color(text).ok_or_else(|| unknown(text)));
                colors.collect::<Result<_, _>>()?
            }
        };
        let ramp = ColorRamp::even(&colors).map_err(|error| error.to_string())?;
        Ok(Self {
            text: text.to_owned(),
            colors,
            ramp,
        })
    }
}

impl Serialize for RampArg {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.text.serialize(serializer)
    }
}

/// Parses a color in hexadecimal, or `black` or `white`.
pub(super) fn color(text: &str) -> Option<LinearRgb> {
    match text.trim() {
        "black" => Some(LinearRgb::BLACK),
        "white" => Some(LinearRgb::WHITE),
        text => LinearRgb::from_hex(text).ok(),
    }
}

/// Returns the error message for `text`, which is neither a color nor a palette.
fn unknown(text: &str) -> String {
    let (text, palettes) = (text.trim(), Palette::NAMES.join(", "));
    format!("{text:?} is neither a color such as #ff8000 nor a palette: {palettes}")
}

#[cfg(test)]
mod tests {
    use super::RampArg;
    use dapple::color::{LinearRgb, Palette};

    #[test]
    fn ramps_are_palettes_or_colors() {
        let lagoon: RampArg = "Lagoon".parse().unwrap();
        assert_eq!(lagoon.ramp, Palette::Lagoon.ramp());
        let two: RampArg = "#000,white".parse().unwrap();
        assert_eq!(two.colors, [LinearRgb::BLACK, LinearRgb::WHITE]);
    }

    #[test]
    fn ramps_that_are_none_name_the_palettes() {
        for text in ["", "lagon", "#12,#345", "#000,,#fff"] {
            let error = text.parse::<RampArg>().unwrap_err();
            assert!(error.contains("lagoon"), "{text:?}: {error}");
        }
    }
}
