"""Recipes: data in, maps out."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import dapple_textures as dp

DATA = {
    "dapple": 1,
    "seed": 7,
    "extent": [8, 8],
    "nodes": {
        "joint": {"worley": {"value": "f2_minus_f1"}},
        "stones": {"levels": {"input": "joint", "from": [0.04, 0.4]}},
    },
    "material": {"height": "stones", "relief": 0.3, "albedo": "#886644"},
}


def changed(**changes):
    return {**DATA, **changes}


def test_a_recipe_is_the_same_from_data_and_from_text():
    recipe = dp.Recipe(DATA)
    assert recipe == dp.Recipe.from_toml(recipe.to_toml()) == dp.Recipe.from_json(recipe.to_json())
    assert dp.Recipe(recipe.to_dict()) == recipe
    assert (recipe.seed, recipe.extent, recipe.image_files) == (7, (8.0, 8.0), [])
    other = recipe.with_seed(np.uint64(2**63))
    assert other.seed == 2**63 and other != recipe and other.hash != recipe.hash
    numbers = changed(extent=np.array([8.0, 8.0]), seed=np.int64(7))
    assert dp.Recipe(numbers) == recipe


def test_parameters_are_read_and_replaced_by_name():
    text = "dapple = 1\n[parameters]\nsize = { value = 8, range = [1, 64] }\nlow = [0.25, 0.5]\n"
    text += "[nodes.cells.worley]\nfrequency = \"$size\"\n[nodes.a.levels]\ninput = \"cells\"\nfrom = \"$low\"\n"
    recipe = dp.Recipe.from_toml(text + "[material]\nheight = \"a\"\n")
    assert recipe.parameters == {"size": 8, "low": [0.25, 0.5]}
    other = recipe.with_parameters(size=np.int64(16), low=(0.0, 1.0))
    assert other.parameters == {"size": 16, "low": [0.0, 1.0]} and recipe.parameters["size"] == 8
    assert other.to_dict()["nodes"]["cells"]["worley"]["frequency"] == "$size"
    assert recipe.with_parameters() == recipe
    assert dp.Recipe.builtin("rock").parameters == {}
    with pytest.raises(dp.DappleError, match="from 1 to 64"):
        recipe.with_parameters(size=99)


@pytest.mark.parametrize("name", dp.Recipe.builtin_names())
def test_all_maps_of_the_builtin_recipes_in_windows(name):
    plan = dp.Recipe.builtin(name).plan()
    whole = plan.bake((64, 96), dp.map_names())
    part = plan.bake((64, 96), dp.map_names(), window=np.s_[10:31, 50:96])
    assert list(whole) == dp.map_names() == list(plan.map_info)
    for kind, info in plan.map_info.items():
        assert whole[kind].shape == ((64, 96, 3) if info.channels == 3 else (64, 96))
        assert np.isfinite(whole[kind]).all()
        assert np.array_equal(part[kind], whole[kind][10:31, 50:96])
    lengths = np.linalg.norm(whole["normal"], axis=-1)
    # Each part is rounded to 24 bits.
    assert np.abs(lengths - 1).max() < 1e-6
    assert np.array_equal(whole["orm"][..., 0], whole["ao"])


def test_a_large_bake_is_joined_from_bands():
    plan = dp.Recipe(DATA).plan()
    tall = plan.bake((3000, 700), ["height", "albedo"])
    for rows in (slice(0, 10), slice(1490, 1510), slice(2990, 3000)):
        part = plan.bake((3000, 700), ["height", "albedo"], window=(rows, slice(0, 700)))
        assert all(np.array_equal(part[kind], tall[kind][rows]) for kind in tall)


def test_the_height_is_a_field():
    plan = dp.Recipe(DATA).plan()
    maps = plan.bake(128, ["height"])
    assert np.array_equal(plan.field().render(128, extent=8), maps["height"])
    assert np.array_equal(plan.field("stones").render(128, extent=8), maps["height"])
    with pytest.raises(dp.DappleError) as caught:
        plan.field("stnes")
    assert (caught.value.kind, caught.value.hint) == ("unknown_node", "stones")


def test_images_are_arrays():
    data = changed(nodes={"photo": {"image": {"file": "photo.png"}}}, material={"albedo": "photo"}, extent=[1, 1])
    colors = np.random.default_rng(3).random((32, 32, 3)).astype(np.float32)
    albedo = dp.Recipe(data).plan(images={"photo.png": colors}).bake(32, ["albedo"])["albedo"]
    assert np.array_equal(albedo, colors)
    turned = dp.Recipe(data).plan(images={"photo.png": colors.transpose(1, 0, 2)}).bake(32, ["albedo"])
    assert np.array_equal(turned["albedo"], colors.transpose(1, 0, 2))
    with pytest.raises(dp.DappleError) as caught:
        dp.Recipe(data).plan()
    assert (caught.value.kind, caught.value.node) == ("no_image", "photo")
    with pytest.raises(dp.DappleError, match="channels"):
        dp.Recipe(data).plan(images={"photo.png": np.zeros((4, 4, 5), np.float32)})
    with pytest.raises(dp.DappleError, match="no images"):
        dp.Recipe(data).plan(images={"photo.png": colors}).field("photo")


def test_images_are_no_codes_and_are_named_by_the_recipe():
    nodes = {"photo": {"image": {"file": "photo.png"}}}
    recipe = dp.Recipe(changed(nodes=nodes, material={"albedo": "photo"}))
    colors = np.full((4, 4, 3), 0.25, np.float32)
    for dtype in (np.uint8, np.uint16, np.int64, np.complex64):
        with pytest.raises(dp.DappleError, match="`photo.png` is an array of") as caught:
            recipe.plan(images={"photo.png": colors.astype(dtype)})
        assert caught.value.kind == "type"
    assert recipe.plan(images={"photo.png": colors.tolist()}) == recipe.plan(images={"photo.png": colors})
    for axes in [(4,), (4, 4, 2), (4, 4, 4), (4, 4, 3, 1)]:
        with pytest.raises(dp.DappleError, match="`photo.png` has"):
            recipe.plan(images={"photo.png": np.zeros(axes)})
    with pytest.raises(dp.DappleError, match="did you mean `photo.png`") as caught:
        recipe.plan(images={"photo.png": colors, "foto.png": colors})
    assert (caught.value.kind, caught.value.hint) == ("unknown_image", "photo.png")
    with pytest.raises(dp.DappleError, match="no images") as caught:
        dp.Recipe(DATA).plan(images={"photo.png": colors})
    assert caught.value.hint is None


def test_time_goes_round():
    nodes = {"a": {"worley": {"motion": {"cells": 2}}}}
    recipe = dp.Recipe(changed(nodes=nodes, material={"height": "a"}))
    first, quarter, last = (recipe.plan(time=time).bake(64)["height"] for time in (0.0, 0.25, 1.0))
    assert np.array_equal(first, last)
    assert not np.array_equal(first, quarter)


def test_samples_on_corners_reach_the_sides_and_meet():
    plan = dp.Recipe(DATA).plan()
    whole = plan.bake((33, 65), ["height", "normal"], samples="corners")
    for values in whole.values():
        assert np.array_equal(values[0], values[-1])
        assert np.array_equal(values[:, 0], values[:, -1])
    part = plan.bake((33, 65), window=np.s_[16:33, 32:65], samples="corners")
    assert np.array_equal(part["height"], whole["height"][16:, 32:])
    assert np.array_equal(plan.bake(64, samples="centers")["height"], plan.bake(64)["height"])
    with pytest.raises(dp.DappleError, match="corners"):
        plan.bake((1, 5), samples="corners")
    with pytest.raises(dp.DappleError, match="centers"):
        plan.bake(8, samples="center")


def test_a_dataset_on_corners_has_their_coordinates():
    pytest.importorskip("xarray")
    plan = dp.Recipe(DATA).plan()
    side = plan.bake(8, as_xarray=True).x.values[0] * 16
    part = plan.bake(9, window=np.s_[0:9, 4:9], samples="corners", as_xarray=True)
    # A step is an eighth of the side.
    assert np.allclose(part.x.values, side * np.arange(4, 9) / 8, rtol=1e-15)


def test_a_dataset_has_the_coordinates_of_its_pixels():
    pytest.importorskip("xarray")
    plan = dp.Recipe(DATA).plan()
    whole = plan.bake(64, ["height", "normal"], as_xarray=True)
    part = plan.bake(64, ["height", "normal"], window=np.s_[8:16, 4:32], as_xarray=True)
    assert whole.normal.dims == ("y", "x", "channel")
    assert whole.x.values[0] == 8 / 128
    assert part.equals(whole.isel(y=slice(8, 16), x=slice(4, 32)))


@pytest.mark.parametrize(
    ("data", "kind", "node", "words"),
    [
        (changed(dapple=99), "schema", None, "99"),
        (changed(nodes={"a": {"wurley": {}}}), "text", None, "did you mean `worley`"),
        (changed(nodes={"a": {"worley": {"value": "f9"}}}), "text", None, 'at `"value": "f9"`'),
        (changed(nodes={"a": {"worley": {"frequency": -1}}}), "range", "a", "frequency"),
        (changed(material={"height": "none"}), "unknown_node", "material", "none"),
        (changed(nodes={"a": {"add": {"first": "a", "second": 1}}}), "text", None, "at `"),
        (changed(nodes={"a": {"mix": {"from": "a", "to": 1, "by": 0.5}}}), "cycle", None, "a"),
    ],
)
def test_mistakes_name_their_place(data, kind, node, words):
    with pytest.raises(dp.DappleError) as caught:
        dp.Recipe(data).plan()
    assert (caught.value.kind, caught.value.node) == (kind, node), caught.value
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "data", [None, 7, "dapple = 1", [1], {1: 2}, changed(nodes={"a": {"worley": object()}}), changed(seed=float("inf"))]
)
def test_what_is_no_recipe_is_refused(data):
    with pytest.raises((dp.DappleError, TypeError)):
        dp.Recipe(data)


def test_data_without_an_end_is_refused():
    data = changed()
    data["nodes"] = data
    with pytest.raises(dp.DappleError, match="nested"):
        dp.Recipe(data)


def test_a_bake_is_refused_before_it_begins():
    plan = dp.Recipe(DATA).plan()
    for arguments, words in [
        ((64, ["hieght"]), "one of height"),
        ((0,), "at least 1"),
        (((1, 2, 3),), "2 numbers"),
    ]:
        with pytest.raises(dp.DappleError, match=words):
            plan.bake(*arguments)
    with pytest.raises(dp.DappleError, match="region"):
        plan.bake(64, window=np.s_[0:65, 0:3])
    with pytest.raises(dp.DappleError, match="before the picture"):
        plan.bake(64, window=np.s_[-1:5, 0:3])
    whole = dp.Recipe.builtin("stone-and-grass").plan()
    assert not whole.is_local and plan.is_local
    with pytest.raises(dp.DappleError) as caught:
        whole.check_local()
    assert caught.value.kind == "global" and "image" in caught.value.hint


def test_maps_are_a_word_or_several_once():
    plan = dp.Recipe(DATA).plan()
    assert list(plan.bake(16)) == list(plan.bake(16, "height")) == ["height"]
    assert list(plan.bake(16, (name for name in ["orm", "ao"]))) == ["orm", "ao"]
    for maps, words in [([], "at least one"), (["ao", "height", "ao"], "`ao` is asked for twice")]:
        for as_xarray in (False, True):
            with pytest.raises(dp.DappleError, match=words) as caught:
                plan.bake(16, maps, as_xarray=as_xarray)
            assert caught.value.kind == "maps"
    for maps in (7, [7]):
        with pytest.raises(TypeError):
            plan.bake(16, maps)


def test_maps_are_written_as_what_they_are(tmp_path):
    plan = dp.Recipe(DATA).plan()
    maps = plan.bake(32, dp.map_names())
    paths = dp.write_maps(tmp_path / "a" / "b", maps, name="stones", depth=16)
    assert [path.name for path in paths] == [f"stones_{name}.png" for name in maps]
    assert [path.name for path in dp.write_maps(tmp_path, maps, format="npy")] == [f"{name}.npy" for name in maps]
    for path, (name, values) in zip(paths, maps.items(), strict=True):
        content = plan.map_info[name].content
        read = dp.read_image(path, content=content)
        assert read.shape == values.shape
        # Codes of 16 bits; colors are sRGB, whose steps are at most 2.3 times as long in linear light.
        assert np.abs(read - np.clip(values, -1 if name == "normal" else 0, 1)).max() < 4e-5
        again = dp.encode_image(values, content=content, depth=16)
        assert path.read_bytes() == again
    assert (maps["normal"][..., :2] < 0).any()
    for name in ("../stones", "a/b"):
        with pytest.raises(dp.DappleError, match="no name of a file"):
            dp.write_maps(tmp_path / "c", maps, name=name)
    assert not (tmp_path / "c").exists()
    with pytest.raises(dp.DappleError, match="gif"):
        dp.write_maps(tmp_path, maps, format="gif")


def test_shards_cover_every_pixel_once():
    shards = dp.shards((100, 70), (32, 64))
    assert shards.grid == (4, 2) and len(shards) == 8
    covered = np.zeros((100, 70), int)
    for (row, column), (rows, columns) in shards:
        covered[row : row + rows, column : column + columns] += 1
    assert (covered == 1).all()
    copy = pickle.loads(pickle.dumps(shards))
    assert copy == shards and hash(copy) == hash(shards) and list(copy) == list(shards)
    assert shards != dp.shards((100, 70), (32, 32))
    assert shards[-1] == shards[7] == ((96, 64), (4, 6))
    for index in (8, -9):
        with pytest.raises(IndexError):
            shards[index]
    assert len(dp.shards(2_000_000, 64)) == 31250**2


def test_a_shader_names_the_nodes_that_are_read_from_textures():
    local = dp.Recipe(DATA).wgsl()
    assert "fn material(place: Place2d, zero: u32) -> Material" in local.wgsl
    assert (local.textures, local.data.shape, local.data.dtype) == ([], (0, 1024, 4), np.uint32)
    nodes = {
        **DATA["nodes"],
        "swell": {"wavelet": {}},
        "bumps": {"worley": {"value": "f4"}},
        "photo": {"image": {"file": "a.png"}},
        "sum": {"add": ["stones", "swell", "bumps", "photo"]},
    }
    recipe = dp.Recipe(changed(nodes=nodes, material={"height": "sum"}))
    images = {"a.png": np.zeros((4, 4), np.float32)}
    with pytest.raises(dp.DappleError, match="the distances F3 and F4 have no shader") as refused:
        recipe.wgsl(images=images)
    assert refused.value.kind == "not_in_shader"
    with pytest.raises(dp.DappleError, match="a.png"):
        recipe.wgsl(textures=True)
    shader = recipe.wgsl(images=images, textures=True)
    assert sorted(shader.textures) == ["bumps", "photo"]
    assert shader.data.shape[0] > 0 and shader.data.any()
