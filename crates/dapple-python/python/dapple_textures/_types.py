"""What calls give that is more than an array."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class Features(NamedTuple):
    """The nearest feature points of positions or of pixels; what was not asked for is None."""

    #: Distances, in cells.
    distance: npt.NDArray[np.float32] | None
    #: The ways from the feature points to the positions, in cells.
    vector: npt.NDArray[np.float64 | np.float32] | None
    #: What the feature points are known by.
    id: npt.NDArray[np.uint64] | None
