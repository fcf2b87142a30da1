//! Synthesizes textures from an example, in the plane.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::grid::size;
use crate::options::{self, Coherence, Guide};
use crate::pictures::{self, Layout};
use crate::seed::SeedArgument;
use crate::tiles::flags;
use crate::watch;
use dapple::raster::Raster;
use dapple::synth::{
    self, Edges, Endless, EndlessOptions, Options, PlaneTexture, SynthError, SynthErrorKind,
    repair_levels, synthesize_plane_guided, synthesize_plane_with,
};
use dapple::tile::Map;
use pyo3::prelude::*;

dapple::raster::named! {
    /// The field `method` of the matching.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Method {
        /// A window of a texture without ends.
        Endless = "endless",
        /// Pixel by pixel, as in the paper.
        Sweep = "sweep",
    }
}

/// Options for comparing neighborhoods, for synthesis in the plane and on meshes.
pub(crate) struct Matching<'py>(options::Matching<'py>);

impl<'py> Matching<'py> {
    /// Reads the argument `matching`. The fields `without` have no effect in the calling function, and are refused.
    pub(crate) fn read(
        py: Python<'py>,
        given: Option<&Bound<'py, PyAny>>,
        without: &[&str],
    ) -> Result<Self> {
        let matching: options::Matching<'_> = options::read(py, "Matching", "matching", given)?;
        let set = [
            ("evenness", matching.evenness.is_some()),
            ("guides", !matching.guides.is_empty()),
            ("method", matching.method.is_some()),
            ("space", matching.space.is_some()),
            ("axes", matching.axes.is_some()),
        ];
        for (name, is_set) in set {
            if is_set && without.contains(&name) {
                let message = format!("matching: {name} has no effect in this function");
                return Err(Error::new("conflict", message));
            }
        }
        Ok(Self(matching))
    }

    /// Returns the number of levels.
    pub(crate) fn n_levels(&self) -> usize {
        let default = Options::default().n_levels;
        self.0.levels.map_or(default, |levels| levels as usize)
    }

    pub(crate) fn guides(&self) -> &[Guide<'py>] {
        &self.0.guides
    }

    /// Converts the options to [`Options`] of the library, with the same defaults as the command.
    pub(crate) fn options(&self, seed: SeedArgument) -> Result<Options> {
        let default = match self.0.paper {
            true => Options::paper(),
            false => Options::default(),
        };
        let coherence = match &self.0.coherence {
            None => default.coherence,
            Some(Coherence::Factor(factor)) => synth::Coherence::Factor(*factor),
            Some(Coherence::Word(word)) => word.parse().map_err(|_| {
                let message = format!("the coherence is `{word}`, but it must be auto or a number");
                Error::new("name", message)
            })?,
        };
        let axes = self.0.axes.as_ref();
        let space = self.0.space.as_ref();
        Ok(Options {
            seed: seed.0,
            n_levels: self.n_levels(),
            schedule: None,
            coherence,
            evenness: self.0.evenness.unwrap_or(default.evenness),
            axes: axes.map_or(Ok(default.axes), |name| data::named("axes", name))?,
            center: default.center,
            matching: space.map_or(Ok(default.matching), |name| data::named("space", name))?,
            sources: default.sources,
        })
    }

    /// Returns the requested method, or the one that other options require. `None` means endless synthesis if the
    /// period is a multiple that its levels allow, and a sweep otherwise.
    fn method(&self, at: Option<[i64; 2]>) -> Result<Option<Method>> {
        let Self(given) = self;
        let asked = given.method.as_ref();
        let asked = asked.map(|name| data::named("method", name)).transpose()?;
        let asked = match (asked, at) {
            (None, Some(_)) => Some(Method::Endless),
            (Some(Method::Sweep), Some(_)) => {
                let message = "at has no effect with the method sweep";
                return Err(Error::new("conflict", message));
            }
            _ => asked,
        };
        let is_for_sweeps = given.coherence.is_some()
            || given.evenness.is_some()
            || given.paper
            || !given.guides.is_empty();
        if is_for_sweeps && asked == Some(Method::Endless) {
            let message =
                "coherence, evenness, paper and guides have no effect on an endless texture";
            return Err(Error::new("conflict", message));
        }
        Ok(if is_for_sweeps {
            Some(Method::Sweep)
        } else {
            asked
        })
    }
}

/// The argument `exemplar`: maps of the same size, and their options.
pub(crate) struct Exemplar<'py> {
    pub(crate) layout: Layout,
    pub(crate) maps: Vec<Map>,
    pub(crate) given: options::Exemplar<'py>,
}

impl<'py> Exemplar<'py> {
    /// Reads maps, or an `Exemplar` of Python. `what` names the argument in error messages.
    pub(crate) fn read(what: &str, given: &Bound<'py, PyAny>) -> Result<Self> {
        let module = given.py().import("dapple_textures._options")?;
        let given: options::Exemplar<'_> = module.call_method1("exemplar", (given,))?.extract()?;
        let (layout, maps) = pictures::read(what, &given.maps)?;
        for map in &maps {
            if map.size() != maps[0].size() {
                let message = format!(
                    "the maps of an example have one size, but one has {:?} columns and rows, and the first {:?}",
                    map.size(),
                    maps[0].size()
                );
                return Err(Error::new("size", message));
            }
        }
        Ok(Self {
            layout,
            maps,
            given,
        })
    }

    /// Reads an exemplar whose maps are an image. The texture of a mesh is refused.
    pub(crate) fn read_image(what: &str, given: &Bound<'py, PyAny>) -> Result<Self> {
        let image = Self::read(what, given)?;
        let given = &image.given;
        if given.mesh.is_some() || given.sites.is_some() || given.directions.is_some() {
            let message = format!(
                "{what}: mesh, sites and directions have no effect here; `synthesize_on` takes them"
            );
            return Err(Error::new("conflict", message));
        }
        Ok(image)
    }

    /// Builds the exemplar from the first map. Only this map is matched; the others are transferred. Pixels in `hole`
    /// and outside of the mask are never copied.
    pub(crate) fn matched(&self, hole: Option<&Raster<bool>>) -> Result<synth::Exemplar> {
        let edges: Edges = data::named("edges", &self.given.edges)?;
        let exemplar = match &self.maps[..] {
            [Map::Color(colors), ..] => synth::Exemplar::new(colors, edges)?,
            [Map::Value(values), ..] => synth::Exemplar::from_planes(&[(values, 1.0)], edges)?,
            _ => {
                let message = "normals are no example: let colors or heights be the first map";
                return Err(Error::new("channels", message));
            }
        };
        let mask = self.given.mask.as_ref();
        let mask = mask.map(|mask| is_set("mask", mask)).transpose()?;
        let usable = match (mask, hole) {
            (mask, None) => mask,
            (None, Some(hole)) => Some(hole.map(|is_made| !is_made)),
            (Some(mask), Some(hole)) => {
                Some(mask.zip_map(hole, |&is_usable, &is_made| is_usable && !is_made)?)
            }
        };
        Ok(match usable {
            Some(usable) => exemplar.with_mask(&usable)?,
            None => exemplar,
        })
    }
}

/// Reads a mask: pixels with values of at least 0.5 are set.
pub(crate) fn is_set(what: &str, mask: &Bound<'_, PyAny>) -> Result<Raster<bool>> {
    Ok(pictures::numbers(what, mask)?.map(|&value| value >= 0.5))
}

/// Synthesizes a texture of any size that looks like an example, after Lefebvre and Hoppe (2005, 2006) or Turk
/// (2001).
///
/// Every pixel is copied from the example, chosen so that its neighborhoods in the example and in the texture match.
///
/// Parameters
/// ----------
/// exemplar : dict of array_like, array_like or Exemplar
///     (rows, columns), or (rows, columns, 3 or 4) in linear light, ideally 64 to 256 pixels wide; or a dictionary of
///     maps, of which the first is matched (color in sRGB, scalars unchanged) and the others follow it. An `Exemplar`
///     adds a mask, or edges that repeat.
/// size : int or tuple of int
///     (rows, columns), or one number for both; at most 2**26 pixels.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
/// wrap : bool or tuple of bool, default False
///     Whether the texture repeats along each axis, x first; one value for both. A side that repeats must be a
///     multiple of 2**levels if the method is `"endless"`, and of 2**(levels - 1) otherwise.
/// at : tuple of int or None, default None
///     The position (x, y), that is, column and row, of the result in an endless texture, from -2**52 to 2**52; by
///     default (0, 0). Adjacent windows fit together.
/// matching : Matching, dict or None, default None
///     How neighborhoods are compared; by default Matching(). `space` and `axes` are for meshes.
/// sources : bool, default False
///     Whether to return (texture, sources), where `sources` has the (column, row) of each pixel's source in the
///     example, (rows, columns, 2).
/// progress : callable or None, default None
///     Called with the completed fraction of the work, from 0 to 1. Ctrl-C stops the call.
///
/// Returns
/// -------
/// dict or tuple of (dict, numpy.ndarray of int64) or numpy.ndarray of float32 or tuple of (numpy.ndarray of float32, numpy.ndarray of int64)
///     The texture, in the form of the example: an array, or a dictionary of arrays. With `sources`, also the
///     position in the example that each pixel was copied from.
///
/// Raises
/// ------
/// DappleError
///     If the maps of the example differ in size, or an option is out of range or conflicts with another.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> checker = np.kron([[0, 1], [1, 0]], np.ones((8, 8)))
/// >>> exemplar = dp.Exemplar(checker, edges="wrap")
/// >>> texture, sources = dp.synthesize(exemplar, (24, 20), matching={"levels": 2}, sources=True)
/// >>> bool((texture == checker[sources[..., 1], sources[..., 0]]).all())
/// True
#[pyfunction]
#[pyo3(signature = (exemplar, size, *, seed = SeedArgument::default(), wrap = None, at = None, matching = None,
    sources = false, progress = None),
    text_signature = "(exemplar, size, *, seed=0, wrap=False, at=None, matching=None, sources=False, progress=None)")]
pub(crate) fn synthesize<'py>(
    py: Python<'py>,
    exemplar: &Bound<'py, PyAny>,
    size: &Bound<'py, PyAny>,
    seed: SeedArgument,
    wrap: Option<&Bound<'py, PyAny>>,
    at: Option<[i64; 2]>,
    matching: Option<&Bound<'py, PyAny>>,
    sources: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let given = Exemplar::read_image("exemplar", exemplar)?;
    let matching = Matching::read(py, matching, &["space", "axes"])?;
    let size = self::size(size)?;
    let (exemplar, targets) = guided(given.matched(None)?, size, matching.guides())?;
    let method = matching.method(at)?;
    let options = matching.options(seed)?;
    let wrap = flags(wrap, false)?.map(|wraps| if wraps { Edges::Wrap } else { Edges::Cut });
    let endless = EndlessOptions {
        seed: seed.0,
        n_levels: matching.0.levels,
        period: [0, 1].map(|axis| (wrap[axis] == Edges::Wrap).then_some(size[axis])),
    };
    let texture = watch::run(py, progress, move |heard, _| {
        let targets: Vec<_> = targets.iter().collect();
        if method != Some(Method::Sweep) {
            match Endless::new(&exemplar, &endless) {
                Ok(texture) => {
                    return texture.window(at.unwrap_or([0, 0]), size, heard);
                }
                Err(error)
                    if method.is_none()
                        && matches!(error.kind(), SynthErrorKind::Period { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        match targets[..] {
            [] => synthesize_plane_with(&exemplar, size, wrap, &options, heard),
            _ => synthesize_plane_guided(&exemplar, &targets, wrap, &options, heard),
        }
    })??;
    followed(py, given, &texture, sources)
}

/// Adds the guides' values in the example to an exemplar. Returns it with the guides' values in the texture, which must
/// have the size of the texture.
fn guided(
    exemplar: synth::Exemplar,
    size: [u32; 2],
    guides: &[Guide<'_>],
) -> Result<(synth::Exemplar, Vec<Raster<f32>>)> {
    let mut planes = Vec::new();
    let mut targets = Vec::new();
    for (of_example, of_texture, weight) in guides {
        planes.push((pictures::numbers("guides", of_example)?, *weight));
        let target = pictures::numbers("guides", of_texture)?;
        target.check_same_size(size).map_err(SynthError::from)?;
        targets.push(target);
    }
    let planes: Vec<_> = planes
        .iter()
        .map(|(plane, weight)| (plane, *weight))
        .collect();
    Ok((exemplar.with_guides(&planes)?, targets))
}

/// Re-synthesizes part of a photograph of a texture, such as a stain; everything around it is unchanged.
///
/// Parameters
/// ----------
/// image : dict of array_like, array_like or Exemplar
///     The photograph, in the form of the `exemplar` of `synthesize`.
/// hole : array_like
///     (rows, columns), at least 0.5 where the image is re-synthesized; nothing is copied from there.
/// seed : int, default 0
///     As for `synthesize`.
/// matching : Matching, dict or None, default None
///     How neighborhoods are compared; by default Matching(). `levels` follows the size of the hole unless it is
///     given. Only `levels`, `coherence` and `paper` have an effect.
/// sources : bool, default False
///     Whether to return (image, sources), as for `synthesize`.
/// progress : callable or None, default None
///     As for `synthesize`.
///
/// Returns
/// -------
/// dict or tuple of (dict, numpy.ndarray of int64) or numpy.ndarray of float32 or tuple of (numpy.ndarray of float32, numpy.ndarray of int64)
///     The photograph, in the same form as the input: an array, or a dictionary of arrays. With `sources`, also the
///     position that each pixel was copied from.
///
/// Raises
/// ------
/// DappleError
///     If the mask differs in size or leaves too little to copy from, or an option is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> checker = np.kron(np.indices((8, 8)).sum(0) % 2, np.ones((8, 8)))
/// >>> hole = np.zeros((64, 64))
/// >>> hole[28:36, 20:27] = 1
/// >>> stained = np.where(hole, 0.5, checker)
/// >>> bool((dp.repair(stained, hole) == checker).all())
/// True
#[pyfunction]
#[pyo3(signature = (image, hole, *, seed = SeedArgument::default(), matching = None, sources = false, progress = None),
    text_signature = "(image, hole, *, seed=0, matching=None, sources=False, progress=None)")]
pub(crate) fn repair<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    hole: &Bound<'py, PyAny>,
    seed: SeedArgument,
    matching: Option<&Bound<'py, PyAny>>,
    sources: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let image = Exemplar::read_image("image", image)?;
    let without = ["evenness", "guides", "method", "space", "axes"];
    let matching = Matching::read(py, matching, &without)?;
    let hole = is_set("hole", hole)?;
    let options = Options {
        n_levels: match matching.0.levels {
            None => repair_levels(&hole),
            Some(_) => matching.n_levels(),
        },
        ..matching.options(seed)?
    };
    let exemplar = image.matched(Some(&hole))?;
    let texture = watch::run(py, progress, move |heard, _| {
        PlaneTexture::identity(&exemplar)?.repair(&exemplar, &hole, &options, heard)
    })??;
    followed(py, image, &texture, sources)
}

/// Transfers the example's maps to a texture. Returns them in the layout of the example. With `sources`, also returns
/// the source position of each pixel.
fn followed<'py>(
    py: Python<'py>,
    exemplar: Exemplar<'py>,
    texture: &PlaneTexture,
    sources: bool,
) -> Result<Bound<'py, PyAny>> {
    let transferred = exemplar.maps.iter().map(|map| transfer(texture, map));
    let transferred = transferred.collect::<core::result::Result<_, _>>()?;
    let picture = exemplar.layout.python(py, transferred)?;
    if !sources {
        return Ok(picture);
    }
    let places = texture.sources().pixels().iter().flatten();
    let places = places.map(|&at| i64::from(at)).collect();
    let [width, height] = texture.sources().size().map(|side| side as usize);
    let places = arrays::array(py, places, &[height, width, 2])?;
    Ok((picture, places).into_pyobject(py)?.into_any())
}

/// Transfers a map of the example to the texture, by copying pixels from the source positions.
fn transfer(texture: &PlaneTexture, map: &Map) -> core::result::Result<Map, SynthError> {
    Ok(match map {
        Map::Value(raster) => Map::Value(texture.transfer(raster)?),
        Map::Color(raster) => Map::Color(texture.transfer(raster)?),
        Map::Normal(raster) => Map::Normal(texture.transfer(raster)?),
    })
}
