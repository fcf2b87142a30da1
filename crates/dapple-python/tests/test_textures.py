"""The textures of the paper, each a function."""

from __future__ import annotations

import inspect
import json
import pickle
from typing import Any

import numpy as np
import pytest

import dapple_textures as dp
from dapple_textures import _native, _textures

KINDS: dict[str, Any] = json.loads(_native._texture_defaults())
#: The names of functions that are not those of the textures.
FUNCTIONS = {"reference": "reference_texture", "points": "control_points"}
TRIANGLE = np.minimum(np.arange(32), 31 - np.arange(32)).astype(np.float32)[:, None] / 15


def function(kind: str) -> Any:
    return getattr(dp, FUNCTIONS.get(kind, kind))


def made(kind: str, **options: Any) -> Any:
    if KINDS[kind]["follows_image"]:
        return function(kind)(TRIANGLE, **options)
    if kind == "points":
        return function(kind)([{"x": x, "y": -x, "value": x} for x in [-0.5, 0.0, 0.25, 0.9]], **options)
    return function(kind)(**options)


def test_each_texture_is_a_function_and_each_function_a_texture() -> None:
    assert sorted(FUNCTIONS.get(kind, kind) for kind in KINDS) == _textures.__all__


@pytest.mark.parametrize("kind", KINDS)
def test_options_and_defaults_are_those_of_recipes(kind: str) -> None:
    options = dict(KINDS[kind]["options"])
    options.pop("domain", None)
    if kind == "points":
        options.pop("points")
    # Options that recipes leave out where they are the default.
    net = {"fade": 0.0} | options.pop("net")
    expected = options | ({"values": ()} if kind == "points" else {})
    parameters = inspect.signature(function(kind)).parameters.values()
    given = {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY}
    assert given.pop("seed") == 0
    assert [p.name for p in parameters if p.kind is not p.KEYWORD_ONLY][-1] == "domain"
    assert given.pop("net") is None and made(kind, seed=2) == made(kind, net=net, seed=2)
    assert given.keys() == expected.keys()
    for name, default in given.items():
        value = expected[name]
        if isinstance(default, str):
            assert default == value, name
        else:
            assert np.array_equal(np.float32(default), np.float32(value)), name


@pytest.mark.parametrize("kind", KINDS)
def test_each_parameter_is_described(kind: str) -> None:
    text = inspect.getdoc(function(kind)) or ""
    for name in inspect.signature(function(kind)).parameters:
        assert f"\n{name} : " in text, name


def digest(field: dp.Field) -> int:
    state = 0xCBF29CE484222325
    for bits in field.render(32, origin=-1, extent=2).view(np.uint32).ravel().tolist():
        state = (state ^ bits) * 0x100000001B3 % 2**64
    return state


def test_textures_are_the_bits_of_the_library() -> None:
    found = {
        "noise": digest(dp.noise(seed=7)),
        "cells": digest(dp.cells(seed=7)),
        "cells of three or four": digest(dp.cells(points_per_cell=(3, 4), seed=7)),
        "cow": digest(dp.cow(seed=7)),
        "space giraffe": digest(dp.space_giraffe(seed=7)),
        "reference": digest(dp.reference_texture(TRIANGLE, seed=7)),
        "iterated reference": digest(dp.iterated_reference(TRIANGLE, seed=7)),
        "cow progression": digest(dp.cow_progression(seed=7)),
        "giraffe progression": digest(dp.giraffe_progression(seed=7)),
        "label ramp": digest(dp.label_ramp(seed=7)),
    }
    # Those of the tests `value_stability_recipes` and `value_stability_progressions` of dapple-pups.
    assert found == {
        "noise": 3568823462909858107,
        "cells": 4851137778972051317,
        "cells of three or four": 17659775131150400474,
        "cow": 2292993172515091237,
        "space giraffe": 2937035135665074981,
        "reference": 1735835802462090021,
        "iterated reference": 274647018259932788,
        "cow progression": 11321456807880717093,
        "giraffe progression": 4751766841400521509,
        "label ramp": 10429935572434318117,
    }


@pytest.mark.parametrize("kind", KINDS)
def test_textures_repeat_and_come_back_from_their_description(kind: str) -> None:
    domain = dp.Domain((1, 2), origin=(-1, -1))
    field = made(kind, domain=domain, seed=3)
    wraps = "progression" not in kind and kind != "label_ramp"
    assert field.period == [1.0 if wraps else None, 2.0]
    whole = field.render((32, 16), origin=-1, extent=(1, 2))
    assert np.array_equal(whole, field.render((32, 16), origin=(-1, 3), extent=(1, 2)))
    assert np.array_equal(whole[3:9, 2:5], field.render((32, 16), origin=-1, extent=(1, 2), window=np.s_[3:9, 2:5]))
    assert whole.min() >= 0 or kind == "points"
    assert whole.std() > 0.01 and whole.max() <= 1 + 1e-6
    again = pickle.loads(pickle.dumps(field))
    assert again == field and np.array_equal(again.render((32, 16), origin=-1, extent=(1, 2)), whole)
    if kind != "points":
        assert field != made(kind, domain=domain, seed=4)


def test_options_reach_the_texture() -> None:
    torus = dp.Domain(1)

    def size(field: dp.Field) -> float:
        return float(np.abs(np.diff(field.render(128))).mean())

    assert size(dp.noise(torus, spacing=0.05)) > 1.5 * size(dp.noise(torus, spacing=0.2))
    assert size(dp.noise(torus, spacing={"count": 400})) > 1.5 * size(dp.noise(torus, spacing={"count": 30}))
    assert size(dp.noise(torus, net={"axis_scale": 3.0})) < size(dp.noise(torus))
    assert size(dp.octaves(torus, octaves=6)) > size(dp.octaves(torus, octaves=1))
    assert dp.cow(torus, probability=1, values=(0.25, 0.75)).render(16).tolist() == [[0.75] * 16] * 16
    red = dp.color_noise(torus, palette=np.array([[1, 0, 0]], np.float32)).render(8)
    assert np.array_equal(red, np.tile(np.float32([1, 0, 0]), (8, 8, 1)))
    hard = dp.control_points([{"x": 0.2, "y": 0.5, "value": 0}, {"x": 0.7, "y": 0.5, "value": 1}], torus, cells="hard")
    assert set(hard.render(16).ravel().tolist()) == {0.0, 1.0}
    assert dp.cells(torus, net=dp.Net()) != dp.cells(torus)
    assert dp.noise(torus, spacing=1 / 8) == dp.noise(torus, spacing=np.float64(0.125))


def test_control_points_are_those_of_pups() -> None:
    points = dp.poisson_disk(dp.Domain(1), distance=0.2, seed=3)
    values = dp.random_values(len(points), seed=1)
    given = [{"x": x, "y": y, "value": v} for (x, y), v in zip(points.array.tolist(), values.tolist(), strict=True)]
    net = dp.Net(axis_scale=1.5, weight="quintic")
    texture = dp.control_points(given, dp.Domain(1), net=net)
    same = dp.pups(points, values, net=net)
    assert np.array_equal(texture.render(64), same.render(64))


def test_control_points_share_the_values_of_labels() -> None:
    places = [{"x": 0.2, "y": 0.5}, {"x": 0.5, "y": 0.2}, {"x": 0.8, "y": 0.7}]
    labels, values = [0, 1, 0], [0.25, 0.75]
    shared = [{**place, "label": label} for place, label in zip(places, labels, strict=True)]
    own = [{**place, "value": values[label]} for place, label in zip(places, labels, strict=True)]
    texture = dp.control_points(shared, dp.Domain(1), values=values)
    assert np.array_equal(texture.render(32), dp.control_points(own, dp.Domain(1)).render(32))
    with pytest.raises(dp.DappleError, match="label"):
        dp.control_points(shared, dp.Domain(1), values=[0.25])


def test_bad_options_are_refused() -> None:
    torus = dp.Domain(1)
    with pytest.raises(dp.DappleError, match="16"):
        dp.octaves(torus, octaves=17)
    for call in [
        lambda: dp.noise(torus, spacing=-1.0),
        lambda: dp.noise(torus, spacing={"distnace": 1.0}),
        lambda: dp.noise(torus, net={"weight": "linear"}),
        lambda: dp.cow(torus, probability=2.0),
        lambda: dp.cells(torus, points_per_cell=(0, 1)),
        lambda: dp.octaves(dp.Domain(1, wrap=False), source="rescaled"),
        lambda: dp.reference_texture(np.full((2, 2), 3.0), torus),
        lambda: dp.reference_texture(np.ones((2, 2, 3)), torus),
        lambda: dp.color_noise(torus, palette=[]),
        lambda: dp.control_points([], torus),
        lambda: dp.control_points([{"x": 0, "y": 0}], torus),
        lambda: _native._texture("zebra", {}, None, None, 0),
        lambda: _native._texture("noise", {"zebra": 1}, None, None, 0),
        lambda: _native._texture("reference", {}, None, None, 0),
    ]:
        with pytest.raises((dp.DappleError, TypeError)):
            call()
    with pytest.raises(TypeError):
        dp.noise(torus, 0.1)  # type: ignore[misc]
    with pytest.raises(TypeError):
        dp.noise(1.0)  # type: ignore[arg-type]


def test_threads_do_not_change_textures() -> None:
    before = dp.threads()
    try:
        pictures = []
        for count in [1, 2]:
            dp.set_threads(count)
            pictures.append([made(kind, seed=5).render(48) for kind in KINDS])
        assert all(np.array_equal(one, two) for one, two in zip(*pictures, strict=True))
    finally:
        dp.set_threads(before)
