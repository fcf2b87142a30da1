"""Textures from examples, in the plane and on meshes; mesh files."""

import os
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

import dapple_textures as dp

CHECKER = np.kron([[0.0, 1.0], [1.0, 0.0]], np.ones((8, 8))).astype(np.float32)
#: Cells in colors, which repeat.
CELLS = dp.ramp(dp.worley(seed=3, period=8, value="f1").normalized().render(64), "giraffe")
HEIGHT = dp.worley(seed=3, period=8).normalized().render(64)
MATERIAL = {
    "albedo": CELLS,
    "normal": dp.normal_map(HEIGHT, relief=0.05),
    "height": HEIGHT,
    "orm": np.dstack([HEIGHT, 1 - HEIGHT, 0 * HEIGHT]),
}
COMMAND = os.environ.get("DAPPLE") or shutil.which("dapple")


def torus(n=24, m=12):
    """A torus of 2 n m triangles around the y axis."""
    u, v = np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij")
    radius = 1 + 0.4 * np.cos(v)
    vertices = np.stack([radius * np.cos(u), 0.4 * np.sin(v), -radius * np.sin(u)], 2).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    at = lambda i, j: (i % n) * m + j % m
    faces = np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)], 2)
    return vertices, faces.reshape(-1, 3)


TORUS = torus()
QUICK = {"atlas": {"texels": 256}, "sites": 3000, "matching": {"levels": 2}}
wrapped = partial(dp.Exemplar, edges="wrap")
MODEL = dp.synthesize_on(TORUS, wrapped(MATERIAL), **QUICK, seed=5)


@pytest.mark.parametrize("threads", [1, 2])
def test_every_pixel_is_one_of_the_example_and_maps_follow(threads):
    before = dp.threads()
    try:
        dp.set_threads(threads)
        texture, sources = dp.synthesize(wrapped(MATERIAL), (40, 56), seed=7, wrap=True, sources=True)
    finally:
        dp.set_threads(before)
    assert sources.shape == (40, 56, 2) and list(texture) == list(MATERIAL)
    for name, array in texture.items():
        np.testing.assert_array_equal(array, MATERIAL[name].astype(np.float32)[sources[..., 1], sources[..., 0]])
    np.testing.assert_array_equal(dp.synthesize(wrapped(CELLS), (40, 56), seed=7, wrap=True), texture["albedo"])
    assert (dp.synthesize(wrapped(CELLS), (40, 56), seed=8, wrap=True) != texture["albedo"]).any()


def test_a_texture_that_wraps_is_a_tile_and_alpha_follows():
    image = np.dstack([CELLS, HEIGHT])
    tile = dp.synthesize(wrapped(image), 64, wrap=True)
    assert tile.shape == (64, 64, 4)
    assert dp.seam_report(tile[..., :3]).passes
    assert not dp.seam_report(dp.synthesize(wrapped(image), 64)[..., :3]).passes


def test_a_repair_changes_only_the_hole_and_takes_nothing_from_it():
    hole = np.zeros(CELLS.shape[:2])
    hole[20:28, 30:36] = 1
    maps = {name: array.copy() for name, array in MATERIAL.items()}
    for array in maps.values():
        array[hole > 0] = 0.125
    repaired, sources = dp.repair(wrapped(maps), hole, seed=2, sources=True)
    assert not hole[sources[..., 1], sources[..., 0]].any()
    for name, array in repaired.items():
        np.testing.assert_array_equal(array, maps[name].astype(np.float32)[sources[..., 1], sources[..., 0]])
        np.testing.assert_array_equal(array[hole == 0], maps[name].astype(np.float32)[hole == 0])
    alone = dp.repair(wrapped(maps["albedo"]), hole > 0, seed=2)
    np.testing.assert_array_equal(alone, repaired["albedo"])
    with pytest.raises(dp.DappleError, match="mask|needed"):
        dp.repair(maps["albedo"], hole[1:])
    with pytest.raises(dp.DappleError, match="leaves no neighborhood"):
        dp.repair(maps["albedo"], np.ones_like(hole))


def test_options_have_an_effect():
    plain = dp.synthesize(CELLS, 48, matching={"levels": 2, "method": "sweep"})
    for options in ({"coherence": 5.0}, {"evenness": 0.0}, {"paper": True}, {"levels": 3}):
        assert (dp.synthesize(CELLS, 48, matching={"levels": 2, **options}) != plain).any(), options
    assert (dp.synthesize(wrapped(CELLS), 48, matching={"levels": 2}) != plain).any()
    auto = dp.Matching(levels=2, coherence="auto", evenness=1)
    np.testing.assert_array_equal(dp.synthesize(CELLS, 48, matching=auto), plain)


def test_windows_of_one_texture_fit_together():
    whole = dp.synthesize(MATERIAL, (48, 64), at=(7, -100), seed=3)
    part = dp.synthesize(MATERIAL, (10, 20), at=(17, -70), seed=3)
    for name, array in part.items():
        np.testing.assert_array_equal(array, whole[name][30:40, 10:30])
    tile, beside = (dp.synthesize(CELLS, 64, matching={"levels": 4}, wrap=True, at=at) for at in [(0, 0), (-64, 128)])
    np.testing.assert_array_equal(tile, beside)


def test_the_method_is_the_first_that_can():
    def texture(options, **matching):
        return dp.synthesize(CELLS, 48, **options, matching=matching)

    for options, matching in [({}, {}), ({"at": (0, 0)}, {}), ({"wrap": True}, {"levels": 4})]:
        np.testing.assert_array_equal(texture(options, **matching), texture(options, **matching, method="endless"))
    for options, matching in [({}, {"evenness": 1}), ({"wrap": True}, {"levels": 5})]:
        np.testing.assert_array_equal(texture(options, **matching), texture(options, **matching, method="sweep"))
    for options, matching, match in [
        ({"at": (1, 2)}, {"method": "sweep"}, "at has no effect"),
        ({"at": (1, 2)}, {"coherence": 2}, "have no effect on an endless"),
        ({}, {"method": "endless", "paper": True}, "have no effect on an endless"),
        ({"wrap": True}, {"method": "endless", "levels": 5}, "multiple of 32"),
        ({}, {"method": "fast"}, "endless, sweep"),
        ({"at": (2**52 + 1, 0)}, {}, "2\\^52"),
    ]:
        with pytest.raises(dp.DappleError, match=match):
            texture(options, **matching)


def test_what_has_no_effect_is_refused():
    hole = np.zeros(CELLS.shape[:2])
    for field, value in {"evenness": 1, "guides": [(HEIGHT, HEIGHT, 1)], "method": "sweep", "space": "colors", "axes": "carried"}.items():
        calls = {
            "repair": lambda: dp.repair(CELLS, hole, matching={field: value}),
            "repair_on": lambda: dp.repair_on(MODEL, MODEL.texture, hole, matching={field: value}),
            "along": lambda: dp.synthesize_along(CELLS, hole, matching={field: value}),
            "plane": lambda: dp.synthesize(CELLS, 48, matching={field: value}),
            "mesh": lambda: dp.synthesize_on(TORUS, CELLS, matching={field: value}),
        }
        without = {
            "evenness": ["repair", "repair_on"],
            "guides": ["repair", "repair_on", "along"],
            "method": ["repair", "repair_on", "along", "mesh"],
            "space": ["repair", "repair_on", "plane"],
            "axes": ["repair", "plane"],
        }
        for name in without[field]:
            with pytest.raises(dp.DappleError, match=f"matching: {field} has no effect") as error:
                calls[name]()
            assert error.value.kind == "conflict"
    for example in (dp.Exemplar(CELLS, mesh=MODEL), dp.Exemplar(CELLS, sites=9), dp.Exemplar(CELLS, directions=([], []))):
        for call in (
            lambda: dp.synthesize(example, 48),
            lambda: dp.repair(example, hole),
            lambda: dp.synthesize_along(example, hole),
            lambda: dp.repair_on(MODEL, example, hole),
        ):
            with pytest.raises(dp.DappleError, match="mesh, sites and directions have no effect here; `synthesize_on`"):
                call()


def test_nothing_is_copied_from_outside_of_a_mask():
    # The left half is dark, and the right half, which the mask keeps, is light.
    light = np.arange(64) >= 32
    halves = np.where(light, 0.7, 0.3) + 0.2 * np.random.default_rng(1).random((64, 64))
    masked = dp.Exemplar(halves.astype(np.float32), mask=np.tile(light, (64, 1)) * 1.0)
    dark = np.float32(0.5)
    assert (dp.synthesize(masked, 48) > dark).all()
    assert (dp.synthesize_along(masked, np.zeros((40, 40)), matching={"levels": 2}) > dark).all()
    model = dp.synthesize_on(TORUS, masked, **QUICK)
    at = (model.uv.mean(1) * 256).astype(int)
    assert (model.texture[at[:, 1], at[:, 0]] > dark).all()
    hole = np.zeros((64, 64))
    hole[30:38, 10:18] = 1
    repaired = dp.repair(masked, hole, matching={"levels": 2})
    assert (repaired[hole > 0] > dark).all() and (repaired[hole == 0] == np.float32(halves)[hole == 0]).all()


@pytest.mark.skipif(COMMAND is None, reason="the command dapple is not on PATH")
def test_textures_are_those_of_the_command(tmp_path):
    dp.write_image(tmp_path / "a.png", CELLS)
    example = dp.read_image(tmp_path / "a.png")
    run = [COMMAND, "synth", tmp_path / "a.png", "--seed", "7", "-q"]
    subprocess.run([*run, "--size", "48x40", "--wrap", "both", "-o", tmp_path / "b.png", "--format", "png16"], check=True)
    plane = dp.synthesize(example, (40, 48), seed=7, wrap=True)
    assert (tmp_path / "b.png").read_bytes() == dp.encode_image(plane, depth=16)
    subprocess.run([*run, "--size", "48x40", "--at", "9,-3", "-o", tmp_path / "f.png", "--format", "png16"], check=True)
    far = dp.synthesize(example, (40, 48), seed=7, at=(9, -3))
    assert (tmp_path / "f.png").read_bytes() == dp.encode_image(far, depth=16)
    trimesh.Trimesh(*TORUS, process=False).export(tmp_path / "torus.ply")
    mesh = ["--mesh", tmp_path / "torus.ply", "--sites", "3000", "--texture-size", "256", "--crease", "30"]
    subprocess.run([*run, *mesh, "-o", tmp_path / "b.glb"], check=True)
    model = dp.synthesize_on(dp.read_model(tmp_path / "torus.ply"), example, atlas={"texels": 256}, sites=3000, seed=7)
    model.export(tmp_path / "c.glb")
    assert (tmp_path / "b.glb").read_bytes() == (tmp_path / "c.glb").read_bytes()
    lift = [COMMAND, "synth", tmp_path / "c.glb", "--seed", "3", "-q", "--example-sites", "2000", *mesh]
    subprocess.run([*lift, "-o", tmp_path / "d.glb"], check=True)
    textured = dp.read_model(tmp_path / "c.glb")
    exemplar = dp.Exemplar(textured.texture, mesh=textured, sites=2000)
    options = {"atlas": {"texels": 256}, "sites": 3000, "seed": 3}
    dp.synthesize_on(dp.read_model(tmp_path / "torus.ply"), exemplar, **options).export(tmp_path / "e.glb")
    assert (tmp_path / "d.glb").read_bytes() == (tmp_path / "e.glb").read_bytes()


def test_the_texture_of_another_mesh_is_lifted_with_all_its_maps():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    target = corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    options = {"atlas": {"texels": 128}, "sites": 1500, "matching": {"levels": 2}}
    lift = partial(dp.Exemplar, mesh=MODEL, sites=3000)
    lifted = dp.synthesize_on(target, lift(MODEL.maps), **options)
    assert list(lifted.maps) == list(MATERIAL) and len(lifted.faces) == 4
    for name in ("albedo", "height", "orm"):
        before, values = (maps[name].reshape(-1, maps[name][0, 0].size) for maps in (MODEL.maps, lifted.maps))
        # Values between texels are read, with a rounding.
        assert (values >= before.min(0) - 1e-6).all() and (values <= before.max(0) + 1e-6).all(), name
        assert values.std() > 0.5 * before.std(), name
    alone = dp.synthesize_on(target, lift(MODEL.texture), **options)
    np.testing.assert_array_equal(alone.texture, lifted.texture)
    turned = lift(MODEL.texture, directions=([[1.4, 0, 0]], [[0, 0, 1]]))
    turned = dp.synthesize_on(target, turned, **options)
    assert (turned.texture != alone.texture).any()


def test_the_texture_of_a_mesh_is_made_again_in_the_hole_alone():
    maps = MODEL.maps
    hole = np.hypot(*(np.indices((256, 256)) - 90)) < 30
    stained = {name: np.where(hole if map.ndim == 2 else hole[..., None], 0, map) for name, map in maps.items()}
    clean = dp.repair_on(MODEL, stained, hole, sites=3000, matching={"levels": 2}, seed=4)
    assert list(clean) == list(maps)
    for name, map in clean.items():
        np.testing.assert_array_equal(map[~hole], maps[name][~hole])
    # Black is nowhere in the coat, and it is not taken from the hole.
    inside = clean["albedo"][hole]
    assert (inside.sum(-1) > 0).mean() > 0.5 and inside.std() > 0.5 * maps["albedo"].std()
    alone = dp.repair_on(MODEL, stained["albedo"], hole * 1.0, sites=3000, matching={"levels": 2}, seed=4)
    np.testing.assert_array_equal(alone, clean["albedo"])
    with pytest.raises(dp.DappleError, match="no attribute uv"):
        dp.repair_on(TORUS, stained, hole)
    with pytest.raises(dp.DappleError):
        dp.repair_on(MODEL, stained, hole[1:])
    with pytest.raises(dp.DappleError):
        dp.repair_on(MODEL, stained, hole * 0 + 1)


@pytest.mark.skipif(COMMAND is None, reason="there is no command dapple")
def test_the_command_repairs_the_texture_of_a_mesh_alike(tmp_path):
    dp.synthesize_on(TORUS, wrapped(CELLS), **QUICK).export(tmp_path / "coat.glb")
    coat = dp.read_model(tmp_path / "coat.glb")
    hole = (np.hypot(*(np.indices((256, 256)) - 90)) < 30).astype(np.float32)
    dp.write_image(tmp_path / "hole.png", hole)
    run = [COMMAND, "synth", "coat.glb", "--repair", "hole.png", "--example-sites", "3000", "--levels", "2", "--seed", "4"]
    subprocess.run([*run, "--format", "png8", "-o", "clean.png"], cwd=tmp_path, check=True)
    clean = dp.repair_on(coat, coat.texture, hole, sites=3000, matching={"levels": 2}, seed=4)
    np.testing.assert_array_equal(dp.srgb_from_linear(clean), dp.srgb_from_linear(dp.read_image(tmp_path / "clean.png")))


@pytest.mark.parametrize("options, match", [
    ({"sites": 100}, "without mesh"),
    ({"directions": ([[0, 0, 0]], [[0, 1, 0]])}, "without mesh"),
    ({"mesh": TORUS}, "no attribute uv"),
    ({"mesh": MODEL, "sites": 0}, "0 sites"),
    ({"mesh": MODEL, "directions": ([[0, 0, 0]], [[0, 1, 0], [1, 0, 0]])}, "1 positions, but 2 vectors"),
])
def test_bad_example_meshes_are_refused(options, match):
    with pytest.raises(dp.DappleError, match=match):
        dp.synthesize_on(TORUS, dp.Exemplar(MODEL.texture, **options), atlas={"texels": 128}, sites=500)


def test_textures_of_unit_squares_are_listed_and_not_mixed_up(tmp_path):
    for number in (1001, 1002):
        dp.write_image(tmp_path / f"skin.{number}.png", CELLS, depth=8)
    (tmp_path / "a.mtl").write_text("newmtl a\nmap_Kd skin.<UDIM>.png\n")
    corners = "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 0\nvt 2 0\nvt 1 1\n"
    faces = "f 1/1 2/2 3/3\nf 1/4 2/5 3/6\n"
    (tmp_path / "a.obj").write_text(f"mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{corners}{faces}")
    model = dp.read_model(tmp_path / "a.obj")
    assert model.texture is None
    assert model.left_out == ["the textures of 2 unit squares (UDIM)"]


def test_progress_is_told_and_what_it_raises_comes_out():
    told = []
    dp.synthesize(CELLS, 400, progress=told.append)
    assert told == sorted(told) and 0 <= told[0] and told[-1] <= 1

    def refuse(part):
        raise KeyError(part)

    with pytest.raises(KeyError):
        dp.synthesize(CELLS, 600, progress=refuse)
    with pytest.raises(KeyError):
        dp.synthesize_on(TORUS, CELLS, sites=100_000, progress=refuse)


def test_progress_is_told_while_charts_are_cut():
    told = []
    begin = time.perf_counter()
    note = lambda part: told.append((time.perf_counter() - begin, part))
    dp.synthesize_on(torus(160, 80), CELLS, sites=500, atlas={"texels": 512}, progress=note)
    whole = time.perf_counter() - begin
    # Charts take most of the time, and come first.
    first = next(at for at, part in told if part > 0)
    assert first < whole / 2
    assert [part for _, part in told] == sorted(part for _, part in told)


def test_ctrl_c_stops_a_synthesis_and_the_next_call_works():
    script = """
        import dapple_textures as dp, numpy as np, signal, time
        # A shell that runs the tests in the background lets them ignore the signal.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        example = np.random.default_rng(1).random((128, 128, 3))
        begin = time.perf_counter()
        try:
            dp.synthesize(example, 4000, progress=lambda part: print("going on", flush=True))
        except KeyboardInterrupt:
            print("stopped after", time.perf_counter() - begin)
        print(dp.synthesize(example, 16).shape)
    """
    python = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    watchdog = threading.Timer(120, python.kill)
    watchdog.start()
    assert python.stdout.readline() == "going on\n"
    python.send_signal(signal.SIGINT)
    rest = python.communicate()[0]
    watchdog.cancel()
    assert "stopped after" in rest and rest.endswith("(16, 16, 3)\n") and python.returncode == 0


def test_guides_say_where_parts_of_the_example_go():
    rows, columns = np.indices((32, 64))
    stripes = np.where(columns < 32, rows // 2 % 2, rows // 4 % 2).astype(np.float32)
    is_wide = (columns >= 32).astype(np.float32)
    wanted = np.repeat([[1.0], [0.0]], 24, axis=0) * np.ones((1, 40))
    _, sources = dp.synthesize(stripes, (48, 40), matching={"guides": [(is_wide, wanted, 3)]}, sources=True)
    assert ((sources[..., 0] >= 32) == wanted.astype(bool)).mean() > 0.95
    _, sources = dp.synthesize(dp.Exemplar(stripes, mask=is_wide), 40, sources=True)
    assert sources[..., 0].min() >= 32


@pytest.mark.parametrize("guides", [
    [(np.zeros((32, 64)), np.zeros((40, 41)), 1)],
    [(np.zeros((32, 63)), np.zeros((40, 40)), 1)],
    [(np.zeros((32, 64)), np.zeros((40, 40)), 0)],
    [(np.zeros((32, 64)), np.full((40, 40), np.nan), 1)],
])
def test_bad_guides_are_refused(guides):
    with pytest.raises(dp.DappleError):
        dp.synthesize(np.zeros((32, 64)), 40, matching={"guides": guides})
    with pytest.raises(dp.DappleError):
        dp.synthesize(dp.Exemplar(np.zeros((32, 64)), mask=np.ones((32, 65))), 40)


def test_guides_of_vertices_and_images_say_where_parts_of_the_example_go_on_a_mesh():
    columns = np.indices((32, 64))[1]
    stripes = np.where(columns < 32, 0.3, 0.7).astype(np.float32)
    is_light = (columns >= 32).astype(np.float32)
    vertices, faces = TORUS
    # Light where x is positive: a number for each vertex, and an image at texture coordinates that are x and z.
    of_vertices = (vertices[:, 0] > 0).astype(np.float32)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    mesh.uv = (vertices[faces][..., [0, 2]] + 2) / 4
    image = np.repeat([[0.0, 1.0]], 2, axis=0)
    middle = vertices[faces].mean(1)[:, 0]
    for of_mesh in (of_vertices, image):
        model = dp.synthesize_on(mesh, stripes, **{**QUICK, "matching": {"levels": 2, "guides": [(is_light, of_mesh, 3)]}})
        at = (model.uv.mean(1) * 256).astype(int)
        values = model.texture[at[:, 1], at[:, 0]]
        away = np.abs(middle) > 0.2
        assert ((values > 0.5) == (middle > 0))[away].mean() > 0.97


def test_guides_of_vertices_are_interpolated_as_sites_lie():
    # On a mesh without a repair and with one the same numbers, although the repaired one has fewer vertices.
    vertices, faces = TORUS
    twice = np.concatenate([vertices, vertices]), np.concatenate([faces[::2], faces[1::2] + len(vertices)])
    number = vertices[:, 1] * 2
    models = [
        dp.synthesize_on(mesh, wrapped(CELLS), **{**QUICK, "matching": {"levels": 2, "guides": [(HEIGHT, of_mesh, 1)]}})
        for mesh, of_mesh in [((vertices, np.concatenate([faces[::2], faces[1::2]])), number), (twice, np.tile(number, 2))]
    ]
    np.testing.assert_array_equal(models[0].texture, models[1].texture)


def test_a_model_has_the_mesh_its_layout_and_all_maps():
    np.testing.assert_allclose(MODEL.vertices, TORUS[0])
    assert MODEL.faces.shape == TORUS[1].shape and MODEL.uv.shape == (len(TORUS[1]), 3, 2)
    assert 0 <= MODEL.uv.min() and MODEL.uv.max() <= 1 and not MODEL.double_sided
    np.testing.assert_allclose(np.linalg.norm(MODEL.normals, axis=2), 1)
    assert {name: map.shape for name, map in MODEL.maps.items()} == {
        name: (256, 256, *array.shape[2:]) for name, array in MATERIAL.items()
    }
    np.testing.assert_array_equal(MODEL.texture, MODEL.maps["albedo"])
    np.testing.assert_array_equal(MODEL.maps["orm"][..., 0], MODEL.maps["height"])
    assert (MODEL.maps["normal"][..., 2] > 0).all()
    # The texture has the colors of the example: the mean at the middles of faces is that of the example.
    middle = MODEL.uv.mean(1) * 256
    colors = MODEL.texture[middle[:, 1].astype(int), middle[:, 0].astype(int)]
    np.testing.assert_allclose(colors.mean(0), CELLS.mean((0, 1)), atol=0.08)


def test_meshes_of_all_kinds_and_any_threads_give_the_same_bits(tmp_path):
    vertices, faces = TORUS
    path = tmp_path / "torus.obj"
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    before = dp.threads()
    try:
        for mesh, threads in [
            ((vertices.tolist(), faces.tolist()), 1),
            ((np.asfortranarray(vertices), faces.astype(np.uint32)[:, ::1]), 2),
            (trimesh.Trimesh(vertices, faces, process=False), 2),
        ]:
            dp.set_threads(threads)
            again = dp.synthesize_on(mesh, wrapped(MATERIAL), **QUICK, seed=5)
            np.testing.assert_array_equal(again.texture, MODEL.texture)
    finally:
        dp.set_threads(before)
    assert dp.synthesize_on(dp.read_model(path), wrapped(CHECKER), **QUICK).texture.shape == (256, 256)


def test_directions_turn_the_texture():
    stripes = np.repeat(np.sin(np.arange(32) * np.pi / 4)[:, None] * 0.5 + 0.5, 32, 1)
    square = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    options = {**QUICK, "sites": 8000, "matching": {"levels": 3}}
    stripes = wrapped(stripes)
    for directions in (dp.Directions(down=(1, 0, 0)), {"field": ([[2, 2, 0]], [[1, 0, 0]])}, ([[2, 2, 0]], [[1, 0, 0]])):
        turned = {"directions": directions}
        for model, axis in ((dp.synthesize_on(square, stripes, **options), 1), (dp.synthesize_on(square, stripes, **options, **turned), 0)):
            # Positions of the first face along both of its legs, and how the texture changes between them.
            a, b, c = model.uv[0] * 256
            x, y = np.meshgrid(np.linspace(0.05, 0.95, 100), np.linspace(0.05, 0.95, 100))
            at = a + x[..., None] * (b - a) + y[..., None] * (c - b)
            values = np.where(y < x, model.texture[at[..., 1].astype(int) % 256, at[..., 0].astype(int) % 256], np.nan)
            change = [np.nanmean(np.abs(np.diff(values, axis=axis))) for axis in (1, 0)]
            assert change[axis] > 2.5 * change[1 - axis], (turned, axis, change)


def test_appearance_is_compared_by_default_and_colors_as_in_the_paper():
    def texture(**options):
        options = {**QUICK, "matching": {"levels": 2, **options}}
        return dp.synthesize_on(TORUS, wrapped(CHECKER), **options).texture

    plain, colors = texture(), texture(space="colors")
    assert (plain == texture(space="appearance")).all()
    assert (plain != colors).any()
    assert (texture(paper=True) == texture(paper=True, space="colors")).all()


def test_a_symmetry_lets_the_texture_turn_and_has_its_colors():
    plain = dp.synthesize_on(TORUS, wrapped(CHECKER), **QUICK)
    for symmetry in (1, 2, 4):
        model = dp.synthesize_on(TORUS, wrapped(CHECKER), **QUICK, directions={"symmetry": symmetry})
        assert (model.texture != plain.texture).any() == (symmetry > 1)
        assert abs(model.texture.mean() - 0.5) < 0.05


def test_textures_in_the_plane_follow_directions_and_scales():
    stripes = np.repeat(np.sin(np.arange(32) * np.pi / 4)[:, None] * 0.5 + 0.5, 32, 1).astype(np.float32)
    one = np.zeros((60, 72), np.float32)
    options = {"matching": {"levels": 2}}
    down = dp.synthesize_along(wrapped({"a": stripes, "b": 1 - stripes}), one, **options)
    # Between pixels values are sums of sixteen in single precision, with weights of both signs.
    np.testing.assert_allclose(down["a"], 1 - down["b"], atol=1e-5)
    for texture, axis, period in [
        (down["a"], 0, 8),
        (dp.synthesize_along(wrapped(stripes), one + np.pi / 2, **options), 1, 8),
        (dp.synthesize_along(wrapped(stripes), one, one + 2, **options), 0, 16),
    ]:
        assert texture.shape == (60, 72)
        passes = [(np.diff(texture > 0.5, axis=at) != 0).mean() for at in (axis, 1 - axis)]
        assert abs(passes[0] * period / 2 - 1) < 0.2 and passes[1] < 0.3 * passes[0]


def test_features_grow_where_scales_or_directions_say():
    stripes = np.kron(np.arange(8) % 2, np.ones(4))[:, None] * np.ones(32, np.float32)
    square = SimpleNamespace(
        vertices=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2], [0, 2, 3]]),
        uv=np.array([[[0, 1], [1, 1], [1, 0]], [[0, 1], [1, 0], [0, 0]]]),
    )
    options = {"atlas": {"kind": "uv", "texels": 128}, "sites": 16000, "matching": {"levels": 2}}

    def passes(scales, field=None):
        """How often values pass a half along the columns of the left and the right half."""
        directions = {"field": field, "scales": scales}
        texture = dp.synthesize_on(square, wrapped(stripes), directions=directions, **options).texture
        passes = np.diff(texture > 0.5, axis=0) != 0
        return passes[:, 8:56].sum(), passes[:, 72:120].sum()

    left, right = passes(None)
    assert abs(left / right - 1) < 0.1
    # In the middle of the halves pixels are 1.25 and 1.75 as large.
    for scales in ([1, 2, 2, 1], np.linspace(1, 2, 64) * np.ones((4, 1))):
        wide, wider = passes(scales)
        assert abs(wide / wider / 1.4 - 1) < 0.15 and abs(left / wide / 1.25 - 1) < 0.15
    # Along rays from a point to the left rows spread in proportion to the distance from it: 0.75 and 1.25 in the middles.
    at = np.indices((11, 11)).reshape(2, -1).T / 10
    across = np.stack([at[:, 1] - 0.5, -at[:, 0] - 0.5, np.zeros(121)], 1)
    at = np.column_stack([at, np.zeros(121)])
    near, far = passes((0.25, 4), (at, across))
    assert 1.4 < near / far < 1.9
    down, right = np.indices((128, 128)) / 128
    across = np.arctan2(0.5 - down, right + 0.5)
    texture = dp.synthesize_along(wrapped(stripes), across, (0.25, 4), matching={"levels": 2})
    passes = np.diff(texture > 0.5, axis=0) != 0
    assert 1.4 < passes[:, 8:56].sum() / passes[:, 72:120].sum() < 1.9


def test_models_are_exported_and_read_back(tmp_path):
    for ending in ("glb", "obj", "ply"):
        (tmp_path / ending).mkdir()
        MODEL.export(tmp_path / ending / f"model.{ending}")
        back = dp.read_model(tmp_path / ending / f"model.{ending}")
        if ending == "ply":
            assert len(back.vertices) == 3000 and back.colors.shape == (3000, 4) and back.texture is None
            continue
        assert len(back.faces) == len(MODEL.faces)
        np.testing.assert_allclose(back.vertices[back.faces], MODEL.vertices[MODEL.faces], atol=1e-6)
        np.testing.assert_allclose(back.uv, MODEL.uv, atol=1e-6)
        np.testing.assert_array_equal(dp.srgb_from_linear(back.texture), dp.srgb_from_linear(MODEL.texture))
    names = sorted(os.listdir(tmp_path / "obj"))
    assert "model.obj" in names and "model.mtl" in names and not [name for name in names if name.startswith(".")]
    again = dp.synthesize_on(dp.read_model(tmp_path / "glb" / "model.glb"), wrapped(CELLS), **{**QUICK, "atlas": {"texels": 256, "kind": "uv"}})
    assert again.texture.shape == (256, 256, 3)


def test_a_model_far_from_zero_survives_its_export(tmp_path):
    """GLB has single precision, whose steps are 0.5 at these coordinates of UTM."""
    vertices, faces = TORUS
    far = (0.1 * vertices + [500_000, 4_649_776, 120], faces)
    model = dp.synthesize_on(far, wrapped(CELLS), **QUICK)
    model.export(tmp_path / "far.glb")
    back = dp.read_model(tmp_path / "far.glb")
    # A step of float32 at the extent of 0.28, and one of float64 at the coordinates.
    limit = 0.28 * 2.0**-23 + 4_649_776 * 2.0**-52
    np.testing.assert_allclose(back.vertices[back.faces], model.vertices[model.faces], atol=limit, rtol=0)
    np.testing.assert_allclose(np.ptp(back.vertices, axis=0), [0.28, 0.08, 0.28], atol=1e-6)
    np.testing.assert_allclose(back.uv, model.uv, atol=1e-6)
    # trimesh applies the translation of the node too.
    other = trimesh.load(tmp_path / "far.glb", force="mesh", process=False)
    np.testing.assert_allclose(other.vertices[other.faces], model.vertices[model.faces], atol=limit, rtol=0)


def test_trimesh_takes_the_model_with_its_material(tmp_path):
    mesh = MODEL.to_trimesh()
    assert mesh.faces.shape == MODEL.faces.shape and mesh.visual.uv.shape == (3 * len(MODEL.faces), 2)
    material = mesh.visual.material
    np.testing.assert_array_equal(np.asarray(material.baseColorTexture), dp.srgb_from_linear(MODEL.texture))
    assert material.normalTexture.size == (256, 256) and material.metallicRoughnessTexture is not None
    # trimesh and we agree on which way v goes: the color at the corners of faces is the same.
    at = mesh.visual.uv * [1, -1] + [0, 1]
    np.testing.assert_allclose(at, MODEL.uv.reshape(-1, 2), atol=1e-12)
    MODEL.export(tmp_path / "ours.glb")
    ours = trimesh.load(tmp_path / "ours.glb", force="mesh", process=False)
    np.testing.assert_allclose(ours.vertices[ours.faces], mesh.vertices[mesh.faces], atol=1e-6)
    np.testing.assert_allclose(ours.visual.uv[ours.faces], mesh.visual.uv[mesh.faces], atol=1e-6)
    gray = dp.synthesize_on(TORUS, wrapped(CHECKER), **QUICK).to_trimesh()
    assert np.asarray(gray.visual.material.baseColorTexture).shape == (256, 256, 3)


def test_a_report_counts_what_is_wrong():
    report = dp.mesh_report(TORUS)
    assert report["vertices"] == 288 and report["faces"] == 576 and report["components"] == 1
    assert sum(report.values()) == 288 + 576 + 1
    vertices, faces = TORUS
    broken = np.concatenate([faces[1:], faces[5:6], [[0, 0, 1]]])
    report = dp.mesh_report(trimesh.Trimesh(vertices, broken, process=False))
    assert report["duplicate_faces"] == 1 and report["degenerate_faces"] == 1 and report["boundary_edges"] >= 1


@pytest.mark.parametrize(
    "call",
    [
        lambda: dp.synthesize(CHECKER, 0),
        lambda: dp.synthesize(CHECKER, 2**16),
        lambda: dp.synthesize(CHECKER, 16, matching={"levels": 0}),
        lambda: dp.synthesize(CHECKER, 16, matching={"levels": 9}),
        lambda: dp.synthesize(CHECKER, 17, wrap=True),
        lambda: dp.synthesize(dp.Exemplar(CHECKER, edges="fold"), 16),
        lambda: dp.synthesize(CELLS, 16, matching={"coherence": "much"}),
        lambda: dp.synthesize(CELLS, 16, matching={"coherence": -1.0}),
        lambda: dp.synthesize(CELLS, 16, matching={"evenness": np.nan}),
        lambda: dp.synthesize(np.full((64, 64), np.inf), 16),
        lambda: dp.synthesize({"normal": MATERIAL["normal"]}, 16),
        lambda: dp.synthesize({"a": CELLS, "b": HEIGHT[:9]}, 16),
        lambda: dp.synthesize_on(TORUS, np.dstack([CELLS, HEIGHT])),
        lambda: dp.synthesize_on(TORUS, CELLS, sites=0),
        lambda: dp.synthesize_on(TORUS, CELLS, atlas={"texels": 2}),
        lambda: dp.synthesize_on(TORUS, CELLS, atlas={"texels": 2**30}),
        lambda: dp.synthesize_on(TORUS, CELLS, atlas={"kind": "cube"}),
        lambda: dp.synthesize_on(TORUS, CELLS, atlas={"padding": 0}),
        lambda: dp.synthesize_on(TORUS, CELLS, matching={"levels": 2, "guides": [(HEIGHT, np.zeros(287), 1)]}),
        lambda: dp.synthesize_on(TORUS, CELLS, matching={"levels": 2, "guides": [(HEIGHT[:9], np.zeros(288), 1)]}),
        lambda: dp.synthesize_on(TORUS, CELLS, matching={"levels": 2, "guides": [(HEIGHT, np.full(288, np.nan), 1)]}),
        lambda: dp.synthesize_on(TORUS, CELLS, matching={"levels": 2, "guides": [(HEIGHT, np.zeros((4, 4)), 1)]}),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"down": (0, 0, 0)}, **QUICK),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"symmetry": 3}),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"scales": np.ones(287)}),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"scales": np.zeros(288)}, **QUICK),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"scales": np.ones((4, 4))}),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"scales": (2, 1)}, **QUICK),
        lambda: dp.synthesize_on(TORUS, CELLS, directions={"scales": (1, np.nan)}, **QUICK),
        lambda: dp.synthesize_along(CELLS, np.zeros((40, 40)), (0, 1)),
        lambda: dp.synthesize_along(CELLS, np.zeros((40, 40)), np.zeros((40, 40))),
        lambda: dp.synthesize_along(CELLS, np.zeros((40, 40)), np.ones((40, 41))),
        lambda: dp.synthesize_along(CELLS, np.full((40, 40), np.nan)),
        lambda: dp.synthesize_on(TORUS, wrapped(CELLS), directions=([[0, 0, 0]], [[0, np.nan, 0]]), **QUICK),
        lambda: dp.synthesize_on(TORUS, CELLS, directions=([[0, 0, 0]], np.zeros((2, 3)))),
        lambda: dp.synthesize_on((TORUS[0], TORUS[1] + 10_000), CELLS),
        lambda: dp.synthesize_on((TORUS[0], TORUS[1] - 1), CELLS),
        lambda: dp.synthesize_on((TORUS[0], TORUS[1] + 0.5), CELLS),
        lambda: dp.synthesize_on((TORUS[0] * np.nan, TORUS[1]), CELLS),
        lambda: dp.synthesize_on((TORUS[0][:, :2], TORUS[1]), CELLS),
        lambda: dp.synthesize_on((TORUS[0], TORUS[1][:, :2]), CELLS),
        lambda: dp.synthesize_on((TORUS[0], np.zeros((0, 3), int)), CELLS),
        lambda: dp.synthesize_on("torus.obj", CELLS),
        lambda: MODEL.export("model.nothing"),
        lambda: dp.read_model("model.fbx"),
    ],
)
def test_what_cannot_be_is_refused(call):
    with pytest.raises(dp.DappleError) as error:
        call()
    assert error.value.kind


def test_scenes_and_textures_of_trimesh_are_taken():
    trimesh = pytest.importorskip("trimesh")
    example = np.random.default_rng(0).random((32, 32, 3))
    ball = trimesh.creation.icosphere(1)
    scene = trimesh.Scene([ball])
    model = dp.synthesize_on(scene, example, sites=500, atlas={"texels": 64})
    assert np.array_equal(model.vertices, dp.synthesize_on(ball, example, sites=500, atlas={"texels": 64}).vertices)
    moved = trimesh.Scene()
    moved.add_geometry(ball)
    moved.add_geometry(ball, transform=trimesh.transformations.translation_matrix([5, 0, 0]))
    assert dp.mesh_report(moved)["components"] == 2 and dp.mesh_report(moved)["faces"] == 2 * len(ball.faces)
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    uv = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    roof = trimesh.Trimesh(vertices, [[0, 1, 2], [0, 2, 3]], process=False, visual=trimesh.visual.TextureVisuals(uv=uv))
    for mesh in (roof, trimesh.Scene([roof])):
        model = dp.synthesize_on(mesh, example, sites=500, atlas={"texels": 64, "kind": "uv"})
        # v is down here, and up in trimesh.
        assert np.allclose(model.uv, (uv * [1, -1] + [0, 1])[np.array([[0, 1, 2], [0, 2, 3]])])
    with pytest.raises(dp.DappleError, match="no faces"):
        dp.mesh_report(trimesh.PointCloud(vertices))
