"""Values, labels and weights of control points."""

from __future__ import annotations

import pickle
import struct

import numpy as np
import pytest

import dapple_textures as dp

PAPER = dp.Domain(2, (-1, -1))


@pytest.fixture(scope="module")
def points() -> dp.Points:
    return dp.poisson_disk(dp.Domain((2, 1)), distance=0.1, seed=3)


@pytest.fixture(scope="module")
def values(points: dp.Points) -> np.ndarray:
    return np.random.default_rng(1).random((len(points), 3))


def test_a_field_goes_through_its_values_and_repeats(points: dp.Points, values: np.ndarray) -> None:
    land = dp.pups(points, values[:, 0])
    assert isinstance(land, dp.Field) and land.period == [2.0, 1.0]
    assert np.array_equal(land.sample(points), values[:, 0].astype(np.float32))
    quarter = land.render((32, 64))
    assert np.array_equal(quarter, land.render((32, 64), origin=(-2, 3)))
    assert values[:, 0].min() <= quarter.min() < quarter.max() <= values[:, 0].max()


def test_windows_and_samples_are_those_of_the_whole(points: dp.Points, values: np.ndarray) -> None:
    labels = dp.random_labels(len(points), 3, seed=5)
    fields = [
        dp.pups(points, values[:, 0]),
        dp.pups(points, values),
        dp.pups(points, values[:3], labels=labels),
        dp.pups(points, values[:3, 0], labels=labels),
        dp.pups(points, values[:, 0], graph=dp.yao(points), net=dp.Net(weight={"oscillating": {"dips": 3, "depth": 0.5}})),
        dp.color_noise(dp.Domain((2, 1)), seed=2),
        dp.pups(points, values, net={"orientations": "random", "strength": 0.9}, seed=4),
    ]
    ys, xs = np.mgrid[:40, :80]
    centers = np.stack([(xs + 0.5) * (2 / 80), (ys + 0.5) * (1 / 40)], axis=-1)
    for field in fields:
        whole = field.render((40, 80), extent=(2, 1))
        part = field.render((40, 80), extent=(2, 1), window=np.s_[7:30, -3:33])
        assert np.array_equal(part[:, 3:], whole[7:30, :33]), field
        assert np.array_equal(field.sample(centers), whole), field
        out = np.empty_like(whole)
        assert field.render((40, 80), extent=(2, 1), out=out) is out and np.array_equal(out, whole)


def test_channels_are_fields(points: dp.Points, values: np.ndarray) -> None:
    for channels in range(1, 9):
        many = np.random.default_rng(channels).random((len(points), channels))
        color = dp.pups(points, many)
        assert isinstance(color, dp.ColorField)
        assert (color.channels, color.ndim, color.period) == (channels, 2, [2.0, 1.0])
        picture = color.render((24, 48))
        assert picture.shape == (24, 48, channels) and picture.dtype == np.float32
        for channel in range(channels):
            single = dp.pups(points, many[:, channel]).render((24, 48))
            assert np.array_equal(picture[:, :, channel], single)
    with pytest.raises(dp.DappleError) as error:
        dp.pups(points, np.ones((len(points), 9)))
    assert error.value.kind == "channels"


def test_labels_make_cells(points: dp.Points, values: np.ndarray) -> None:
    n_points = len(points)
    partition = dp.Partition(points, net={"orientations": "random"}, seed=3)
    strongest = partition.strongest((50, 100))
    assert strongest.dtype == np.uint32 and strongest.shape == (50, 100)
    cells = partition.field(values, labels=range(n_points)).render((50, 100))
    assert np.array_equal(cells, values.astype(np.float32)[strongest])
    labels = dp.grouped_labels(dp.delaunay(points), (3, 4), seed=2)
    grouped = partition.field(np.arange(labels.max() + 1.0), labels=labels)
    assert np.array_equal(grouped.render((50, 100)), labels[strongest])
    assert set(np.bincount(labels).tolist()) <= {3, 4}


def test_weights_sum_to_one_and_interpolate(points: dp.Points, values: np.ndarray) -> None:
    partition = dp.Partition(points)
    positions = np.random.default_rng(2).random((500, 2)) * [2, 1]
    found = partition.weights(positions)
    rows = [slice(*pair) for pair in zip(found.indptr[:-1], found.indptr[1:], strict=True)]
    sums = np.array([found.weights[row].sum() for row in rows])
    assert np.abs(sums - 1).max() < 1e-6 and (found.weights > 0).all()
    by_hand = [found.weights[row] @ values[found.indices[row], 0] for row in rows]
    # Single precision against double.
    assert np.abs(partition.field(values[:, 0]).sample(positions) - by_hand).max() < 2e-6
    assert partition.weights([np.nan, 0.5]).indptr.tolist() == [0, 0]
    assert len(partition) == len(points)


def test_values_are_the_bits_of_the_library() -> None:
    assert dp.random_values(3, seed=4).tolist() == [np.float32(x) for x in [0.30855393, 0.35184413, 0.8846284]]
    vector = dp.random_orientations(3, seed=4)[2]
    expected = [4597614699398262687, 13820021926418203215, 4606729273623855712]
    assert [struct.unpack("<Q", struct.pack("<d", x))[0] for x in vector] == expected
    points = dp.white_noise(PAPER, 20, seed=1)
    labels = dp.grouped_labels(dp.delaunay(points), (3, 4), seed=4)
    assert labels.tolist() == [0, 1, 2, 3, 4, 5, 4, 1, 4, 3, 3, 0, 2, 2, 5, 0, 0, 1, 5, 3]


def test_labels_and_orientations_follow_what_they_are_given(points: dp.Points) -> None:
    ramp = {"ramp": {"from": [0, 0], "to": [2, 0], "start": 0, "end": 1}}
    array = np.repeat(np.linspace(0, 1, 200)[None], 3, axis=0)
    for probability in [ramp, array, dp.constant(0.5), 0.5]:
        white = dp.biased_labels(points, probability, seed=1)
        assert set(white.tolist()) <= {0, 1} and 0.3 < white.mean() < 0.7
    assert (white == dp.biased_labels(points, dp.constant(0.5), seed=1)).all()
    outward = dp.outward_orientations(points, (0.1, 0.5))
    assert np.allclose(np.linalg.norm(outward, axis=1), 1)
    delta = (points.array - [0.1, 0.5] + [1, 0.5]) % [2, 1] - [1, 0.5]
    assert (np.sum(outward[:, :2] * delta, axis=1) > 0).all()
    turned = dp.angle_orientations(points, ramp)
    assert np.allclose(turned[:, 0], np.cos(points[:, 0] / 2)) and (turned[:, 2] == 0).all()
    image = np.zeros((1, 2))
    image[0, 1] = 1
    assert np.array_equal(dp.reference_labels(points, image), points[:, 0] >= 1)


def test_orientations_have_many_forms(points: dp.Points, values: np.ndarray) -> None:
    def picture(orientations: object, seed: int = 0, **options: object) -> np.ndarray:
        net = dp.Net(orientations=orientations, **options)
        return dp.pups(points, values[:, 0], net=net, seed=seed).render((30, 60))

    plain = picture(None)
    assert np.array_equal(plain, picture("none"))
    leaning = picture({"same": [1, 0, 0]})
    assert not np.array_equal(plain, leaning)
    assert np.array_equal(leaning, picture(np.tile([2.0, 0.0], (len(points), 1))))
    assert np.array_equal(leaning, picture([[1, 0, 0]])) and np.array_equal(leaning, picture({"angle": 0}))
    assert np.array_equal(picture({"away_from": [1, 0.5]}), picture(dp.outward_orientations(points, (1, 0.5))))
    assert not np.array_equal(picture("random", seed=1), picture("random", seed=2))
    assert not np.array_equal(picture("random", strength=0.1), picture("random", strength=0.9))


def test_fields_are_their_descriptions(points: dp.Points, values: np.ndarray) -> None:
    tokenize = pytest.importorskip("dask.base").tokenize
    land = dp.pups(points, values[:, 0], graph=dp.gabriel(points), net={"orientations": "random"})
    made = [
        land,
        land * 2.0 + dp.noise(dp.Domain((2, 1)), seed=3),
        dp.pups(points, values, labels=None),
        dp.pups(points, values[:5], labels=np.arange(len(points)) % 5),
        dp.Partition(points, net=dp.Net(axis_scale=2.0)),
        dp.reference_texture(values[:4, :2].astype(np.float32), seed=3),
    ]
    for field in made:
        again = pickle.loads(pickle.dumps(field))
        assert type(again) is type(field) and again == field
        if isinstance(field, dp.Partition):
            assert np.array_equal(again.strongest(20), field.strongest(20))
            continue
        assert hash(again) == hash(field) and tokenize(again) == tokenize(field) and len(repr(field)) < 600
        assert again.render(20, extent=2).tobytes() == field.render(20, extent=2).tobytes()
    assert len({tokenize(field) for field in made[:4]}) == 4
    assert made[0] != made[1] and dp.pups(points, values[:, 1]) != dp.pups(points, values[:, 0])


@pytest.mark.parametrize("channels", [1, 3])
def test_colors_are_baked_in_chunks(points: dp.Points, channels: int) -> None:
    pytest.importorskip("dask.array")
    from dapple_textures.dask import bake

    color = dp.pups(points, np.random.default_rng(5).random((len(points), channels)))
    lazy = bake(color, (40, 80), chunks=16)
    whole = color.render((40, 80))
    assert np.array_equal(lazy.compute(scheduler="threads"), whole if channels > 1 else whole[..., 0])


def test_composing_does_not_make_the_net_again() -> None:
    import time

    points = dp.white_noise(dp.Domain(1), 50_000, seed=1)
    begin = time.perf_counter()
    land = dp.pups(points, np.ones(len(points)))
    made = time.perf_counter() - begin
    begin = time.perf_counter()
    for _ in range(20):
        land = land + 1.0
    composed = time.perf_counter() - begin
    # Twenty nets would take twenty times as long as one.
    assert composed < 5 * made and land.sample([0.5, 0.5]) == 21.0


def test_arrays_are_read_as_they_are(points: dp.Points, values: np.ndarray) -> None:
    expected = dp.pups(points, values).render(16)
    strided = np.asfortranarray(values.astype(np.float32))
    strided.setflags(write=False)
    for same in [strided, values[::-1][::-1], values.tolist()]:
        assert np.array_equal(dp.pups(points.array, same, domain=points.domain).render(16), expected)


def test_bad_input_is_refused_with_its_kind(points: dp.Points, values: np.ndarray) -> None:
    few, one = values[:5, 0], values[:, 0]
    kinds = {
        "count": lambda: dp.pups(points, few),
        "no_points": lambda: dp.pups(np.zeros((0, 2)), []),
        "range": lambda: dp.pups(points, one, net={"axis_scale": 0.5}),
        "shape": lambda: dp.pups(points, values[None]),
        "different_points": lambda: dp.pups(points, one, graph=dp.delaunay([[0, 0], [1, 1], [1, 0]])),
        "options": lambda: dp.pups(points, one, net={"weight": "linear"}),
        "short_axis": lambda: dp.pups([[0, 0], [1, 0], [1e-12, 0]], [1, 2, 3]),
        "channels": lambda: dp.pups(points, np.ones((len(points), 0))),
        "graph": lambda: dp.pups([[0, 0], [0, 0]], [1, 2]),
    }
    for kind, call in kinds.items():
        with pytest.raises(dp.DappleError) as error:
            call()
        assert error.value.kind == kind, (kind, error.value.kind, str(error.value))
    for call in [
        lambda: dp.pups(points, np.full(len(points), np.nan)),
        lambda: dp.pups(points, one, net={"strength": 1.0, "orientations": "random"}),
        lambda: dp.pups(points, one, net={"orientations": np.zeros((len(points), 3))}),
        lambda: dp.pups(points, one, net={"orientations": np.zeros((3, 3))}),
        lambda: dp.pups(points, few, labels=[0] * 3),
        lambda: dp.pups(points, few, labels=[5] * len(points)),
        lambda: dp.random_labels(10, 0),
        lambda: dp.grouped_labels(dp.delaunay(points), (4, 3)),
        lambda: dp.biased_labels(points, 2.0),
        lambda: dp.reference_labels(points, np.full((2, 2), 2.0)),
        lambda: dp.outward_orientations(points, (np.nan, 0)),
        lambda: dp.random_values(2**40),
        lambda: dp.pups(points, values) + 1,
        lambda: dp.pups(points, few, labels=[0.5] * len(points)),
        lambda: dp.pups(points, few, labels=[-1] * len(points)),
    ]:
        with pytest.raises((ValueError, TypeError, OverflowError)):
            call()
    color = dp.pups(points, values)
    with pytest.raises(dp.DappleError):
        color.render(8, out=np.zeros((8, 8), np.float32))
    with pytest.raises(dp.DappleError):
        color.render(8, out=np.zeros((8, 3, 8), np.float32).swapaxes(1, 2))


def test_threads_do_not_change_fields(points: dp.Points, values: np.ndarray) -> None:
    before = dp.threads()
    try:
        pictures = []
        for count in [1, 2]:
            dp.set_threads(count)
            field = dp.pups(points, values, net={"orientations": "random"})
            pictures.append((field.render((200, 400)), field.sample(np.random.default_rng(1).random((5000, 2)))))
        assert all(np.array_equal(one, two) for one, two in zip(*pictures, strict=True))
    finally:
        dp.set_threads(before)


def test_samples_on_corners_are_values_at_corners(points: dp.Points, values: np.ndarray) -> None:
    ys, xs = np.mgrid[:30, :70]
    places = np.stack([-0.5 * (2 / 70) + (xs + 0.5) * (2 / 70), -0.5 * (1 / 30) + (ys + 0.5) * (1 / 30)], axis=-1)
    color = dp.pups(points, values)
    picture = color.render((31, 71), samples="corners")
    assert np.array_equal(picture[:-1, :-1], color.sample(places))
    assert np.array_equal(picture[-1], picture[0]) and np.array_equal(picture[:, -1], picture[:, 0])
    assert np.array_equal(color.render((31, 71), samples="corners", window=np.s_[9:31, 70:71]), picture[9:31, 70:71])
    partition = dp.Partition(points, net={"orientations": "random"}, seed=3)
    strongest = partition.strongest((31, 71), samples="corners")
    cells = partition.field(values, labels=range(len(points))).render((31, 71), samples="corners")
    assert np.array_equal(cells, values.astype(np.float32)[strongest])
    assert np.array_equal(strongest[-1], strongest[0]) and np.array_equal(strongest[:, -1], strongest[:, 0])
