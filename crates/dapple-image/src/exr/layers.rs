//! Finds the layers of an OpenEXR file and chooses its main image.
//!
//! Reference: "Technical Introduction to OpenEXR", sections on layers, multi-view and multi-part files. A plane
//! `layer.channel` belongs to a layer, a plane without a dot belongs to the main image, and the planes of the default
//! view have no prefix. Renderers depart from this convention. Therefore names are compared without regard to case,
//! `red` means `R`, and the main image may have a layer name: `ViewLayer.Combined` (Blender), `rgba`, `beauty`.

use super::{ExrImage, ExrPlane, check_size};
use crate::{ImageError, ImageErrorKind};
use core::cmp::Reverse;
use dapple_raster::Raster;

#[cfg(feature = "exr")]
/// View names assumed for files that do not list their views.
const USUAL_VIEWS: [&str; 2] = ["left", "right"];

/// The planes of an image, by the kind of image.
pub(crate) enum Picture<'a> {
    /// One value per pixel, and optionally alpha.
    Gray {
        values: &'a Raster<f32>,
        alpha: Option<&'a Raster<f32>>,
    },
    /// Red, green and blue, and optionally alpha.
    Color {
        parts: [&'a Raster<f32>; 3],
        alpha: Option<&'a Raster<f32>>,
    },
    /// Components X, Y and Z of vectors.
    Vectors([&'a Raster<f32>; 3]),
}

/// A layer: its name, and its planes by their names within the layer.
struct Layer<'a> {
    name: &'a str,
    planes: Vec<(&'a str, &'a ExrPlane)>,
}

impl<'a> Layer<'a> {
    /// Returns the plane with one of these names, ignoring case.
    fn plane(&self, names: &[&str]) -> Option<&'a Raster<f32>> {
        let is_named = |name: &str| names.iter().any(|other| name.eq_ignore_ascii_case(other));
        let mut planes = self.planes.iter();
        let (_, plane) = planes.find(|(name, _)| is_named(name))?;
        Some(&plane.values)
    }

    /// Interprets the planes by their names; `None` if the names are ambiguous.
    fn picture(&self) -> Option<Picture<'a>> {
        let alpha = self.plane(&["A", "alpha"]);
        let [r, g, b] = [&["R", "red"], &["G", "green"], &["B", "blue"]].map(|of| self.plane(of));
        let [x, y, z] = [["X"], ["Y"], ["Z"]].map(|of| self.plane(&of));
        if let (Some(r), Some(g), Some(b)) = (r, g, b) {
            let parts = [r, g, b];
            return Some(Picture::Color { parts, alpha });
        }
        if r.or(g).or(b).is_some() {
            return None;
        }
        match (x, y, z) {
            (Some(x), Some(y), Some(z)) => Some(Picture::Vectors([x, y, z])),
            (_, Some(values), _) => Some(Picture::Gray { values, alpha }),
            _ => None,
        }
    }

    /// Returns the rank of the layer among the layers of a file; the main image has the smallest rank.
    ///
    /// Vectors come last. Layers are then ordered by name: no name, `Combined`, `rgba`, `beauty`, any other name. Ties
    /// are broken by the order of views. Between layers with other names, color precedes gray.
    fn rank(&self, picture: &Picture<'_>, views: &[String]) -> [usize; 4] {
        let name = self.name.to_lowercase();
        let words: Vec<&str> = name.split(['.', '_']).collect();
        let view = |word: &&str| views.iter().position(|view| view == word);
        let of_view = words.iter().find_map(view).map_or(0, |view| view + 1);
        let mut words = words.iter().filter(|word| view(word).is_none());
        let by_name = match words.next_back() {
            None | Some(&"") => 0,
            Some(&"combined") => 1,
            Some(&"rgba") => 2,
            Some(&"beauty") => 3,
            Some(_) => 4,
        };
        [
            usize::from(matches!(picture, Picture::Vectors(_))),
            by_name,
            of_view,
            usize::from(matches!(picture, Picture::Gray { .. })),
        ]
    }
}

impl ExrImage {
    /// Returns the names of the layers, in file order. A plane without a dot in its name is listed as a layer.
    ///
    /// [`layer`](Self::layer) accepts these names.
    #[must_use]
    pub fn layers(&self) -> Vec<&str> {
        let mut names = Vec::new();
        for layer in self.split() {
            if layer.name.is_empty() {
                names.extend(layer.planes.iter().map(|(name, _)| *name));
            } else {
                names.push(layer.name);
            }
        }
        names
    }

    /// Returns the image of one layer, or of one plane. The layer's prefix is removed from the plane names.
    ///
    /// An exact match takes precedence; otherwise the case of the name is ignored.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingLayer`], which lists all layers, if there is no layer with this name.
    pub fn layer(&self, name: &str) -> Result<Self, ImageError> {
        let layers = self.split();
        let is_same = |other: &str| other == name;
        let is_like = |other: &str| other.eq_ignore_ascii_case(name);
        let of_layer = |is_named: &dyn Fn(&str) -> bool| {
            let mut layers = layers.iter().filter(|layer| !layer.name.is_empty());
            let planes = &layers.find(|layer| is_named(layer.name))?.planes;
            let named = planes
                .iter()
                .map(|&(name, plane)| ExrPlane::new(name, plane.values.clone()));
            Some(named.collect())
        };
        let of_plane = |is_named: &dyn Fn(&str) -> bool| {
            let mut planes = self.planes.iter();
            Some(vec![planes.find(|plane| is_named(&plane.name))?.clone()])
        };
        let planes = of_layer(&is_same)
            .or_else(|| of_plane(&is_same))
            .or_else(|| of_layer(&is_like))
            .or_else(|| of_plane(&is_like));
        let Some(planes) = planes else {
            return Err(ImageError::new(ImageErrorKind::MissingLayer {
                name: name.to_owned(),
                layers: self.layers().into_iter().map(str::to_owned).collect(),
            }));
        };
        Ok(Self {
            planes,
            ..self.without_planes()
        })
    }

    /// Returns the planes of the main image of the file.
    ///
    /// If the file has a single plane, it is a gray image. Of several layers, the one without a name is chosen, then
    /// one named `Combined`, `rgba` or `beauty`, then the only one with an image. If several views have the layer, the
    /// first view is chosen.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::MissingPlane`] if one of red, green and blue is missing in the only layer,
    /// [`ImageErrorKind::AmbiguousLayer`] if no layer or several layers qualify, and
    /// [`ImageErrorKind::SizeMismatch`] if the sizes of the planes differ.
    pub(crate) fn picture(&self) -> Result<Picture<'_>, ImageError> {
        if let [plane] = self.planes.as_slice() {
            let (values, alpha) = (&plane.values, None);
            return Ok(Picture::Gray { values, alpha });
        }
        let layers = self.split();
        let mut candidates: Vec<_> = layers
            .iter()
            .filter_map(|layer| {
                let picture = layer.picture()?;
                Some((layer.rank(&picture, &self.views), picture))
            })
            .collect();
        candidates.sort_by_key(|&(rank, _)| Reverse(rank));
        let best = candidates.pop();
        let second = candidates.last().map(|&(rank, _)| rank);
        match best {
            Some((rank, picture)) if second != Some(rank) => {
                picture.check_sizes()?;
                Ok(picture)
            }
            _ => Err(self.no_picture(&layers)),
        }
    }

    /// Returns the image with the planes of the main image only: `R`, `G`, `B`, or `X`, `Y`, `Z`, or one plane of any
    /// name; and
    /// `A` last, if there is alpha.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::AmbiguousLayer`], which lists all layers, if no layer or several layers qualify,
    /// [`ImageErrorKind::MissingPlane`] if one of red, green and blue is missing in the only layer, and
    /// [`ImageErrorKind::SizeMismatch`] if the sizes of the planes differ.
    pub fn to_picture(&self) -> Result<Self, ImageError> {
        if self.planes.len() == 1 {
            return Ok(self.clone());
        }
        let (names, parts, alpha): (_, &[&Raster<f32>], _) = match &self.picture()? {
            Picture::Gray { values, alpha } => (["Y"].as_slice(), &[*values], *alpha),
            Picture::Color { parts, alpha } => (["R", "G", "B"].as_slice(), &parts.clone(), *alpha),
            Picture::Vectors(parts) => (["X", "Y", "Z"].as_slice(), &parts.clone(), None),
        };
        let named = names
            .iter()
            .zip(parts)
            .chain(alpha.iter().map(|alpha| (&"A", alpha)));
        let planes = named.map(|(name, plane)| ExrPlane::new(*name, Raster::clone(plane)));
        Ok(Self {
            planes: planes.collect(),
            ..self.without_planes()
        })
    }

    /// Creates the error for an image whose main image is not determined by the names of its planes.
    fn no_picture(&self, layers: &[Layer<'_>]) -> ImageError {
        if let [layer] = layers {
            let colors = [["R", "red"], ["G", "green"], ["B", "blue"]];
            let missing = colors.iter().find(|names| layer.plane(*names).is_none());
            if colors.iter().any(|names| layer.plane(names).is_some())
                && let Some([name, _]) = missing
            {
                let name = (*name).to_owned();
                return ImageError::new(ImageErrorKind::MissingPlane { name });
            }
        }
        let layers = self.layers().into_iter().map(str::to_owned).collect();
        ImageError::new(ImageErrorKind::AmbiguousLayer { layers })
    }

    /// Groups the planes by layer, in file order.
    fn split(&self) -> Vec<Layer<'_>> {
        let mut layers: Vec<Layer<'_>> = Vec::new();
        for plane in &self.planes {
            let (name, channel) = plane.name.rsplit_once('.').unwrap_or(("", &plane.name));
            match layers.iter_mut().find(|layer| layer.name == name) {
                Some(layer) => layer.planes.push((channel, plane)),
                None => layers.push(Layer {
                    name,
                    planes: vec![(channel, plane)],
                }),
            }
        }
        layers
    }
}

impl Picture<'_> {
    /// Checks that all planes have the same size.
    fn check_sizes(&self) -> Result<(), ImageError> {
        let (parts, alpha): (&[&Raster<f32>], _) = match self {
            Self::Gray { values, alpha } => (core::slice::from_ref(values), *alpha),
            Self::Color { parts, alpha } => (parts, *alpha),
            Self::Vectors(parts) => (parts, None),
        };
        let needed = parts[0].size();
        let mut planes = parts.iter().copied().chain(alpha);
        planes.try_for_each(|plane| check_size(plane.size(), needed))
    }
}

/// Returns the names of a file's views in lower case, the default view first. `listed` are the views in the header's
/// list, `of_parts` the views of its parts.
#[cfg(feature = "exr")]
pub(super) fn views(
    listed: impl IntoIterator<Item = String>,
    of_parts: impl IntoIterator<Item = String>,
) -> Vec<String> {
    let mut views: Vec<String> = Vec::new();
    let usual = USUAL_VIEWS.map(str::to_owned);
    for view in listed.into_iter().chain(of_parts).chain(usual) {
        let view = view.to_lowercase();
        if !view.is_empty() && !views.contains(&view) {
            views.push(view);
        }
    }
    views
}
