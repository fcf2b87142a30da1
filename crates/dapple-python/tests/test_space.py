"""Fields of three and four axes are composed as those of the plane."""

from __future__ import annotations

import pickle
import timeit

import numpy as np
import pytest

import dapple_textures as dp

AT = np.random.default_rng(0).random((200, 3)) * 9
F, G = dp.gradient_noise(seed=1, dims=3), dp.worley(seed=2, dims=3)
f, g = F.sample(AT), G.sample(AT)


@pytest.mark.parametrize(
    ("composed", "expected"),
    [
        (F + G, f + g),
        (F - 0.5, f - np.float32(0.5)),
        (2 - F, 2 - f),
        (F * G, f * g),
        (-F, -f),
        (abs(F), abs(f)),
        (F.clamp(-0.1, 0.2), f.clip(np.float32(-0.1), np.float32(0.2))),
        (F.minimum(G), np.minimum(f, g)),
        (F.maximum(0.1), np.maximum(f, np.float32(0.1))),
        (F.mix(G, 0.25), f + (g - f) * np.float32(0.25)),
        (F.remap((-1, 1)), (f + 1) / 2),
        (F.frequency(2), F.sample(AT * 2)),
        (F.frequency((1, 2, 3)), F.sample(AT * [1, 2, 3])),
        (F.offset((0.5, 0.25, 3)), F.sample(AT + [0.5, 0.25, 3])),
        (F.fbm(3), F.sample(AT) + F.sample(AT * 2) / 2 + F.sample(AT * 4) / 4),
    ],
    ids=lambda part: "" if isinstance(part, np.ndarray) else None,
)
def test_compositions_are_those_of_their_values(composed, expected):
    assert composed.ndim == 3
    # One rounding of float32 for each operation on numbers below 8.
    assert np.allclose(composed.sample(AT), expected, rtol=0, atol=2e-6)
    assert pickle.loads(pickle.dumps(composed)) == composed


def test_warps_and_rotations_move_positions_in_planes():
    x, y = dp.gradient_noise(seed=3, dims=3), dp.gradient_noise(seed=4, dims=3)
    moved = AT + 0.5 * np.stack([x.sample(AT), y.sample(AT), np.zeros(len(AT))], axis=1)
    # The values of noise change by less than 4 over a cell; positions are rounded in float64.
    assert np.allclose(F.warp(x, y, 0.5).sample(AT), F.sample(moved), rtol=0, atol=1e-5)
    turned = AT @ np.array([[np.cos(0.3), -np.sin(0.3), 0], [np.sin(0.3), np.cos(0.3), 0], [0, 0, 1]])
    assert np.allclose(F.rotate(0.3).sample(AT), F.sample(turned), rtol=0, atol=1e-5)


def test_warps_move_positions_along_all_axes():
    for dims in (3, 4):
        at = np.random.default_rng(5).random((500, dims)) * 9
        field, *by = (dp.gradient_noise(seed=seed, dims=dims) for seed in range(dims + 1))
        further = dict(zip("zw", by[2:], strict=False))
        warped = field.warp(by[0], by[1], 0.5, **further)
        moved = at + 0.5 * np.stack([along.sample(at) for along in by], axis=1)
        # The values of noise change by less than 4 over a cell; positions are rounded in float64.
        assert np.allclose(warped.sample(at), field.sample(moved), rtol=0, atol=1e-5)
        assert not np.allclose(warped.sample(at), field.warp(by[0], by[1], 0.5).sample(at), rtol=0, atol=0.1)
        assert pickle.loads(pickle.dumps(warped)) == warped
        # A composition of it has the same values in arrays, slices and at positions.
        composed = (warped * 0.5 + field).fbm(2)
        size = (2,) * (dims - 2) + (8, 8)
        array = composed.render(size, extent=4)
        corners = np.stack(np.meshgrid(*(np.arange(side) for side in size), indexing="ij"), -1)
        centers = (corners + 0.5) / size * 4
        assert np.array_equal(array, composed.sample(centers[..., ::-1]))
        first = array[(0,) * (dims - 2)]
        assert np.array_equal(first, composed.slice(*[1.0] * (dims - 2)).render(8, extent=4))
        assert np.array_equal(array[..., 2:5, 3:], composed.render(size, extent=4, window=np.s_[:2, :2, 2:5, 3:8][4 - dims :]))


def test_a_displacement_along_w_alone_keeps_z():
    field, x, y, w = (dp.gradient_noise(seed=seed, dims=4) for seed in range(4))
    at = np.random.default_rng(5).random((100, 4)) * 9
    moved = at + np.stack([x.sample(at), y.sample(at), np.zeros(100), w.sample(at)], axis=1)
    assert np.allclose(field.warp(x, y, 1, w=w).sample(at), field.sample(moved), rtol=0, atol=1e-5)


def test_displacements_along_axes_that_fields_lack_are_refused():
    flat = dp.gradient_noise()
    with pytest.raises(dp.DappleError, match="along z, which they lack"):
        flat.warp(flat, flat, 1, z=flat)
    with pytest.raises(dp.DappleError, match="along w, which they lack"):
        F.warp(F, F, 1, w=F)


def test_periods_of_warps_out_of_the_plane():
    a, b = dp.gradient_noise(dims=3, period=(2, 3, 4)), dp.gradient_noise(seed=1, dims=3, period=(4, 3, 6))
    warped = a.warp(a, a, 0.5, z=b)
    assert warped.period == [4, 3, 12]
    at = np.random.default_rng(5).random((100, 3)) * 9
    # Positions are rounded in float64.
    assert np.allclose(warped.sample(at), warped.sample(at + [4, 3, 12]), rtol=0, atol=1e-6)


def test_compositions_in_space_take_the_time_of_their_parts():
    """The composition is made for thousands of positions, and not for each."""
    field = dp.gradient_noise(dims=3)
    composed = field
    for _ in range(30):
        composed = (composed + 1) - 1
    at = np.random.default_rng(1).random((200_000, 3)) * 9

    def seconds(of):
        return min(timeit.repeat(lambda: of.sample(at), number=1, repeat=3))

    # Sixty sums take some nanoseconds each, and to make the composition takes microseconds.
    assert seconds(composed) < 20 * seconds(field)


def test_arrays_slices_and_positions_agree():
    field = (F.fbm(2) * G).frequency((1, 1, 2)) + 0.5
    volume = field.render((4, 8, 8), extent=4)
    centers = (np.stack(np.meshgrid(np.arange(4), np.arange(8), np.arange(8), indexing="ij"), -1) + 0.5) / [4, 8, 8] * 4
    assert np.array_equal(volume, field.sample(centers[..., ::-1]))
    assert np.array_equal(volume[2], field.slice(2.5).render(8, extent=4))
    assert np.array_equal(volume[1:3, 2:5, 3:], field.render((4, 8, 8), extent=4, window=np.s_[1:3, 2:5, 3:8]))


def test_periods_of_compositions():
    a, b = dp.gradient_noise(dims=3, period=(2, 3, 4)), dp.gradient_noise(seed=1, dims=3, period=(4, 3, 6))
    assert (a + 1).period == [2, 3, 4]
    assert (a + b).period == [4, 3, 12]
    assert a.frequency((1, 1, 2)).period == [2, 3, 2]
    assert (a + dp.gradient_noise(period=2)).period == [2, 6, 4]
    assert dp.gradient_noise(dims=4, period=(2, 2, 2, 5)).fbm(3).period == [2, 2, 2, 5]


def test_other_numbers_of_axes_are_refused():
    with pytest.raises(dp.DappleError, match="three and of four axes"):
        F + dp.gradient_noise(dims=4)
    with pytest.raises(dp.DappleError, match="3 numbers"):
        F.frequency((1, 2))
    with pytest.raises(dp.DappleError, match="2 numbers"):
        dp.worley().offset((1, 2, 3))
