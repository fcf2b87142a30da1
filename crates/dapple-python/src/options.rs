//! Reads option objects, which are dataclasses of the module `_options`. Defaults are declared there and nowhere else.

use crate::error::Result;
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;

/// Weighting of control points: the Python class `Net`.
#[derive(FromPyObject)]
pub(crate) struct Net<'py> {
    pub(crate) axis_scale: f64,
    pub(crate) weight: Bound<'py, PyAny>,
    pub(crate) orientations: Option<Bound<'py, PyAny>>,
    pub(crate) strength: f64,
    pub(crate) fade: f64,
}

/// Layout of a mesh in a texture: the Python class `Atlas`.
#[derive(FromPyObject)]
pub(crate) struct Atlas {
    pub(crate) texels: u32,
    pub(crate) kind: String,
    pub(crate) padding: Option<u32>,
    pub(crate) crease: f64,
}

/// Positions on a mesh, and a vector at each.
pub(crate) type Vectors<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

/// Directions and sizes of a texture on a mesh: the Python class `Directions`.
#[derive(FromPyObject)]
pub(crate) struct Directions<'py> {
    pub(crate) field: Option<Vectors<'py>>,
    pub(crate) down: Option<[f64; 3]>,
    pub(crate) symmetry: u8,
    pub(crate) scales: Option<Bound<'py, PyAny>>,
}

/// Maps of an example, with their edges, mask and mesh: the Python class `Exemplar`.
#[derive(FromPyObject)]
pub(crate) struct Exemplar<'py> {
    pub(crate) maps: Bound<'py, PyAny>,
    pub(crate) edges: String,
    pub(crate) mask: Option<Bound<'py, PyAny>>,
    pub(crate) mesh: Option<Bound<'py, PyAny>>,
    pub(crate) sites: Option<usize>,
    pub(crate) directions: Option<Vectors<'py>>,
}

/// A guide: its values in the example, its values in the texture, and its weight.
pub(crate) type Guide<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, f32);

/// The field `coherence` of [`Matching`].
#[derive(FromPyObject)]
pub(crate) enum Coherence {
    /// A number of at least 0.
    Factor(f32),
    /// The word `auto`.
    Word(String),
}

/// Options for comparing neighborhoods: the Python class `Matching`.
#[derive(FromPyObject)]
pub(crate) struct Matching<'py> {
    pub(crate) levels: Option<u32>,
    pub(crate) coherence: Option<Coherence>,
    pub(crate) evenness: Option<f32>,
    pub(crate) paper: bool,
    pub(crate) guides: Vec<Guide<'py>>,
    pub(crate) method: Option<String>,
    pub(crate) space: Option<String>,
    pub(crate) axes: Option<String>,
}

/// Reads the option object given for the parameter `name`: an instance of the class `kind`, a dictionary of its fields,
/// or `None` for the defaults.
pub(crate) fn read<'py, T: FromPyObjectOwned<'py>>(
    py: Python<'py>,
    kind: &str,
    name: &str,
    given: Option<&Bound<'py, PyAny>>,
) -> Result<T> {
    let module = py.import("dapple_textures._options")?;
    let options = module.call_method1("read", (module.getattr(kind)?, name, given))?;
    Ok(options.extract::<T>().map_err(Into::<PyErr>::into)?)
}
