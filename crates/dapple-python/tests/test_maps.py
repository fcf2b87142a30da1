"""Maps from heights, ramps and the sRGB curve."""

import numpy as np
import pytest

import dapple_textures as dp

HEIGHT = dp.worley(seed=7, period=8).render((48, 64), extent=(8, 6))


def test_normals_of_a_slope_are_those_of_the_formula_and_y_turns():
    y, x = np.mgrid[0:16, 0:32] / 16.0
    up = dp.normal_map(0.25 * y, relief=2.0, extent=(2, 1), wrap="clamp")
    assert up.shape == (16, 32, 3) and up.dtype == np.float32
    # The height grows downward by 0.5, so the normal leans up.
    np.testing.assert_allclose(up[8, 8], np.array([0, 0.5, 1]) / 1.25**0.5, atol=1e-6)
    down = dp.normal_map(0.25 * y, relief=2.0, extent=(2, 1), wrap="clamp", y="down")
    np.testing.assert_array_equal(down * [1, -1, 1], up)
    side = dp.normal_map(x, extent=(2, 1), wrap=("clamp", "repeat"))
    np.testing.assert_allclose(side[8, 8], np.array([-1, 0, 1]) / 2**0.5, atol=1e-6)


def test_normals_do_not_depend_on_the_resolution():
    coarse, fine = (
        dp.normal_map(np.sin(2 * np.pi * (np.arange(n) + 0.5) / n)[None].repeat(8, 0), extent=1)
        for n in (256, 768)
    )
    np.testing.assert_allclose(coarse[0], fine[0, 1::3], atol=2e-3)


@pytest.mark.parametrize("make", [dp.normal_map, dp.ambient_occlusion, dp.curvature, dp.ramp])
def test_strided_and_read_only_arrays_and_threads_give_the_same_bits(make):
    expected = make(HEIGHT)
    wide = np.zeros((48, 128), np.float64)
    wide[:, ::2] = HEIGHT
    wide.flags.writeable = False
    np.testing.assert_array_equal(make(wide[:, ::2]), expected)
    np.testing.assert_array_equal(make(HEIGHT.tolist()), expected)
    before = dp.threads()
    try:
        for threads in (1, 2):
            dp.set_threads(threads)
            np.testing.assert_array_equal(make(HEIGHT), expected)
    finally:
        dp.set_threads(before)


def test_a_tile_of_heights_gives_tiles():
    for make in (dp.normal_map, dp.ambient_occlusion, dp.curvature):
        rolled = make(np.roll(HEIGHT, (5, 9), (0, 1)), extent=(8, 6))
        np.testing.assert_allclose(rolled, np.roll(make(HEIGHT, extent=(8, 6)), (5, 9), (0, 1)), atol=1e-6)


def test_occlusion_is_one_on_planes_and_low_in_grooves():
    x = np.linspace(0, 3, 64)[None].repeat(64, 0)
    np.testing.assert_allclose(dp.ambient_occlusion(x, wrap="clamp", radius=0.2)[:, 20:40], 1, atol=1e-6)
    seen = dp.ambient_occlusion(HEIGHT, extent=(8, 6), radius=1.0)
    assert 0 <= seen.min() < 0.9 and seen[HEIGHT > 0.9 * HEIGHT.max()].mean() > seen[HEIGHT < 0.1].mean()


def test_curvature_of_a_sphere_is_one_over_its_radius():
    y, x = np.mgrid[-0.5:0.5:129j, -0.5:0.5:129j]
    bent = dp.curvature(np.sqrt(4 - x * x - y * y), extent=129 / 128, wrap="clamp")
    np.testing.assert_allclose(bent[32:96, 32:96], 0.5, rtol=0.01)


def test_ramps_meet_their_stops_whatever_they_are_made_of():
    palettes = dp.palettes()
    for name, colors in palettes.items():
        at = np.linspace(0, 1, len(colors), dtype=np.float32)[None]
        for given in (name, colors, colors.tolist(), list(zip(at[0], colors))):
            np.testing.assert_allclose(dp.ramp(at, given)[0], colors, atol=1e-6)
    stops = [(-1.0, "#f00"), (1.0, "#00f")]
    np.testing.assert_allclose(dp.ramp([[0.0]], stops, space="linear"), [[[0.5, 0, 0.5]]])
    assert dp.ramp([[0.9]], stops, interpolation="stepped").tolist() == [[[1, 0, 0]]]
    np.testing.assert_allclose(dp.ramp([[0.5]], stops, outside="repeat"), dp.ramp([[-1.5 + 2]], stops))


def test_srgb_codes_survive_and_are_those_of_the_standard():
    for dtype, depth in ((np.uint8, 8), (np.uint16, 16)):
        codes = np.arange(np.iinfo(dtype).max + 1, dtype=dtype).reshape(4, -1)
        linear = dp.linear_from_srgb(codes)
        unit = codes / np.iinfo(dtype).max
        curve = np.where(unit <= 0.04045, unit / 12.92, ((unit + 0.055) / 1.055) ** 2.4)
        np.testing.assert_allclose(linear, curve, rtol=1e-6)
        again = dp.srgb_from_linear(linear, depth=depth)
        assert again.dtype == dtype
        np.testing.assert_array_equal(again, codes)
    assert dp.srgb_from_linear([-1, np.nan, 2, np.inf]).tolist() == [0, 0, 255, 255]


@pytest.mark.parametrize(
    "call",
    [
        lambda: dp.normal_map(HEIGHT, y="left"),
        lambda: dp.normal_map(HEIGHT, wrap="torus"),
        lambda: dp.normal_map(HEIGHT, relief=np.inf),
        lambda: dp.normal_map(HEIGHT, extent=(0, 1)),
        lambda: dp.normal_map(np.zeros((4, 4, 3))),
        lambda: dp.normal_map(np.zeros((0, 4))),
        lambda: dp.normal_map(np.zeros(4)),
        lambda: dp.normal_map(np.zeros((4, 4), np.uint8)),
        lambda: dp.normal_map(np.zeros((4, 4), complex)),
        lambda: dp.ambient_occlusion(HEIGHT, radius=-1),
        lambda: dp.curvature(HEIGHT, radius=1e9),
        lambda: dp.ramp(HEIGHT, "rainbow"),
        lambda: dp.ramp(HEIGHT, []),
        lambda: dp.ramp(HEIGHT, ["#zzz"]),
        lambda: dp.ramp(HEIGHT, [(0.0, "#000"), "#fff"]),
        lambda: dp.ramp(HEIGHT, [(1.0, "#000"), (0.0, "#fff")]),
        lambda: dp.ramp(HEIGHT, [[0.0, 0.0, 0.0, 0.0]]),
        lambda: dp.srgb_from_linear([0.5], depth=12),
    ],
)
def test_what_cannot_be_is_refused(call):
    with pytest.raises(dp.DappleError) as error:
        call()
    assert error.value.kind


def test_codes_must_have_a_type():
    with pytest.raises(TypeError):
        dp.linear_from_srgb([1, 2])
    with pytest.raises(ValueError):
        dp.normal_map("heights")
