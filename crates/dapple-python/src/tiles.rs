//! Makes images tileable, measures seams, and covers maps with tiles.

use crate::arrays;
use crate::data;
use crate::error::{Error, Result};
use crate::grid::size;
use crate::pictures::{self, Content, Kind, Layout, numbers};
use crate::seed::SeedArgument;
use crate::threads;
use crate::watch::{self, Stop};
use dapple::raster::Raster;
use dapple::tile::{
    BorderSource, ChannelReport, CornerTiles as Corners, Disturbance, Map, MatchBorders, Method,
    SeamOptions, SeamReports, Seamless, TileError,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};
use serde_json::{Map as Object, Value, json};
use std::sync::Arc;

/// Reads a flag per axis: one bool for both axes, or one for each axis, x first.
pub(crate) fn flags(data: Option<&Bound<'_, PyAny>>, default: bool) -> Result<[bool; 2]> {
    let Some(data) = data else {
        return Ok([default; 2]);
    };
    match data.extract::<bool>() {
        Ok(flag) => Ok([flag; 2]),
        Err(_) => Ok(data.extract()?),
    }
}

/// Reads the position of a map's first pixel in the plane, x first; (0, 0) by default.
fn first(data: Option<&Bound<'_, PyAny>>) -> Result<[i64; 2]> {
    Ok(data.map_or(Ok([0; 2]), |first| first.extract())?)
}

/// Renders a window of the plane band by band, so that an interruption stops it soon.
fn rows(
    py: Python<'_>,
    first: [i64; 2],
    size: [u32; 2],
    render: impl Fn([i64; 2], [u32; 2], &Stop) -> core::result::Result<Vec<Map>, TileError>
    + Send
    + 'static,
) -> Result<Vec<Map>> {
    watch::run(py, None, move |_, stop| {
        let mut whole: Option<Vec<Map>> = None;
        let band = (BAND / size[0].max(1) as usize).max(1);
        for top in (0..size[1]).step_by(band) {
            stop.check()?;
            let height = u32::try_from(band).unwrap_or(u32::MAX).min(size[1] - top);
            let first = [first[0], first[1].wrapping_add(top.into())];
            let maps = render(first, [size[0], height], stop)?;
            match &mut whole {
                None => whole = Some(maps),
                Some(whole) => extend(whole, maps)?,
            }
        }
        whole.ok_or_else(|| Error::new("size", "a map has at least one row"))
    })?
}

/// Number of pixels in a band. Copies of a tile that a band cuts are rendered twice; large bands cut few of them.
const BAND: usize = 1 << 22;

/// Appends the rows of `maps` to `whole`, whose maps have the same kinds and widths.
fn extend(whole: &mut [Map], maps: Vec<Map>) -> Result<()> {
    fn both<T>(above: &mut Raster<T>, below: Raster<T>) -> Result<()> {
        let size = [above.width(), above.height() + below.height()];
        let above_it = core::mem::replace(above, Raster::from_vec([0, 0], Vec::new())?);
        let mut pixels = above_it.into_pixels();
        pixels.extend(below.into_pixels());
        *above = Raster::from_vec(size, pixels)?;
        Ok(())
    }
    for (above, below) in whole.iter_mut().zip(maps) {
        match (above, below) {
            (Map::Value(above), Map::Value(below)) => both(above, below)?,
            (Map::Color(above), Map::Color(below)) => both(above, below)?,
            (Map::Normal(above), Map::Normal(below)) => both(above, below)?,
            _ => return Err(Error::new("channels", "rows of a map have one kind")),
        }
    }
    Ok(())
}

/// Reads a tiling method from its name and options.
fn method(name: &Bound<'_, PyAny>, options: Option<&Bound<'_, PyDict>>) -> Result<Method> {
    let options = options.map_or(Ok(Value::Null), |options| data::value(options.as_any()))?;
    let given = match options {
        Value::Object(given) => given,
        _ => Object::new(),
    };
    let Ok(name) = name.cast::<PyString>() else {
        return data::options("method", name);
    };
    let name = name.to_str()?;
    let data = match name {
        "soft_cut" | "spline_project" | "periodic_then_project" => json!({ name: given }),
        "feather" if !given.is_empty() => json!({ name: { "margin": given } }),
        "feather" => json!({ name: "half_shift" }),
        "poisson" if given.keys().all(|option| option == "wrap_gradient") => {
            json!({ name: given.get("wrap_gradient").unwrap_or(&json!("zero")) })
        }
        _ if given.is_empty() => json!(name),
        _ => json!({ name: given }),
    };
    data::read(&format!("method {name}"), data)
}

/// Makes an image tile seamlessly, or all maps of a material along the same cut.
///
/// Parameters
/// ----------
/// image : dict of array_like or array_like
///     (rows, columns), or (rows, columns, 3 or 4) in linear light; or a dictionary of such maps, of which `normal`
///     holds unit vectors and `orm` three independent values.
/// method : str or dict, default "soft_cut"
///     The method, with its options as keywords, or a dictionary as in a recipe.
///
///     * `"soft_cut"` cuts along the path with the smallest difference, and the result is smaller by the `margin`, by
///       default an eighth of the shorter side (at least 32 pixels, at most a quarter): `margin`, `half_width`,
///       `crossfade`.
///     * `"periodic"` preserves all detail and the size (Moisan 2011); so does `"poisson"`, with `wrap_gradient`.
///     * `"spline_project"` is the tile of Du, Wang and Meng, which smooths the image, and
///       `"periodic_then_project"` applies both methods: `levels`, `phase`, `basis`, `pixels`.
///     * `"feather"` is a crossfade: `margin`, `crossfade`. `"mirror"` places the image next to its mirror image.
/// axes : bool or tuple of bool, default True
///     Whether the result repeats along each axis, x first; one value for both.
/// **options : object
///     Options of the method.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The tile, in the form of the image: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the maps of the image differ in size, or an option is unknown, out of range or not supported by the method.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> photo = np.random.default_rng(1).random((96, 128, 3))
/// >>> dp.make_tile(photo, margin=16).shape
/// (80, 112, 3)
/// >>> dp.make_tile({"albedo": photo, "height": photo[..., 0]}, method="periodic")["height"].shape
/// (96, 128)
#[pyfunction]
#[pyo3(signature = (image, *, method = None, axes = None, **options),
    text_signature = "(image, *, method=\"soft_cut\", axes=True, **options)")]
pub(crate) fn make_tile<'py>(
    py: Python<'py>,
    image: &Bound<'py, PyAny>,
    method: Option<&Bound<'py, PyAny>>,
    axes: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("image", image)?;
    let default = PyString::new(py, "soft_cut");
    let method = method.unwrap_or(default.as_any());
    let seamless = Seamless {
        method: self::method(method, options)?,
        axes: flags(axes, true)?,
    };
    let tile = watch::run(py, None, move |_, stop| {
        seamless.apply_maps_cancellable(&maps, &|| stop.is_set())
    })??;
    layout.python(py, tile)
}

/// Measures how well an image repeats, and how much of its source image it has preserved.
///
/// Differences across the seam are compared with differences inside the image at four scales. With a source, lost
/// detail, lost contrast, and parts unlike the source are measured. Colors are judged as displayed, in sRGB.
///
/// Parameters
/// ----------
/// tile : dict of array_like or array_like
///     The image that repeats, or a dictionary of maps.
/// source : dict of array_like or array_like or None, default None
///     The original image, of the same kind; None if there is none.
/// axes : bool or tuple of bool, default True
///     Whether the image repeats along each axis, x first; one value for both.
/// lattice : int or tuple of int, default 1
///     The distance in pixels between boundaries that resemble the seam, such as 2**levels for `"spline_project"`.
///
/// Returns
/// -------
/// dict or SeamReport
///     A `SeamReport`, or a dictionary of them by map name.
///
/// Raises
/// ------
/// DappleError
///     If the tile and the source have different channels.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> report = dp.seam_report(np.linspace(0, 1, 64)[None].repeat(64, 0))
/// >>> report.passes, report.faults
/// (False, [('', 'the seam shows, most at 1 px')])
#[pyfunction]
#[pyo3(signature = (tile, source = None, *, axes = None, lattice = None),
    text_signature = "(tile, source=None, *, axes=True, lattice=1)")]
pub(crate) fn seam_report<'py>(
    py: Python<'py>,
    tile: &Bound<'py, PyAny>,
    source: Option<&Bound<'py, PyAny>>,
    axes: Option<&Bound<'py, PyAny>>,
    lattice: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let lattice = lattice.map_or(Ok([1; 2]), |lattice| match lattice.extract::<u32>() {
        Ok(pixels) => Ok([pixels; 2]),
        Err(_) => lattice.extract(),
    })?;
    let axes = flags(axes, true)?;
    let options = SeamOptions { axes, lattice };
    let (layout, tile) = pictures::read("tile", tile)?;
    let source = source.map(|source| pictures::read("source", source));
    let source = match source.transpose()? {
        Some((other, _)) if other.kinds != layout.kinds || other.names != layout.names => {
            let message = "the source has other maps or channels than the tile";
            return Err(Error::new("channels", message));
        }
        source => source.map(|(_, maps)| maps),
    };
    let reports = threads::run(
        py,
        move || -> core::result::Result<Vec<SeamReports>, TileError> {
            let of = |(at, tile): (usize, &Map)| match &source {
                None => SeamReports::of_map(tile, &options),
                Some(source) => SeamReports::beside(&source[at], tile, &options),
            };
            tile.iter().enumerate().map(of).collect()
        },
    )??;
    let pictures = layout.split(reports).into_iter().zip(&layout.kinds);
    let reports = pictures.map(|(reports, kind)| report(py, &reports, *kind));
    let reports: Vec<_> = reports.collect::<Result<_>>()?;
    match &layout.names {
        None => Ok(reports
            .into_iter()
            .next()
            .unwrap_or(py.None().into_bound(py))),
        Some(names) => {
            let named = PyDict::new(py);
            for (name, report) in names.iter().zip(reports) {
                named.set_item(name, report)?;
            }
            Ok(named.into_any())
        }
    }
}

/// Combines the reports for an image's maps into a Python `SeamReport`.
fn report<'py>(py: Python<'py>, reports: &[SeamReports], kind: Kind) -> Result<Bound<'py, PyAny>> {
    let (mut channels, mut faults, mut texts) = (Vec::new(), Vec::new(), Vec::new());
    for (at, map) in reports.iter().enumerate() {
        let name = match kind.content {
            Content::Data => at.to_string(),
            Content::Color if at == 1 => "alpha".to_owned(),
            _ => String::new(),
        };
        texts.push(match name.is_empty() {
            true => map.to_string(),
            false => format!("{name}:\n{map}"),
        });
        for of in map.channels() {
            let name = if name.is_empty() { &of.channel } else { &name };
            let found = of.report.faults().into_iter();
            faults.extend(found.map(|fault| (name.clone(), fault.to_string())));
            channels.push(ChannelReport {
                channel: name.clone(),
                report: of.report.clone(),
            });
        }
    }
    let badness = reports.iter().map(SeamReports::badness).fold(0.0, f64::max);
    let passes = reports.iter().all(SeamReports::passes);
    let channels = json!(channels).to_string();
    let channels = py.import("json")?.call_method1("loads", (channels,))?;
    let report = py
        .import("dapple_textures._pictures")?
        .getattr("SeamReport")?;
    Ok(report.call1((passes, faults, badness, channels, texts.join("\n")))?)
}

/// Repeats a tile along both axes, cropped to a size.
///
/// Parameters
/// ----------
/// tile : dict of array_like or array_like
///     An image with any number of channels, or a dictionary of maps.
/// size : int or tuple of int
///     (rows, columns), or one number for both.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The copies, in the form of the tile: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the size is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> dp.repeat([[1.0, 2.0]], (2, 3)).tolist()
/// [[1.0, 2.0, 1.0], [1.0, 2.0, 1.0]]
#[pyfunction]
pub(crate) fn repeat<'py>(
    py: Python<'py>,
    tile: &Bound<'py, PyAny>,
    size: &Bound<'py, PyAny>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("tile", tile)?;
    let size = self::size(size)?;
    let maps = threads::run(py, move || -> core::result::Result<Vec<Map>, TileError> {
        let repeated = maps.iter().map(|map| {
            Ok(match map {
                Map::Value(raster) => Map::Value(dapple::tile::repeat(raster, size)?),
                Map::Color(raster) => Map::Color(dapple::tile::repeat(raster, size)?),
                Map::Normal(raster) => Map::Normal(dapple::tile::repeat(raster, size)?),
            })
        });
        repeated.collect()
    })??;
    layout.python(py, maps)
}

/// Covers a map with copies of a tile; each copy is varied inside and preserves its borders.
///
/// A window of the map is bit for bit a crop of the whole.
///
/// Parameters
/// ----------
/// tile : dict of array_like or array_like
///     An image that repeats, or a dictionary of maps, with sides of at least 56 pixels for the default widths.
/// size : int or tuple of int
///     (rows, columns), or one number for both.
/// seed : int, default 0
///     The random seed, from 0 to 2**64 - 1.
/// first : tuple of int, default (0, 0)
///     (x, y) of the first pixel in the plane, where copy (0, 0) begins at pixel (0, 0).
/// frozen : int, default 4
///     The width of the unchanged border of each copy, in pixels.
/// margin : int, default 24
///     The width, in pixels, of the transition from this border to the shifted copy inside.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The map, in the form of the tile: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the tile is too small, or the size or an option is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> tile = dp.worley(seed=7, period=8).render(64)
/// >>> land = dp.disturb(tile, 200, seed=1)
/// >>> bool((land[:, 64] == dp.repeat(tile, 200)[:, 64]).all())
/// True
#[pyfunction]
#[pyo3(signature = (tile, size, *, seed = SeedArgument::default(), first = None, frozen = 4, margin = 24),
    text_signature = "(tile, size, *, seed=0, first=(0, 0), frozen=4, margin=24)")]
pub(crate) fn disturb<'py>(
    py: Python<'py>,
    tile: &Bound<'py, PyAny>,
    size: &Bound<'py, PyAny>,
    seed: SeedArgument,
    first: Option<&Bound<'py, PyAny>>,
    frozen: u32,
    margin: u32,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("tile", tile)?;
    let (first, size) = (self::first(first)?, self::size(size)?);
    let disturbance = Disturbance {
        frozen,
        margin,
        seed: seed.0,
    };
    let maps = rows(py, first, size, move |first, size, stop| {
        disturbance.render_maps_cancellable(&maps, first, size, &|| stop.is_set())
    })?;
    layout.python(py, maps)
}

/// Gives all tiles the border of the first one, so that they fit together in any order.
///
/// Parameters
/// ----------
/// tiles : iterable of dict of array_like or iterable of array_like
///     Images of the same size, or dictionaries of maps.
/// width : int, default 16
///     The width of the border in which tiles change, in pixels.
/// source : {"border", "middle"}, default "border"
///     `"border"` uses the border of the first tile, which must repeat; `"middle"` uses the strip along its middle,
///     for a tile that does not repeat.
///
/// Returns
/// -------
/// list of dict or list of numpy.ndarray of float32
///     The tiles, each in the same form as the input: arrays, or dictionaries of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the tiles differ in size or maps, or an option is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> tiles = [dp.worley(seed=seed, period=4).render(64) for seed in (1, 2)]
/// >>> a, b = dp.match_borders(tiles, width=16)
/// >>> bool((a[0] == b[0]).all() and (a[:, -1] == b[:, -1]).all())
/// True
#[pyfunction]
#[pyo3(signature = (tiles, *, width = None, source = None),
    text_signature = "(tiles, *, width=16, source=\"border\")")]
pub(crate) fn match_borders<'py>(
    py: Python<'py>,
    tiles: &Bound<'py, PyAny>,
    width: Option<u32>,
    source: Option<&str>,
) -> Result<Bound<'py, PyList>> {
    let (layout, tiles) = pictures::read_all("tiles", tiles)?;
    let options = borders(width, source)?;
    let matched = watch::run(py, None, move |_, stop| {
        options.apply_maps_cancellable(&tiles, &|| stop.is_set())
    })??;
    list(py, &layout, matched)
}

/// Covers a map with tiles in random order, after matching their borders; maps of whole tiles repeat.
///
/// Parameters
/// ----------
/// tiles : iterable of dict of array_like or iterable of array_like
///     As for `match_borders`.
/// size : int or tuple of int
///     As for `disturb`.
/// seed : int, default 0
///     As for `disturb`.
/// first : tuple of int, default (0, 0)
///     As for `disturb`.
/// width : int, default 16
///     As for `match_borders`.
/// source : {"border", "middle"}, default "border"
///     As for `match_borders`.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The map, in the form of the tiles: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If there are no tiles, tiles differ in size or maps, or the size is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> tiles = [dp.worley(seed=seed, period=4).render(64) for seed in (1, 2)]
/// >>> dp.lay_tiles(tiles, (128, 192), seed=3).shape
/// (128, 192)
#[pyfunction]
#[pyo3(signature = (tiles, size, *, seed = SeedArgument::default(), first = None, width = None, source = None),
    text_signature = "(tiles, size, *, seed=0, first=(0, 0), width=16, source=\"border\")")]
pub(crate) fn lay_tiles<'py>(
    py: Python<'py>,
    tiles: &Bound<'py, PyAny>,
    size: &Bound<'py, PyAny>,
    seed: SeedArgument,
    first: Option<&Bound<'py, PyAny>>,
    width: Option<u32>,
    source: Option<&str>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, tiles) = pictures::read_all("tiles", tiles)?;
    let (first, size) = (self::first(first)?, self::size(size)?);
    let options = borders(width, source)?;
    let maps = threads::run(py, move || options.render(&tiles, seed.0, first, size))??;
    layout.python(py, maps)
}

fn borders(width: Option<u32>, source: Option<&str>) -> Result<MatchBorders> {
    let default = MatchBorders::default();
    let source = source.map(|name| data::named::<BorderSource>("source", name));
    Ok(MatchBorders {
        width: width.unwrap_or(default.width),
        source: source.transpose()?.unwrap_or(default.source),
    })
}

/// Converts each list of maps to an image in the given layout. Returns a Python list of the images.
fn list<'py>(py: Python<'py>, layout: &Layout, all: Vec<Vec<Map>>) -> Result<Bound<'py, PyList>> {
    let pictures = all.into_iter().map(|maps| layout.python(py, maps));
    Ok(PyList::new(py, pictures.collect::<Result<Vec<_>>>()?)?)
}

/// Corner tiles, which fit next to each other if their corners have the same colors, after Lagae and Dutré (2006).
///
/// Every tile is built from 2 to 4 sources, one per corner color: at each corner it shows the source of that color,
/// and sources meet along the paths with the smallest difference. The C**4 tiles for C colors cover a plane without
/// repeating.
///
/// Parameters
/// ----------
/// sources : iterable of array_like or dict of array_like
///     2 to 4 images of the same size, or dictionaries of maps.
/// width : float, default 0.5
///     The width of the region where cuts may run, as a fraction of the shorter side, above 0 and at most 1.
/// period : int, tuple of int or None, default None
///     The number of tiles after which the corners repeat: one number, or (x, y); None if they do not repeat.
///
/// Raises
/// ------
/// DappleError
///     If there are no sources, sources differ in size or maps, or an option is out of range.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> sources = [dp.worley(seed=seed, period=4).render(32) for seed in (1, 2)]
/// >>> tiles = dp.CornerTiles(sources)
/// >>> len(tiles.all()), tiles.render((100, 200), seed=3).shape
/// (16, (100, 200))
#[pyclass(frozen, module = "dapple_textures")]
pub(crate) struct CornerTiles {
    tiles: Arc<Corners>,
    layout: Layout,
    /// The maps of the source tiles, for pickling.
    sources: Vec<Vec<Map>>,
    width: f64,
    period: [Option<u32>; 2],
}

#[pymethods]
impl CornerTiles {
    #[new]
    #[pyo3(signature = (sources, *, width = 0.5, period = None))]
    fn new(
        py: Python<'_>,
        sources: &Bound<'_, PyAny>,
        width: f64,
        period: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let (layout, sources) = pictures::read_all("sources", sources)?;
        let period = match period {
            None => [None; 2],
            Some(period) => match period.extract::<u32>() {
                Ok(tiles) => [Some(tiles); 2],
                Err(_) => period.extract()?,
            },
        };
        let (tiles, sources) = threads::run(py, move || -> Result<_> {
            let tiles = Corners::new(&sources)?;
            Ok((tiles.with_width(width)?.with_period(period)?, sources))
        })??;
        Ok(Self {
            tiles: Arc::new(tiles),
            layout,
            sources,
            width,
            period,
        })
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> Result<((Bound<'py, PyList>,), Bound<'py, PyDict>)> {
        let options = PyDict::new(py);
        options.set_item("width", self.width)?;
        options.set_item("period", self.period.to_vec())?;
        Ok(((list(py, &self.layout, self.sources.clone())?,), options))
    }

    /// Returns the tile with the given sources at its corners: top left, top right, bottom left, bottom right.
    ///
    /// Parameters
    /// ----------
    /// corners : sequence of int
    ///     The source indices at the corners: top left, top right, bottom left, bottom right.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32 or dict
    ///     The tile, in the form of the sources: an array, or a dictionary of arrays.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If a corner is not the index of a source.
    fn tile<'py>(&self, py: Python<'py>, corners: [u8; 4]) -> Result<Bound<'py, PyAny>> {
        let tiles = Arc::clone(&self.tiles);
        let maps = threads::run(py, move || tiles.tile(corners))??;
        self.layout.python(py, maps)
    }

    /// Returns all C**4 tiles; the tile with the corners a, b, c, d is at index a + b C + c C**2 + d C**3.
    ///
    /// Returns
    /// -------
    /// list of numpy.ndarray of float32 or list of dict
    ///     The tiles, in the form of the sources: arrays, or dictionaries of arrays.
    fn all<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyList>> {
        let tiles = Arc::clone(&self.tiles);
        let tiles = threads::run(py, move || tiles.all())??;
        list(py, &self.layout, tiles)
    }

    /// Covers a map with tiles whose corners are random. A window of the map is bit for bit a crop of the whole.
    ///
    /// Parameters
    /// ----------
    /// size : int or tuple of int
    ///     (rows, columns), or one number for both.
    /// seed : int, default 0
    ///     The random seed, from 0 to 2**64 - 1.
    /// first : tuple of int, default (0, 0)
    ///     (x, y) of the first pixel in the plane.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray of float32 or dict
    ///     The map, in the form of the sources: an array, or a dictionary of arrays.
    ///
    /// Raises
    /// ------
    /// DappleError
    ///     If the size is out of range.
    /// OverflowError
    ///     If a number in `first` does not fit into 64 bits.
    #[pyo3(signature = (size, *, seed = SeedArgument::default(), first = None),
        text_signature = "($self, size, *, seed=0, first=(0, 0))")]
    fn render<'py>(
        &self,
        py: Python<'py>,
        size: &Bound<'py, PyAny>,
        seed: SeedArgument,
        first: Option<&Bound<'py, PyAny>>,
    ) -> Result<Bound<'py, PyAny>> {
        let (first, size) = (self::first(first)?, self::size(size)?);
        let tiles = Arc::clone(&self.tiles);
        let maps = rows(py, first, size, move |first, size, _| {
            tiles.render(seed.0, first, size)
        })?;
        self.layout.python(py, maps)
    }
}

/// Replaces values by their ranks, from 0 to 1: values below `x` cover the fraction `x` of the area.
///
/// If ranks are used as the tile of `blend`, weights equal area fractions.
///
/// Parameters
/// ----------
/// values : array_like
///     The values, (rows, columns).
///
/// Returns
/// -------
/// numpy.ndarray of float32
///     The ranks, (rows, columns), from 0 to 1.
///
/// Raises
/// ------
/// DappleError
///     If the array is not (rows, columns), or a number is not finite.
///
/// Examples
/// --------
/// >>> import dapple_textures as dp
/// >>> float(dp.rank_equalize([[5.0, 1.0], [2.0, 9.0]]).mean())
/// 0.5
#[pyfunction]
pub(crate) fn rank_equalize<'py>(
    py: Python<'py>,
    values: &Bound<'py, PyAny>,
) -> Result<Bound<'py, PyAny>> {
    let values = numbers("values", values)?;
    let ranks = threads::run(py, move || dapple::tile::rank_equalize(&values))??;
    arrays::numbers(py, ranks)
}
