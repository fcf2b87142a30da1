//! Synthesis of textures from an example, in the plane.

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
    /// A factor.
    Factor(f32),
    /// `auto`.
    Word(String),
}

/// Options of matching, shared by synthesis in the plane and on meshes.
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
    /// The options of a repair.
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

/// Makes the exemplar from the first map, which is matched. The other maps are transferred.
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

/// A texture of any size that looks like an example, after Lefebvre and Hoppe (2005, 2006) or Turk (2001).
///
/// Every pixel is one of the example's, chosen so that its surroundings in the example match those in the texture.
///
/// Parameters
/// ----------
/// exemplar : dict of array_like or array_like
///     (rows, columns), or (rows, columns, 3 or 4) in linear light, best 64 to 256 pixels wide; or a dictionary of
///     maps, of which the first is matched (color in sRGB, numbers unchanged) and the others follow it.
/// size : int or tuple of int
///     (rows, columns), or a number for both; at most 2**26 pixels.
/// seed : int, default 0
///     From 0 to 2**64 - 1.
/// wrap : bool or tuple of bool, default False
///     The axes along which the texture repeats, x first; one for both. These sides are multiples of 2**levels where
///     the method is `"endless"`, and else of 2**(levels - 1).
/// edges : {"cut", "wrap"}, default "cut"
///     The treatment of the edges of the example: `"cut"`, or `"wrap"` if it repeats.
/// levels : int or None, default None
///     1 to 16, each with half the resolution: more for larger features. By default 3, or as many as the example has
///     room for where the method is `"endless"`.
/// coherence : float, {"auto"} or None, default None
///     The tolerance for a worse match that continues the pixels beside it: `"auto"` or a number of at least 0; higher
///     copies larger pieces.
/// evenness : float or None, default None
///     How evenly the example is used, 0 to 1000; 1 by default.
/// paper : bool, default False
///     Match as in the paper: the smallest difference wins.
/// mask : array_like or None, default None
///     (rows, columns) of the example, at least 0.5 where it is used; nowhere else is anything taken from.
/// guides : sequence of tuple of (array_like, float), default ()
///     A list of (of_example, of_texture, weight): numbers in the sizes of the example and of the texture; parts of the
///     example go where both are alike. With weight 1 a guide counts as much as one channel; with 3 one of zeros and
///     ones is obeyed nearly everywhere. With guides, `evenness` has no effect.
/// sources : bool, default False
///     Return (texture, sources): for every pixel the (column, row) of its source in the example, (rows, columns, 2).
/// method : {"endless", "sweep"} or None, default None
///     `"endless"`, a window of a texture without ends, which is fast and continues what is large or regular; or
///     `"sweep"`, pixel by pixel. By default `"endless"`, unless `coherence`, `evenness`, `paper` or `guides` are given
///     or a side that wraps has another length than it needs.
/// at : tuple of int or None, default None
///     The (x, y), column and row, of an endless texture at which the result begins, from -2**52 to 2**52: windows
///     beside each other fit together; by default (0, 0).
/// progress : callable or None, default None
///     Called with the part of the work done, from 0 to 1. Ctrl-C stops the call.
///
/// Returns
/// -------
/// dict or tuple of (dict, numpy.ndarray of int64) or numpy.ndarray of float32 or tuple of (numpy.ndarray of float32, numpy.ndarray of int64)
///     The texture, in the form of the example: an array, or a dictionary of arrays. With `return_indices`, the places
///     in the example that the pixels come from, too.
///
/// Raises
/// ------
/// DappleError
///     If the maps of the example differ in size, or an option is out of range or excluded by another.
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

/// The requested method, or the method that other options need. `None` means endless synthesis, or a sweep if the
/// period does not fit the levels.
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

/// Adds the guides to an exemplar, and returns it with the guides of the texture, which must have its size.
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

/// A photograph of a texture in which a part is made again, such as a stain; all around it stays as it is.
///
/// Parameters
/// ----------
/// image : dict of array_like or array_like
///     (rows, columns), or (rows, columns, 3 or 4) in linear light; or a dictionary of maps, of which the first is
///     matched (color in sRGB, numbers unchanged) and the others follow it.
/// hole : array_like
///     (rows, columns), at least 0.5 where the image is made again; nothing is taken from there.
/// seed : int, default 0
///     As for `synthesize`. More levels fill larger holes.
/// edges : {"cut", "wrap"}, default "cut"
///     As for `synthesize`. More levels fill larger holes.
/// levels : int, default 3
///     As for `synthesize`. More levels fill larger holes.
/// coherence : float, {"auto"} or None, default None
///     As for `synthesize`. More levels fill larger holes.
/// sources : bool, default False
///     As for `synthesize`. More levels fill larger holes.
/// progress : callable or None, default None
///     As for `synthesize`. More levels fill larger holes.
///
/// Returns
/// -------
/// dict or tuple of (dict, numpy.ndarray of int64) or numpy.ndarray of float32 or tuple of (numpy.ndarray of float32, numpy.ndarray of int64)
///     The photograph, in the form that was given: an array, or a dictionary of arrays. With `return_indices`, the
///     places that the pixels come from, too.
///
/// Raises
/// ------
/// DappleError
///     If the mask has another size or leaves too little to copy from, or an option is out of range.
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

/// Transfers the maps of the example to a texture, and returns them in the layout of the example; with `sources`, also
/// the source of each pixel.
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

/// Checks that maps have the same size.
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

/// Transfers a map of the example to the texture.
fn transfer(texture: &PlaneTexture, map: &Map) -> core::result::Result<Map, SynthError> {
    Ok(match map {
        Map::Value(raster) => Map::Value(texture.transfer(raster)?),
        Map::Color(raster) => Map::Color(texture.transfer(raster)?),
        Map::Normal(raster) => Map::Normal(texture.transfer(raster)?),
    })
}
