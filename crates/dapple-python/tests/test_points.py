"""Points: where they lie, how they are placed, what is measured on them."""

from __future__ import annotations

import pickle
import struct

import numpy as np
import pytest

import dapple_textures as dp

PAPER = dp.Domain(2, (-1, -1))


def bits(number: float) -> int:
    return int(struct.unpack("<Q", struct.pack("<d", number))[0])


def test_domains_are_values() -> None:
    domain = dp.Domain((2, 1), origin=(-1, 3), wrap=(True, False))
    assert (domain.size, domain.origin, domain.wrap, domain.area) == ((2.0, 1.0), (-1.0, 3.0), (True, False), 2.0)
    again = eval(repr(domain), {"Domain": dp.Domain})
    assert domain == again == pickle.loads(pickle.dumps(domain)) and hash(domain) == hash(again)
    assert domain != dp.Domain((2, 1), origin=(-1, 3)) and dp.Domain(1).wrap == (True, True)
    assert dp.Domain(1, wrap=False) == dp.Domain((1, 1), wrap=(False, False))
    assert hash(dp.Domain(1, (0.0, 0.0))) == hash(dp.Domain(1, (-0.0, 0.0)))
    with pytest.raises(AttributeError):
        domain.size = (1, 1)  # type: ignore[misc]


@pytest.mark.parametrize("size", [0, -1, 1e301, (1, np.nan), (1, 2, 3), np.inf])
def test_domains_without_area_are_refused(size: object) -> None:
    with pytest.raises(dp.DappleError):
        dp.Domain(size)


def test_thin_and_far_domains_hold_points_or_are_refused() -> None:
    for width in [1e-9, 1e-12, 1e-100]:
        strip = dp.Domain((width, 2), wrap=False)
        assert dp.poisson_disk(strip, distance=0.3, seed=1).minimum_distance() >= 0.3
    with pytest.raises(dp.DappleError) as error:
        dp.Domain(1, origin=1e17)
    assert error.value.kind == "domain"


def test_points_are_the_bits_of_the_library() -> None:
    points = dp.poisson_disk(PAPER, distance=0.1, seed=7)
    total = 0
    for number in points.array.ravel():
        total = ((total << 1 | total >> 63) & (2**64 - 1)) ^ bits(number)
    assert (len(points), total) == (282, 8764673758391801309)
    cylinder = dp.Domain((2, 1), (-3, 10), wrap=(False, True))
    ramp = {"geometric_ramp": {"from": [-3, 10], "to": [-1, 10], "start": 0.02, "end": 0.16}}
    varied = dp.poisson_disk(cylinder, distance=ramp, seed=7)
    assert len(varied) == 835
    assert [bits(x) for x in varied[100]] == [13836822501338237467, 4622035698459658779]


def test_points_keep_their_distance_and_leave_no_gap() -> None:
    for wrap in [True, False, (True, False)]:
        points = dp.poisson_disk(dp.Domain((2, 1), wrap=wrap), distance=0.05, seed=3)
        circle = points.largest_empty_circle()
        assert circle is not None
        assert points.minimum_distance() >= 0.05 * (1 - 1e-9) and circle.radius <= 0.05 * (1 + 2e-6)
        assert abs(points.normalized_density(0.05) - 0.697) < 0.08


def test_counts_and_densities_are_kept() -> None:
    assert 950 < len(dp.poisson_disk(dp.Domain(1), count=1000, seed=1)) < 1050
    assert 950 < len(dp.poisson_disk(dp.Domain(1), density=1000, seed=1)) < 1050
    image = np.zeros((64, 64), np.float32)
    image[:, 32:] = 1
    for density in [image, image.astype(np.float64), image[::-1, ::1], image.tolist()]:
        points = dp.poisson_disk(dp.Domain(1), density=density, count=1000, seed=1)
        assert 850 < len(points) < 1150 and (points[:, 0] > 0.45).mean() > 0.9


def test_a_field_and_an_array_vary_alike() -> None:
    torus = dp.Domain(1)
    field = dp.gradient_noise(seed=1, period=2).frequency(2) * 0.01 + 0.05
    from_field = dp.poisson_disk(torus, distance=field, seed=5)
    from_array = dp.poisson_disk(torus, distance=field.render(256, extent=1), seed=5)
    distances = field.sample(from_field)
    assert from_field.minimum_distance() >= distances.min() * (1 - 1e-6)
    assert abs(len(from_field) - len(from_array)) < 0.05 * len(from_field)
    # Where they are farther apart there are fewer of them.
    sparse = distances > 0.05
    share = (field.render(256, extent=1) > 0.05).mean()
    assert sparse.mean() < share


def test_sets_extend_and_nest() -> None:
    torus = dp.Domain(1)
    coarse, fine = dp.nested_poisson_disk(torus, [0.2, 0.1], seed=3)
    assert np.array_equal(fine[: len(coarse)], coarse) and fine.minimum_distance() >= 0.1
    given = np.array([[0.5, 0.5], [1.25, 0.5]])
    more = dp.extend_poisson_disk(given, 0.1, domain=torus, seed=3)
    assert np.array_equal(more[:2], given % 1.0)
    assert more == dp.extend_poisson_disk(dp.Points(given, torus), 0.1, seed=3)
    with pytest.raises(dp.DappleError) as error:
        dp.extend_poisson_disk(more, 0.2)
    assert error.value.kind == "too_close"


def test_grids_and_white_noise() -> None:
    grid = dp.jittered_grid(dp.Domain((2, 1)), (4, 2), jitter=0)
    assert len(grid) == 8 and grid[1].tolist() == [0.75, 0.25]
    noise = dp.white_noise(PAPER, 200, seed=7)
    assert noise.array[:100].tolist() == dp.white_noise(PAPER, 100, seed=7).array.tolist()
    assert dp.white_noise(PAPER, 0).array.shape == (0, 2)


def test_measures_are_the_bits_of_the_library() -> None:
    lattice = dp.Points([[i % 8, i // 8] for i in range(64)], dp.Domain(8))
    circle = lattice.largest_empty_circle()
    assert circle is not None and circle.radius == 0.5**0.5 and lattice.minimum_distance() == 1.0
    assert lattice.mean_neighbor_count(1.0) == 4.0
    found = dp.spectrum(lattice)
    assert found.power[found.frequency < 0.9].max() < 1e-20 and found.power.max() > 5
    both = dp.spectrum([lattice, lattice], ring_width=0.1)
    assert len(both.power) < len(found.power) and both.n_frequencies.dtype == np.uint32
    assert dp.Points([[0, 0]], dp.Domain(1)).minimum_distance() is None
    assert dp.Points(np.zeros((0, 2)), dp.Domain(1)).largest_empty_circle() is None


def test_points_are_arrays_for_numpy() -> None:
    points = dp.poisson_disk(dp.Domain(1), distance=0.2, seed=3)
    array = np.asarray(points)
    assert array.shape == (len(points), 2) and array.dtype == np.float64 and array is points.array
    assert np.asarray(points, np.float32).dtype == np.float32
    copy = np.array(points)
    copy[0] = 0
    assert not np.array_equal(copy, points) and not points.array.flags.writeable
    with pytest.raises(ValueError):
        points.array[0] = 0
    assert [tuple(point) for point in points] == [tuple(point) for point in array]
    assert points == pickle.loads(pickle.dumps(points)) != dp.poisson_disk(dp.Domain(1), distance=0.2, seed=4)
    assert repr(points).startswith(f"<{len(points)} points in Domain(")


def test_arrays_without_a_domain_lie_in_their_rectangle() -> None:
    strided = np.arange(40.0).reshape(10, 4)[::2, 1:3]
    strided.setflags(write=False)
    points = dp.Points(strided)
    assert points.domain.wrap == (False, False) and np.array_equal(points, strided)
    for flat in [[[3.0, 4.0]], [[0, 0], [0, 5]], [[1e12, 1], [1e12, 1 + 1e-9]], [[0.1, 0.2], [0.3, 0.7]]]:
        assert np.array_equal(dp.Points(flat), np.array(flat, float))
    rng = np.random.default_rng(1)
    for _ in range(200):
        some = rng.normal(size=(7, 2)) * 10.0 ** rng.integers(-12, 12) + rng.normal(size=2) * 10.0 ** rng.integers(-9, 9)
        assert np.array_equal(dp.Points(some), some)


def test_bad_input_is_refused_with_its_kind() -> None:
    torus = dp.Domain(1)
    kinds = {
        "conflict": lambda: dp.poisson_disk(torus),
        "not_positive": lambda: dp.poisson_disk(torus, distance=-1.0),
        "too_many": lambda: dp.poisson_disk(torus, distance=1e-9),
        "no_points": lambda: dp.poisson_disk(torus, count=0),
        "period_too_short": lambda: dp.poisson_disk(torus, distance=0.9),
        "name": lambda: dp.poisson_disk(torus, distance=0.1, rule="best"),
        "radius": lambda: dp.poisson_disk(torus, distance=dp.constant(-1.0)),
        "too_steep": lambda: dp.poisson_disk(dp.Domain(1, wrap=False), distance=dp.gradient_noise(seed=1).frequency(40) + 1.1),
        "options": lambda: dp.poisson_disk(torus, distance={"ramp": {"from": [0, 0]}}),
        "outside": lambda: dp.Points([[2, 2]], dp.Domain(1, wrap=False)),
        "shape": lambda: dp.Points([[[1, 2]]]),
        "out_of_range": lambda: dp.jittered_grid(torus, 3, jitter=2),
        "not_descending": lambda: dp.nested_poisson_disk(torus, [0.1, 0.2]),
        "different_domains": lambda: dp.extend_poisson_disk(dp.Points([[0, 0]], torus), 0.1, domain=dp.Domain(2)),
    }
    for kind, call in kinds.items():
        with pytest.raises(dp.DappleError) as error:
            call()
        assert error.value.kind == kind, (kind, error.value.kind, str(error.value))
    with pytest.raises(dp.DappleError):
        dp.Points([[np.nan, 0]])
    with pytest.raises(dp.DappleError):
        dp.poisson_disk(torus, distance=float("nan"))
    for call in [
        lambda: dp.poisson_disk(1.0, distance=0.1),
        lambda: dp.poisson_disk(torus, distance="near"),
        lambda: dp.poisson_disk(torus, distance=lambda x: x),
        lambda: dp.jittered_grid(torus, "a"),
        lambda: dp.Points("points"),
    ]:
        with pytest.raises((TypeError, ValueError)):
            call()


def test_threads_do_not_change_points() -> None:
    before = dp.threads()
    try:
        made = []
        for count in [1, 2]:
            dp.set_threads(count)
            field = dp.gradient_noise(seed=1, period=4).frequency(4) + 1.0
            made.append((dp.poisson_disk(dp.Domain(1), distance=0.01), dp.poisson_disk(dp.Domain(1), density=field, count=3000)))
        assert made[0] == made[1]
    finally:
        dp.set_threads(before)
