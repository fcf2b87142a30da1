"""Recipes and their images from files, as the command reads them."""

from __future__ import annotations

import os
import shutil
import subprocess

import numpy as np
import pytest

import dapple_textures as dp

COMMAND = os.environ.get("DAPPLE") or shutil.which("dapple")


def test_a_recipe_is_read_by_its_ending_or_name(tmp_path):
    rock = dp.Recipe.builtin("rock").with_seed(3)
    (tmp_path / "a.toml").write_text(rock.to_toml())
    (tmp_path / "a.JSON").write_text(rock.to_json())
    assert dp.read_recipe(tmp_path / "a.toml") == dp.read_recipe(str(tmp_path / "a.JSON")) == rock
    assert dp.read_recipe("rock") == dp.Recipe.builtin("rock")
    (tmp_path / "mine.toml").write_text('dapple = 1\n[nodes.a.worley]\n[material]\nheight = "a"\n')
    assert dp.read_recipe(tmp_path / "mine.toml").name == "mine"


def test_what_is_no_recipe_is_refused_with_what_was_meant(tmp_path):
    with pytest.raises(dp.DappleError, match="did you mean `rock`"):
        dp.read_recipe("rcok")
    with pytest.raises(FileNotFoundError):
        dp.read_recipe(tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_text("dapple = ")
    with pytest.raises(dp.DappleError):
        dp.read_recipe(tmp_path / "bad.toml")


COLORS = np.random.default_rng(5).integers(0, 256, (16, 16, 4), dtype=np.uint8)


def recipe(folder, image, *alphas):
    """A recipe with an image node for each alpha."""
    from PIL import Image

    Image.fromarray(image, "LA" if image.shape[2] == 2 else None).save(folder / "a.png")
    nodes = [f'[nodes.n{at}.image]\nfile = "a.png"\n{alpha}\n' for at, alpha in enumerate(alphas)]
    path = folder / "mine.toml"
    path.write_text("dapple = 1\n" + "".join(nodes) + '[material]\nalbedo = "n0"\n')
    return dp.read_recipe(path)


@pytest.mark.filterwarnings("ignore::DeprecationWarning:PIL")
@pytest.mark.parametrize("n_channels", [2, 4])
@pytest.mark.parametrize("alpha", ["drop", "over:#804020"])
def test_alpha_is_used_as_the_command_does(tmp_path, n_channels, alpha):
    image = COLORS[..., -n_channels:]
    mine = recipe(tmp_path, image, f'alpha = "{alpha}"')
    images = dp.read_recipe_images(mine, tmp_path)
    if alpha != "drop":
        wanted = dp.read_image(tmp_path / "a.png", alpha=alpha)
    elif n_channels == 2:
        wanted = image[..., 0] / np.float32(255)
    else:
        wanted = dp.linear_from_srgb(image[..., :3])
    assert np.array_equal(images["a.png"], wanted)
    albedo = mine.plan(images=images).bake(32, ["albedo"])["albedo"]
    if COMMAND is not None:
        bake = [COMMAND, "bake", tmp_path / "mine.toml", "--size", "32", "--maps", "albedo", "-o", tmp_path / "out.png", "-q"]
        subprocess.run(bake, check=True)
        assert (tmp_path / "out.png").read_bytes() == dp.encode_image(albedo, content="color", depth=16)


def test_what_is_transparent_is_refused_with_the_way_out(tmp_path):
    with pytest.raises(dp.DappleError, match='alpha = "drop"'):
        dp.read_recipe_images(recipe(tmp_path, COLORS, ""), tmp_path)
    with pytest.raises(dp.DappleError, match="nodes that name one image say the same"):
        dp.read_recipe_images(recipe(tmp_path, COLORS, 'alpha = "drop"', ""), tmp_path)
    with pytest.raises((OSError, dp.DappleError)):
        dp.read_recipe_images(recipe(tmp_path, COLORS, 'alpha = "drop"'), tmp_path / "elsewhere")
