//! Plans: recipes that are ready to be baked.

use super::maps::{_map_info, kind_of, maps};
use super::node::plan;
use super::{NodeMade, Recipe, sha256};
use crate::arrays;
use crate::error::{Error, Result};
use crate::field::Field;
use crate::function::Made;
use crate::grid::{self, Grid, GridArguments, size as size_of};
use crate::shared::Shared;
use crate::watch::{self, Stop};
use dapple::color::{LinearRgb, Normal};
use dapple::recipe::{
    Bake, BakeOptions, Images, MapKind, MapRows, Picture, Plan as RustPlan, Recipe as RustRecipe,
    Region, Samples,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A recipe that is ready to be baked.
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct Plan {
    recipe: RustRecipe,
    images: Images,
    time: f64,
    plan: RustPlan,
}

impl Plan {
    pub(super) fn new(
        py: Python<'_>,
        recipe: RustRecipe,
        images: Images,
        time: f64,
    ) -> Result<Self> {
        watch::run(py, None, move |_, stop| -> Result<Self> {
            let plan = plan(&recipe, &images, time, stop.clone())?;
            Ok(Self {
                recipe,
                images,
                time,
                plan,
            })
        })?
    }
}

/// Inputs that a plan is pickled with: the recipe text, its images, and the time.
type PlanParts<'py> = (String, Bound<'py, PyDict>, f64);

/// The values of a map, collected band by band.
struct Gathered {
    map: MapKind,
    values: Vec<f32>,
}

impl Gathered {
    /// Appends rows of a map that has `n_values` values in total. If the rows are the whole map, they are moved
    /// instead of copied.
    fn push(&mut self, rows: MapRows, n_values: usize) -> Result<()> {
        let rows = match rows {
            MapRows::Gray(raster) => raster.into_pixels(),
            MapRows::Color(raster) => flat(raster.into_pixels(), LinearRgb::to_array),
            MapRows::Normal(raster) => flat(raster.into_pixels(), Normal::to_array),
            MapRows::Packed(raster) => raster.into_pixels().into_flattened(),
        };
        if rows.len() == n_values {
            self.values = rows;
            return Ok(());
        }
        if self.values.is_empty() {
            arrays::reserve(&mut self.values, n_values)?;
        }
        self.values.extend_from_slice(&rows);
        Ok(())
    }
}

/// Flattens pixels to numbers, reusing the memory of the pixels.
fn flat<T>(pixels: Vec<T>, numbers: impl Fn(T) -> [f32; 3]) -> Vec<f32> {
    pixels
        .into_iter()
        .map(numbers)
        .collect::<Vec<_>>()
        .into_flattened()
}

/// Bakes all bands of the maps. Stops with an error if requested. Returns the numbers of columns and rows, and the
/// maps.
fn bake_all(
    plan: &RustPlan,
    options: &BakeOptions,
    stop: &Stop,
) -> Result<([usize; 2], Vec<Gathered>)> {
    let wanted = stop.clone();
    let plan = plan.clone().with_progress(move |_| wanted.flow());
    let bake = Bake::new(&plan, options)?;
    let [columns, rows] = bake.size().map(|side| side as usize);
    let n_values = |map| columns * rows * kind_of(map).n_channels;
    let empty = |&map| Gathered {
        map,
        values: Vec::new(),
    };
    let mut gathered: Vec<_> = options.maps.iter().map(empty).collect();
    for band in bake {
        stop.check()?;
        for (gathered, (map, rows)) in gathered.iter_mut().zip(band?.maps) {
            debug_assert_eq!(
                gathered.map, map,
                "maps come in the order in which they were asked for"
            );
            gathered.push(rows, n_values(map))?;
        }
    }
    Ok(([columns, rows], gathered))
}

/// Converts the baked maps to a dictionary of arrays.
fn dictionary<'py>(
    py: Python<'py>,
    [columns, rows]: [usize; 2],
    gathered: Vec<Gathered>,
) -> Result<Bound<'py, PyDict>> {
    let dictionary = PyDict::new(py);
    for Gathered { map, values } in gathered {
        let shape = [rows, columns, kind_of(map).n_channels];
        let n_axes = if shape[2] > 1 { 3 } else { 2 };
        dictionary.set_item(map.name(), arrays::array(py, values, &shape[..n_axes])?)?;
    }
    Ok(dictionary)
}

/// Reads a window of a map, which must be within the map.
fn region(size: &Bound<'_, PyAny>, window: &Bound<'_, PyAny>) -> Result<Region> {
    let arguments = GridArguments {
        size,
        extent: None,
        origin: None,
        window: Some(window),
        samples: None,
    };
    let window = Grid::new(&arguments, &[None; 2], &[1.0; 2])?.plane();
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
    /// Bakes the maps of the material as float32 arrays: (rows, columns) for `height`, `ao`, `curvature`, `roughness`
    /// and `metallic`, (rows, columns, 3) for `normal`, `albedo` and `emission` (both linear) and `orm`.
    ///
    /// Parameters
    /// ----------
    /// size : int or tuple of int
    ///     (rows, columns) of the whole tile, or one number for both. The tile may be far larger than memory.
    /// maps : str or iterable of str, default "height"
    ///     The name of a map, or several distinct names; see `map_names`.
    /// window : tuple of slice or None, default None
    ///     The part to bake, such as `np.s_[100:150, 33:94]`. The result is bit for bit a crop of the whole. The
    ///     window must be inside the tile.
    /// samples : str, default "centers"
    ///     The sample positions: "centers" of pixels, or "corners" of a grid that reaches the sides of the tile, as
    ///     terrain heights use. With corners, the last row and column equal the first ones where the tile repeats.
    /// supersample : int, default 1
    ///     The samples per pixel along each axis, from 1 to 16, whose mean is the pixel. Heights are averaged before
    ///     normals and occlusion are computed, and colors in linear light.
    /// as_xarray : bool, default False
    ///     Whether to return an `xarray.Dataset` with coordinates in units of the plane instead of a dictionary.
    ///
    /// Returns
    /// -------
    /// dict or xarray.Dataset
    ///     The arrays by map name.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If `size` or `window` is out of range, a map is unknown or named twice, or a node fails; the error's
    ///     `node` names it.
    #[pyo3(signature = (size, maps = None, *, window = None, samples = None, supersample = 1, as_xarray = false),
        text_signature = "(self, size, maps='height', *, window=None, samples='centers', supersample=1, as_xarray=False)")]
    #[expect(clippy::too_many_arguments, reason = "they are keywords")]
    fn bake<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        maps: Option<&Bound<'py, PyAny>>,
        window: Option<&Bound<'py, PyAny>>,
        samples: Option<&str>,
        supersample: u32,
        as_xarray: bool,
    ) -> Result<Bound<'py, PyAny>> {
        let samples = grid::samples(samples)?;
        let options = BakeOptions {
            size: size_of(size)?,
            samples,
            supersample,
            region: window.map(|window| region(size, window)).transpose()?,
            maps: maps.map_or(Ok(vec![MapKind::Height]), self::maps)?,
            ..BakeOptions::default()
        };
        let (plan, wanted) = (self.plan.clone(), options.clone());
        let (sides, gathered) =
            watch::run(py, None, move |_, stop| bake_all(&plan, &wanted, stop))??;
        let maps = dictionary(py, sides, gathered)?;
        if !as_xarray {
            return Ok(maps.into_any());
        }
        let first = options.region.map_or([0; 2], |region| region.first);
        let (spaces, shift) = match samples {
            Samples::Corners => (options.size.map(|side| side - 1), 0.5),
            _ => (options.size, 0.0),
        };
        let [[width, height], [x, y]] = [spaces, first].map(|sides| sides.map(f64::from));
        let extent = self.plan.extent();
        let pixel = (extent.x / width, extent.y / height);
        let (x, y) = (x - shift, y - shift);
        let dataset = py.import("dapple_textures._xarray")?.getattr("dataset")?;
        Ok(dataset.call1((maps, pixel, (x, y)))?)
    }

    /// The recipe that the plan was built from.
    #[getter]
    fn recipe(&self) -> Recipe {
        Recipe {
            recipe: self.recipe.clone(),
        }
    }

    /// The elapsed fraction of the looping animation, as passed to `Recipe.plan`.
    #[getter]
    fn time(&self) -> f64 {
        self.time
    }

    /// Whether every map can be baked in parts, that is, whether no node depends on the whole tile.
    #[getter]
    fn is_local(&self) -> bool {
        self.plan.check_local().is_ok()
    }

    /// Raises an error if a node of the plan depends on the whole tile.
    fn check_local(&self) -> Result<()> {
        Ok(self.plan.check_local()?)
    }

    /// The maps by name: the number of channels, whether they are colors ("linear") or data ("non-color"), and the
    /// `content` for `write_image`.
    #[getter]
    fn map_info<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        _map_info(py)
    }

    /// Returns the values of the node called `node` as a field; by default the material's height.
    ///
    /// Parameters
    /// ----------
    /// node : str or None, default None
    ///     The name of the node; by default the material's height.
    ///
    /// Returns
    /// -------
    /// Field
    ///     The field.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If there is no such node, its values are colors or depend on the whole tile, or the plan has images.
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

    /// The SHA-256 of all inputs of the plan, including its images; it is the same on every machine.
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

/// Builds a plan from a recipe in JSON, with its images.
#[pyfunction]
pub(crate) fn _plan_from_parts(
    py: Python<'_>,
    recipe: &str,
    images: &Bound<'_, PyDict>,
    time: f64,
) -> Result<Plan> {
    Recipe::from_json(recipe)?.plan(py, Some(images), time)
}
