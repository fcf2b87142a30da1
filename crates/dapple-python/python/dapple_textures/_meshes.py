"""Meshes of files, and models for trimesh."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ._types import refusal

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


class _Plain(NamedTuple):
    """The arrays of a mesh of another program."""

    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int64]
    #: Texture coordinates of the corners of faces, (m, 3, 2), v down.
    uv: npt.NDArray[np.float64] | None


def plain(mesh: Any) -> tuple[Any, bool]:
    """Returns the arrays of a mesh or scene of trimesh or an object of Blender, and whether it is one of Blender.

    Others are returned as they are: they have the arrays as attributes, or are a pair of them.
    """
    package = type(mesh).__module__.partition(".")[0]
    if package == "trimesh":
        return _of_trimesh(mesh), False
    if package in ("bpy", "bpy_types"):
        return _of_blender(mesh), True
    return mesh, False


def _of_trimesh(mesh: Any) -> _Plain:
    parts = [part for part in mesh.dump() if hasattr(part, "faces")] if hasattr(mesh, "dump") else [mesh]
    if not parts or not all(hasattr(part, "faces") for part in parts):
        raise refusal("type", f"the {type(mesh).__name__} of trimesh has no faces")
    vertices, faces, uvs, count = [], [], [], 0
    for part in parts:
        corners = np.asarray(part.faces, np.int64)
        vertices.append(np.asarray(part.vertices, np.float64))
        faces.append(corners + count)
        uvs.append(_uv_of_trimesh(part, corners))
        count += len(part.vertices)
    known = [uv for uv in uvs if uv is not None]
    return _Plain(np.concatenate(vertices), np.concatenate(faces), np.concatenate(known) if len(known) == len(uvs) else None)


def _uv_of_trimesh(mesh: Any, faces: npt.NDArray[np.int64]) -> npt.NDArray[np.float64] | None:
    """Returns an attribute `uv` that was given to the mesh, in our form, or else what trimesh has for each vertex."""
    given = getattr(mesh, "uv", None)
    if given is not None:
        return np.asarray(given, np.float64)
    uv = getattr(mesh.visual, "uv", None)
    if uv is None or len(uv) != len(mesh.vertices):
        return None
    return np.asarray(uv, np.float64)[faces] * [1, -1] + [0, 1]


def _of_blender(thing: Any) -> _Plain:
    """Reads a mesh, or an object with its modifiers at its place in the scene; the vertical axis stays z."""
    import bpy

    owner = None
    if isinstance(thing, bpy.types.Object):
        owner = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        try:
            mesh = owner.to_mesh()
        except RuntimeError as error:
            raise refusal("type", f"the object `{thing.name}` of Blender has no mesh: {error}") from error
    elif isinstance(thing, bpy.types.Mesh):
        mesh = thing
    else:
        raise refusal("type", f"an Object or a Mesh of Blender is needed, and not {type(thing).__name__}")
    try:
        return _arrays_of_blender(mesh, np.eye(4) if owner is None else np.array(owner.matrix_world))
    finally:
        if owner is not None:
            owner.to_mesh_clear()


def _arrays_of_blender(mesh: Any, matrix: npt.NDArray[np.float64]) -> _Plain:
    def read(things: Any, name: str, shape: tuple[int, ...], dtype: Any) -> Any:
        values = np.empty(len(things) * math.prod(shape), dtype)
        things.foreach_get(name, values)
        return values.reshape(-1, *shape)

    mesh.calc_loop_triangles()
    vertices = read(mesh.vertices, "co", (3,), np.float32).astype(np.float64)
    vertices = vertices @ matrix[:3, :3].T + matrix[:3, 3]
    faces = read(mesh.loop_triangles, "vertices", (3,), np.int32).astype(np.int64)
    uv = None
    if mesh.uv_layers.active is not None:
        loops = read(mesh.loop_triangles, "loops", (3,), np.int32)
        uv = read(mesh.uv_layers.active.data, "uv", (2,), np.float32)[loops] * [1.0, -1.0] + [0.0, 1.0]
    if np.linalg.det(matrix[:3, :3]) < 0:
        # A mirrored object reverses its faces, so reverse the order of their corners.
        faces, uv = faces[:, ::-1], None if uv is None else uv[:, ::-1]
    return _Plain(vertices, faces, uv)


def to_trimesh(model: Model) -> Any:
    """Returns the model as a ``trimesh.Trimesh`` with one vertex per corner of a face."""
    import io

    import trimesh
    from PIL import Image

    from . import _native

    def image(name: str, content: Literal["color", "normal", "data"]) -> Any:
        pixels = maps[name]
        if content == "color" and pixels.ndim == 2:
            # Write gray values without sRGB encoding.
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
