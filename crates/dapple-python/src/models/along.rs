//! Synthesizes textures in the plane along an orientation field and with varying scales.

use super::bake;
use super::surface_guides::bounds;
use crate::error::Result;
use crate::pictures;
use crate::seed::SeedArgument;
use crate::synthesis::{Exemplar, Matching};
use crate::watch;
use dapple::mesh::CREASE;
use dapple::synth::{PlaneAlong, PlaneScales, SynthError, synthesize_plane_along};
use pyo3::prelude::*;

/// Synthesizes a texture that follows given directions, with features of varying size.
///
/// Parameters
/// ----------
/// exemplar : dict of array_like, array_like or Exemplar
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
/// matching : Matching, dict or None, default None
///     How neighborhoods are compared; by default Matching(). `guides` and `method` are not for this function.
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
/// >>> angles = np.arctan2(columns - 15, rows - 20)
/// >>> dp.synthesize_along(dp.Exemplar(stripes, edges="wrap"), angles, matching={"levels": 2}).shape
/// (40, 30)
#[pyfunction]
#[pyo3(signature = (exemplar, directions, scales = None, *, seed = SeedArgument::default(), matching = None, progress = None),
    text_signature = "(exemplar, directions, scales=None, *, seed=0, matching=None, progress=None)")]
pub(crate) fn synthesize_along<'py>(
    py: Python<'py>,
    exemplar: &Bound<'py, PyAny>,
    directions: &Bound<'py, PyAny>,
    scales: Option<&Bound<'py, PyAny>>,
    seed: SeedArgument,
    matching: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let exemplar = Exemplar::read_image("exemplar", exemplar)?;
    super::refuse_alpha(&exemplar.layout)?;
    let example = exemplar.matched(None)?;
    let options = Matching::read(py, matching, &["guides", "method"])?.options(seed)?;
    let Exemplar { layout, maps, .. } = exemplar;
    let directions = pictures::numbers("directions", directions)?;
    let plane = scales.filter(|scales| bounds(scales).is_none());
    let plane = plane
        .map(|scales| pictures::numbers("scales", scales))
        .transpose()?;
    let bounds = scales.and_then(bounds).unwrap_or([1.0; 2]);
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
