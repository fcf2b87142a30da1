"""Maps as an `xarray.Dataset`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import xarray


def dataset(
    maps: dict[str, npt.NDArray[np.float32]],
    pixel: tuple[float, float],
    first: tuple[float, float],
) -> xarray.Dataset:
    """Returns maps with the coordinates of their pixel centers, in units of the plane.

    `pixel` is the width and height of a pixel, and `first` the column and row of the first pixel.
    """
    import xarray

    rows, columns = next(iter(maps.values())).shape[:2]
    return xarray.Dataset(
        {
            name: (("y", "x", "channel")[: values.ndim], values)
            for name, values in maps.items()
        },
        coords={
            "y": (first[1] + np.arange(rows) + 0.5) * pixel[1],
            "x": (first[0] + np.arange(columns) + 0.5) * pixel[0],
        },
    )
