//! The paper's textures, by name, with options as data.

use super::vectors::Values;
use crate::arrays;
use crate::color_field;
use crate::data;
use crate::error::{Error, Result};
use crate::function::Made;
use crate::points::Domain;
use crate::seed::SeedArgument;
use crate::shared::{Build, Shared};
use crate::watch::Stop;
use dapple::hash::Seed;
use dapple::pups::{PupsField, PupsRecipe, ReferenceImage};
use dapple::raster::Raster;
use pyo3::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::marker::PhantomData;
use std::sync::Arc;

/// Description of a texture of the PUPs paper as data.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct TextureMade {
    kind: String,
    /// All options of the texture. `domain`, if it is set, replaces the domain in the options.
    options: Value,
    domain: Option<dapple::points::Domain>,
    image: Option<Image>,
    seed: Seed,
}

/// A gray image.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Image {
    size: [u32; 2],
    values: Vec<f32>,
}

impl Build for TextureMade {
    type Built = Values;

    fn build(&self) -> Result<Values> {
        Ok(match (kind(&self.kind)?.build)(self)? {
            PupsField::Numbers(field) => Values::Numbers(field),
            PupsField::Colors(texture) => Values::Vectors(Arc::new(*texture)),
        })
    }
}

/// An entry of the table of textures: a name, its documentation, and functions of its options' type.
struct Kind {
    name: &'static str,
    about: &'static str,
    follows_image: bool,
    /// Returns the options with all defaults filled in.
    complete: fn(Value) -> Result<Value>,
    build: fn(&TextureMade) -> Result<PupsField>,
}

/// Options type of a texture, and whether an image guides the texture.
trait Texture {
    const FOLLOWS_IMAGE: bool;
    type Options: DeserializeOwned + Serialize;

    fn build(options: Self::Options, made: &TextureMade) -> Result<PupsField>;
}

/// The options type of a texture guided by an image.
struct Referenced<T>(PhantomData<T>);

impl<T: PupsRecipe + DeserializeOwned + Serialize> Texture for T {
    const FOLLOWS_IMAGE: bool = false;
    type Options = T;

    fn build(options: T, made: &TextureMade) -> Result<PupsField> {
        Ok(placed(options, made.domain).build(&(), made.seed)?)
    }
}

impl<T: PupsRecipe<ReferenceImage> + DeserializeOwned + Serialize> Texture for Referenced<T> {
    const FOLLOWS_IMAGE: bool = true;
    type Options = T;

    fn build(options: T, made: &TextureMade) -> Result<PupsField> {
        let Some(image) = &made.image else {
            return Err(Error::new("image", "an image is needed"));
        };
        let image = ReferenceImage::new(Raster::from_vec(image.size, image.values.clone())?)?;
        Ok(placed(options, made.domain).build(&image, made.seed)?)
    }
}

/// Sets the domain of the options. It never wraps along an axis along which the texture's default domain does not
/// wrap.
fn placed<T: PupsRecipe<I>, I>(mut options: T, domain: Option<dapple::points::Domain>) -> T {
    if let Some(domain) = domain {
        let usual = T::default().domain_mut().wrap;
        *options.domain_mut() = dapple::points::Domain {
            wrap: [0, 1].map(|axis| domain.wrap[axis] && usual[axis]),
            ..domain
        };
    }
    options.net_mut().cancel = Stop::current().cancel();
    options
}

/// Returns the table entry of a texture with the options type `T`.
const fn row<T: Texture>(name: &'static str, about: &'static str) -> Kind {
    Kind {
        name,
        about,
        follows_image: T::FOLLOWS_IMAGE,
        complete: |options| {
            let options: T::Options = data::read("options", options)?;
            serde_json::to_value(options).map_err(|error| Error::new("options", error.to_string()))
        },
        build: |made| T::build(data::read(&made.kind, made.options.clone())?, made),
    }
}

macro_rules! kinds {
    ($(#[doc = $about:literal] $name:literal $variant:ident($options:ty),)*) => {
        /// The table of all textures.
        const KINDS: &[Kind] = &[$(row::<$options>($name, $about)),*];
    };
}

dapple::pups::recipes!(kinds);

/// Returns the texture called `name`.
fn kind(name: &str) -> Result<&'static Kind> {
    let found = KINDS.iter().find(|kind| kind.name == name);
    found.ok_or_else(|| {
        let names: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        data::unknown_name("texture", name, &names)
    })
}

/// Builds the texture called `name` with the given options.
#[pyfunction]
pub(crate) fn _texture(
    py: Python<'_>,
    name: &str,
    options: &Bound<'_, PyAny>,
    domain: Option<&Domain>,
    image: Option<&Bound<'_, PyAny>>,
    seed: SeedArgument,
) -> Result<Py<PyAny>> {
    let image = image.map(|image| -> Result<Image> {
        let raster = arrays::raster("image", image)?;
        Ok(Image {
            size: raster.size(),
            values: raster.into_pixels(),
        })
    });
    let made = TextureMade {
        kind: name.to_owned(),
        options: (kind(name)?.complete)(data::value(options)?)?,
        domain: domain.map(|domain| domain.0),
        image: image.transpose()?,
        seed: seed.0,
    };
    color_field::object(py, Made::Texture(Shared::new(made)))
}

/// Returns all textures as JSON: a one-sentence description, whether an image guides it, and the options with their
/// defaults.
#[pyfunction]
pub(crate) fn _texture_defaults() -> Result<String> {
    let described = KINDS.iter().map(|kind| {
        // `points` is a required option, so describe it as an empty list.
        let given = if kind.name == "points" {
            "{\"points\": []}"
        } else {
            "{}"
        };
        let given = serde_json::from_str(given).unwrap_or_default();
        let described = Value::Object(Map::from_iter([
            ("about".to_owned(), kind.about.trim().into()),
            ("follows_image".to_owned(), kind.follows_image.into()),
            ("options".to_owned(), (kind.complete)(given)?),
        ]));
        Ok((kind.name.to_owned(), described))
    });
    Ok(Value::Object(described.collect::<Result<_>>()?).to_string())
}
