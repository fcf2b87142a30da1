//! Synthesizes textures from an example, in the plane.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::grid::size;
use crate::pictures::{self, Layout};
use crate::seed::SeedArgument;
use crate::tiles::flags;
use crate::watch;
use dapple::raster::Raster;
use dapple::synth::{
    Axes, Edges, Endless, EndlessOptions, Exemplar, Options, PlaneTexture, SynthError,
    SynthErrorKind, synthesize_plane_guided, synthesize_plane_with,
};
use dapple::tile::Map;
use pyo3::prelude::*;

dapple::raster::named! {
    /// The argument `method`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Method {
        /// A window of a texture without ends.
        Endless = "endless",
        /// Pixel by pixel, as in the paper.
        Sweep = "sweep",
    }
}

/// The argument `coherence`.
#[derive(FromPyObject)]
pub(crate) enum Coherence {
    /// A number of at least 0.
    Factor(f32),
    /// The word `auto`.
    Word(String),
}

/// Matching options, shared by synthesis in the plane and on meshes.
pub(crate) struct Matching {
    pub(crate) seed: SeedArgument,
    pub(crate) levels: usize,
    pub(crate) coherence: Option<Coherence>,
    pub(crate) evenness: Option<f32>,
    pub(crate) axes: Option<Axes>,
    pub(crate) matching: Option<dapple::synth::Matching>,
    pub(crate) paper: bool,
}

impl Matching {
    /// Returns the options for a repair.
    pub(crate) fn of_repair(
        seed: SeedArgument,
        levels: usize,
        coherence: Option<Coherence>,
    ) -> Self {
        Self {
            seed,
            levels,
            coherence,
            evenness: None,
            axes: None,
            matching: None,
            paper: false,
        }
    }

    /// Converts the options to the options of the library, with the defaults of the command.
    pub(crate) fn options(self) -> Result<Options> {
        let default = match self.paper {
            true => Options::paper(),
            false => Options::default(),
        };
        let coherence = match self.coherence {
            None => default.coherence,
            Some(Coherence::Factor(factor)) => dapple::synth::Coherence::Factor(factor),
            Some(Coherence::Word(word)) => word.parse().map_err(|_| {
                let message = format!("the coherence is `{word}`, but it must be auto or a number");
                Error::new("name", message)
            })?,
        };
        Ok(Options {
            seed: self.seed.0,
            n_levels: self.levels,
            schedule: None,
            coherence,
            evenness: self.evenness.unwrap_or(default.evenness),
            axes: self.axes.unwrap_or(default.axes),
            center: default.center,
            matching: self.matching.unwrap_or(default.matching),
            sources: default.sources,
        })
    }
}

/// Builds the exemplar from the first map, which is matched. The other maps are transferred.
pub(crate) fn exemplar(maps: &[Map], edges: &str) -> Result<Exemplar> {
    let edges: Edges = data::named("edges", edges)?;
    match maps {
        [Map::Color(colors), ..] => Ok(Exemplar::new(colors, edges)?),
        [Map::Value(values), ..] => Ok(Exemplar::from_planes(&[(values, 1.0)], edges)?),
        _ => {
            let message = "normals are no example: let colors or heights be the first map";
            Err(Error::new("channels", message))
        }
    }
}

/// Synthesizes a texture of any size that looks like an example, after Lefebvre and Hoppe (2005, 2006) or Turk
/// (2001).
///
/// Every pixel is copied from the example, chosen so that its neighborhoods in the example and in the texture match.
///
/// Parameters
/// ----------
/// exemplar : dict of array_like or array_like
///     (rows, columns), or (rows, columns, 3 or 4) in linear light, ideally 64 to 256 pixels wide; or a dictionary of
///     maps, of which the first is matched (color in sRGB, scalars unchanged) and the others follow it.
/// size : int or tuple of int
///     (rows, columns), or one number for both; at most 2**26 pixels.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
/// wrap : bool or tuple of bool, default False
///     Whether the texture repeats along each axis, x first; one value for both. A side that repeats must be a
///     multiple of 2**levels if the method is `"endless"`, and of 2**(levels - 1) otherwise.
/// edges : {"cut", "wrap"}, default "cut"
///     How the edges of the example are treated: `"cut"`, or `"wrap"` if the example repeats.
/// levels : int or None, default None
///     1 to 16 levels, each with half the resolution of the next finer one: more levels capture larger features. By
///     default 3, or as many as fit the example if the method is `"endless"`.
/// coherence : float, {"auto"} or None, default None
///     The tolerance for worse matches that continue the adjacent pixels: `"auto"` or a number of at least 0; higher
///     values copy larger pieces.
/// evenness : float or None, default None
///     How evenly the pixels of the example are used, 0 to 1000; 1 by default.
/// paper : bool, default False
///     Whether to match as in the paper, where the smallest difference wins.
/// mask : array_like or None, default None
///     (rows, columns) of the example, at least 0.5 where it may be used; nothing is copied from elsewhere.
/// guides : sequence of tuple of (array_like, float), default ()
///     A list of (of_example, of_texture, weight): scalar images of the same size as the example and as the texture.
///     Parts of the example are placed where both have similar values. With weight 1 a guide counts as much as one
///     channel; with weight 3 a guide of zeros and ones is followed nearly everywhere. With guides, `evenness` has no
///     effect.
/// sources : bool, default False
///     Whether to return (texture, sources), where `sources` has the (column, row) of each pixel's source in the
///     example, (rows, columns, 2).
/// method : {"endless", "sweep"} or None, default None
///     `"endless"`, a window of an infinite texture, which is fast and preserves large or regular features; or
///     `"sweep"`, pixel by pixel. By default `"endless"`, unless `coherence`, `evenness`, `paper` or `guides` are
///     given or the length of a side that wraps is not the required multiple.
/// at : tuple of int or None, default None
///     The position (x, y), that is, column and row, of the result in an endless texture, from -2**52 to 2**52; by
///     default (0, 0). Adjacent windows fit together.
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
/// >>> texture, sources = dp.synthesize(checker, (24, 20), edges="wrap", levels=2, sources=True)
/// >>> bool((texture == checker[sources[..., 1], sources[..., 0]]).all())
/// True
#[pyfunction]
#[pyo3(signature = (exemplar, size, *, seed = SeedArgument::default(), wrap = None, edges = "cut", levels = None, coherence = None,
    evenness = None, paper = false, mask = None, guides = Vec::new(), sources = false, method = None, at = None,
    progress = None),
    text_signature = "(exemplar, size, *, seed=0, wrap=False, edges=\"cut\", levels=None, coherence=None, evenness=None, \
    paper=False, mask=None, guides=(), sources=False, method=None, at=None, progress=None)")]
pub(crate) fn synthesize<'py>(
    py: Python<'py>,
    exemplar: &Bound<'py, PyAny>,
    size: &Bound<'py, PyAny>,
    seed: SeedArgument,
    wrap: Option<&Bound<'py, PyAny>>,
    edges: &str,
    levels: Option<u32>,
    coherence: Option<Coherence>,
    evenness: Option<f32>,
    paper: bool,
    mask: Option<&Bound<'py, PyAny>>,
    guides: Vec<(Bound<'py, PyAny>, Bound<'py, PyAny>, f32)>,
    sources: bool,
    method: Option<&str>,
    at: Option<[i64; 2]>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("exemplar", exemplar)?;
    check_sizes(&maps)?;
    let mut exemplar = self::exemplar(&maps, edges)?;
    if let Some(mask) = mask {
        exemplar =
            exemplar.with_mask(&pictures::numbers("mask", mask)?.map(|&value| value >= 0.5))?;
    }
    let size = self::size(size)?;
    let (exemplar, targets) = guided(exemplar, size, &guides)?;
    let is_for_sweeps = coherence.is_some() || evenness.is_some() || paper || !targets.is_empty();
    let method = self::method(method, at, is_for_sweeps)?;
    let default = Options::default().n_levels;
    let matching = Matching {
        seed,
        levels: levels.map_or(default, |levels| levels as usize),
        coherence,
        evenness,
        axes: None,
        matching: None,
        paper,
    };
    let options = matching.options()?;
    let wrap = flags(wrap, false)?.map(|wraps| if wraps { Edges::Wrap } else { Edges::Cut });
    let endless = EndlessOptions {
        seed: seed.0,
        n_levels: levels,
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
    followed(py, layout, &maps, &texture, sources)
}

/// Returns the requested method, or the method that other options require. `None` means endless synthesis, or a sweep
/// if the period does not fit the levels.
fn method(
    asked: Option<&str>,
    at: Option<[i64; 2]>,
    is_for_sweeps: bool,
) -> Result<Option<Method>> {
    let asked = asked.map(|name| data::named("method", name)).transpose()?;
    let asked = match (asked, at) {
        (None, Some(_)) => Some(Method::Endless),
        (Some(Method::Sweep), Some(_)) => {
            return Err(Error::new(
                "conflict",
                "at has no effect with the method sweep",
            ));
        }
        _ => asked,
    };
    if is_for_sweeps && asked == Some(Method::Endless) {
        let message = "coherence, evenness, paper and guides have no effect on an endless texture";
        return Err(Error::new("conflict", message));
    }
    Ok(if is_for_sweeps {
        Some(Method::Sweep)
    } else {
        asked
    })
}

/// Adds the guides to an exemplar, and returns it with the texture's guides, which must be the same size as the
/// texture.
fn guided(
    exemplar: Exemplar,
    size: [u32; 2],
    guides: &[(Bound<'_, PyAny>, Bound<'_, PyAny>, f32)],
) -> Result<(Exemplar, Vec<Raster<f32>>)> {
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
/// image : dict of array_like or array_like
///     (rows, columns), or (rows, columns, 3 or 4) in linear light; or a dictionary of maps, of which the first is
///     matched (color in sRGB, scalars unchanged) and the others follow it.
/// hole : array_like
///     (rows, columns), at least 0.5 where the image is re-synthesized; nothing is copied from there.
/// seed : int, default 0
///     As for `synthesize`.
/// edges : {"cut", "wrap"}, default "cut"
///     As for `synthesize`.
/// levels : int, default 3
///     As for `synthesize`; more levels fill larger holes.
/// coherence : float, {"auto"} or None, default None
///     As for `synthesize`.
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
#[pyo3(signature = (image, hole, *, seed = SeedArgument::default(), edges = "cut", levels = 3, coherence = None, sources = false,
    progress = None),
    text_signature = "(image, hole, *, seed=0, edges=\"cut\", levels=3, coherence=None, sources=False, progress=None)")]
pub(crate) fn repair<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    hole: &Bound<'py, PyAny>,
    seed: SeedArgument,
    edges: &str,
    levels: usize,
    coherence: Option<Coherence>,
    sources: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("image", image)?;
    check_sizes(&maps)?;
    let hole = pictures::numbers("hole", hole)?.map(|&value| value >= 0.5);
    let usable = hole.map(|is_made| !is_made);
    let exemplar = self::exemplar(&maps, edges)?.with_mask(&usable)?;
    let options = Matching::of_repair(seed, levels, coherence).options()?;
    let texture = watch::run(py, progress, move |heard, _| {
        PlaneTexture::identity(&exemplar)?.repair(&exemplar, &hole, &options, heard)
    })??;
    followed(py, layout, &maps, &texture, sources)
}

/// Transfers the example's maps to a texture, and returns them in the layout of the example; with `sources`, also the
/// source of each pixel.
fn followed<'py>(
    py: Python<'py>,
    layout: Layout,
    maps: &[Map],
    texture: &PlaneTexture,
    sources: bool,
) -> Result<Bound<'py, PyAny>> {
    let transferred = maps.iter().map(|map| transfer(texture, map));
    let picture = layout.python(py, transferred.collect::<core::result::Result<_, _>>()?)?;
    if !sources {
        return Ok(picture);
    }
    let places = texture.sources().pixels().iter().flatten();
    let places = places.map(|&at| i64::from(at)).collect();
    let [width, height] = texture.sources().size().map(|side| side as usize);
    let places = arrays::array(py, places, &[height, width, 2])?;
    Ok((picture, places).into_pyobject(py)?.into_any())
}

/// Checks that the maps have the same size.
pub(crate) fn check_sizes(maps: &[Map]) -> Result<()> {
    for map in maps {
        if map.size() != maps[0].size() {
            let message = format!(
                "the maps of an example have one size, but one has {:?} columns and rows, and the first {:?}",
                map.size(),
                maps[0].size()
            );
            return Err(Error::new("size", message));
        }
    }
    Ok(())
}

/// Transfers one of the example's maps to the texture.
fn transfer(texture: &PlaneTexture, map: &Map) -> core::result::Result<Map, SynthError> {
    Ok(match map {
        Map::Value(raster) => Map::Value(texture.transfer(raster)?),
        Map::Color(raster) => Map::Color(texture.transfer(raster)?),
        Map::Normal(raster) => Map::Normal(texture.transfer(raster)?),
    })
}
