"""What calls give that is more than an array."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ._native import DappleError

if TYPE_CHECKING:
    import numpy.typing as npt


class Features(NamedTuple):
    """The nearest feature points of positions or of pixels; what was not asked for is None."""

    #: Distances, in cells as the metric measures them: those of "manhattan" are sums along the axes.
    distance: npt.NDArray[np.float32] | None
    #: The ways from the feature points to the positions, in cells.
    vector: npt.NDArray[np.float64 | np.float32] | None
    #: What the feature points are known by.
    id: npt.NDArray[np.uint64] | None


class EmptyCircle(NamedTuple):
    """A circle without a point inside of it."""

    #: Its center, (x, y), in the domain.
    center: tuple[float, float]
    #: The distance from the center to the nearest points.
    radius: float


class Spectrum(NamedTuple):
    """The power spectrum of points, by rings of equal frequency, the lowest first; arrays of one length."""

    #: The middle of each ring, in units of sqrt(n / area).
    frequency: npt.NDArray[np.float64]
    #: The mean power of the frequencies in the ring: 1 for white noise.
    power: npt.NDArray[np.float64]
    #: The variance of the power over what it is without a preferred direction, which is 1.
    anisotropy: npt.NDArray[np.float64]
    #: How many frequencies the ring holds.
    n_frequencies: npt.NDArray[np.uint32]


class Axes(NamedTuple):
    """The neighbors of points in compressed rows: those of point i are `indices[indptr[i]:indptr[i + 1]]`."""

    #: Where the neighbors of each point begin, and at the end where the last ones end.
    indptr: npt.NDArray[np.int64]
    #: The neighbors.
    indices: npt.NDArray[np.int64]
    #: The ways to them, (m, 2), x first.
    vectors: npt.NDArray[np.float64]


class Weights(NamedTuple):
    """The weights of control points at positions, in compressed rows."""

    #: Where the weights of each position begin, and at the end where the last ones end.
    indptr: npt.NDArray[np.int64]
    #: The control points.
    indices: npt.NDArray[np.int64]
    #: Their weights, which sum to 1 at each position.
    weights: npt.NDArray[np.float32]


class MapInfo(NamedTuple):
    """What a map of a material holds."""

    #: Numbers of a pixel: 1 or 3.
    channels: int
    #: "linear", for colors with the primaries of sRGB, or "non-color".
    color_space: str
    #: With which `content` `write_image` writes it.
    content: Literal["gray", "color", "normal", "data"]


def refusal(kind: str, message: str, hint: str | None = None) -> DappleError:
    """The error of a limit: its kind, its message, and the way out."""
    error = DappleError(message if hint is None else f"{message}: {hint}")
    error.kind, error.hint = kind, hint
    return error
