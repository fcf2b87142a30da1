//! Recipes: materials as data, and the maps baked from them.

mod maps;
mod node;
mod plan;
mod shard_list;

pub(crate) use maps::{_map_info, content_of, map_names};
pub(crate) use node::NodeMade;
pub(crate) use plan::{_plan_from_parts, Plan};
pub(crate) use shard_list::{ShardList, shards};

use crate::arrays::array;
use crate::data;
use crate::error::{Error, Result};
use crate::function::hex;
use crate::pictures::Pixels;
use crate::seed::SeedArgument;
use crate::threads;
use dapple::color::LinearRgb;
use dapple::raster::Raster;
use dapple::recipe::{Images, MaterialShader, Picture, Recipe as RustRecipe, ShaderOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// A material as data: named nodes, and the maps that use them.
///
/// Create it from a dictionary, or read it from text. `plan` prepares it for baking. `Recipe.reference()` describes
/// all nodes and their options; to describe a single node, use for example `print(dp.Recipe.reference("worley"))`.
///
/// Parameters
/// ----------
/// data : dict
///     A recipe as nested dictionaries and lists.
///
/// Raises
/// ------
/// DappleError
///     If the data is not a valid recipe. The message names the entry, and `hint` is the nearest valid name, if any.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> recipe = dp.Recipe({
/// ...     "dapple": 1, "seed": 7, "extent": [8, 8],
/// ...     "nodes": {"joint": {"worley": {"value": "f2_minus_f1"}},
/// ...               "stones": {"levels": {"input": "joint", "from": [0.04, 0.4]}}},
/// ...     "material": {"height": "stones", "relief": 0.3}})
/// >>> maps = recipe.plan().bake(64, ["height", "normal"])
/// >>> maps["normal"].shape
/// (64, 64, 3)
#[pyclass(frozen, module = "dapple_textures")]
#[derive(Clone)]
pub(crate) struct Recipe {
    recipe: RustRecipe,
}

/// Returns the SHA-256 of a list of byte strings, in hexadecimal.
fn sha256(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        // Include the lengths, so that different lists have different hashes.
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    hex(&hash.finalize())
}

/// Reads a recipe from Python data. Error messages name the entry instead of a line, since the user has no text.
fn from_data(data: &Bound<'_, PyAny>) -> Result<RustRecipe> {
    let text = data::text(data)?;
    RustRecipe::from_json(&text).map_err(|error| {
        // Search upward from the error's line for a line with content, since an error may be reported at a closing
        // bracket.
        let before = error.place().map_or(0, |place| place.line);
        let mut lines = text
            .lines()
            .take(before)
            .collect::<Vec<_>>()
            .into_iter()
            .rev();
        let line = lines.find(|line| line.contains(char::is_alphanumeric));
        let entry = line.map(|line| {
            let entry = line.trim().trim_end_matches([',', '{', '[', ' ', ':']);
            format!("at `{entry}`: ")
        });
        let near = error
            .nearest()
            .map(|near| format!("; did you mean `{near}`?"));
        let message = format!(
            "{}{}{}",
            entry.unwrap_or_default(),
            error.kind(),
            near.unwrap_or_default()
        );
        Error::from(error).with_message(message)
    })
}

#[pymethods]
impl Recipe {
    #[new]
    fn new(data: &Bound<'_, PyAny>) -> Result<Self> {
        Ok(Self {
            recipe: from_data(data)?,
        })
    }

    /// Reads a recipe from TOML text.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The TOML text.
    ///
    /// Returns
    /// -------
    /// Recipe
    ///     The recipe.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the text is not TOML or not a valid recipe. The message names line and column, `node` is the node if
    ///     the error concerns one, and `hint` is the nearest valid name.
    #[staticmethod]
    fn from_toml(text: &str) -> Result<Self> {
        Ok(Self {
            recipe: RustRecipe::from_toml(text)?,
        })
    }

    /// Reads a recipe from JSON text.
    ///
    /// Parameters
    /// ----------
    /// text : str
    ///     The JSON text.
    ///
    /// Returns
    /// -------
    /// Recipe
    ///     The recipe.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the text is not JSON or not a valid recipe; `node` names the node, and `hint` is the nearest valid
    ///     name.
    #[staticmethod]
    fn from_json(text: &str) -> Result<Self> {
        Ok(Self {
            recipe: RustRecipe::from_json(text)?,
        })
    }

    /// Returns the built-in recipe called `name`.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     The name of the recipe, one of `builtin_names()`.
    ///
    /// Returns
    /// -------
    /// Recipe
    ///     The recipe.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If there is no such recipe.
    #[staticmethod]
    fn builtin(name: &str) -> Result<Self> {
        Ok(Self {
            recipe: RustRecipe::builtin(name)?,
        })
    }

    /// Returns the names of the built-in recipes.
    ///
    /// Returns
    /// -------
    /// list of str
    ///     The names, sorted.
    #[staticmethod]
    fn builtin_names() -> Vec<&'static str> {
        RustRecipe::builtin_names().collect()
    }

    /// Returns the recipe reference as Markdown text: every option with its range and default.
    ///
    /// Parameters
    /// ----------
    /// node : str or None, default None
    ///     The kind of a node, such as "worley"; None for the whole reference.
    ///
    /// Returns
    /// -------
    /// str
    ///     The reference, or the section about the node.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If there is no such node.
    ///
    /// Examples
    /// --------
    /// >>> import dapple_textures as dp
    /// >>> dp.Recipe.reference("worley").splitlines()[0]
    /// '### `worley`'
    #[staticmethod]
    #[pyo3(signature = (node = None))]
    fn reference(node: Option<&str>) -> Result<String> {
        let reference = RustRecipe::reference();
        let Some(node) = node else {
            return Ok(reference);
        };
        let nodes = section(&reference, "## Nodes").unwrap_or_default();
        let found = section(nodes, &format!("### `{node}`"));
        found.map(str::to_owned).ok_or_else(|| {
            let names = nodes.lines().filter_map(|line| line.strip_prefix("### `"));
            let names: Vec<&str> = names.map(|name| name.trim_end_matches('`')).collect();
            data::unknown_name("node", node, &names)
        })
    }

    /// Returns the JSON Schema of recipes as a dictionary, for editors and validators.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The schema.
    #[staticmethod]
    fn schema(py: Python<'_>) -> Result<Bound<'_, PyAny>> {
        let schema = RustRecipe::schema().to_string();
        Ok(py.import("json")?.call_method1("loads", (schema,))?)
    }

    /// Converts the recipe to TOML.
    ///
    /// Returns
    /// -------
    /// str
    ///     The TOML text.
    fn to_toml(&self) -> Result<String> {
        Ok(self.recipe.to_toml()?)
    }

    /// Converts the recipe to JSON.
    ///
    /// Returns
    /// -------
    /// str
    ///     The JSON text.
    fn to_json(&self) -> Result<String> {
        Ok(self.recipe.to_json()?)
    }

    /// Converts the recipe to a dictionary.
    ///
    /// Returns
    /// -------
    /// dict
    ///     The recipe as nested dictionaries and lists of numbers and strings. `Recipe` reads it.
    fn to_dict<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(py
            .import("json")?
            .call_method1("loads", (self.recipe.to_json()?,))?)
    }

    /// Returns this recipe with another seed, from 0 to 2**64 - 1.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     The random seed, from 0 to 2**64 - 1.
    ///
    /// Returns
    /// -------
    /// Recipe
    ///     The recipe with the new seed.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the seed is not from 0 to 2**64 - 1.
    fn with_seed(&self, seed: SeedArgument) -> Self {
        let recipe = RustRecipe {
            seed: seed.0,
            ..self.recipe.clone()
        };
        Self { recipe }
    }

    /// The named parameters of the recipe and their values, in the order of its text. Options share their values as
    /// `"$name"`.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let (json, table) = (py.import("json")?, PyDict::new(py));
        for (name, parameter) in self.recipe.parameters.iter() {
            let text = parameter.value().to_string();
            table.set_item(name, json.call_method1("loads", (text,))?)?;
        }
        Ok(table)
    }

    /// Returns this recipe with other values of named parameters.
    ///
    /// Parameters
    /// ----------
    /// **values : object
    ///     A value for each name: a number, a string, a boolean, or a list of these.
    ///
    /// Returns
    /// -------
    /// Recipe
    ///     The recipe with the new values.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the recipe has no parameter of a name, or a value is out of the range of its parameter or does not fit an
    ///     option. `hint` is the nearest name, if any.
    ///
    /// Examples
    /// --------
    /// >>> import dapple_textures as dp
    /// >>> recipe = dp.Recipe({
    /// ...     "dapple": 1, "parameters": {"size": 8},
    /// ...     "nodes": {"cells": {"worley": {"frequency": "$size"}}}, "material": {"height": "cells"}})
    /// >>> recipe.with_parameters(size=16).parameters
    /// {'size': 16}
    #[pyo3(signature = (**values))]
    fn with_parameters(&self, values: Option<&Bound<'_, PyDict>>) -> Result<Self> {
        let mut recipe = self.recipe.clone();
        for (name, value) in values.into_iter().flatten() {
            let name: String = name.extract()?;
            recipe.set(&format!("parameters.{name}"), &data::text(&value)?)?;
        }
        Ok(Self { recipe })
    }

    /// The name of the recipe, which is used for the baked files.
    #[getter]
    fn name(&self) -> &str {
        &self.recipe.name
    }

    /// The seed for all random numbers.
    #[getter]
    fn seed(&self) -> u64 {
        self.recipe.seed.0
    }

    /// The width and height of the tile, in units of the plane.
    #[getter]
    fn extent(&self) -> (f64, f64) {
        self.recipe.extent.into()
    }

    /// The names of the image files that the recipe uses.
    #[getter]
    fn image_files(&self) -> Vec<String> {
        self.recipe
            .image_files()
            .into_iter()
            .map(str::to_owned)
            .collect()
    }

    /// The images of the recipe: the file, the layer and the handling of alpha, as for `read_image`; None where no
    /// node sets them.
    fn _image_sources(&self) -> Result<Vec<Source<'_>>> {
        let mut sources = Vec::new();
        for source in self.recipe.image_sources()? {
            let alpha = source.alpha.map(serde_json::to_value).transpose();
            let alpha = alpha.map_err(|error| Error::new("alpha", error.to_string()))?;
            let alpha = alpha.and_then(|alpha| alpha.as_str().map(str::to_owned));
            sources.push((source.file, source.layer, alpha));
        }
        Ok(sources)
    }

    /// The SHA-256 of the recipe's text, which is the same for the same recipe on every machine.
    #[getter]
    fn hash(&self) -> Result<String> {
        Ok(sha256(&[self.recipe.to_json()?.as_bytes()]))
    }

    /// Builds all nodes of the recipe.
    ///
    /// Parameters
    /// ----------
    /// images : dict or None, default None
    ///     The images by name (see `image_files`), or by name and layer, such as `("render.exr", "Depth")`, if nodes
    ///     read several layers of a file: floating-point arrays (rows, columns) of scalars or (rows, columns, 3) of
    ///     linear colors.
    /// time : float, default 0.0
    ///     The elapsed fraction of a looping animation, for nodes that move; 0 and 1 give the same result.
    ///
    /// Returns
    /// -------
    /// Plan
    ///     The plan.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If an image is missing, or a node rejects an option; `node` names it.
    #[pyo3(signature = (*, images = None, time = 0.0))]
    fn plan(&self, py: Python<'_>, images: Option<&Bound<'_, PyDict>>, time: f64) -> Result<Plan> {
        Plan::new(py, self.recipe.clone(), self.pictures(images)?, time)
    }

    /// Generates the material as a function of WGSL, with the same bits as a bake.
    ///
    /// The function `material` takes a position and returns the material there. The text has no bindings and contains
    /// all that it uses.
    ///
    /// Parameters
    /// ----------
    /// images : dict or None, default None
    ///     The images, as for `plan`.
    /// textures : bool, default False
    ///     Whether the shader takes the values of nodes that no shader computes as arguments, which its caller reads from
    ///     baked textures. Such nodes are an error otherwise.
    ///
    /// Returns
    /// -------
    /// Shader
    ///     The text, the nodes to bake to textures, and the data that the shader looks up.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If no shader computes a node and `textures` is False, or for the reasons of `plan`.
    ///
    /// Examples
    /// --------
    /// >>> import dapple_textures as dp
    /// >>> recipe = dp.Recipe({
    /// ...     "dapple": 1, "nodes": {"cells": {"worley": {}}}, "material": {"height": "cells"}})
    /// >>> "fn material(place: Place2d, zero: u32) -> Material" in recipe.wgsl().wgsl
    /// True
    #[pyo3(signature = (*, images = None, textures = false))]
    fn wgsl<'py>(
        &self,
        py: Python<'py>,
        images: Option<&Bound<'py, PyDict>>,
        textures: bool,
    ) -> Result<Bound<'py, PyAny>> {
        let (recipe, images) = (self.recipe.clone(), self.pictures(images)?);
        let options = ShaderOptions { textures };
        let shader = threads::run(py, move || recipe.to_wgsl(&images, &options))??;
        let texel = 4;
        let columns = MaterialShader::DATA_ROW / texel;
        let rows = shader.data.len() / MaterialShader::DATA_ROW;
        let data = array(py, shader.data, &[rows, columns, texel])?;
        let kind = py.import("dapple_textures._types")?.getattr("Shader")?;
        Ok(kind.call1((shader.wgsl, shader.textures, data))?)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> Result<bool> {
        match other.cast::<Self>() {
            Ok(other) => Ok(other.get().recipe.to_json()? == self.recipe.to_json()?),
            Err(_) => Ok(false),
        }
    }

    fn __hash__(&self) -> Result<u64> {
        let hash = self.hash()?;
        Ok(u64::from_str_radix(&hash[..16], 16).unwrap_or(0))
    }

    fn __reduce__(&self, py: Python<'_>) -> Result<(Py<PyAny>, (String,))> {
        let make = py.get_type::<Self>().getattr("from_json")?;
        Ok((make.unbind(), (self.recipe.to_json()?,)))
    }

    fn __dask_tokenize__(&self) -> Result<String> {
        self.hash()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Recipe {:?}, {} nodes, seed {}>",
            self.recipe.name,
            self.recipe.nodes.len(),
            self.recipe.seed.0
        )
    }
}

/// An image of a recipe: its file, its layer, and how its alpha is handled.
type Source<'a> = (&'a str, Option<&'a str>, Option<String>);

impl Recipe {
    /// Converts the images of a dictionary.
    fn pictures(&self, images: Option<&Bound<'_, PyDict>>) -> Result<Images> {
        let mut pictures = Images::new();
        for (name, image) in images.into_iter().flat_map(|images| images.iter()) {
            let key = image_key(&name)?;
            self.check_image(&key)?;
            let image = picture(&format!("image {}", shown(&key)), &image)?;
            pictures.insert(key, image);
        }
        Ok(pictures)
    }

    /// Checks that the recipe has an image with the given key.
    fn check_image(&self, key: &str) -> Result<()> {
        let sources = self.recipe.image_sources()?;
        if sources
            .iter()
            .any(|source| source.file == key || source.key() == key)
        {
            return Ok(());
        }
        let image = shown(key);
        let message = match sources.is_empty() {
            true => format!("the recipe names no images, but {image} is given"),
            false => {
                let known: Vec<_> = sources.iter().map(|source| shown(&source.key())).collect();
                format!(
                    "the recipe names no image {image}, but {}",
                    known.join(", ")
                )
            }
        };
        let name = key.split('\0').next().unwrap_or_default();
        let near = dapple::recipe::similar_words(name, self.recipe.image_files());
        let near = near.first().map(|near| (*near).to_owned());
        Err(Error::new("unknown_image", message).with_near(near))
    }
}

/// Returns the part of a Markdown text below a heading, up to the next heading of the same or a higher level.
fn section<'a>(text: &'a str, heading: &str) -> Option<&'a str> {
    let level = heading.bytes().take_while(|&byte| byte == b'#').count();
    let start = text.find(&format!("\n{heading}\n"))? + 1;
    let after = start + heading.len();
    let ends =
        (1..=level).filter_map(|level| text[after..].find(&format!("\n{} ", "#".repeat(level))));
    Some(text[start..ends.min().map_or(text.len(), |end| after + end)].trim_end())
}

/// Reads an image key in the form of `ImageSource::key`, from a file name or a pair of file name and layer.
fn image_key(name: &Bound<'_, PyAny>) -> Result<String> {
    match name.extract::<(String, String)>() {
        Ok((file, layer)) => Ok(format!("{file}\0{layer}")),
        Err(_) => Ok(name.extract()?),
    }
}

/// Formats an image key for messages.
fn shown(key: &str) -> String {
    match key.split_once('\0') {
        Some((file, layer)) => format!("`{file}` with the layer `{layer}`"),
        None => format!("`{key}`"),
    }
}

/// Reads a recipe image from an array.
fn picture(what: &str, image: &Bound<'_, PyAny>) -> Result<Picture> {
    let pixels = Pixels::read(what, image)?;
    let values = pixels.values();
    Ok(match pixels.n_channels {
        1 => Picture::Numbers(Arc::new(Raster::from_vec(
            pixels.size,
            values.into_owned(),
        )?)),
        3 => {
            let colors = values
                .chunks_exact(3)
                .map(|at| LinearRgb::new(at[0], at[1], at[2]));
            Picture::Colors(Arc::new(Raster::from_vec(pixels.size, colors.collect())?))
        }
        n => {
            let message = format!("the {what} has {n} channels, but 1 or 3 are needed");
            return Err(Error::new("channels", message));
        }
    })
}
