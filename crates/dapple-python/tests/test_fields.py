"""Fields: windows, positions, volumes, composition, and the bits of the Rust crates."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import dapple_textures as dp

CRATES = Path(__file__).parents[2]

FIELDS = {
    "f1": dp.worley(seed=7),
    "cracks": dp.worley(seed=7, value="f2_minus_f1", period=8).normalized(),
    "scales": dp.worley(value=[0.5, -0.25, 0, 0], metric="manhattan", scatter={"jittered": {"jitter": 0.5}}),
    "minkowski": dp.worley(metric={"minkowski": 3}),
    "cells": dp.worley(seed=7, value="cell_value"),
    "joints": dp.worley(seed=7, value="edge_distance"),
    "crumpled": dp.worley(seed=1, octaves={"count": 3}, range=(0.0, 2.0)),
    "slice": dp.worley(seed=7, dims=3, value="f2_minus_f1").slice(0.75),
    "cells at a place": dp.worley(seed=7, dims=4, value="cell_value").slice(0.75, -3.5),
    "gradient": dp.gradient_noise(seed=3, period=(4, None)),
    "hills": dp.gradient_noise(seed=3, period=4, octaves=4, shape="ridged"),
    "clouds": dp.gradient_noise(seed=3, dims=4).slice(1.5, 2.5),
    "bands": dp.wavelet_noise(seed=1, period=16, weights=[1.0, 0.5]),
    "solid bands": dp.wavelet_noise(seed=1, period=(8, 6, 4), dims=3).slice(0.3),
    "number": dp.constant(0.25),
    "node": dp.Recipe.builtin("flagstone").plan().field(),
}
FIELDS["sum"] = 2 * FIELDS["f1"] - FIELDS["gradient"] + 0.5
FIELDS["warped"] = FIELDS["cracks"].warp(FIELDS["gradient"], -FIELDS["gradient"], 0.25)
FIELDS["turned"] = FIELDS["bands"].rotate(0.5).frequency((2, 3)).offset((0.25, 1))
FIELDS["shaped"] = abs(FIELDS["gradient"].remap((-1, 1), (-1, 1))).clamp(0.1, 0.5).maximum(0.2).minimum(FIELDS["f1"])
FIELDS["mixed"] = FIELDS["f1"].mix(1.0, FIELDS["cells"])
FIELDS["fractal"] = FIELDS["gradient"].fbm(3) + FIELDS["gradient"].billow(2, gain=0.3) + FIELDS["f1"].ridged(2)

VOLUMES = {
    "cells": dp.worley(seed=7, dims=3),
    "crumpled": dp.worley(seed=7, dims=3, octaves={"count": 2}),
    "joints": dp.worley(seed=7, dims=3, value="edge_distance"),
    "cell values": dp.worley(seed=7, dims=4, value="cell_value"),
    "gradient": dp.gradient_noise(seed=1, dims=3, period=4),
    "gradient in time": dp.gradient_noise(seed=1, dims=4),
    "bands": dp.wavelet_noise(seed=1, dims=3, period=8),
}


def centers(size, extent, origin=(0.0,) * 4):
    """Pixel centers (…, axes), x first."""
    axes = [
        start + (np.arange(side) + 0.5) * (length / side)
        for side, length, start in zip(reversed(size), extent, origin)
    ]
    grids = np.meshgrid(*reversed(axes), indexing="ij")
    return np.stack(list(reversed(grids)), axis=-1)


@pytest.mark.parametrize("name", FIELDS)
def test_window_is_the_crop_of_the_whole(name):
    field = FIELDS[name]
    whole = field.render((96, 120), extent=(6, 5), origin=(-1, 0.5))
    assert whole.shape == (96, 120) and whole.dtype == np.float32 and whole.flags.c_contiguous
    assert np.isfinite(whole).all()
    part = field.render((96, 120), extent=(6, 5), origin=(-1, 0.5), window=np.s_[31:65, 7:119])
    assert np.array_equal(part, whole[31:65, 7:119])
    beyond = field.render((96, 120), extent=(6, 5), origin=(-1, 0.5), window=np.s_[-3:2, -5:9])
    assert np.array_equal(beyond[3:, 5:], whole[:2, :9])


@pytest.mark.parametrize("name", FIELDS)
def test_sample_equals_render(name):
    field = FIELDS[name]
    rendered = field.render((40, 30), extent=(4, 4), origin=(0.25, -8))
    sampled = field.sample(centers((40, 30), (4, 4), (0.25, -8)))
    assert np.array_equal(sampled, rendered)
    assert sampled.shape == (40, 30)


@pytest.mark.parametrize("name", FIELDS)
def test_bits_do_not_depend_on_threads(name):
    field = FIELDS[name]
    try:
        pictures = []
        for threads in (1, 2, 7):
            dp.set_threads(threads)
            assert dp.threads() == threads
            pictures.append((field.render(200, extent=9), field.sample(centers((99, 99), (3, 3)))))
    finally:
        dp.set_threads(0)
    for rendered, sampled in pictures[1:]:
        assert np.array_equal(rendered, pictures[0][0])
        assert np.array_equal(sampled, pictures[0][1])


@pytest.mark.parametrize("name", VOLUMES)
def test_volumes_are_stacks_of_their_slices(name):
    field = VOLUMES[name]
    shape = (2, 5, 24, 20)[4 - field.ndim :]
    extent = (2.0, 3.0, 1.0, 0.5)[: field.ndim]
    volume = field.render(shape, extent=extent)
    assert volume.shape == shape
    places = centers(shape, extent)
    assert np.array_equal(field.sample(places), volume)
    assert np.array_equal(field.render(shape, extent=extent, window=(slice(0, 1),) * (field.ndim - 2) + np.s_[3:9, 2:7]), volume[(slice(0, 1),) * (field.ndim - 2) + np.s_[3:9, 2:7]])
    index = (0,) * (field.ndim - 3) + (3,)
    rest = places[index][0, 0, 2:]
    plane = field.slice(*rest).render(shape[-2:], extent=extent[:2])
    assert np.array_equal(plane, volume[index])


def corners(size, extent, origin=(0.0,) * 4):
    """Corners of a grid that reaches the sides (…, axes), x first, computed as windows compute them."""
    axes = [
        (start - 0.5 * (length / (side - 1))) + (np.arange(side) + 0.5) * (length / (side - 1))
        for side, length, start in zip(reversed(size), extent, origin)
    ]
    grids = np.meshgrid(*reversed(axes), indexing="ij")
    return np.stack(list(reversed(grids)), axis=-1)


@pytest.mark.parametrize("name", FIELDS)
def test_samples_on_corners_are_values_at_corners(name):
    field = FIELDS[name]
    extent = field._default_extent()
    # A step of 1/30 or 1/40 of the extent is inexact, so that a side without a copy would differ in the last bits.
    picture = field.render((41, 31), samples="corners")
    assert np.array_equal(picture[:-1, :-1], field.sample(corners((41, 31), extent))[:-1, :-1])
    assert picture[0, 0] == field.sample((0.0, 0.0))
    x, y = field.period
    assert y is None or np.array_equal(picture[-1], picture[0])
    assert x is None or np.array_equal(picture[:, -1], picture[:, 0])
    # Beyond the sides there are positions, and no copies.
    beyond = field.render((41, 31), samples="corners", window=np.s_[-2:44, -3:35])
    assert np.array_equal(beyond[2:43, 3:34], picture)
    for window in (np.s_[7:41, 5:31], np.s_[40:41, 30:31], np.s_[0:3, 30:31], np.s_[40:41, 0:7]):
        assert np.array_equal(field.render((41, 31), samples="corners", window=window), picture[window])


@pytest.mark.parametrize("name", VOLUMES)
def test_volumes_on_corners_are_values_at_corners(name):
    field = VOLUMES[name]
    shape = (3, 4, 12, 10)[4 - field.ndim :]
    volume = field.render(shape, samples="corners")
    inside = (slice(0, -1),) * field.ndim
    assert np.array_equal(volume[inside], field.sample(corners(shape, field._default_extent()))[inside])
    for axis, period in enumerate(reversed(field.period)):
        if period is not None:
            assert np.array_equal(volume.take(-1, axis), volume.take(0, axis))


def test_samples_on_corners_have_the_bits_of_a_bake():
    plan = dp.Recipe.builtin("flagstone").plan()
    field = plan.field()
    # The field of a node knows no period, so its last row and column are values and no copies.
    assert field.period == [None, None]
    picture = field.render((33, 65), extent=plan.recipe.extent, samples="corners")
    baked = plan.bake((33, 65), samples="corners")["height"]
    assert np.array_equal(picture[:-1, :-1], baked[:-1, :-1])
    assert np.allclose(picture, baked, atol=1e-4)


def test_copies_on_corners_follow_the_extent():
    field = dp.gradient_noise(seed=3, period=(3, None)).frequency(3)
    # The extent is 3 / 7 of 21 periods along x; its last column is a copy though no step is exact.
    wide = field.render((5, 8), extent=(3.0, 1.0), samples="corners")
    assert np.array_equal(wide[:, -1], wide[:, 0]) and not np.array_equal(wide[-1], wide[0])
    half = field.render((5, 8), extent=(1.5, 1.0), samples="corners")
    assert not np.array_equal(half[:, -1], half[:, 0])
    assert np.array_equal(field.render((5, 8), samples="centers"), field.render((5, 8)))


def test_feature_points_on_corners_are_those_of_positions():
    field = dp.worley(seed=7, period=(4, 3))
    drawn = field.render_features((31, 41), count=2, samples="corners")
    found = field.features(corners((31, 41), (4, 3)), count=2)
    assert np.array_equal(drawn.distance[:, :-1, :-1], np.moveaxis(found.distance, -1, 0)[:, :-1, :-1])
    for plane in (drawn.distance, drawn.vector, drawn.id):
        assert np.array_equal(plane[:, -1], plane[:, 0]) and np.array_equal(plane[:, :, -1], plane[:, :, 0])


def test_samples_that_are_no_grid_are_refused():
    with pytest.raises(dp.DappleError, match="the number of corners along a side is 1, but it must be at least 2") as caught:
        FIELDS["f1"].render((1, 5), samples="corners")
    assert caught.value.kind == "range"
    with pytest.raises(dp.DappleError, match="centers, corners") as caught:
        FIELDS["f1"].render(5, samples="corner")
    assert (caught.value.kind, caught.value.hint) == ("name", "corners")


def test_periods_are_exact():
    field = FIELDS["cracks"]
    assert field.period == [8.0, 8.0]
    tile = field.render(64)
    assert np.array_equal(tile, field.render(64, extent=8, window=np.s_[64:128, -64:0]))
    assert dp.constant(1.0).period == [0.0, 0.0]
    assert FIELDS["gradient"].period == [4.0, None]
    assert FIELDS["gradient"].frequency((2, 1)).period == [2.0, None]


def test_render_fills_memory_that_it_is_given():
    field = FIELDS["f1"]
    out = np.full((32, 48), np.nan, np.float32)
    assert field.render((32, 48), extent=4, out=out) is out
    assert np.array_equal(out, field.render((32, 48), extent=4))
    with pytest.raises(dp.DappleError, match=r"shape \[32, 48\]"):
        field.render((32, 47), out=out)
    with pytest.raises(dp.DappleError, match="C order"):
        field.render((48, 32), out=out.T)
    frozen = out.copy()
    frozen.flags.writeable = False
    with pytest.raises((TypeError, ValueError)):
        field.render((32, 48), out=frozen)
    with pytest.raises(TypeError, match="`out` is an array of float64, but"):
        field.render((32, 48), out=out.astype(np.float64))
    with pytest.raises(TypeError, match="`out` is <class 'list'>, but"):
        field.render((32, 48), out=[0.0])


def test_sizes_and_periods_are_numbers_of_numpy_too():
    field = dp.worley(period=np.array([4, 4]))
    assert field == dp.worley(period=np.int64(4)) == dp.worley(period=(np.uint8(4), 4))
    assert field.render(np.array([3, 5]), extent=np.array([1, 2])).shape == (3, 5)
    assert field.render(np.int32(3), extent=np.float32(1)).shape == (3, 3)


def test_positions_of_any_shape_type_and_stride():
    field = FIELDS["cracks"]
    places = np.random.default_rng(1).uniform(-9, 9, (7, 5, 2))
    values = field.sample(places)
    assert values.shape == (7, 5)
    assert np.array_equal(field.sample(places[::-1, ::2]), values[::-1, ::2])
    assert np.array_equal(field.sample(np.asfortranarray(places)), values)
    places.flags.writeable = False
    assert np.array_equal(field.sample(places), values)
    assert field.sample([0.5, 1.25]).shape == ()
    assert field.sample(np.array([[1, 2]])).shape == (1,)
    assert field.sample(np.empty((0, 2))).shape == (0,)
    assert np.isnan(field.sample([[np.nan, 0], [np.inf, 1]])).all()
    for shape in [(3,), (2, 3), ()]:
        with pytest.raises(dp.DappleError, match="last axis"):
            field.sample(np.zeros(shape))


@pytest.mark.parametrize(("dims", "name"), [(2, "sample2"), (3, "sample3"), (4, "sample4")])
def test_features_have_the_pinned_bits_of_the_crate(dims, name):
    source = CRATES / "dapple-worley/tests/it/stability.rs"
    if not source.exists():
        pytest.skip("the pinned values are in the repository")
    body = re.search(rf"fn value_stability_{name}\(\) {{(.*?)\n}}", source.read_text(), re.S)[1]
    pinned = [line.split() for line in re.findall(r'"([0-9a-f ]+)"', body)]
    places = np.array(
        [[0.25, 0.75, -3.5, 1.125], [-1e9 + 0.375, 12.5, 1e6, -7.0625], [1234.5625, -0.03125, 0.5, 77.0]]
    )
    found = dp.worley(seed=7, dims=dims).features(places[:, :dims], count=4)
    for distance, ids, words in zip(found.distance, found.id, pinned, strict=True):
        assert [f"{bits:08x}" for bits in distance.view(np.uint32)] == words[:4]
        assert [f"{ids[0]:016x}", f"{ids[3]:016x}"] == words[4:]


def test_noise_has_the_pinned_values_of_the_crates():
    position = [0.25, 0.5, 0.75, 0.3]
    for source, generator in [
        ("dapple-noise/src/gradient/tests.rs", "gradient_noise"),
    ]:
        text = (CRATES / source).read_text() if (CRATES / source).exists() else pytest.skip("no sources")
        body = re.search(rf"fn value_stability_{generator}\(\) {{(.*?)\n}}", text, re.S)[1]
        pinned = [np.float32(number.replace("_", "")) for number in re.findall(r"-?0\.[0-9_]{6,}", body)]
        seed = int(re.search(r"const SEED: Seed = Seed\((\d+)\)", text)[1])
        values = [dp.gradient_noise(seed=seed, dims=dims).sample(position[:dims]) for dims in (2, 3, 4)]
        assert [values[0], values[1], values[2]] == [pinned[0], pinned[2], pinned[3]]


def test_feature_planes_equal_features():
    for dims in (2, 3, 4):
        cells = dp.worley(seed=7, dims=dims, period=8)
        at = [0.75, -3.25][: dims - 2]
        planes = cells.render_features((24, 20), count=3, extent=(3, 2), at=at)
        places = np.concatenate([centers((24, 20), (3, 2)), np.broadcast_to(at, (24, 20, dims - 2))], axis=-1)
        found = cells.features(places, count=3)
        assert np.array_equal(planes.distance, np.moveaxis(found.distance, -1, 0))
        assert np.array_equal(planes.id, np.moveaxis(found.id, -1, 0))
        assert np.array_equal(planes.vector, np.moveaxis(found.vector, -2, 0).astype(np.float32))
        assert np.array_equal(planes.distance[0], cells.render_features((24, 20), outputs=["distance"], extent=(3, 2), at=at).distance[0])
        assert cells.render_features((4, 4), outputs=["id"], at=at).vector is None
    with pytest.raises(dp.DappleError, match="from 1 to 4"):
        cells.features([[0.0] * 4], count=5)


def test_gradients_are_differences():
    cells = dp.worley(seed=7)
    places = np.random.default_rng(2).uniform(0, 4, (200, 2))
    gradient = cells.gradient(places)
    assert gradient.shape == (200, 2)
    step = 1e-3
    moved = cells.sample(places + [step, 0]).astype(float) - cells.sample(places - [step, 0])
    # Distances are rounded to f32 and positions to 2^-21 of a cell; cells meet at few of the places.
    near = np.abs(moved / (2 * step) - gradient[:, 0]) < 2e-3
    assert near.mean() > 0.97
    with pytest.raises(dp.DappleError, match="no gradient"):
        dp.worley(value="cell_value").gradient(places)


def test_cell_points_are_found_as_features():
    cells = dp.worley(seed=7, dims=3)
    places, ids = cells.cell_points([4, -2, 9])
    assert places.shape == (len(ids), 3) and 1 <= len(ids) <= 9
    found = cells.features(places)
    assert (found.distance == 0).all()
    assert np.array_equal(found.id[:, 0], ids)


@pytest.mark.parametrize(
    ("make", "kind", "words"),
    [
        (lambda: dp.worley(dims=5), "axes", "2, 3 or 4"),
        (lambda: dp.worley(value="f9"), "options", "f2_minus_f1"),
        (lambda: dp.worley(metric="taxi"), "options", "manhattan"),
        (lambda: dp.worley(scatter={"poisson": {"density": 1e9}}), "range", "density"),
        (lambda: dp.worley(period=[1, 2, 3]), "period", "[1, 2, 3]"),
        (lambda: dp.worley(period=-1), "period", "is -1"),
        (lambda: dp.gradient_noise(period=1.5), "period", "is 1.5"),
        (lambda: dp.gradient_noise(period="ab"), "period", "whole number"),
        (lambda: dp.wavelet_noise(period=(8, None)), "period", "(8, None)"),
        (lambda: dp.worley().render(-3), "size", "is -3"),
        (lambda: dp.worley().render(16.0), "size", "is 16.0"),
        (lambda: dp.worley().render("ab"), "size", "is 'ab'"),
        (lambda: dp.worley().render(5, origin="a"), "count", "is 'a'"),
        (lambda: dp.worley().render(5, window=np.s_[...]), "window", "is Ellipsis"),
        (lambda: dp.worley().render(5, window=np.s_[3:5]), "window", "slice(3, 5, None)"),
        (lambda: dp.worley().render(5, window=np.s_[3:5, 3]), "window", "2 slices"),
        (lambda: dp.set_threads(-1), "threads", "is -1"),
        (lambda: dp.set_threads(1.5), "threads", "is 1.5"),
        (lambda: dp.mesh_report(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, -1]])), "corner", "vertex -1"),
        (lambda: dp.mesh_report(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 2**40]])), "corner", "face 1"),
        (lambda: dp.worley(octaves={"cuont": 2}), "options", "cuont"),
        (lambda: dp.worley(octaves={"count": float("nan")}), "options", "finite"),
        (lambda: dp.worley(value="cell_value", octaves={}), "conflict", "cell_value"),
        (lambda: dp.worley(range=(0, 1)).normalized(), "no_range", "before"),
        (lambda: dp.gradient_noise(octaves=99), "range", "octaves"),
        (lambda: dp.gradient_noise(octaves=2, shape="bumpy"), "name", "ridged"),
        (lambda: dp.gradient_noise(period=0), "range", "period"),
        (lambda: dp.wavelet_noise(period=7), "not_divisible", "7"),
        (lambda: dp.wavelet_noise(period=10**6), "range", "2^27"),
        (lambda: dp.worley().fbm(33), "range", "1 to 32"),
        (lambda: dp.worley().slice(1.0), "axes", "slice"),
        (lambda: dp.worley(dims=3) + dp.worley(dims=4), "axes", "slice"),
        (lambda: dp.worley().clamp(2, 1), "range", "bounds"),
        (lambda: dp.worley().remap((1, 1)), "range", "length"),
        (lambda: dp.worley().render((0, 5)), "size", "at least 1"),
        (lambda: dp.worley().render((1, 2, 3)), "size", "2 numbers"),
        (lambda: dp.worley().render(5, extent=0), "not_finite", "extent"),
        (lambda: dp.worley().render(5, extent=(1, 2, 3)), "count", "x first"),
        (lambda: dp.worley().render(5, window=np.s_[3:3, 0:2]), "window", "pixel"),
        (lambda: dp.worley().render(5, window=np.s_[0:4:2, 0:2]), "window", "steps of 2"),
        (lambda: dp.worley().render(5, window=(slice(0, 1),)), "window", "slices"),
        (lambda: dp.worley().render((2**31, 2**31)), "too_large", "values"),
        (lambda: dp.worley().render((2**20, 2**19)), "memory", "no memory"),
        (lambda: dp.Recipe.builtin("rock").plan().bake((2**20, 2**19)), "memory", "no memory"),
        (lambda: dp.set_threads(10**6), "threads", "1024"),
    ],
)
def test_what_is_refused_says_its_limit(make, kind, words):
    with pytest.raises(dp.DappleError) as caught:
        make()
    assert caught.value.kind == kind
    assert words in str(caught.value)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf, 1e39])
def test_numbers_of_fields_are_finite(number):
    field, one = dp.worley(), dp.constant(1.0)
    for make in [
        lambda: dp.constant(number),
        lambda: field + number,
        lambda: number * field,
        lambda: field.maximum(number),
        lambda: field.mix(number, 0.5),
        lambda: field.remap((0, number)),
        lambda: field.remap((0, 1), (number, 1)),
        lambda: field.clamp(-number, number),
        lambda: dp.worley(range=(0, number)),
        lambda: dp.wavelet_noise(period=8, weights=[number]),
    ]:
        with pytest.raises(dp.DappleError):
            make()
    if number == 1e39:
        return
    for make in [
        lambda: field / number,
        lambda: field.frequency(number),
        lambda: field.offset((0, number)),
        lambda: field.rotate(number),
        lambda: field.warp(one, one, number),
        lambda: field.fbm(2, gain=number),
        lambda: field.fbm(2, lacunarity=number),
        lambda: dp.worley(dims=3).slice(number),
        lambda: dp.worley(octaves={"gain": number}),
        lambda: dp.gradient_noise(octaves=2, gain=number),
        lambda: dp.gradient_noise(octaves=2, lacunarity=number),
        lambda: dp.pups([[0.5, 0.5], [0.2, 0.1], [0.7, 0.3]], [0.0, number, 1.0], domain=dp.Domain(1)),
    ]:
        with pytest.raises(dp.DappleError):
            make()


def test_arithmetic_with_numbers():
    field = FIELDS["gradient"]
    pixels = field.render(16, extent=4)
    assert np.array_equal((field / 4).render(16, extent=4), pixels / 4)
    assert np.array_equal((np.float64(2.0) * field - np.int64(1)).render(16, extent=4), 2 * pixels - 1)
    assert +field == field and type(+dp.worley()) is dp.Worley
    assert sum([field, field], start=dp.constant(0.0)).render(16, extent=4).any()
    with pytest.raises(dp.DappleError, match="divided by 0"):
        field / 0
    for wrong in (None, "1", [1.0], np.array([1.0, 2.0]), object()):
        for act in [
            lambda: field + wrong, lambda: wrong + field, lambda: field - wrong, lambda: wrong - field,
            lambda: field * wrong, lambda: field / wrong, lambda: wrong / field,
        ]:
            with pytest.raises(TypeError, match="support|can't multiply|concatenate"):
                act()
        with pytest.raises(TypeError, match="a field or a number is needed"):
            field.maximum(wrong)
    with pytest.raises(TypeError, match="unsupported"):
        1 / field
    with pytest.raises(TypeError, match="unsupported"):
        field / field


def test_seeds_are_whole_numbers_of_64_bits():
    last = dp.worley(seed=2**64 - 1)
    assert dp.worley(seed=np.uint64(2**64 - 1)) == last
    assert dp.worley(seed=np.random.default_rng(1).integers(2**63)) is not None
    for seed in (-1, 2**64):
        with pytest.raises(ValueError, match="2\\^64"):
            dp.worley(seed=seed)
    for seed in (1.5, "7", None):
        with pytest.raises(TypeError, match="whole number"):
            dp.worley(seed=seed)


@pytest.mark.parametrize("dims", [2, 3])
def test_without_a_period_some_cells_are_shown(dims):
    cells = dp.worley(seed=1, value="cell_value", dims=dims)
    shape = (32,) * dims
    assert np.array_equal(cells.render(shape), cells.render(shape, extent=8))
    # A cell has 3 points in the mean: 8 cells along an axis show some hundreds.
    assert len(np.unique(cells.render(shape))) > 100


def test_the_default_extent_is_that_of_the_cells():
    cells, noise = dp.worley(seed=1), dp.gradient_noise(seed=2)
    window = {"window": np.s_[3:9, 5:7]}
    for field, extent in [
        (cells + 1, 8),
        (noise.fbm(3), 8),
        (noise.frequency((4, 2)), (2, 4)),
        (dp.gradient_noise(period=(6, None)), (6, 8)),
        (dp.constant(0.5).mix(cells, noise), 8),
        (dp.noise(dp.Domain(1, wrap=False), spacing=0.2), 1),
        (dp.noise(dp.Domain(3), spacing=0.4), 3),
    ]:
        assert np.array_equal(field.render(16, **window), field.render(16, extent=extent, **window))
    features = cells.render_features(16, outputs=["id"])
    assert np.array_equal(features.id, cells.render_features(16, outputs=["id"], extent=8).id)
