//! The pictures in the documentation of the crates: small Markdown files that hold their pictures as data URIs.
//!
//! A [`Strip`] is a row of pictures for one option, such as a metric in all its kinds, with the same seed and the same
//! place, so that only the option differs. `cargo xtask gallery --docs` writes each as `docs/<name>.md` into the folder of
//! its crate, where the source includes it as a part of a doc comment. So the pictures are there without a network, and
//! part of the published package. A test compares the files with the strips, pixel by pixel.
//!
//! The source includes them under `cfg(doc)`: rustdoc shows them, also for a crate that another one depends on, and editors
//! do not. Where another crate's documentation takes an item in (`#[doc(inline)]`), they are left out.

mod base64;
mod worley;

use crate::{Panel, Picture};
use anyhow::ensure;
use core::fmt::Write as _;
use dapple_color::Code;
use dapple_image::{Transfer, encode_png};

/// A crate, and the strips of its documentation.
#[derive(Clone, Copy, Debug)]
pub struct Documented {
    /// The name of the package, and of its folder.
    pub package: &'static str,
    /// Its strips.
    pub strips: &'static [Strip],
}

/// A row of pictures that shows one option.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// The file, without `.md`.
    pub name: &'static str,
    /// What all pictures of the row have in common; without it, the row has no line of text.
    pub caption: &'static str,
    /// Makes the pictures. Their labels say what is what.
    pub render: fn() -> anyhow::Result<Vec<Panel>>,
}

/// The crates that have pictures in their documentation.
pub const DOCUMENTED: &[Documented] = &[worley::DOCUMENTED];

/// What a picture begins with in the Markdown.
const DATA: &str = "data:image/png;base64,";

impl Strip {
    /// The strip as Markdown: its pictures, then a line that says what is what from left to right.
    ///
    /// # Errors
    ///
    /// What the strip's own code reports; or that it made no picture.
    pub fn markdown(&self) -> anyhow::Result<String> {
        let panels = (self.render)()?;
        ensure!(!panels.is_empty(), "the strip {} is empty", self.name);
        let mut text = String::new();
        for panel in &panels {
            let (label, data) = (&panel.label, base64::encode(&png(panel)?));
            writeln!(text, "![{label}]({DATA}{data} \"{label}\")")?;
        }
        let labels: Vec<_> = panels.iter().map(|panel| panel.label.as_str()).collect();
        match (self.caption, labels.as_slice()) {
            ("", _) => {}
            (caption, [_]) => writeln!(text, "\n{caption}.")?,
            (caption, labels) => {
                writeln!(
                    text,
                    "\n{caption}. From left to right: {}.",
                    labels.join(", ")
                )?;
            }
        }
        Ok(text)
    }
}

/// The text of a strip without its pictures, and the PNG files in it.
///
/// # Errors
///
/// If a picture is not in base64.
pub fn split(markdown: &str) -> anyhow::Result<(String, Vec<Vec<u8>>)> {
    let mut parts = markdown.split(DATA);
    let mut text = parts.next().unwrap_or_default().to_owned();
    let mut files = Vec::new();
    for part in parts {
        let (data, rest) = part.split_once(' ').unwrap_or((part, ""));
        files.push(base64::decode(data)?);
        text.push_str(rest);
    }
    Ok((text, files))
}

fn png(panel: &Panel) -> anyhow::Result<Vec<u8>> {
    Ok(match &panel.picture {
        Picture::Gray(shades) => {
            let codes = shades.map(|&shade| u8::from_unit(shade));
            encode_png(codes.view(), Transfer::Data)?
        }
        Picture::Color(colors) => {
            let codes = colors.map(|color| color.to_srgb::<u8>());
            encode_png(codes.view(), Transfer::Srgb)?
        }
    })
}

#[cfg(test)]
mod tests {
    use super::{Strip, split};
    use crate::Panel;
    use dapple_image::{Limits, decode_png};
    use dapple_raster::Raster;

    fn strip(render: fn() -> anyhow::Result<Vec<Panel>>) -> Strip {
        Strip {
            name: "metric",
            caption: "F1",
            render,
        }
    }

    #[test]
    fn markdown_names_each_picture_and_gives_it_back() {
        let two = strip(|| {
            let shades = Raster::from_vec([2, 1], vec![0.0, 1.0])?;
            Ok(vec![
                Panel::gray("a", shades.clone()),
                Panel::gray("b", shades),
            ])
        });
        let (text, files) = split(&two.markdown().unwrap()).unwrap();
        let expected = "![a](\"a\")\n![b](\"b\")\n\nF1. From left to right: a, b.\n";
        assert_eq!(text, expected);
        for file in &files {
            let image = decode_png(file, &Limits::default()).unwrap();
            assert_eq!(image.gray().unwrap().pixels(), [0.0, 1.0]);
        }
        assert_eq!(files.len(), 2);
    }

    #[test]
    fn strips_without_pictures_are_refused() {
        let error = strip(|| Ok(Vec::new())).markdown().unwrap_err();
        assert_eq!(error.to_string(), "the strip metric is empty");
    }
}
