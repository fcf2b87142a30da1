"""What calls give that is more than an array."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ._native import DappleError


class Features(NamedTuple):
    """The nearest feature points of positions or of pixels; what was not asked for is None."""

    #: Distances, in cells.
    distance: npt.NDArray[np.float32] | None
    #: The ways from the feature points to the positions, in cells.
    vector: npt.NDArray[np.float64 | np.float32] | None
    #: What the feature points are known by.
    id: npt.NDArray[np.uint64] | None


class MapInfo(NamedTuple):
    """What a map of a material holds."""

    #: Numbers of a pixel: 1 or 3.
    channels: int
    #: "linear", for colors with the primaries of sRGB, or "non-color".
    color_space: str


def refusal(kind: str, message: str, hint: str | None = None) -> DappleError:
    """The error of a limit: its kind, its message, and the way out."""
    error = DappleError(message if hint is None else f"{message}: {hint}")
    error.kind, error.hint = kind, hint
    return error
