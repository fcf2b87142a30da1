"""Materials in Blender: the maps of a recipe as a Principled material, and synthesized models with their textures.

It runs in Blender's own Python (4.2 and newer), or with the module `bpy`. Colors are sRGB images, all other maps are
"Non-Color". Images are packed into the Blender file, so that the file is complete on its own. The extension in the folder
`blender` of the sources offers these functions in a panel.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Sequence
from operator import index
from pathlib import Path
from typing import Any, Literal, TypeAlias

import numpy as np

from ._native import Plan, Recipe, _plan_from_parts, encode_image
from ._types import refusal

#: The property of a material that records its recipe and options.
_PROPERTY = "dapple_textures"

_Depth: TypeAlias = Literal[8, 16]
_Content: TypeAlias = Literal["gray", "color", "normal", "data"]

#: The maps of a material: bit depth of the PNG, kind of content, and Blender's name of the color space.
_IMAGES: dict[str, tuple[_Depth, _Content, str]] = {
    "albedo": (8, "color", "sRGB"),
    "orm": (8, "data", "Non-Color"),
    "normal": (16, "normal", "Non-Color"),
    "height": (16, "gray", "Non-Color"),
    "emission": (8, "color", "sRGB"),
    "opacity": (16, "gray", "Non-Color"),
    "specular": (16, "gray", "Non-Color"),
    "clearcoat": (16, "gray", "Non-Color"),
}

#: The maps that only some materials have.
_OPTIONAL = ("emission", "opacity", "specular", "clearcoat")

#: The node group that Blender's glTF exporter reads. Occlusion goes only there, so that it never darkens the albedo.
_GLTF_GROUP = "glTF Material Output"


def material(
    what: Plan | Recipe,
    size: int | tuple[int, int] = 1024,
    *,
    name: str | None = None,
    displacement: bool = False,
    scale: float = 1.0,
) -> Any:
    """Makes a material whose maps are baked from a recipe: albedo, roughness, metallic, occlusion, normals.

    If this function made a material of the same name before, that material is baked again, and all its objects show the
    new maps. Other materials and images stay as they are; Blender adds a number to the new name if it is taken.

    Parameters
    ----------
    what : Plan or Recipe
        A recipe, or a plan with its images and its time.
    size : int or tuple of int, default 1024
        Pixels of the tile, (rows, columns) or one number.
    name : str or None, default None
        The name of the material; by default the name of the recipe.
    displacement : bool, default False
        Whether to displace the surface by the height as well (Cycles with adaptive subdivision, or EEVEE). The tile is
        assumed to be as wide as the recipe's extent, in Blender's units.
    scale : float, default 1.0
        The number of copies of the tile across the UV map.

    Returns
    -------
    object
        The material of Blender, a `bpy.types.Material`, which has the name of the recipe by default.

    Raises
    ------
    DappleError
        If the recipe cannot be planned or baked at this size, or Blender reads an image with another size.
    """
    import bpy

    name = name or (what if isinstance(what, Recipe) else what.recipe).name or "dapple"
    made = next((found for found in bpy.data.materials if _data_of(found).get("name") == name), None)
    if made is not None:
        bake_into(made, what, size, displacement=displacement, scale=scale)
        return made
    made = bpy.data.materials.new(name)
    try:
        bake_into(made, what, size, displacement=displacement, scale=scale)
    except Exception:
        bpy.data.materials.remove(made)
        raise
    made[_PROPERTY] = json.dumps({**_data_of(made), "name": name})
    return made


def bake_into(
    made: Any,
    what: Plan | Recipe,
    size: int | tuple[int, int] = 1024,
    *,
    displacement: bool = False,
    scale: float = 1.0,
) -> None:
    """Bakes a recipe into an existing material and replaces all of its nodes. See `material` for the parameters."""
    import bpy

    plan = _opengl(what.plan() if isinstance(what, Recipe) else what)
    sides = [index(side) for side in size] if isinstance(size, Sequence) else index(size)
    values = plan.recipe.to_dict()["material"]
    maps = ["albedo", "orm", "normal", *(["height"] if displacement else [])]
    maps += [kind for kind in _OPTIONAL if values.get(kind) is not None]
    baked = plan.bake(size, maps)
    low, high = 0.0, 1.0
    if displacement:
        # Store heights from 0 to 1; the displacement node scales them to the original range.
        low, high = min(low, float(baked["height"].min())), max(high, float(baked["height"].max()))
        baked["height"] = (baked["height"] - np.float32(low)) / np.float32(high - low)
    before = _images_of(made)
    images = {kind: _image(bpy, kind, pixels, *_IMAGES[kind]) for kind, pixels in baked.items()}
    relief = float(values.get("relief", 0.1))
    _shader(bpy, made, images, relief * (high - low), (0.5 - low) / (high - low), scale, values)
    # Remove images without users only, since copies of the material may use the others.
    for image in before:
        if image.users == 0:
            bpy.data.images.remove(image)
    for kind, image in images.items():
        image.name = f"{_shortened(made.name)}_{kind}"
        image.filepath_raw = f"//{image.name}.png"
    data = {"recipe": plan.recipe.to_dict(), "size": sides, "time": plan.time, "hash": plan.hash}
    made[_PROPERTY] = json.dumps({**_data_of(made), **data})


def baked_from(made: Any) -> Recipe | None:
    """Returns the recipe that a material was baked from, or None for other materials."""
    data = _data_of(made)
    return Recipe(data["recipe"]) if data else None


def import_model(model: Any, *, up: Literal["y", "z"] | None = None) -> list[Any]:
    """Imports a model of `synthesize_on` with its texture and normals, or a GLB file by path.

    Parameters
    ----------
    model : Model, str or os.PathLike
        A model, or the path of a GLB file.
    up : {"y", "z"} or None, default None
        The vertical axis of the coordinates. None is z for models, whose vertices keep their coordinates, and y for
        files, as glTF defines it; y is turned into Blender's z.

    Returns
    -------
    list of bpy.types.Object
        The new objects.
    """
    import bpy
    from mathutils import Matrix

    before = set(bpy.data.objects)
    if isinstance(model, (str, os.PathLike)):
        bpy.ops.import_scene.gltf(filepath=os.fspath(model))
    else:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "model.glb"
            model.export(path)
            bpy.ops.import_scene.gltf(filepath=str(path))
            # Pack the images, since the file will be deleted.
            for image in bpy.data.images:
                if image.filepath and Path(bpy.path.abspath(image.filepath)).parent == Path(folder):
                    image.pack()
    made = [thing for thing in bpy.data.objects if thing not in before]
    is_file = isinstance(model, (str, os.PathLike))
    if (up or ("y" if is_file else "z")) == "z":
        # Undo the importer's rotation of (x, y, z) to (x, -z, y).
        back = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
        for thing in made:
            thing.location = back @ thing.location
            if thing.type == "MESH":
                thing.data.transform(back)
    return made


def _opengl(plan: Plan) -> Plan:
    """Returns the plan with normals whose green points up, as Blender expects."""
    _, (recipe, images, time) = plan.__reduce__()
    data = json.loads(recipe)
    data["material"]["normal_y"] = "opengl"
    return _plan_from_parts(json.dumps(data), images, time)


def _data_of(made: Any) -> dict[str, Any]:
    """Returns the recorded data of a baked material; empty for other materials."""
    data = json.loads(made.get(_PROPERTY, "{}"))
    assert isinstance(data, dict)
    return data


def _images_of(made: Any) -> set[Any]:
    """Returns the images of a material that this module baked."""
    nodes = made.node_tree.nodes if made.node_tree else []
    images = {node.image for node in nodes if node.bl_idname == "ShaderNodeTexImage"}
    return {image for image in images if image is not None and _PROPERTY in image}


def _shortened(name: str) -> str:
    """Shortens a name so that the kind of an image fits after it: names in Blender have at most 63 bytes."""
    return name.encode()[:48].decode(errors="ignore")


def _image(bpy: Any, kind: str, values: Any, depth: _Depth, content: _Content, space: str) -> Any:
    """Makes a new Blender image, packed as PNG."""
    data = encode_image(values, "png", content=content, depth=depth)
    image = bpy.data.images.new(kind, values.shape[1], values.shape[0], is_data=space != "sRGB")
    image[_PROPERTY] = kind
    # Pack a file, since generated pixels would be lost when the file is saved. Set the source before packing: Blender
    # searches for a file as long as nothing is packed.
    image.filepath_raw = f"//{kind}.png"
    image.source = "FILE"
    image.pack(data=data, data_len=len(data))
    image.colorspace_settings.name = space
    image.alpha_mode = "NONE"
    if tuple(image.size) != (values.shape[1], values.shape[0]):
        raise refusal("blender", f"Blender read {kind} with {tuple(image.size)} pixels")
    return image


def _shader(
    bpy: Any,
    made: Any,
    images: dict[str, Any],
    relief: float,
    middle: float,
    scale: float,
    values: dict[str, Any],
) -> None:
    """Replaces all nodes of a material. `values` are the entries of the recipe's material."""
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    place: dict[str, Sequence[float]] = {
        "ShaderNodeOutputMaterial": (400, 0),
        "ShaderNodeBsdfPrincipled": (100, 0),
    }

    def node(kind: str, x: float, y: float) -> Any:
        added = tree.nodes.new(kind)
        added.location = place.get(kind, (x, y))
        return added

    def texture(kind: str, y: float) -> Any:
        added = node("ShaderNodeTexImage", -600, y)
        added.image = images[kind]
        added.label = kind
        tree.links.new(mapping.outputs["Vector"], added.inputs["Vector"])
        return added

    output = node("ShaderNodeOutputMaterial", 0, 0)
    shader = node("ShaderNodeBsdfPrincipled", 0, 0)
    link = tree.links.new
    link(shader.outputs["BSDF"], output.inputs["Surface"])
    coordinates = node("ShaderNodeTexCoord", -1000, 0)
    mapping = node("ShaderNodeMapping", -800, 0)
    mapping.inputs["Scale"].default_value = (scale, scale, scale)
    link(coordinates.outputs["UV"], mapping.inputs["Vector"])
    link(texture("albedo", 300).outputs["Color"], shader.inputs["Base Color"])
    parts = node("ShaderNodeSeparateColor", -300, 0)
    link(texture("orm", 0).outputs["Color"], parts.inputs["Color"])
    link(parts.outputs["Green"], shader.inputs["Roughness"])
    link(parts.outputs["Blue"], shader.inputs["Metallic"])
    occlusion = node("ShaderNodeGroup", 100, 200)
    occlusion.node_tree = _gltf_group(bpy)
    link(parts.outputs["Red"], occlusion.inputs["Occlusion"])
    bump = node("ShaderNodeNormalMap", -300, -300)
    link(texture("normal", -300).outputs["Color"], bump.inputs["Color"])
    link(bump.outputs["Normal"], shader.inputs["Normal"])
    if "emission" in images:
        link(texture("emission", 600).outputs["Color"], shader.inputs["Emission Color"])
        shader.inputs["Emission Strength"].default_value = values.get("emission_strength") or 1.0
    if "opacity" in images:
        opacity = texture("opacity", 900).outputs["Color"]
        cutoff = values.get("opacity_cutoff")
        if cutoff is not None:
            # One minus (opacity < cutoff), the nodes of Blender's glTF exporter for alpha mode MASK.
            below, rest = node("ShaderNodeMath", -300, 900), node("ShaderNodeMath", -100, 900)
            below.operation, rest.operation = "LESS_THAN", "SUBTRACT"
            below.inputs[1].default_value = cutoff
            rest.inputs[0].default_value = 1.0
            link(opacity, below.inputs[0])
            link(below.outputs["Value"], rest.inputs[1])
            opacity = rest.outputs["Value"]
        link(opacity, shader.inputs["Alpha"])
    if "specular" in images:
        # A level of 0.5 is an index of refraction of 1.5.
        half = node("ShaderNodeMath", -300, 1200)
        half.operation = "MULTIPLY"
        half.inputs[1].default_value = 0.5
        link(texture("specular", 1200).outputs["Color"], half.inputs[0])
        link(half.outputs["Value"], shader.inputs["Specular IOR Level"])
    if "clearcoat" in images:
        link(texture("clearcoat", 1500).outputs["Color"], shader.inputs["Coat Weight"])
        roughness = values.get("clearcoat_roughness")
        shader.inputs["Coat Roughness"].default_value = 0.03 if roughness is None else roughness
    if "height" in images:
        moved = node("ShaderNodeDisplacement", 100, -300)
        moved.inputs["Midlevel"].default_value = middle
        moved.inputs["Scale"].default_value = relief
        link(texture("height", -600).outputs["Color"], moved.inputs["Height"])
        link(moved.outputs["Displacement"], output.inputs["Displacement"])
        made.displacement_method = "BOTH"


def _gltf_group(bpy: Any) -> Any:
    """Returns the node group whose input the glTF exporter takes as occlusion; makes it if it does not exist."""
    group = bpy.data.node_groups.get(_GLTF_GROUP)
    if group is None:
        group = bpy.data.node_groups.new(_GLTF_GROUP, "ShaderNodeTree")
        group.interface.new_socket("Occlusion", in_out="INPUT", socket_type="NodeSocketFloat")
        group.nodes.new("NodeGroupInput")
    return group
