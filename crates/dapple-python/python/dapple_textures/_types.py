"""Results of functions that are more than an array."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ._native import DappleError

if TYPE_CHECKING:
    import numpy.typing as npt


class Features(NamedTuple):
    """The nearest feature points of positions or of pixels; data that was not requested is None."""

    #: Distances in cells, as the metric measures them; "manhattan" adds up the distances along the axes.
    distance: npt.NDArray[np.float32] | None
    #: The vectors from the feature points to the positions, in cells.
    vector: npt.NDArray[np.float64 | np.float32] | None
    #: The identities of the feature points.
    id: npt.NDArray[np.uint64] | None


class EmptyCircle(NamedTuple):
    """A circle with no point inside."""

    #: Its center, (x, y), in the domain.
    center: tuple[float, float]
    #: The distance from the center to the nearest points.
    radius: float


class Spectrum(NamedTuple):
    """The power spectrum of points, averaged over rings of equal frequency, lowest first; all arrays have one length."""

    #: The middle of each ring, in units of sqrt(n / area).
    frequency: npt.NDArray[np.float64]
    #: The mean power of the frequencies in the ring: 1 for white noise.
    power: npt.NDArray[np.float64]
    #: The variance of the power in the ring, scaled so that it is 1 for points without a preferred direction.
    anisotropy: npt.NDArray[np.float64]
    #: The number of frequencies in the ring.
    n_frequencies: npt.NDArray[np.uint32]


class Axes(NamedTuple):
    """The neighbors of points in compressed rows: point i has the neighbors `indices[indptr[i]:indptr[i + 1]]`."""

    #: The index of the first neighbor of each point, and the total number as the last entry.
    indptr: npt.NDArray[np.int64]
    #: The indices of the neighbors.
    indices: npt.NDArray[np.int64]
    #: The vectors to the neighbors, (m, 2), x first.
    vectors: npt.NDArray[np.float64]


class Weights(NamedTuple):
    """The weights of control points at positions, in compressed rows."""

    #: The index of the first weight of each position, and the total number as the last entry.
    indptr: npt.NDArray[np.int64]
    #: The indices of the control points.
    indices: npt.NDArray[np.int64]
    #: Their weights, which sum to 1 at each position.
    weights: npt.NDArray[np.float32]


class MapInfo(NamedTuple):
    """The kind of data in a map of a material."""

    #: The number of channels of a pixel: 1 or 3.
    channels: int
    #: "linear", for colors with the primaries of sRGB, or "non-color".
    color_space: str
    #: The value of `content` with which `write_image` writes the map.
    content: Literal["gray", "color", "normal", "data"]


class Shader(NamedTuple):
    """The material of a recipe as a function of WGSL."""

    #: The text: a module without bindings and entry points.
    wgsl: str
    #: The nodes whose values the caller reads from textures, in the order of the members of the structure `Textures`.
    textures: list[str]
    #: The texture `data`, (rows, 1024, 4), in the format rgba32uint. Without rows if the function has no such argument.
    data: npt.NDArray[np.uint32]


def refusal(kind: str, message: str, hint: str | None = None) -> DappleError:
    """Returns an error with a kind, a message, and a hint at the way out."""
    error = DappleError(message if hint is None else f"{message}: {hint}")
    error.kind, error.hint = kind, hint
    return error
