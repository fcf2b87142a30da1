"""Errors are Python's own where a file is at fault, and speak the language of the documentation."""

from __future__ import annotations

import errno

import numpy as np
import pytest

import dapple_textures as dp


@pytest.mark.parametrize("read", [dp.read_image, dp.read_model, dp.read_recipe], ids=lambda read: read.__name__)
def test_a_missing_file_is_a_file_not_found_error(read, tmp_path):
    path = tmp_path / "missing.obj"
    with pytest.raises(FileNotFoundError) as caught:
        read(path)
    assert caught.value.errno == errno.ENOENT and str(path) in str(caught.value)


@pytest.mark.parametrize("read", [dp.read_image, dp.read_model, dp.read_recipe], ids=lambda read: read.__name__)
def test_a_folder_is_an_os_error(read, tmp_path):
    (tmp_path / "folder.obj").mkdir()
    # Windows says that access is denied.
    with pytest.raises((IsADirectoryError, PermissionError)):
        read(tmp_path / "folder.obj")


def test_images_of_recipes_and_written_files(tmp_path):
    recipe = dp.Recipe({"dapple": 1, "nodes": {"a": {"image": {"file": "a.png"}}}, "material": {"height": "a"}})
    with pytest.raises(FileNotFoundError):
        dp.read_recipe_images(recipe, tmp_path)
    with pytest.raises(FileNotFoundError):
        dp.write_image(tmp_path / "nowhere/a.png", np.zeros((2, 2)))
    (tmp_path / "file").touch()
    with pytest.raises(OSError):
        dp.write_maps(tmp_path / "file/maps", {"height": np.zeros((2, 2))})
    model = dp.synthesize_on(ROOF, np.eye(16), atlas={"texels": 16}, sites=50, matching={"levels": 1})
    with pytest.raises(FileNotFoundError):
        model.export(tmp_path / "nowhere/a.glb")


ROOF = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])


@pytest.mark.parametrize(
    ("call", "message", "hint"),
    [
        (lambda: dp.worley(octaves=4), "octaves: found the number `4`, expected a table", None),
        (lambda: dp.worley(octaves={"count": 4, "gian": 0.5}), "`gian`", "gain"),
        (lambda: dp.worley(octaves={"count": "four"}), 'found the text "four"', None),
        (lambda: dp.worley(octaves=[4]), "found a list, expected a table", None),
        (lambda: dp.worley(scatter="jittered"), "`jittered` is written with options: a table with the one key", None),
        (lambda: dp.worley(metric="minkowski"), "`minkowski` is written with a value", None),
        (lambda: dp.worley(metric="euclidian"), "metric: `euclidian` is not one of `euclidean`", "euclidean"),
        (lambda: dp.worley(octaves={"cout": 4}), "octaves: `cout` is not one of `count`", "count"),
        (lambda: dp.worley(value="cel_value"), "cel_value", None),
        (lambda: dp.gradient_noise(octaves=2, shape="ridge"), "the shape is `ridge`", "ridged"),
        (lambda: dp.make_tile(np.eye(64), method="poison"), "poison", None),
        (lambda: dp.Recipe.builtin("flagstone").plan().bake(8, "heigth"), "the map is `heigth`", "height"),
        (lambda: dp.worley(seed=-1), "the seed is -1", None),
        (lambda: dp.Recipe.reference("worly"), "the node is `worly`", "worley"),
    ],
)
def test_messages_have_no_words_of_the_implementation(call, message, hint):
    with pytest.raises(dp.DappleError) as caught:
        call()
    text = str(caught.value)
    assert message in text
    assert not any(word in text for word in ("struct", "newtype", "tuple", "invalid type", "variant", "unknown field", "os error"))
    assert hint is None or (caught.value.hint == hint and f"did you mean `{hint}`?" in text)


def test_cell_values_are_normalized_as_they_are():
    cells = dp.worley(seed=1, value="cell_value")
    assert cells.normalized() == cells
    with pytest.raises(dp.DappleError, match="cannot be normalized"):
        dp.worley(value="edge_distance").normalized()


def test_recipes_have_a_reference_and_a_schema():
    reference = dp.Recipe.reference()
    section = dp.Recipe.reference("worley")
    assert section in reference and section.startswith("### `worley`") and "`frequency`" in section
    assert "### `pups`" not in section
    assert "properties" in dp.Recipe.schema()
