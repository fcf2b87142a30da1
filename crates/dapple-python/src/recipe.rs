//! Recipes: materials as data, and the maps that are baked from them.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::field::Field;
use crate::function::{Function, Made};
use crate::grid::{Grid, GridArguments, size as size_of};
use crate::pictures::Pixels;
use crate::seed::SeedArgument;
use crate::shared::{Build, Shared};
use crate::threads;
use dapple::color::{LinearRgb, Normal};
use dapple::raster::Raster;
use dapple::recipe::{
    Bake, BakeMemory, BakeOptions, Images, MapKind, MapRows, Picture, Plan as RustPlan,
    Recipe as RustRecipe, Region, Shards,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// A material as data: named nodes, and the maps that are made of them.
///
/// It is made from a dictionary, or read from a text. `plan` makes it ready to be baked. The nodes and their options are
/// those of the command, in `docs/reference.md`.
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

/// The hash of some data, in hexadecimal.
fn sha256(parts: &[&[u8]]) -> String {
    let mut hash = Sha256::new();
    for part in parts {
        // With the lengths, so that no two lists of parts are alike.
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    hash.finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// The recipe that data holds. Errors name the entry, and not a place in a text that nobody wrote.
fn from_data(data: &Bound<'_, PyAny>) -> Result<RustRecipe> {
    let text = data::text(data)?;
    RustRecipe::from_json(&text).map_err(|error| {
        // A value that nobody closes yet is refused at the line after it.
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

    /// The recipe that a text in TOML holds.
    #[staticmethod]
    fn from_toml(text: &str) -> Result<Self> {
        Ok(Self {
            recipe: RustRecipe::from_toml(text)?,
        })
    }

    /// The recipe that a text in JSON holds.
    #[staticmethod]
    fn from_json(text: &str) -> Result<Self> {
        Ok(Self {
            recipe: RustRecipe::from_json(text)?,
        })
    }

    /// The built-in recipe of this name.
    #[staticmethod]
    fn builtin(name: &str) -> Result<Self> {
        Ok(Self {
            recipe: RustRecipe::builtin(name)?,
        })
    }

    /// The names of the built-in recipes.
    #[staticmethod]
    fn builtin_names() -> Vec<&'static str> {
        RustRecipe::builtin_names().collect()
    }

    /// The recipe as TOML.
    fn to_toml(&self) -> Result<String> {
        Ok(self.recipe.to_toml()?)
    }

    /// The recipe as JSON.
    fn to_json(&self) -> Result<String> {
        Ok(self.recipe.to_json()?)
    }

    /// The recipe as a dictionary.
    fn to_dict<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(py
            .import("json")?
            .call_method1("loads", (self.recipe.to_json()?,))?)
    }

    /// This recipe with another seed, from 0 to 2**64 - 1.
    fn with_seed(&self, seed: SeedArgument) -> Self {
        let recipe = RustRecipe {
            seed: seed.0,
            ..self.recipe.clone()
        };
        Self { recipe }
    }

    /// The name, which files get.
    #[getter]
    fn name(&self) -> &str {
        &self.recipe.name
    }

    /// Where all of its chance comes from.
    #[getter]
    fn seed(&self) -> u64 {
        self.recipe.seed.0
    }

    /// The width and height of the tile, in units of the plane.
    #[getter]
    fn extent(&self) -> (f64, f64) {
        self.recipe.extent.into()
    }

    /// The names of the images that it asks for.
    #[getter]
    fn image_files(&self) -> Vec<String> {
        self.recipe
            .image_files()
            .into_iter()
            .map(str::to_owned)
            .collect()
    }

    /// The SHA-256 of its text: the same for the same recipe on every machine.
    #[getter]
    fn hash(&self) -> Result<String> {
        Ok(sha256(&[self.recipe.to_json()?.as_bytes()]))
    }

    /// Makes everything that the recipe names.
    ///
    /// Parameters
    /// ----------
    /// images : the images that it names (see `image_files`): arrays (rows, columns) of numbers or (rows, columns, 3) of linear
    ///     colors, floating point.
    /// time : the part of a loop that has passed, for what moves: 0 and 1 are the same.
    #[pyo3(signature = (*, images = None, time = 0.0))]
    fn plan(&self, py: Python<'_>, images: Option<&Bound<'_, PyDict>>, time: f64) -> Result<Plan> {
        let mut pictures = Images::new();
        for (name, image) in images.into_iter().flat_map(|images| images.iter()) {
            let name: String = name.extract()?;
            self.check_image(py, &name)?;
            let image = picture(&format!("image `{name}`"), &image)?;
            pictures.insert(name, image);
        }
        Plan::new(py, self.recipe.clone(), pictures, time)
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

impl Recipe {
    /// Refuses an image that the recipe does not name.
    fn check_image(&self, py: Python<'_>, name: &str) -> Result<()> {
        let names = self.recipe.image_files();
        if names.contains(&name) {
            return Ok(());
        }
        let message = match names.is_empty() {
            true => format!("the recipe names no images, but `{name}` is given"),
            false => format!(
                "the recipe names no image `{name}`, but {}",
                names.join(", ")
            ),
        };
        let near = py
            .import("difflib")?
            .call_method1("get_close_matches", (name, names, 1))?;
        let near: Vec<String> = near.extract()?;
        Err(Error::new("unknown_image", message).with_near(near.into_iter().next()))
    }
}

/// An image of a recipe from an array.
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

/// A recipe that is ready to be baked.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Plan {
    recipe: RustRecipe,
    images: Images,
    time: f64,
    plan: RustPlan,
}

impl Plan {
    fn new(py: Python<'_>, recipe: RustRecipe, images: Images, time: f64) -> Result<Self> {
        let plan = threads::run(py, || RustPlan::new(&recipe, &images, time))??;
        Ok(Self {
            recipe,
            images,
            time,
            plan,
        })
    }
}

/// The text of a recipe, its images, and the time.
type PlanParts<'py> = (String, Bound<'py, PyDict>, f64);

/// The numbers of a map, gathered band by band.
struct Gathered {
    kind: MapKind,
    n_channels: usize,
    values: Vec<f32>,
}

impl Gathered {
    fn push(&mut self, rows: MapRows) {
        let rows = match rows {
            MapRows::Gray(raster) => raster.into_pixels(),
            MapRows::Color(raster) => flat(raster.into_pixels(), LinearRgb::to_array),
            MapRows::Normal(raster) => flat(raster.into_pixels(), Normal::to_array),
            MapRows::Packed(raster) => raster.into_pixels().into_flattened(),
        };
        if self.values.capacity() == 0 {
            self.values = rows;
        } else {
            self.values.extend_from_slice(&rows);
        }
    }
}

/// The most pixels that come in one band.
const BAND_PIXELS: usize = 1 << 20;

/// The numbers of pixels, in the memory of the pixels.
fn flat<T>(pixels: Vec<T>, numbers: impl Fn(T) -> [f32; 3]) -> Vec<f32> {
    pixels
        .into_iter()
        .map(numbers)
        .collect::<Vec<_>>()
        .into_flattened()
}

/// How many numbers a pixel of a map has.
fn n_channels(kind: MapKind) -> usize {
    match kind {
        MapKind::Normal | MapKind::Albedo | MapKind::Orm => 3,
        _ => 1,
    }
}

/// The map of a name.
fn map_kind(name: &str) -> Result<MapKind> {
    MapKind::from_name(name).ok_or_else(|| {
        let names = MapKind::ALL.map(MapKind::name).join(", ");
        Error::new(
            "name",
            format!("the map is `{name}`, but it must be one of {names}"),
        )
    })
}

/// The columns and rows of a window of a picture, which must lie within it.
fn region(size: &Bound<'_, PyAny>, window: &Bound<'_, PyAny>) -> Result<Region> {
    let arguments = GridArguments {
        size,
        extent: None,
        origin: None,
        window: Some(window),
    };
    let window = Grid::new(&arguments, &[None, None])?.plane();
    let inside = |first: i64| {
        u32::try_from(first)
            .map_err(|_| Error::new("window", "the window begins before the picture"))
    };
    Ok(Region {
        first: [inside(window.first[0])?, inside(window.first[1])?],
        size: window.size,
    })
}

#[pymethods]
impl Plan {
    /// The maps of the material, each a float32 array: (rows, columns) for `height`, `ao`, `curvature`, `roughness` and
    /// `metallic`, (rows, columns, 3) for `normal`, `albedo` (linear) and `orm`.
    ///
    /// Parameters
    /// ----------
    /// size : (rows, columns) of the whole tile, or a number for both. It may be far larger than memory.
    /// maps : the names of the maps.
    /// window : the part to make, as `np.s_[100:150, 33:94]`: bit for bit the crop of the whole.
    /// as_xarray : gives an `xarray.Dataset` with coordinates in units of the plane instead of a dictionary.
    #[pyo3(signature = (size, maps = vec!["height".to_owned()], *, window = None, as_xarray = false),
        text_signature = "(self, size, maps=('height',), *, window=None, as_xarray=False)")]
    fn bake<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        maps: Vec<String>,
        window: Option<&Bound<'py, PyAny>>,
        as_xarray: bool,
    ) -> Result<Bound<'py, PyAny>> {
        let kinds = maps
            .iter()
            .map(|name| map_kind(name))
            .collect::<Result<Vec<_>>>()?;
        let options = BakeOptions {
            size: size_of(size)?,
            region: window.map(|window| region(size, window)).transpose()?,
            maps: kinds.clone(),
            memory: BakeMemory::Whole,
        };
        let mut bake = threads::run(py, || Bake::new(&self.plan, &options))??;
        let [columns, rows] = bake.size().map(|side| side as usize);
        let mut gathered = Vec::new();
        for kind in kinds {
            let n_channels = n_channels(kind);
            let mut values = Vec::new();
            // A map of a single band is taken as it is.
            if columns * rows > BAND_PIXELS {
                arrays::reserve(&mut values, columns * rows * n_channels)?;
            }
            gathered.push(Gathered {
                kind,
                n_channels,
                values,
            });
        }
        loop {
            let band = threads::run(py, || {
                let Some(band) = bake.next() else {
                    return Ok(false);
                };
                for (gathered, (_, map)) in gathered.iter_mut().zip(band?.maps) {
                    gathered.push(map);
                }
                Ok::<_, Error>(true)
            })??;
            if !band {
                break;
            }
            py.check_signals()?;
        }
        let dictionary = PyDict::new(py);
        for (name, map) in maps.iter().zip(gathered) {
            let mut shape = vec![rows, columns];
            if map.n_channels > 1 {
                shape.push(map.n_channels);
            }
            debug_assert_eq!(
                map.kind,
                map_kind(name)?,
                "maps come in the order in which they were asked for"
            );
            dictionary.set_item(name, arrays::array(py, map.values, &shape)?)?;
        }
        if !as_xarray {
            return Ok(dictionary.into_any());
        }
        let [[width, height], [x, y]] = [
            options.size.map(f64::from),
            options
                .region
                .map_or([0; 2], |region| region.first)
                .map(f64::from),
        ];
        let extent = self.plan.extent();
        let pixel = (extent.x / width, extent.y / height);
        let dataset = py.import("dapple_textures._xarray")?.getattr("dataset")?;
        Ok(dataset.call1((dictionary, pixel, (x, y)))?)
    }

    /// The recipe that it was made from.
    #[getter]
    fn recipe(&self) -> Recipe {
        Recipe {
            recipe: self.recipe.clone(),
        }
    }

    /// The part of a loop that has passed.
    #[getter]
    fn time(&self) -> f64 {
        self.time
    }

    /// Whether every map can be made in parts: no node sees the whole tile.
    #[getter]
    fn is_local(&self) -> bool {
        self.plan.check_local().is_ok()
    }

    /// Refuses a plan with a node that sees the whole tile.
    fn check_local(&self) -> Result<()> {
        Ok(self.plan.check_local()?)
    }

    /// The maps by their names: how many channels they have, and whether they are colors ("linear") or data ("non-color").
    #[getter]
    fn map_info<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let info = py.import("dapple_textures._types")?.getattr("MapInfo")?;
        let all = PyDict::new(py);
        for kind in MapKind::ALL {
            let space = if kind == MapKind::Albedo {
                "linear"
            } else {
                "non-color"
            };
            all.set_item(kind.name(), info.call1((n_channels(kind), space))?)?;
        }
        Ok(all)
    }

    /// The numbers of a node as a field, by its name: those of the height of the material by default.
    #[pyo3(signature = (node = None))]
    fn field(&self, node: Option<String>) -> Result<Field> {
        if !self.images.is_empty() {
            return Err(Error::new(
                "conflict",
                "fields are made again from their description, which holds no images: bake the maps of this plan instead",
            ));
        }
        Field::new(Made::Node(Shared::new(NodeMade {
            recipe: self.recipe.to_json()?,
            node,
            time: self.time,
        })))
    }

    /// The SHA-256 of all that the plan is made of, its images too: the same on every machine.
    #[getter]
    fn hash(&self) -> Result<String> {
        let text = self.recipe.to_json()?;
        let mut parts = vec![text.into_bytes(), self.time.to_le_bytes().to_vec()];
        for (name, picture) in &self.images {
            let (size, values): (_, Vec<f32>) = match picture {
                Picture::Numbers(raster) => (raster.size(), raster.pixels().to_vec()),
                Picture::Colors(raster) => (
                    raster.size(),
                    flat(raster.pixels().to_vec(), LinearRgb::to_array),
                ),
            };
            parts.push(name.clone().into_bytes());
            parts.push(size.iter().flat_map(|side| side.to_le_bytes()).collect());
            parts.push(
                values
                    .iter()
                    .flat_map(|value| value.to_le_bytes())
                    .collect(),
            );
        }
        Ok(sha256(&parts.iter().map(Vec::as_slice).collect::<Vec<_>>()))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> Result<bool> {
        match other.cast::<Self>() {
            Ok(other) => Ok(other.get().hash()? == self.hash()?),
            Err(_) => Ok(false),
        }
    }

    fn __hash__(&self) -> Result<u64> {
        Ok(u64::from_str_radix(&self.hash()?[..16], 16).unwrap_or(0))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> Result<(Py<PyAny>, PlanParts<'py>)> {
        let images = PyDict::new(py);
        for (name, picture) in &self.images {
            let array = match picture {
                Picture::Numbers(raster) => arrays::numbers(py, raster.as_ref().clone()),
                Picture::Colors(raster) => {
                    arrays::channels(py, raster.map(|color| color.to_array()))
                }
            }?;
            images.set_item(name, array)?;
        }
        let make = py
            .import("dapple_textures._native")?
            .getattr("_plan_from_parts")?;
        Ok((make.unbind(), (self.recipe.to_json()?, images, self.time)))
    }

    fn __dask_tokenize__(&self) -> Result<String> {
        self.hash()
    }

    fn __repr__(&self) -> String {
        format!("<Plan of {:?} at time {}>", self.recipe.name, self.time)
    }
}

/// The plan of a recipe in JSON, with its images.
#[pyfunction]
pub(crate) fn _plan_from_parts(
    py: Python<'_>,
    recipe: &str,
    images: &Bound<'_, PyDict>,
    time: f64,
) -> Result<Plan> {
    Recipe::from_json(recipe)?.plan(py, Some(images), time)
}

/// How a field of a recipe was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct NodeMade {
    /// The recipe as JSON.
    recipe: String,
    /// The node, or the height.
    node: Option<String>,
    time: f64,
}

impl Build for NodeMade {
    type Built = Function;

    fn build(&self) -> Result<Function> {
        let plan = RustPlan::new(
            &RustRecipe::from_json(&self.recipe)?,
            &Images::new(),
            self.time,
        )?;
        Ok(Function::Plane(Arc::new(match &self.node {
            Some(node) => plan.field(node)?,
            None => plan.height()?,
        })))
    }
}

/// The windows of the shards of a picture, as pairs of (first row, first column) and (rows, columns), row by row.
///
/// A shard is a part that a machine makes on its own; the last ones of a row and of a column are cut off at the border.
/// They are those of `dapple shards`.
#[pyfunction]
pub(crate) fn shards(size: &Bound<'_, PyAny>, shard: &Bound<'_, PyAny>) -> Result<ShardList> {
    Ok(ShardList {
        shards: Shards::new(size_of(size)?, size_of(shard)?)?,
    })
}

/// The shards of a picture: a sequence that takes no memory, however long it is.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct ShardList {
    shards: Shards,
}

#[pymethods]
impl ShardList {
    /// How many shards there are below one another and side by side.
    #[getter]
    fn grid(&self) -> (u32, u32) {
        let [columns, rows] = self.shards.grid();
        (rows, columns)
    }

    fn __len__(&self) -> usize {
        usize::try_from(self.shards.len()).unwrap_or(usize::MAX)
    }

    fn __getitem__(&self, index: i64) -> Result<((u32, u32), (u32, u32))> {
        let index = if index < 0 {
            self.shards.len().checked_add_signed(index)
        } else {
            u64::try_from(index).ok()
        };
        let region = index.and_then(|index| self.shards.get(index));
        let Region {
            first: [column, row],
            size: [columns, rows],
        } = region
            .ok_or_else(|| pyo3::exceptions::PyIndexError::new_err("there are fewer shards"))?;
        Ok(((row, column), (rows, columns)))
    }
}

/// The names of all maps of a material.
#[pyfunction]
pub(crate) fn map_names() -> Vec<&'static str> {
    MapKind::ALL.map(MapKind::name).to_vec()
}
