"""Tiles, seam reports, blending, and bands."""

import os
import shutil
import subprocess

import numpy as np
import pytest

import dapple_textures as dp

RNG = np.random.default_rng(3)
Y, X = np.mgrid[0:96, 0:128]
#: A picture that does not repeat: waves of odd lengths, grain and a light from one side.
PHOTO = (
    0.45
    + 0.15 * np.sin(X[..., None] / [7.3, 9.1, 6.2] + Y[..., None] / 5.7)
    + 0.0008 * X[..., None]
    + 0.1 * RNG.random((96, 128, 3))
).astype(np.float32)
HEIGHT = PHOTO[..., 0]
#: Noise under the same light, without a pattern that a cut could break.
SAND = (
    0.5
    + 0.2 * np.dstack([dp.gradient_noise(seed=seed, octaves=4).render((96, 128), extent=(12.8, 9.6)) for seed in (7, 8, 9)])
    + 0.0008 * X[..., None]
).astype(np.float32)
MATERIAL = {"albedo": PHOTO, "height": HEIGHT, "normal": dp.normal_map(HEIGHT, relief=0.02), "orm": PHOTO[::-1]}
TILE = dp.worley(seed=7, period=8).render(64)
COMMAND = os.environ.get("DAPPLE") or shutil.which("dapple")
METHODS = {
    "periodic": {},
    "poisson": {"wrap_gradient": "extrapolate"},
    "soft_cut": {"margin": 16, "half_width": 2.0, "crossfade": "keep_variance"},
    "spline_project": {"levels": 2, "basis": {"spline": "cubic"}},
    "periodic_then_project": {},
    "feather": {"margin": 8},
    "mirror": {},
}
REPORTED = ("periodic", "soft_cut", "feather", "mirror")


@pytest.mark.parametrize("method", METHODS)
def test_tiles_of_gray_color_alpha_and_materials_agree(method):
    options = METHODS[method]
    gray = dp.make_tile(HEIGHT, method=method, **options)
    alpha = dp.make_tile(np.dstack([PHOTO, HEIGHT]), method=method, **options)
    assert alpha.shape == (*gray.shape, 4) and alpha.dtype == np.float32
    wrapped = np.abs(gray[:, 0] - gray[:, -1]).mean()
    assert wrapped < 0.7 * np.abs(HEIGHT[:, 0] - HEIGHT[:, -1]).mean()
    if method not in ("soft_cut", "feather"):
        # Nothing is chosen by the content, so channels do not know each other.
        np.testing.assert_array_equal(alpha[..., 0], gray)
        np.testing.assert_array_equal(alpha[..., 3], gray)
    maps = dp.make_tile(MATERIAL, method=method, **options)
    assert {name: tile.shape for name, tile in maps.items()} == {
        name: (*gray.shape, *array.shape[2:]) for name, array in MATERIAL.items()
    }
    np.testing.assert_array_equal(maps["albedo"][..., 0], maps["height"])
    np.testing.assert_allclose(np.linalg.norm(maps["normal"], axis=2), 1, atol=1e-6)


def test_a_method_is_a_name_with_options_or_data():
    named = dp.make_tile(PHOTO, method="soft_cut", margin=16, half_width=2.0)
    np.testing.assert_array_equal(dp.make_tile(PHOTO, method={"soft_cut": {"margin": 16, "half_width": 2.0}}), named)
    one = dp.make_tile(PHOTO, margin=16, axes=(True, False))
    assert one.shape == (96, 112, 3)
    # A small picture gets a small margin.
    assert dp.make_tile(PHOTO[:20, :20]).shape == (15, 15, 3)


@pytest.mark.skipif(COMMAND is None, reason="the command dapple is not on PATH")
@pytest.mark.parametrize("method", ["soft_cut", "periodic", "feather", "mirror"])
def test_tiles_are_those_of_the_command(tmp_path, method):
    source, out = tmp_path / "a.exr", tmp_path / "b.exr"
    dp.write_image(source, PHOTO)
    subprocess.run(
        [COMMAND, "tile", source, "--method", method.replace("_", "-"), "-o", out, "-q"], check=True
    )
    np.testing.assert_array_equal(dp.read_image(out), dp.make_tile(PHOTO, method=method))


def test_reports_tell_tiles_from_pictures_and_say_why():
    bad = dp.seam_report(PHOTO)
    assert not bad.passes and bad.badness > 1
    assert {channel for channel, _ in bad.faults} <= {"red", "green", "blue"} and "the seam shows" in bad.faults[0][1]
    assert bad.channels[0]["report"]["size"] == [128, 96] and "seam" in str(bad)
    good = dp.seam_report(dp.make_tile(SAND, margin=32), SAND)
    assert good.passes and good.faults == [] and good.badness < dp.seam_report(SAND).badness
    assert good.channels[0]["report"]["kept"]["coarse_strangeness"] < 1.5
    # The waves have lengths that do not fit the tile, so that a cut shifts them; squares of 16 pixels show it.
    cut = dp.seam_report(dp.make_tile(PHOTO, margin=24), PHOTO)
    assert not cut.passes and cut.badness < bad.badness
    assert {fault for _, fault in cut.faults} == {"the seam is unlike anything in the source"}
    kept = cut.channels[0]["report"]["kept"]
    assert kept["strangeness"] < 1.5 < kept["coarse_strangeness"]
    mirrored = dp.seam_report(dp.make_tile(PHOTO, method="mirror"), PHOTO)
    assert any("mirror" in fault for _, fault in mirrored.faults)
    reports = dp.seam_report(MATERIAL)
    assert list(reports) == list(MATERIAL)
    assert [of["channel"] for of in reports["orm"].channels] == ["0", "1", "2"]
    assert dp.seam_report(np.dstack([TILE] * 4)).channels[-1]["channel"] == "alpha"
    assert dp.seam_report(TILE).passes
    assert dp.seam_report(HEIGHT, axes=(False, True)).channels[0]["report"]["seams"][0]["x"] is None


def test_repeat_is_what_numpy_tiles():
    for tile in (HEIGHT, PHOTO, np.dstack([PHOTO, HEIGHT])):
        np.testing.assert_array_equal(dp.repeat(tile, (150, 333)), np.concatenate([np.concatenate([tile] * 3, 1)] * 2)[:150, :333])


@pytest.mark.parametrize(
    "cover",
    [
        lambda size, first: dp.disturb(TILE, size, seed=3, first=first),
        lambda size, first: dp.lay_tiles([TILE, 1 - TILE, TILE[::-1]], size, seed=3, first=first),
        lambda size, first: CORNERS.render(size, seed=3, first=first),
    ],
)
def test_windows_of_maps_are_crops_and_seeds_differ(cover):
    whole = cover((200, 260), (0, 0))
    np.testing.assert_array_equal(cover((50, 70), (100, 60)), whole[60:110, 100:170])
    assert (cover((200, 260), (10_000, 0)) != whole).any()
    before = dp.threads()
    try:
        dp.set_threads(1)
        np.testing.assert_array_equal(cover((200, 260), (0, 0)), whole)
    finally:
        dp.set_threads(before)


CORNERS = dp.CornerTiles([TILE, np.roll(TILE, 30, 0), TILE.T])


def test_corner_tiles_fit_where_their_corners_do():
    tiles = CORNERS.all()
    assert len(tiles) == 81
    np.testing.assert_array_equal(tiles[1 + 2 * 3 + 0 * 9 + 2 * 27], CORNERS.tile([1, 2, 0, 2]))
    np.testing.assert_array_equal(CORNERS.tile([2, 2, 2, 2]), TILE.T)
    colored = dp.CornerTiles([np.dstack([TILE] * 3), np.dstack([TILE.T] * 3)], width=0.25, period=(2, 1))
    assert colored.tile([0, 1, 1, 0]).shape == (64, 64, 3)
    plane = colored.render((64, 256), seed=1)
    np.testing.assert_array_equal(plane[:, :128], plane[:, 128:])


def test_matched_borders_are_one():
    tiles = dp.match_borders([TILE, 1 - TILE, TILE.T], width=12)
    np.testing.assert_array_equal(tiles[0], TILE)
    for tile in tiles:
        np.testing.assert_array_equal(tile[[0, -1]], TILE[[0, -1]])
        np.testing.assert_array_equal(tile[:, [0, -1]], TILE[:, [0, -1]])
    np.testing.assert_array_equal(tiles[1][20:40, 20:40], (1 - TILE)[20:40, 20:40])


def test_ranks_are_even_and_keep_the_order():
    ranks = dp.rank_equalize(HEIGHT)
    assert abs((ranks < 0.3).mean() - 0.3) < 0.01
    assert (np.argsort(ranks, None, "stable") == np.argsort(HEIGHT, None, "stable")).mean() > 0.99


def test_blends_take_weights_heights_and_tiles():
    a, b = np.zeros((64, 64, 3), np.float32), np.ones((64, 64, 3), np.float32)
    np.testing.assert_allclose(dp.blend([a, b]), 0.5)
    np.testing.assert_allclose(dp.blend([a, b], weights=[1, 3]), 0.75)
    mask = TILE / TILE.max()
    np.testing.assert_allclose(dp.blend([a, b], weights=[1 - mask, mask])[..., 1], mask, atol=1e-6)
    higher = dp.blend([a, b], heights=[mask, 1 - mask], weighting={"height": {"depth": 0.01}})
    assert (higher[mask > 0.6] == 0).all() and (higher[mask < 0.4] == 1).all()
    tile = dp.rank_equalize(dp.blend_map(TILE, feature_size=8))
    cracks = dp.blend([a, b], weights=[0.3, 0.7], tile=tile, weighting={"mask": {"gain": 1e9}})
    assert abs((cracks == 0).mean() - 0.3) < 0.02
    for mixing in ("keep_variance", {"pyramid": {"levels": 3}}):
        np.testing.assert_allclose(dp.blend([b, b], mixing=mixing), 1, atol=1e-5)
    material = dp.blend([{"albedo": a, "height": mask}, {"albedo": b, "height": 1 - mask}])
    np.testing.assert_allclose(material["height"], 0.5, atol=1e-6)


def test_what_is_transparent_lends_no_color():
    red, clear = np.zeros((4, 4, 4), np.float32), np.zeros((4, 4, 4), np.float32)
    red[..., [0, 3]] = 1
    clear[..., 1] = 1
    mixed = dp.blend([red, clear])
    np.testing.assert_allclose(mixed, np.broadcast_to([1, 0, 0, 0.5], (4, 4, 4)))


def test_bands_add_up_and_halving_undoes_doubling():
    for image in (HEIGHT, PHOTO):
        for options in ({}, {"degree": "cubic"}, {"fit": "coefficients", "phase": "cook_de_rose"}):
            bands = dp.wavelet_analyze(image, levels=3, **options)
            np.testing.assert_allclose(dp.wavelet_synthesize(bands, **options), image, atol=2e-6)
            np.testing.assert_array_equal(dp.wavelet_halve(dp.wavelet_halve(dp.wavelet_halve(image, **options), **options), **options), bands.coarse)
    odd = HEIGHT[:33, :21]
    half = dp.wavelet_halve(odd, borders="mirror")
    assert dp.wavelet_double(half, odd.shape, borders="mirror").shape == odd.shape


def test_wavelet_tiles_have_their_variance_and_bands():
    tile = dp.wavelet_tile(256, [0.5, 1.0], seed=9)
    assert abs(tile.var() - 1.25) < 0.1 and dp.seam_report(tile).passes
    coarse = dp.wavelet_tile(256, [0.0, 1.0], seed=9)
    np.testing.assert_allclose(dp.wavelet_analyze(coarse).details[0], 0, atol=1e-5)
    assert (dp.wavelet_tile(256, [0.5, 1.0], seed=8) != tile).any()


@pytest.mark.parametrize(
    "call",
    [
        lambda: dp.make_tile(PHOTO, method="magic"),
        lambda: dp.make_tile(PHOTO, method="periodic", margin=3),
        lambda: dp.make_tile(PHOTO, method="poisson", margin=3),
        lambda: dp.make_tile(PHOTO, margin=90),
        lambda: dp.make_tile(PHOTO, margin=-1),
        lambda: dp.make_tile(PHOTO, margin=np.nan),
        lambda: dp.make_tile(PHOTO, method="spline_project", levels=9),
        lambda: dp.make_tile({}),
        lambda: dp.make_tile({"a": PHOTO, "b": HEIGHT[:9]}),
        lambda: dp.make_tile(np.full((8, 8), np.nan)),
        lambda: dp.make_tile(np.zeros((8, 8, 5))),
        lambda: dp.seam_report(PHOTO, HEIGHT),
        lambda: dp.seam_report(PHOTO, axes=False),
        lambda: dp.seam_report(PHOTO, lattice=0),
        lambda: dp.repeat(TILE, 0),
        lambda: dp.repeat(TILE, 2**31),
        lambda: dp.disturb(TILE, 10, margin=60),
        lambda: dp.match_borders([]),
        lambda: dp.match_borders([TILE, TILE[:9]]),
        lambda: dp.match_borders([TILE, PHOTO]),
        lambda: dp.CornerTiles([TILE]),
        lambda: dp.CornerTiles([TILE, TILE], width=2),
        lambda: dp.CornerTiles([TILE, TILE], period=0),
        lambda: CORNERS.tile([0, 0, 0, 3]),
        lambda: dp.blend([]),
        lambda: dp.blend([TILE, TILE], weights=[1]),
        lambda: dp.blend([TILE, TILE], weights=[-1, 1]),
        lambda: dp.blend([TILE, TILE], weights=[0, 0]),
        lambda: dp.blend([TILE, TILE], weighting="height"),
        lambda: dp.blend([TILE, TILE], weighting={"mask": {"gain": 1}}),
        lambda: dp.blend_map(np.zeros((8, 8, 4))),
        lambda: dp.blend_map(TILE, feature_size=0),
        lambda: dp.wavelet_halve(HEIGHT[:33]),
        lambda: dp.wavelet_halve(HEIGHT, degree="quintic"),
        lambda: dp.wavelet_analyze(HEIGHT, levels=99),
        lambda: dp.wavelet_synthesize(([PHOTO], HEIGHT)),
        lambda: dp.wavelet_synthesize(([HEIGHT], HEIGHT)),
        lambda: dp.wavelet_tile(100, [1] * 4),
        lambda: dp.wavelet_tile(64, []),
    ],
)
def test_what_cannot_be_is_refused(call):
    with pytest.raises(dp.DappleError) as error:
        call()
    assert error.value.kind
