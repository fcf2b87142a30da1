//! Renders the images in the crates' documentation: small Markdown files that contain their images as data URIs.
//!
//! A [`Strip`] is a row of images that shows one option in several settings, such as all metrics. All images of a
//! strip use the same seed and the same window, so that only the option differs. `cargo xtask docs-images` writes
//! each strip as `docs/<name>.md` into its crate's folder, where the source includes it in a doc comment. The images
//! therefore need no network and are part of the published package. READMEs cannot contain data URIs; their image is
//! the file `docs/gallery.png` next to them. A test compares the files with newly rendered images, pixel by pixel.
//!
//! The source includes strips under `cfg(doc)`. They therefore appear in rustdoc, also for a crate that another one
//! depends on, but not in editors. Strips are omitted where another crate's documentation inlines the item
//! (`#[doc(inline)]`).
//!
//! [`documented`] lists the images of all crates. Each crate has its own file.

mod color;
mod front;
mod graph;
mod mesh;
mod noise;
mod picture;
mod points;
mod preview;
mod pups;
mod recipe;
mod synth;
mod tile;
mod wavelet;
mod worley;

use crate::{Panel, Picture};
use anyhow::ensure;
use base64::prelude::{BASE64_STANDARD as BASE64, Engine as _};
use core::fmt::Write as _;
use dapple_color::Code;
use dapple_image::{Limits, PngImage, Transfer, decode_png, encode_png};

/// A folder with a README and documentation that contain rendered images.
#[derive(Clone, Copy, Debug)]
pub struct Documented {
    /// Path of the folder relative to the workspace root; empty for the root itself.
    pub folder: &'static str,
    /// Rows of images in its documentation, written to `docs/<name>.md`.
    pub strips: &'static [Strip],
    /// Renders the README's image, which is written to `docs/gallery.png`.
    pub banner: fn() -> anyhow::Result<Panel>,
}

/// A row of images that show one option in different settings.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// Name of the file, without `.md`.
    pub name: &'static str,
    /// Text shared by all images of the row. If it is empty, the row has no line of text.
    pub caption: &'static str,
    /// Renders the images. Their labels say how they differ.
    pub render: fn() -> anyhow::Result<Vec<Panel>>,
}

/// Returns all folders that have images in their documentation: the workspace, then its crates in README order.
// A function that is not inlined, because a unit test compiles everything that a `static` of its crate references, and
// every user of a `const` compiles it again.
#[inline(never)]
#[must_use]
pub fn documented() -> &'static [Documented] {
    &[
        front::DOCUMENTED,
        color::DOCUMENTED,
        points::DOCUMENTED,
        noise::DOCUMENTED,
        wavelet::DOCUMENTED,
        mesh::DOCUMENTED,
        graph::DOCUMENTED,
        worley::DOCUMENTED,
        tile::DOCUMENTED,
        preview::DOCUMENTED,
        pups::DOCUMENTED,
        synth::DOCUMENTED,
        recipe::DOCUMENTED,
    ]
}

/// A file in the `docs` folder of a [`Documented`].
#[derive(Clone, Debug)]
pub struct File {
    /// Name of the file, which ends in `.md` or `.png`.
    pub name: String,
    /// Contents of the file.
    pub bytes: Vec<u8>,
}

/// Prefix of every image in the Markdown.
const DATA: &str = "data:image/png;base64,";

impl Documented {
    /// Renders all files of the `docs` folder.
    ///
    /// # Errors
    ///
    /// If rendering a strip or the banner fails, or if a strip has no image.
    pub fn files(&self) -> anyhow::Result<Vec<File>> {
        let mut files = vec![File {
            name: "gallery.png".to_owned(),
            bytes: png(&(self.banner)()?)?,
        }];
        for strip in self.strips {
            files.push(File {
                name: format!("{}.md", strip.name),
                bytes: strip.markdown()?.into_bytes(),
            });
        }
        Ok(files)
    }
}

impl File {
    /// Returns whether an older version of the file has the same text and the same pixels. Compression is ignored,
    /// since a different library version may change it.
    #[must_use]
    pub fn shows_the_same_as(&self, before: &[u8]) -> bool {
        if self.name.ends_with(".png") {
            let [now, before] = [&self.bytes, before].map(decode);
            now.is_some() && now == before
        } else {
            let [now, before] = [&self.bytes, before].map(decode_markdown);
            now.is_some() && now == before
        }
    }
}

impl Strip {
    /// Returns the strip as Markdown: its images, then a line that names them from left to right.
    fn markdown(&self) -> anyhow::Result<String> {
        let panels = (self.render)()?;
        ensure!(!panels.is_empty(), "the strip {} is empty", self.name);
        let mut text = String::new();
        for panel in &panels {
            let (label, data) = (&panel.label, BASE64.encode(png(panel)?));
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

/// Decodes a PNG file, or returns `None` if it is not one.
fn decode(file: &[u8]) -> Option<PngImage> {
    decode_png(file, &Limits::default()).ok()
}

/// Splits a strip into its text and its images, or returns `None` if an image cannot be decoded.
fn decode_markdown(markdown: &[u8]) -> Option<(String, Vec<PngImage>)> {
    let mut parts = core::str::from_utf8(markdown).ok()?.split(DATA);
    let mut text = parts.next()?.to_owned();
    let mut images = Vec::new();
    for part in parts {
        let (data, rest) = part.split_once(' ')?;
        images.push(decode(&BASE64.decode(data).ok()?)?);
        text.push_str(rest);
    }
    Some((text, images))
}

#[cfg(test)]
mod tests {
    use super::{Documented, File, Strip, decode_markdown};
    use crate::Panel;
    use dapple_raster::Raster;

    fn two(left: f32) -> anyhow::Result<Vec<Panel>> {
        let shades = Raster::from_vec([2, 1], vec![left, 1.0])?;
        Ok(vec![
            Panel::gray("a", shades.clone()),
            Panel::gray("b", shades),
        ])
    }

    fn strip(render: fn() -> anyhow::Result<Vec<Panel>>) -> Strip {
        Strip {
            name: "metric",
            caption: "F1",
            render,
        }
    }

    #[test]
    fn markdown_names_each_picture_and_gives_it_back() {
        let markdown = strip(|| two(0.0)).markdown().unwrap();
        let (text, images) = decode_markdown(markdown.as_bytes()).unwrap();
        let expected = "![a](\"a\")\n![b](\"b\")\n\nF1. From left to right: a, b.\n";
        assert_eq!(text, expected);
        assert_eq!(images.len(), 2);
        for image in images {
            assert_eq!(image.gray().unwrap().pixels(), [0.0, 1.0]);
        }
    }

    #[test]
    fn strips_without_pictures_are_refused() {
        let error = strip(|| Ok(Vec::new())).markdown().unwrap_err();
        assert_eq!(error.to_string(), "the strip metric is empty");
    }

    #[test]
    fn files_are_compared_by_their_text_and_their_pixels() {
        let files = |strips, banner| {
            let documented = Documented {
                folder: "",
                strips,
                banner,
            };
            documented.files().unwrap()
        };
        const DARK: &[Strip] = &[Strip {
            name: "metric",
            caption: "F1",
            render: || two(0.0),
        }];
        const LIGHT: &[Strip] = &[Strip {
            render: || two(1.0),
            ..DARK[0]
        }];
        const RENAMED: &[Strip] = &[Strip {
            caption: "F2",
            ..DARK[0]
        }];
        let dark: fn() -> anyhow::Result<Panel> = || Ok(two(0.0)?.swap_remove(0));
        let light: fn() -> anyhow::Result<Panel> = || Ok(two(1.0)?.swap_remove(0));
        let now = files(DARK, dark);
        let names: Vec<_> = now.iter().map(|file| file.name.as_str()).collect();
        assert_eq!(names, ["gallery.png", "metric.md"]);
        let same = |before: &[File]| {
            let pairs = now.iter().zip(before);
            let same: Vec<bool> = pairs
                .map(|(now, before)| now.shows_the_same_as(&before.bytes))
                .collect();
            same
        };
        assert_eq!(same(&files(DARK, dark)), [true, true]);
        assert_eq!(same(&files(LIGHT, light)), [false, false]);
        assert_eq!(same(&files(RENAMED, dark)), [true, false]);
        for damaged in [&b""[..], b"data:image/png;base64,", b"\xff"] {
            let same = now.iter().any(|file| file.shows_the_same_as(damaged));
            assert!(!same, "{damaged:?}");
        }
    }
}
