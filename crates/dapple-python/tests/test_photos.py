"""Photographs: light, size, perspective, and materials that are estimated from them."""

import dapple_textures as dp
import numpy as np
import pytest

PHOTO = np.random.default_rng(3).random((48, 64, 3)).astype(np.float32)


def test_resize_averages_areas_and_weights_colors_by_alpha():
    np.testing.assert_allclose(dp.resize(PHOTO, (24, 32)), PHOTO.reshape(24, 2, 32, 2, 3).mean((1, 3)), atol=1e-6)
    assert dp.resize({"height": PHOTO[..., 0], "albedo": PHOTO}, 8)["albedo"].shape == (8, 8, 3)
    # Clear pixels are black, but only the opaque ones count.
    clear = np.zeros((2, 2, 4), np.float32)
    clear[:, 1] = [0.5, 0.25, 1.0, 1.0]
    np.testing.assert_allclose(dp.resize(clear, 1), [[[0.5, 0.25, 1.0, 0.5]]], atol=1e-6)


def test_even_out_keeps_alpha_and_removes_a_ramp():
    ramp = np.linspace(0.2, 1, 64, dtype=np.float32)[None, :, None].repeat(48, 0)
    even = dp.even_out(np.concatenate([ramp] * 4, -1), 16)
    np.testing.assert_allclose(even[..., :3], ramp.mean(), atol=1e-3)
    np.testing.assert_array_equal(even[..., 3], ramp[..., 0])


def test_rectify_crops_at_whole_pixels_and_refuses_bad_corners():
    corners = [(8, 4), (40, 4), (40, 30), (8, 30)]
    np.testing.assert_array_equal(dp.rectify(PHOTO, corners), PHOTO[4:30, 8:40])
    assert dp.rectify(PHOTO, corners, size=(5, 6)).shape == (5, 6, 3)
    with pytest.raises(dp.DappleError, match="clockwise"):
        dp.rectify(PHOTO, corners[::-1])
    with pytest.raises(dp.DappleError, match="outside"):
        dp.rectify(PHOTO, [(0, 0), (65, 0), (64, 48), (0, 48)])
    with pytest.raises(dp.DappleError, match="normals"):
        dp.rectify({"normal": np.tile([0.0, 0.0, 1.0], (48, 64, 1))}, corners)


def test_estimates_have_the_size_of_the_photograph_and_options_by_name():
    maps, relief = dp.estimate_material(PHOTO)
    assert {name: map.shape for name, map in maps.items()} == {
        "albedo": (48, 64, 3),
        "height": (48, 64),
        "roughness": (48, 64),
    }
    assert relief > 0 and 0 <= maps["height"].min() and maps["height"].max() <= 1
    flat = dp.estimate_material(PHOTO, slope=0.0, variation=0.0)
    assert flat[1] == 0 and np.ptp(flat[0]["roughness"]) == 0
    with pytest.raises(dp.DappleError, match="slop"):
        dp.estimate_material(PHOTO, slop=0.5)
    with pytest.raises(dp.DappleError, match="from 0 to 10"):
        dp.estimate_material(PHOTO, slope=11)
    with pytest.raises(dp.DappleError, match="three channels"):
        dp.estimate_material(PHOTO[..., 0])
