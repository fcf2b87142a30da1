"""Meshes of files, and models for trimesh."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt
    from ._native import Model


class MeshFile(NamedTuple):
    """The contents of a mesh file; a part that the file lacks is None."""

    #: Positions of the vertices, (n, 3).
    vertices: npt.NDArray[np.float64]
    #: The vertices of each face, (m, 3).
    faces: npt.NDArray[np.int64]
    #: Texture coordinates of the corners of faces, (m, 3, 2), v down.
    uv: npt.NDArray[np.float64] | None
    #: Normals of the corners of faces, (m, 3, 3).
    normals: npt.NDArray[np.float64] | None
    #: Linear colors of the vertices with alpha, (n, 4).
    colors: npt.NDArray[np.float32] | None
    #: The image of the base color, linear.
    texture: npt.NDArray[np.float32] | None
    #: Descriptions of the parts of the file that were not read.
    left_out: list[str]


def to_trimesh(model: Model) -> Any:
    """Returns the model as a ``trimesh.Trimesh`` with one vertex per corner of a face."""
    import io

    import trimesh
    from PIL import Image

    from . import _native

    def image(name: str, content: Literal["color", "normal", "data"]) -> Any:
        pixels = maps[name]
        if content == "color" and pixels.ndim == 2:
            # Plain numbers are written without the curve of colors.
            pixels, content = np.stack([pixels] * 3, 2), "data"
        return Image.open(io.BytesIO(_native.encode_image(pixels, "png", content=content, depth=8)))

    # trimesh has no types.
    visual: Any = trimesh.visual
    maps = model.maps
    textures = {"baseColorTexture": image(next(iter(maps)), "color")}
    if "normal" in maps:
        textures["normalTexture"] = image("normal", "normal")
    if "orm" in maps:
        textures["metallicRoughnessTexture"] = textures["occlusionTexture"] = image("orm", "data")
    material = visual.material.PBRMaterial(**textures, doubleSided=model.double_sided)
    corners = model.faces.reshape(-1)
    uv = model.uv.reshape(-1, 2) * [1, -1] + [0, 1]
    return trimesh.Trimesh(
        vertices=model.vertices[corners],
        faces=np.arange(len(corners)).reshape(-1, 3),
        vertex_normals=model.normals.reshape(-1, 3),
        visual=visual.TextureVisuals(uv=uv, material=material),
        process=False,
    )
