//! A figure of a paper: the file that renders it, and its data.

use crate::Panel;
use crate::lock::{Hash, hash_panels};
use anyhow::{Context, ensure};

/// A figure: a file under `src/figures/<paper>/` that renders one or several images.
///
/// The name and the caption are not stored here; they come from the file's name and header.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// The number of the figure in the paper, such as `"3a"`, or `"extra"` for a figure that the paper does not have.
    pub number: &'static str,
    /// Parameters shown on the page, as pairs of a name and a value. The value of `recipe` is a built-in recipe
    /// similar to the figure; the page shows a command that opens it.
    pub parameters: &'static [(&'static str, &'static str)],
    /// Source file of the figure, always `source!()`.
    pub source: Source,
    /// Renders the images, with `size` pixels along the longer side of each.
    pub render: fn(size: u32) -> anyhow::Result<Vec<Panel>>,
}

/// A paper and its figures, in the order of the paper.
#[derive(Clone, Copy, Debug)]
pub struct Paper {
    /// Name of the folder that contains its figures, and prefix of their names.
    pub key: &'static str,
    /// Title of the paper.
    pub title: &'static str,
    /// Authors, publication and year.
    pub reference: &'static str,
    /// Figures of the paper.
    pub figures: &'static [Figure],
}

/// A figure's own source file.
#[derive(Clone, Copy)]
pub struct Source {
    /// The path from the root of the workspace.
    pub path: &'static str,
    /// The text of the file.
    pub text: &'static str,
}

/// Returns the [`Source`] of the file that contains the call.
macro_rules! source {
    () => {
        $crate::Source {
            path: file!(),
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../", file!())),
        }
    };
}
pub(crate) use source;

impl Figure {
    /// Renders the images, with `size` pixels along the longer side of each.
    ///
    /// # Errors
    ///
    /// If rendering fails, with the name of the figure as context, or if the figure returns no images or an image of
    /// the wrong size.
    pub fn render(&self, size: u32) -> anyhow::Result<Vec<Panel>> {
        let panels = (self.render)(size).with_context(|| format!("figure {}", self.name()))?;
        ensure!(!panels.is_empty(), "figure {} made no picture", self.name());
        for panel in &panels {
            let [width, height] = panel.size();
            ensure!(
                width.max(height) == size,
                "figure {} made a picture of {width} × {height} pixels for {size}",
                self.name()
            );
        }
        Ok(panels)
    }

    /// Returns the hash of the figure's images, rendered at `size` pixels. `figures.lock` contains the hash for
    /// [`LOCK_SIZE`](crate::LOCK_SIZE).
    ///
    /// # Errors
    ///
    /// Same as [`render`](Self::render).
    pub fn hash(&self, size: u32) -> anyhow::Result<Hash> {
        Ok(hash_panels(&self.render(size)?))
    }

    /// Returns the name of the figure, derived from its file: `figures/pups/fig_03a.rs` is `pups-fig-03a`.
    #[must_use]
    pub fn name(&self) -> String {
        let stem = self.source.path.trim_end_matches(".rs");
        let mut parts = stem.rsplit(['/', '\\']);
        let (file, paper) = (
            parts.next().unwrap_or_default(),
            parts.next().unwrap_or_default(),
        );
        format!("{paper}-{file}").replace('_', "-")
    }

    /// Returns the caption: the first paragraph of the file's `//!` header.
    #[must_use]
    pub fn caption(&self) -> String {
        let header = self
            .source
            .text
            .lines()
            .map_while(|line| line.strip_prefix("//!"));
        let paragraph: Vec<_> = header
            .map(str::trim)
            .take_while(|line| !line.is_empty())
            .collect();
        paragraph.join(" ")
    }
}

impl core::fmt::Debug for Source {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_tuple("Source").field(&self.path).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::{Figure, Source};
    use crate::Panel;
    use dapple_color::LinearRgb;
    use dapple_raster::Raster;

    fn figure(path: &'static str, text: &'static str) -> Figure {
        Figure {
            number: "1",
            parameters: &[],
            source: Source { path, text },
            render: |_| Ok(Vec::new()),
        }
    }

    #[test]
    fn name_comes_from_the_path_with_either_separator() {
        for path in [
            "crates/dapple-gallery/src/figures/pups/fig_03a.rs",
            r"crates\dapple-gallery\src\figures\pups\fig_03a.rs",
        ] {
            assert_eq!(figure(path, "").name(), "pups-fig-03a", "{path}");
        }
    }

    #[test]
    fn caption_is_the_first_paragraph_of_the_header() {
        let text =
            "//! The weight of a point,\n//! and more.\n//!\n//! Not this.\nuse x;\n//! Nor this.";
        assert_eq!(
            figure("a/b.rs", text).caption(),
            "The weight of a point, and more."
        );
    }

    #[test]
    fn render_without_a_picture_is_an_error_that_names_the_figure() {
        let error = figure("figures/pups/fig_99.rs", "").render(8).unwrap_err();
        assert_eq!(error.to_string(), "figure pups-fig-99 made no picture");
    }

    #[test]
    fn render_refuses_pictures_of_another_size() {
        let small = |_| {
            let picture = Raster::filled([4, 2], LinearRgb::WHITE)?;
            Ok(vec![Panel::color("small", picture)])
        };
        let figure = Figure {
            render: small,
            ..figure("figures/pups/fig_99.rs", "")
        };
        assert!(figure.render(4).is_ok(), "the longer side counts");
        let error = figure.render(8).unwrap_err();
        assert_eq!(
            error.to_string(),
            "figure pups-fig-99 made a picture of 4 × 2 pixels for 8"
        );
    }
}
