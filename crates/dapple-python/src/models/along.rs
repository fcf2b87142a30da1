//! Synthesizes textures in the plane along an orientation field and with varying scales.

use super::bake;
use super::surface_guides::bounds;
use crate::error::Result;
use crate::pictures;
use crate::seed::SeedArgument;
use crate::synthesis::{Coherence, Matching, check_sizes, exemplar};
use crate::watch;
use dapple::mesh::CREASE;
use dapple::synth::{PlaneAlong, PlaneScales, SynthError, synthesize_plane_along};
use pyo3::prelude::*;

/// Synthesizes a texture that follows given directions, with features of varying size.
///
/// Parameters
/// ----------
/// exemplar : dict of array_like or array_like
///     As for `synthesize`, without alpha.
/// directions : array_like
///     (rows, columns), angles in radians: at 0 the example's downward axis points down, at pi / 2 it points to the
///     right.
/// scales : array_like or None, default None
///     (rows, columns), the size of an example pixel in pixels of the texture, from 1/8 to 8; by default 1. Or two
///     bounds, between which sizes follow the directions: features grow where the directions diverge and shrink where
///     they converge.
/// seed : int, default 0
///     As for `synthesize`.
/// edges : {"cut", "wrap"}, default "cut"
///     As for `synthesize`.
/// levels : int, default 3
///     As for `synthesize`.
/// coherence : float, {"auto"} or None, default None
///     As for `synthesize`.
/// evenness : float or None, default None
///     As for `synthesize`.
/// paper : bool, default False
///     As for `synthesize`.
/// progress : callable or None, default None
///     As for `synthesize`.
///
/// Returns
/// -------
/// dict or numpy.ndarray of float32
///     The texture, in the form of the example: an array, or a dictionary of arrays.
///
/// Raises
/// ------
/// DappleError
///     If the example is too small, `scales` or `directions` has a different shape, or an option is out of range.
///
/// Examples
/// --------
/// >>> import numpy as np, dapple_textures as dp
/// >>> stripes = np.kron([[0], [1], [0], [1]], np.ones((4, 16)))
/// >>> rows, columns = np.indices((40, 30))
/// >>> dp.synthesize_along(stripes, np.arctan2(columns - 15, rows - 20), edges="wrap", levels=2).shape
/// (40, 30)
#[pyfunction]
#[pyo3(signature = (exemplar, directions, scales = None, *, seed = SeedArgument::default(), edges = "cut", levels = 3,
    coherence = None, evenness = None, paper = false, progress = None),
    text_signature = "(exemplar, directions, scales=None, *, seed=0, edges=\"cut\", levels=3, coherence=None, evenness=None, \
    paper=False, progress=None)")]
pub(crate) fn synthesize_along<'py>(
    py: Python<'py>,
    exemplar: &Bound<'py, PyAny>,
    directions: &Bound<'py, PyAny>,
    scales: Option<&Bound<'py, PyAny>>,
    seed: SeedArgument,
    edges: &str,
    levels: usize,
    coherence: Option<Coherence>,
    evenness: Option<f32>,
    paper: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let (layout, maps) = pictures::read("exemplar", exemplar)?;
    check_sizes(&maps)?;
    super::refuse_alpha(&layout)?;
    let example = self::exemplar(&maps, edges)?;
    let directions = pictures::numbers("directions", directions)?;
    let plane = scales.filter(|scales| bounds(scales).is_none());
    let plane = plane
        .map(|scales| pictures::numbers("scales", scales))
        .transpose()?;
    let bounds = scales.and_then(bounds).unwrap_or([1.0; 2]);
    let matching = Matching {
        seed,
        levels,
        coherence,
        evenness,
        axes: None,
        matching: None,
        paper,
    };
    let options = matching.options()?;
    let baked = watch::run(py, progress, move |heard, _| {
        let scales = match &plane {
            Some(plane) => PlaneScales::Plane(plane),
            None => PlaneScales::Conformal(bounds),
        };
        let along = synthesize_plane_along(&example, &directions, scales, &options, heard)?;
        let PlaneAlong {
            synthesizer,
            texture,
            atlas,
        } = &along;
        let shading = synthesizer.surface().mesh().corner_normals(CREASE);
        let maps = maps.iter();
        let baked = maps.map(|map| bake(synthesizer, texture, atlas, &shading, map));
        baked.collect::<core::result::Result<Vec<_>, SynthError>>()
    })??;
    layout.python(py, baked)
}
