"""The textures and coats of Caron and Mould, "Partition of Unity Parametrics for Texture Synthesis" (2013), one function each.

Options and defaults are the same as in recipes; a test compares them. Docstrings have the entries of parameters that
are not in `_ENTRIES`; `_documented` adds those.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, TypeAlias, TypeVar, cast

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
    "cow",
    "cow_progression",
    "giraffe_progression",
    "iterated_reference",
    "label_ramp",
    "noise",
    "octaves",
    "reference_texture",
    "space_giraffe",
    "turbulence",
]

#: A number, or a ramp of numbers: {"ramp": {"from": [x, y], "to": [x, y], "start": a, "end": b}}.
Varying: TypeAlias = float | Mapping[str, object]
#: The smallest distance between points as a number, or {"distance": …}, {"density": …} or {"count": n}.
Spacing: TypeAlias = float | Mapping[str, object]
#: The weights of control points.
NetLike: TypeAlias = Net | Mapping[str, object] | None

_Function = TypeVar("_Function", bound=Callable[..., object])

#: The default of textures of cells.
_RANDOM = Net(orientations="random")

#: Docstring entries of parameters that several textures have, without the defaults.
_ENTRIES = {
    "image": """array_like
    A gray image (rows, columns) with values from 0 to 1, which covers the domain.""",
    "domain": """Domain or None
    The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
    Domain(2, (-1, -1)).""",
    "spacing": """float or dict
    The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
    or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.""",
    "octaves": """int
    The number of octaves, 1 to 16.""",
    "lacunarity": """float
    The factor by which the spacing is divided from octave to octave, above 1 and at most 16; 2, 4, 8 or 16 if
    octaves are rescaled.""",
    "gain": """float
    The amplitude of an octave as a multiple of the previous one, above 0 and at most 1.""",
    "source": """{"separate", "rescaled"}
    "separate", each octave with points of its own, or "rescaled", one tile at several scales, which takes less
    memory; the domain must then wrap along both axes.""",
    "distances": """tuple of float
    The smallest distance of points at the left and at the right, with equal ratios over equal lengths in between.""",
    "net": """Net, dict or None
    The weights of the control points; by default Net().""",
    "seed": """int
    From 0 to 2**64 - 1.""",
}
_RAISES = "If `spacing` is not above 0 and finite, or another option is unknown or out of range."

#: Entries of textures that change along x, and of textures of cells.
_ALONG_X = {
    "domain": """Domain or None
    The domain of the control points. By default Domain(2, (-1, -1), wrap=(False, True)); it never wraps along x,
    since the texture changes along x.""",
}
_OF_CELLS = {
    "net": """Net, dict or None
    The weights of the control points; by default Net(orientations="random").""",
    "points_per_cell": """tuple of int
    The least and the largest number of control points of a cell, 1 to 16.""",
}


def _documented(entries: Mapping[str, str] = {}, raises: str = _RAISES) -> Callable[[_Function], _Function]:
    """Completes the docstring of a texture: entries of shared parameters, defaults, the result and the errors."""

    def documented(function: _Function) -> _Function:
        about, _, examples = (inspect.getdoc(function) or "").partition("Examples\n--------\n")
        about, _, own = about.partition("Parameters\n----------\n")
        texts = {**_ENTRIES, **entries, **dict(re.findall(r"^(\w+) : (.*?)\s*(?=^\w|\Z)", own, re.M | re.S))}
        parameters = ""
        for name, parameter in inspect.signature(function).parameters.items():
            kind, text = texts[name].split("\n", 1)
            if parameter.default is not parameter.empty:
                quote = '"' if isinstance(parameter.default, str) else ""
                kind += f", default {quote}{parameter.default}{quote}"
            parameters += f"{name} : {kind}\n{text}\n"
        sections = {
            "Parameters": parameters,
            "Returns": f"{function.__annotations__['return']}\n    The field.\n",
            "Raises": f"DappleError\n    {raises}\n",
            "Examples": examples,
        }
        function.__doc__ = about + "\n".join(f"{name}\n{'-' * len(name)}\n{text}" for name, text in sections.items())
        return function

    return documented


def _build(kind: str, given: dict[str, Any], default: Net = Net()) -> Field:
    """Builds a texture from the parameters of its function. `default` is the default of `net`."""
    domain, image, seed = given.pop("domain"), given.pop("image", None), given.pop("seed")
    net = vars(default if given["net"] is None else read(Net, "net", given["net"]))
    given["net"] = {**net, "orientations": "none" if net["orientations"] is None else net["orientations"]}
    return cast("Field", _texture(kind, given, domain, image, seed))


@_documented()
def noise(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """Random values at control points, interpolated: smooth noise from 0 to 1. Caron and Mould, section 3.1.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> noise = dp.noise(dp.Domain(1), spacing=0.1, seed=7)
    >>> noise.render((64, 64)).shape
    (64, 64)
    """
    return _build("noise", locals())


@_documented()
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

    Examples
    --------
    >>> import dapple_textures as dp
    >>> hills = dp.octaves(dp.Domain(1), spacing=0.2, octaves=3, seed=7)
    >>> hills.period
    [1.0, 1.0]
    """
    return _build("octaves", locals())


@_documented()
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

    Examples
    --------
    >>> import dapple_textures as dp
    >>> clouds = dp.turbulence(dp.Domain(1), spacing=0.2, octaves=3, seed=7)
    """
    return _build("turbulence", locals())


@_documented(_OF_CELLS)
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

    Examples
    --------
    >>> import dapple_textures as dp
    >>> cobbles = dp.cells(dp.Domain(1), points_per_cell=(3, 4), seed=7)
    """
    return _build("cells", locals(), _RANDOM)


@_documented(_OF_CELLS)
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
    layers : int
        The number of layers, 1 to 16.
    lacunarity : float
        The factor by which the spacing is divided from layer to layer, above 1 and at most 16.
    gain : float
        The amplitude of a layer as a multiple of the previous one, above 0 and at most 1.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> scales = dp.cellular_noise(dp.Domain(1), layers=2, seed=7)
    """
    return _build("cellular_noise", locals(), _RANDOM)


@_documented()
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
    palette : sequence of sequence of float or numpy.ndarray of float
        Linear RGB colors from 0 to 1, all equally probable.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> dye = dp.color_noise(dp.Domain(1), seed=7)
    >>> dye.render((64, 64)).shape
    (64, 64, 3)
    """
    return cast("ColorField", _build("color_noise", locals()))


@_documented(_ALONG_X)
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
    probabilities : tuple of float
        The probability of white at the left and at the right, linear in between.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> ramp = dp.label_ramp(dp.Domain(1), seed=7)
    >>> float(ramp.sample([0.0, 0.5]))
    0.0
    """
    return _build("label_ramp", locals())


@_documented()
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
    values : tuple of float
        The values of the black and of the white group.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> halves = dp.reference_texture([[0.0, 1.0]], dp.Domain(1), seed=7)
    >>> halves.sample([[0.25, 0.5], [0.75, 0.5]]).tolist()
    [0.0, 1.0]
    """
    return _build("reference", locals())


@_documented()
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
    iterations : int
        The number of rounds, 1 to 16, each with twice as many points as the previous one.
    points : {"fresh", "nested"}
        "fresh", each round with points of its own, or "nested", each round with the points of the previous one and as
        many again.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coast = dp.iterated_reference([[0.0, 1.0]], dp.Domain(1), iterations=2, seed=7)
    """
    return _build("iterated_reference", locals())


@_documented(raises="If there is no point, one is outside of the domain, two coincide, or an option is unknown or out of range.")
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
    values : sequence of float
        The values of labels, from label 0.
    cells : {"mixed", "hard"}
        "mixed", the weighted mean of the values, or "hard", the value of the strongest point.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> dot = dp.control_points([{"x": 0.5, "y": 0.5, "value": 1.0}], dp.Domain(1))
    >>> float(dot.sample([0.1, 0.2]))
    1.0
    """
    return _build("points", locals())


@_documented()
def cow(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.1,
    probability: Varying = 0.5,
    values: tuple[float, float] = (0.0, 1.0),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """The patches of a cow: cells of two values. Caron and Mould, figure 11.

    Parameters
    ----------
    probability : float or dict
        The probability of label 1, 0 to 1: a number or a ramp, as in `poisson_disk`.
    values : tuple of float
        The values of the labels 0 and 1.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coat = dp.cow(dp.Domain(1), probability=0.4, seed=7)
    >>> sorted(set(coat.render(32).ravel().tolist()))
    [0.0, 1.0]
    """
    return _build("cow", locals())


@_documented()
def space_giraffe(
    domain: Domain | None = None,
    *,
    spacing: Spacing = 0.2,
    pairs: tuple[int, int] = (10, 20),
    spots: Literal["separated", "literal"] = "separated",
    values: tuple[float, float] = (1.0, 0.0),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """The coat of a giraffe: spots on a ground. Caron and Mould, figure 12.

    Parameters
    ----------
    pairs : tuple of int
        The least and the largest number of pairs of points around the center of a spot, 3 to 256.
    spots : {"separated", "literal"}
        "separated", whole spots that never merge, or "literal", the method of the paper, where most spots are in
        pieces.
    values : tuple of float
        The values of the ground and of the spots.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coat = dp.space_giraffe(dp.Domain(1), spacing=0.28, seed=6)
    """
    return _build("space_giraffe", locals())


@_documented(_ALONG_X, raises="If a distance is not above 0 and finite, or another option is unknown or out of range.")
def cow_progression(
    domain: Domain | None = None,
    *,
    distances: tuple[float, float] = (0.2, 0.025),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """A cow whose patches get smaller to the right. Caron and Mould, figure 15.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coat = dp.cow_progression(dp.Domain(1), distances=(0.2, 0.05))
    >>> coat.period
    [None, 1.0]
    """
    return _build("cow_progression", locals())


@_documented(_ALONG_X, raises="If a distance is not above 0 and finite, or another option is unknown or out of range.")
def giraffe_progression(
    domain: Domain | None = None,
    *,
    distances: tuple[float, float] = (0.2, 0.025),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """A giraffe whose spots get smaller to the right. Caron and Mould, figure 16.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coat = dp.giraffe_progression(dp.Domain(1), distances=(0.4, 0.2))
    """
    return _build("giraffe_progression", locals())
