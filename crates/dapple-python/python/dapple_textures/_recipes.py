"""Reads recipes and their images from files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from ._native import Recipe, read_image
from ._types import refusal

if TYPE_CHECKING:
    import numpy.typing as npt
    from pathlib import Path

_Path = str | os.PathLike[str]


def read_recipe(path_or_name: _Path) -> Recipe:
    """Reads a recipe from a file, or returns the built-in recipe of this name.

    Parameters
    ----------
    path_or_name : str or os.PathLike
        A file in TOML, or in JSON if its name ends with `.json`. If no such file exists, it is a name from
        `Recipe.builtin_names()`. A recipe without a name gets the name of its file.

    Returns
    -------
    Recipe
        The recipe.

    Raises
    ------
    DappleError
        If the text is no recipe. The message names line and column, or `node` the node.

    Examples
    --------
    >>> import os, tempfile, dapple_textures as dp
    >>> path = os.path.join(tempfile.mkdtemp(), "mine.toml")
    >>> with open(path, "w") as file:
    ...     _ = file.write(dp.read_recipe("rock").with_seed(9).to_toml())
    >>> dp.read_recipe(path).seed
    9
    """
    # Imported here, since it takes longer to import than the rest of the package.
    from pathlib import Path

    path = Path(path_or_name)
    name = os.fspath(path_or_name).replace("_", "-")
    is_path = path.suffix != "" or len(path.parts) > 1
    if not path.is_file() and (name in Recipe.builtin_names() or not is_path):
        # For an unknown name, the error suggests a similar one.
        return Recipe.builtin(name)
    text = path.read_text(encoding="utf-8")
    recipe = Recipe.from_json(text) if path.suffix.lower() == ".json" else Recipe.from_toml(text)
    return recipe if recipe.name else Recipe({**recipe.to_dict(), "name": path.stem})


def read_recipe_images(recipe: Recipe, folder: _Path) -> dict[str | tuple[str, str], npt.NDArray[np.float32]]:
    """Reads the images that a recipe names from files in a folder, in the form that `Recipe.plan` takes.

    If a node names the layer of its image, or says how to treat its alpha, that layer is read and converted accordingly.
    Without a treatment of alpha, an image that is partly transparent is refused, as by the command `dapple`.

    Parameters
    ----------
    recipe : Recipe
        The recipe.
    folder : str or os.PathLike
        The folder of the files, in which their paths begin.

    Returns
    -------
    dict of numpy.ndarray of float32
        The images by the names of their files; by name and layer where nodes read several layers of a file.

    Raises
    ------
    DappleError
        If an image is partly transparent, has numbers that are not finite, or is not an image.
    OSError
        If a file cannot be read: `FileNotFoundError` if it does not exist.

    Examples
    --------
    >>> import dapple_textures as dp, numpy as np, tempfile
    >>> folder = tempfile.mkdtemp()
    >>> dp.write_image(folder + "/moss.png", np.full((8, 8, 4), 0.5, np.float32))
    >>> recipe = dp.Recipe({"dapple": 1, "nodes": {"moss": {"image": {"file": "moss.png", "alpha": "drop"}}},
    ...                     "material": {"albedo": "moss"}})
    >>> {name: image.shape for name, image in dp.read_recipe_images(recipe, folder).items()}
    {'moss.png': (8, 8, 3)}
    """
    from pathlib import Path

    sources = recipe._image_sources()
    files = [file for file, _, _ in sources]
    images: dict[str | tuple[str, str], npt.NDArray[np.float32]] = {}
    for file, layer, alpha in sources:
        key = file if layer is None or files.count(file) == 1 else (file, layer)
        images[key] = _image(Path(folder) / file, alpha, layer)
    return images


def _image(path: Path, alpha: str | None, layer: str | None) -> npt.NDArray[np.float32]:
    image = read_image(path, alpha=alpha, layer=layer)
    finite = np.isfinite(image)
    if not finite.all():
        row, column = np.argwhere(~finite)[0][:2]
        raise refusal("not_finite", f"{path}: a number in column {column} and row {row} is not finite")
    if image.ndim == 3 and image.shape[2] == 4:
        hint = 'give its node alpha = "drop" or alpha = "over:#rrggbb"'
        raise refusal("alpha", f"{path} is partly transparent, which is not possible here", hint)
    if alpha == "drop" and image.ndim == 3:
        # A gray image with alpha is data. For OpenEXR, whose values are multiplied by alpha, take the values of
        # `image`, which are divided by it. For other formats, take the codes without sRGB decoding.
        channels = read_image(path, content="data", layer=layer)
        if channels.ndim == 3 and channels.shape[2] == 2:
            with path.open("rb") as file:
                is_openexr = file.read(4) == b"v/1\x01"
            return (image if is_openexr else channels)[..., 0].copy()
    return image
