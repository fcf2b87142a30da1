"""The coats of animals of Caron and Mould, "Partition of Unity Parametrics for Texture Synthesis" (2013).

Options and defaults are the same as in recipes; a test compares them.
"""

from __future__ import annotations

from typing import Literal, SupportsIndex, cast

from ._native import Domain, Field, _texture
from ._textures import NetLike, Spacing, Varying, _net

__all__ = [
    "cow",
    "cow_progression",
    "giraffe_progression",
    "space_giraffe",
]


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
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.1
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    probability : float or dict, default 0.5
        The probability of label 1, 0 to 1: a number or a ramp, as in `poisson_disk`.
    values : tuple of float, default (0.0, 1.0)
        The values of the labels 0 and 1.
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
    >>> coat = dp.cow(dp.Domain(1), probability=0.4, seed=7)
    >>> sorted(set(coat.render(32).ravel().tolist()))
    [0.0, 1.0]
    """
    options = {"spacing": spacing, "probability": probability, "values": values, "net": _net(net)}
    return cast("Field", _texture("cow", options, domain, None, seed))


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
    domain : Domain or None, default None
        The domain of the control points; the texture repeats along the axes that wrap. By default the paper's torus,
        Domain(2, (-1, -1)).
    spacing : float or dict, default 0.2
        The spacing of control points: the smallest distance in units of the domain, or {"distance": …}, {"density": …}
        or {"count": n}; a distance or density may be a ramp, as in `poisson_disk`.
    pairs : tuple of int, default (10, 20)
        The least and the largest number of pairs of points around the center of a spot, 3 to 256.
    spots : {"separated", "literal"}, default "separated"
        "separated", whole spots that never merge, or "literal", the method of the paper, where most spots are in
        pieces.
    values : tuple of float, default (1.0, 0.0)
        The values of the ground and of the spots.
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
    >>> coat = dp.space_giraffe(dp.Domain(1), spacing=0.28, seed=6)
    """
    options = {"spacing": spacing, "pairs": pairs, "spots": spots, "values": values, "net": _net(net)}
    return cast("Field", _texture("space_giraffe", options, domain, None, seed))


def cow_progression(
    domain: Domain | None = None,
    *,
    distances: tuple[float, float] = (0.2, 0.025),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """A cow whose patches get smaller to the right. Caron and Mould, figure 15.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points. By default Domain(2, (-1, -1), wrap=(False, True)); it never wraps along x,
        since the texture changes along x.
    distances : tuple of float, default (0.2, 0.025)
        The smallest distance of points at the left and at the right, with equal ratios over equal lengths in between.
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
        If a distance is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coat = dp.cow_progression(dp.Domain(1), distances=(0.2, 0.05))
    >>> coat.period
    [None, 1.0]
    """
    options = {"distances": distances, "net": _net(net)}
    return cast("Field", _texture("cow_progression", options, domain, None, seed))


def giraffe_progression(
    domain: Domain | None = None,
    *,
    distances: tuple[float, float] = (0.2, 0.025),
    net: NetLike = None,
    seed: SupportsIndex = 0,
) -> Field:
    """A giraffe whose spots get smaller to the right. Caron and Mould, figure 16.

    Parameters
    ----------
    domain : Domain or None, default None
        The domain of the control points. By default Domain(2, (-1, -1), wrap=(False, True)); it never wraps along x,
        since the texture changes along x.
    distances : tuple of float, default (0.2, 0.025)
        The smallest distance of points at the left and at the right, with equal ratios over equal lengths in between.
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
        If a distance is not above 0 and finite, or another option is unknown or out of range.

    Examples
    --------
    >>> import dapple_textures as dp
    >>> coat = dp.giraffe_progression(dp.Domain(1), distances=(0.4, 0.2))
    """
    options = {"distances": distances, "net": _net(net)}
    return cast("Field", _texture("giraffe_progression", options, domain, None, seed))
