"""The textures of Caron and Mould, "Partition of Unity Parametrics for Texture Synthesis" (2013), one function each.

Options and defaults are the same as in recipes; a test compares them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal, SupportsIndex, TypeAlias, cast

import numpy as np

from ._native import ColorField, Domain, Field, _texture
from ._options import Net, read

if TYPE_CHECKING:
    import numpy.typing as npt

__all__ = [
    "cells",
    "cellular_noise",
    "color_noise",
    "control_points",
    "iterated_reference",
    "label_ramp",
    "noise",
    "octaves",
    "reference_texture",
    "turbulence",
]

#: A number, or a ramp of numbers: {"ramp": {"from": [x, y], "to": [x, y], "start": a, "end": b}}.
Varying: TypeAlias = float | Mapping[str, object]
#: The smallest distance between points as a number, or {"distance": …}, {"density": …} or {"count": n}.
Spacing: TypeAlias = float | Mapping[str, object]
#: The weights of control points.
NetLike: TypeAlias = Net | Mapping[str, object] | None

#: The default of textures of cells.
_RANDOM = Net(orientations="random")


def _net(net: NetLike, default: Net = Net()) -> dict[str, object]:
    """Returns the weights in the form of a recipe."""
    options = vars(default if net is None else read(Net, "net", net))
    return {**options, "orientations": "none" if options["orientations"] is None else options["orientations"]}


def noise(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """Random values at control points, interpolated: smooth noise from 0 to 1. Caron and Mould, section 3.1.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> noise = dp.noise(dp.Domain(1), spacing=0.1, seed=7)
    >>> noise.render((64, 64)).shape
    (64, 64)
    """
    options = {"spacing": spacing, "net": _net(net)}
    return cast("Field", _texture("noise", options, domain, None, seed))


def octaves(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    octaves: int = 4,
    lacunarity: float = 2.0,
    gain: float = 0.5,
    source: Literal["separate", "rescaled"] = "separate",
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """The sum of octaves of noise, from 0 to 1 (fractional Brownian motion). Caron and Mould, figure 6.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    octaves : int, default 4
        The number of octaves, 1 to 16.
    lacunarity : float, default 2.0
        The factor by which the spacing is divided from octave to octave, above 1 and at most 16; 2, 4, 8 or 16 if
        octaves are rescaled.
    gain : float, default 0.5
        The amplitude of an octave as a multiple of the previous one, above 0 and at most 1.
    source : {"separate", "rescaled"}, default "separate"
        "separate", each octave with points of its own, or "rescaled", one tile at several scales, which takes less
        memory; the domain must then wrap along both axes.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> hills = dp.octaves(dp.Domain(1), spacing=0.2, octaves=3, seed=7)
    >>> hills.period
    [1.0, 1.0]
    """
    options = {
        "spacing": spacing,
        "octaves": octaves,
        "lacunarity": lacunarity,
        "gain": gain,
        "source": source,
        "net": _net(net),
    }
    return cast("Field", _texture("octaves", options, domain, None, seed))


def turbulence(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    octaves: int = 4,
    lacunarity: float = 2.0,
    gain: float = 0.5,
    source: Literal["separate", "rescaled"] = "separate",
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """The sum of octaves of folded noise, from 0 to 1 (Perlin's turbulence). Caron and Mould, figure 8.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    octaves : int, default 4
        The number of octaves, 1 to 16.
    lacunarity : float, default 2.0
        The factor by which the spacing is divided from octave to octave, above 1 and at most 16; 2, 4, 8 or 16 if
        octaves are rescaled.
    gain : float, default 0.5
        The amplitude of an octave as a multiple of the previous one, above 0 and at most 1.
    source : {"separate", "rescaled"}, default "separate"
        "separate", each octave with points of its own, or "rescaled", one tile at several scales, which takes less
        memory; the domain must then wrap along both axes.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> clouds = dp.turbulence(dp.Domain(1), spacing=0.2, octaves=3, seed=7)
    """
    options = {
        "spacing": spacing,
        "octaves": octaves,
        "lacunarity": lacunarity,
        "gain": gain,
        "source": source,
        "net": _net(net),
    }
    return cast("Field", _texture("turbulence", options, domain, None, seed))


def cells(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    points_per_cell: tuple[int, int] = (1, 1),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """Cells with a random value each, from 0 to below 1. A cell has one control point or a few neighboring ones. Caron and
    Mould, figure 9.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    points_per_cell : tuple of int, default (1, 1)
        The least and the largest number of control points of a cell, 1 to 16.
    net : Net, dict or None, default None
        The weights of the control points; by default Net(orientations="random").
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> cobbles = dp.cells(dp.Domain(1), points_per_cell=(3, 4), seed=7)
    """
    options = {"spacing": spacing, "points_per_cell": points_per_cell, "net": _net(net, _RANDOM)}
    return cast("Field", _texture("cells", options, domain, None, seed))


def cellular_noise(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.4,
    layers: int = 4,
    lacunarity: float = 2.0,
    gain: float = 0.5,
    points_per_cell: tuple[int, int] = (1, 1),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """The sum of layers of cells, from 0 to 1. Caron and Mould, figure 10.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.4
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    layers : int, default 4
        The number of layers, 1 to 16.
    lacunarity : float, default 2.0
        The factor by which the spacing is divided from layer to layer, above 1 and at most 16.
    gain : float, default 0.5
        The amplitude of a layer as a multiple of the previous one, above 0 and at most 1.
    points_per_cell : tuple of int, default (1, 1)
        The least and the largest number of control points of a cell, 1 to 16.
    net : Net, dict or None, default None
        The weights of the control points; by default Net(orientations="random").
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> scales = dp.cellular_noise(dp.Domain(1), layers=2, seed=7)
    """
    options = {
        "spacing": spacing,
        "layers": layers,
        "lacunarity": lacunarity,
        "gain": gain,
        "points_per_cell": points_per_cell,
        "net": _net(net, _RANDOM),
    }
    return cast("Field", _texture("cellular_noise", options, domain, None, seed))


def color_noise(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    palette: Sequence[Sequence[float]] | npt.NDArray[np.floating] = ((0.75, 0.2, 0.03), (0.9, 0.8, 0.55), (0.05, 0.3, 0.3), (0.01, 0.03, 0.15)),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> ColorField:
    """Random colors of a palette at control points, interpolated; not in the paper.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    palette : sequence of sequence of float or numpy.ndarray of float, default ((0.75, 0.2, 0.03), (0.9, 0.8, 0.55), (0.05, 0.3, 0.3), (0.01, 0.03, 0.15))
        Linear RGB colors from 0 to 1, all equally probable.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    ColorField
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> dye = dp.color_noise(dp.Domain(1), seed=7)
    >>> dye.render((64, 64)).shape
    (64, 64, 3)
    """
    options = {"spacing": spacing, "palette": palette, "net": _net(net)}
    return cast("ColorField", _texture("color_noise", options, domain, None, seed))


def label_ramp(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.05,
    probabilities: tuple[float, float] = (0.0, 1.0),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """Black cells (0) on the left that turn white (1) to the right. Caron and Mould, figure 17.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points. By default Domain(2, (-1, -1), wrap=(False, True)); it never wraps along x,
        since the texture changes along x.
    spacing : float or dict, default 0.05
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    probabilities : tuple of float, default (0.0, 1.0)
        The probability of white at the left and at the right, linear in between.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> ramp = dp.label_ramp(dp.Domain(1), seed=7)
    >>> float(ramp.sample([0.0, 0.5]))
    0.0
    """
    options = {"spacing": spacing, "probabilities": probabilities, "net": _net(net)}
    return cast("Field", _texture("label_ramp", options, domain, None, seed))


def reference_texture(
    image: npt.ArrayLike,
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.05,
    values: tuple[float, float] = (0.0, 1.0),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """Black and white cells after an image: a control point is white with the probability of the pixel under it.
    Caron and Mould, figure 13.

    Parameters
    ----------
    image : array_like
        A gray image (rows, columns) with values from 0 to 1, which covers the domain.
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.05
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    values : tuple of float, default (0.0, 1.0)
        The values of the black and of the white group.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> halves = dp.reference_texture([[0.0, 1.0]], dp.Domain(1), seed=7)
    >>> halves.sample([[0.25, 0.5], [0.75, 0.5]]).tolist()
    [0.0, 1.0]
    """
    options = {"spacing": spacing, "values": values, "net": _net(net)}
    return cast("Field", _texture("reference", options, domain, image, seed))


def iterated_reference(
    image: npt.ArrayLike,
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    iterations: int = 4,
    points: Literal["fresh", "nested"] = "fresh",
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """Black and white cells with edges like a coast, from several rounds of points. The first round follows an image, and
    each later round the picture of the previous one. Caron and Mould, figure 14.

    Parameters
    ----------
    image : array_like
        A gray image (rows, columns) with values from 0 to 1, which covers the domain.
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    iterations : int, default 4
        The number of rounds, 1 to 16, each with twice as many points as the previous one.
    points : {"fresh", "nested"}, default "fresh"
        "fresh", each round with points of its own, or "nested", each round with the points of the previous one and as
        many again.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If `spacing` is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coast = dp.iterated_reference([[0.0, 1.0]], dp.Domain(1), iterations=2, seed=7)
    """
    options = {"spacing": spacing, "iterations": iterations, "points": points, "net": _net(net)}
    return cast("Field", _texture("iterated_reference", options, domain, image, seed))


def control_points(
    points: Sequence[Mapping[str, object]],
    domain: Domain | None = None,
    *,
    values: Sequence[float] = (),
    cells: Literal["mixed", "hard"] = "mixed",
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """A texture of control points that are given one by one, in the form of a recipe; `pups` takes arrays.

    Parameters
    ----------
    points : sequence of dict
        Dictionaries with "x", "y", "value" or "label", and, in all or in none, "orientation": [x, y] or [x, y, z].
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    values : sequence of float, default ()
        The values of labels, from label 0.
    cells : {"mixed", "hard"}, default "mixed"
        "mixed", the weighted mean of the values, or "hard", the value of the strongest point.
    net : Net, dict or None, default None
        The weights of the control points; by default Net().
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    Field
        The field.

    Raises
    ------
    DappleError
        If there is no point, one is outside of the domain, two coincide, or an option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> dot = dp.control_points([{"x": 0.5, "y": 0.5, "value": 1.0}], dp.Domain(1))
    >>> float(dot.sample([0.1, 0.2]))
    1.0
    """
    options = {"points": points, "values": values, "cells": cells, "net": _net(net)}
    return cast("Field", _texture("points", options, domain, None, seed))
