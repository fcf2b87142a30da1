"""Fields of three and four axes are composed as those of the plane."""

from __future__ import annotations

import pickle

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


def test_warps_and_rotations_move_positions_in_their_planes():
    x, y = dp.gradient_noise(seed=3, dims=3), dp.gradient_noise(seed=4, dims=3)
    moved = AT + 0.5 * np.stack([x.sample(AT), y.sample(AT), np.zeros(len(AT))], axis=1)
    # The values of noise change by less than 4 over a cell; positions are rounded in float64.
    assert np.allclose(F.warp(x, y, 0.5).sample(AT), F.sample(moved), rtol=0, atol=1e-5)
    turned = AT @ np.array([[np.cos(0.3), -np.sin(0.3), 0], [np.sin(0.3), np.cos(0.3), 0], [0, 0, 1]])
    assert np.allclose(F.rotate(0.3).sample(AT), F.sample(turned), rtol=0, atol=1e-5)


def test_arrays_slices_and_positions_agree():
    field = (F.fbm(2) * G).frequency((1, 1, 2)) + 0.5
    volume = field.render((4, 8, 8), extent=4)
    centers = (np.stack(np.meshgrid(np.arange(4), np.arange(8), np.arange(8), indexing="ij"), -1) + 0.5) / [4, 8, 8] * 4
    assert np.allclose(volume, field.sample(centers[..., ::-1]), rtol=0, atol=1e-6)
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
