"""Materials in the real Blender (the module `bpy`)."""

from __future__ import annotations

import json

import numpy as np
import pytest

import dapple_textures as dp

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not installed")

from dapple_textures import blender  # noqa: E402


@pytest.fixture(autouse=True)
def empty():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def pixels(image):
    """The pixels of an image, row 0 on top."""
    values = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)[::-1]


def node_of(material, socket, node="ShaderNodeBsdfPrincipled"):
    shader = next(found for found in material.node_tree.nodes if found.bl_idname == node)
    return shader.inputs[socket].links[0].from_node


def test_images_have_their_pixels_and_color_spaces_after_saving(tmp_path):
    plan = dp.Recipe.builtin("rock").plan()
    blender.material(plan, (96, 128), name="Rock", displacement=True)
    path = str(tmp_path / "rock.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    maps = plan.bake((96, 128), ["albedo", "orm", "normal", "height"])
    for name, content, depth, space in [
        ("albedo", "color", 8, "sRGB"),
        ("orm", "data", 8, "Non-Color"),
        ("normal", "normal", 16, "Non-Color"),
        ("height", "gray", 16, "Non-Color"),
    ]:
        image = bpy.data.images[f"Rock_{name}"]
        assert image.packed_file is not None and tuple(image.size) == (128, 96)
        assert image.colorspace_settings.name == space
        assert image.is_float == (depth == 16)
        file = dp.encode_image(maps[name], content=content, depth=depth)
        wanted = dp.decode_image(file, content="gray" if content == "gray" else "data")
        wanted = np.broadcast_to(wanted.reshape(96, 128, -1), (96, 128, 3))
        # A code of the file is one of Blender's.
        codes = 2**depth - 1
        assert np.array_equal(np.rint(pixels(image)[..., :3] * codes), np.rint(wanted * codes)), name


def test_the_shader_is_what_gltf_and_blender_expect(tmp_path):
    made = blender.material(dp.Recipe.builtin("rock"), 32, displacement=True)
    assert node_of(made, "Base Color").image.name == "rock_albedo"
    separate = node_of(made, "Roughness")
    assert separate == node_of(made, "Metallic") and separate.bl_idname == "ShaderNodeSeparateColor"
    assert node_of(made, "Normal").inputs["Color"].links[0].from_node.image.name == "rock_normal"
    assert node_of(made, "Displacement", "ShaderNodeOutputMaterial").inputs["Scale"].default_value > 0
    bpy.ops.mesh.primitive_plane_add()
    bpy.context.object.data.materials.append(made)
    bpy.ops.export_scene.gltf(filepath=str(tmp_path / "plane.glb"))
    data = (tmp_path / "plane.glb").read_bytes()
    length = int.from_bytes(data[12:16], "little")
    material = json.loads(data[20 : 20 + length])["materials"][0]
    assert {"normalTexture", "occlusionTexture", "pbrMetallicRoughness"} <= set(material)
    assert {"baseColorTexture", "metallicRoughnessTexture"} <= set(material["pbrMetallicRoughness"])


def test_a_material_is_baked_again_in_its_place():
    recipe = dp.Recipe.builtin("rock")
    first = blender.material(recipe, 32)
    before = pixels(bpy.data.images["rock_albedo"]).copy()
    again = blender.material(recipe.with_seed(99), 48)
    assert again is first or again.name == first.name
    assert len(bpy.data.materials) == 1 and len(bpy.data.images) == 3
    after = pixels(bpy.data.images["rock_albedo"])
    assert after.shape == (48, 48, 4) and not np.array_equal(after[:32, :32], before)
    assert blender.baked_from(again) == dp.Recipe({**recipe.to_dict(), "seed": 99, "material": {**recipe.to_dict()["material"], "normal_y": "opengl"}})
    assert blender.baked_from(bpy.data.materials.new("other")) is None


def test_what_others_made_stays():
    own, image = bpy.data.materials.new("rock"), bpy.data.images.new("rock_normal", 4, 4)
    own.use_nodes = True
    own.node_tree.nodes.new("ShaderNodeValue")
    before = pixels(image).copy(), len(own.node_tree.nodes)
    made = [blender.material(dp.Recipe.builtin("rock"), size) for size in (16, np.int64(32), (16, np.int32(24)))]
    assert made[0] == made[1] == made[2] != own and "dapple_textures" not in own
    assert np.array_equal(pixels(image), before[0]) and len(own.node_tree.nodes) == before[1]
    assert len(bpy.data.materials) == 2 and len(bpy.data.images) == 4


def test_a_copy_keeps_its_maps():
    made = blender.material(dp.Recipe.builtin("rock"), 16)
    copy = made.copy()
    before = pixels(node_of(copy, "Base Color").image).copy()
    blender.bake_into(made, dp.Recipe.builtin("rock").with_seed(5), 16)
    assert np.array_equal(pixels(node_of(copy, "Base Color").image), before)
    assert not np.array_equal(pixels(node_of(made, "Base Color").image), before)


def test_long_names_are_found_again():
    for seed in range(3):
        made = blender.material(dp.Recipe.builtin("rock").with_seed(seed), 16, name="ä" * 60)
    assert len(bpy.data.materials) == 1 and len(bpy.data.images) == 3
    assert made.name == "ä" * 31 and node_of(made, "Base Color").image.name == "ä" * 24 + "_albedo"


def test_heights_outside_of_0_to_1_move_the_surface_as_far_as_they_say():
    nodes = {"far": {"distance": {"center": [0.5, 0.5]}}, "dome": {"levels": {"input": "far", "to": [-2.0, 3.0]}}}
    recipe = dp.Recipe({"dapple": 1, "nodes": nodes, "material": {"height": "dome", "relief": 0.3}})
    height = recipe.plan().bake(32, ["height"])["height"]
    assert height.min() < -0.5 and height.max() > 1.2
    moved = node_of(blender.material(recipe, 32, displacement=True), "Displacement", "ShaderNodeOutputMaterial")
    shown = pixels(moved.inputs["Height"].links[0].from_node.image)[..., 0]
    moves = (shown - moved.inputs["Midlevel"].default_value) * moved.inputs["Scale"].default_value
    # A code of 16 bits is a step of the range.
    np.testing.assert_allclose(moves, 0.3 * (height - 0.5), atol=0.3 * 5 / 65535)


def test_the_console_stays_quiet(capfd):
    for size in (16, 32):
        blender.material(dp.Recipe.builtin("rock"), size, displacement=True)
    printed = capfd.readouterr()
    assert "rror" not in printed.out + printed.err


def lit(made, angle=0.9):
    """A plane with the material, seen from above, lit from the top of the picture."""
    bpy.ops.mesh.primitive_plane_add(size=2)
    bpy.context.object.data.materials.append(made)
    bpy.ops.object.light_add(type="SUN", rotation=(-angle, 0, 0))
    bpy.context.object.data.energy = 2
    bpy.ops.object.camera_add(location=(0, 0, 4))
    camera = bpy.context.object
    camera.data.type, camera.data.ortho_scale = "ORTHO", 2
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.engine, scene.cycles.samples = "CYCLES", 16
    scene.render.resolution_x = scene.render.resolution_y = 96
    scene.view_settings.view_transform = "Standard"
    return scene


def test_a_dome_that_is_lit_from_above_is_bright_above(tmp_path):
    data = {
        "dapple": 1,
        "nodes": {"far": {"distance": {"center": [0.5, 0.5]}}, "dome": {"levels": {"input": "far", "from": [0.5, 0.0]}}},
        "material": {"height": "dome", "relief": 0.3, "albedo": "#bcbcbc", "normal_y": "directx"},
    }
    scene = lit(blender.material(dp.Recipe(data), 128, name="Dome"))
    scene.render.filepath = str(tmp_path / "dome.png")
    bpy.ops.render.render(write_still=True)
    picture = dp.read_image(tmp_path / "dome.png")[..., 0]
    upper, lower, corner = picture[20:40, 38:58].mean(), picture[56:76, 38:58].mean(), picture[2:8, 2:8].mean()
    # DirectX's normals, which the recipe asks for, would turn this around.
    assert upper > 1.1 * corner and corner > 1.1 * lower, (upper, corner, lower)


def test_a_synthesized_model_arrives_with_its_texture(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    rng = np.random.default_rng(1)
    exemplar = np.repeat(np.repeat(rng.random((6, 6, 3)), 4, 0), 4, 1).astype(np.float32)
    model = dp.synthesize_on(trimesh.creation.torus(1.0, 0.4), exemplar, atlas={"texels": 512}, sites=400, seed=1)
    model.export(tmp_path / "torus.glb")
    for source in (model, str(tmp_path / "torus.glb")):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        things = [thing for thing in blender.import_model(source) if thing.type == "MESH"]
        assert len(things) == 1
        mesh = things[0].data
        assert len(mesh.polygons) == len(model.faces) and len(mesh.uv_layers) == 1
        image = node_of(mesh.materials[0], "Base Color").image
        assert image.packed_file is not None and image.colorspace_settings.name == "sRGB"

def test_a_synthesized_model_arrives_with_all_its_maps():
    trimesh = pytest.importorskip("trimesh")
    maps = dp.Recipe.builtin("rock").plan().bake(24, ["albedo", "normal", "orm"])
    model = dp.synthesize_on(trimesh.creation.torus(1.0, 0.4), maps, atlas={"texels": 512}, sites=400, seed=1)
    [thing] = [thing for thing in blender.import_model(model) if thing.type == "MESH"]
    material = thing.data.materials[0]
    separate = node_of(material, "Roughness")
    assert separate == node_of(material, "Metallic")
    images = {
        "albedo": node_of(material, "Base Color").image,
        "orm": separate.inputs[0].links[0].from_node.image,
        "normal": node_of(material, "Normal").inputs["Color"].links[0].from_node.image,
    }
    for name, content, space in [("albedo", "color", "sRGB"), ("orm", "data", "Non-Color"), ("normal", "normal", "Non-Color")]:
        image = images[name]
        assert image.packed_file is not None and image.colorspace_settings.name == space, name
        codes = dp.decode_image(dp.encode_image(model.maps[name], content=content, depth=8), content="data")
        # What is in no chart of the atlas, where the exporter may write what it likes, is not looked at; half a code is.
        shown = pixels(image)[..., :3]
        assert shown.shape == codes.shape and np.abs(shown - codes).mean() < 0.5 / 255, name


@pytest.fixture
def panel():
    """The extension, registered as Blender does it."""
    import importlib.util
    from pathlib import Path

    source = Path(__file__).parents[1] / "blender/__init__.py"
    spec = importlib.util.spec_from_file_location("dapple_textures_panel", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.register()
    yield module
    module.unregister()


def test_the_panel_bakes_and_follows(panel, tmp_path):
    bpy.ops.mesh.primitive_plane_add()
    settings = bpy.context.scene.dapple
    settings.recipe, settings.size, settings.seed = "marble", "256", str(2**64 - 1)
    assert bpy.ops.dapple.bake() == {"FINISHED"}
    made = bpy.context.object.active_material
    assert blender.baked_from(made).seed == 2**64 - 1
    assert tuple(bpy.data.images["marble_albedo"].size) == (256, 256)
    before = pixels(bpy.data.images["marble_albedo"]).copy()
    settings.seed = "1"
    assert bpy.app.timers.is_registered(panel._follow)
    panel._follow()
    assert not np.array_equal(pixels(bpy.data.images["marble_albedo"]), before)
    assert len(bpy.data.materials) == 1
    (tmp_path / "mine.toml").write_text('dapple = 1\n[nodes.a.image]\nfile = "a.png"\n[material]\nalbedo = "a"\n')
    dp.write_image(tmp_path / "a.png", np.full((8, 8, 3), 0.25, np.float32))
    settings.recipe, settings.path, settings.seed = "FILE", str(tmp_path / "mine.toml"), ""
    assert bpy.ops.dapple.bake() == {"FINISHED"}
    assert blender.baked_from(bpy.context.object.active_material).image_files == ["a.png"]
    # What is refused leaves the last good material.
    settings.seed = "many"
    with pytest.raises(RuntimeError, match="many"):
        bpy.ops.dapple.bake()
    assert blender.baked_from(bpy.context.object.active_material).image_files == ["a.png"]


def test_objects_in_the_panel_have_materials_of_their_own(panel):
    settings = bpy.context.scene.dapple
    settings.follow = False
    settings.recipe, settings.size = "marble", "256"
    made = []
    for seed in ("1", "2"):
        bpy.ops.mesh.primitive_plane_add()
        settings.seed = seed
        assert bpy.ops.dapple.bake() == {"FINISHED"}
        made.append(bpy.context.object.active_material)
    assert [blender.baked_from(material).seed for material in made] == [1, 2]
    assert len(bpy.data.materials) == 2 and len(bpy.data.images) == 6


def test_a_mesh_of_blender_comes_back_where_it_was():
    bpy.ops.mesh.primitive_cone_add(radius1=1, depth=3, location=(1, 2, 3))
    cone = bpy.context.object
    bpy.context.view_layer.update()
    before = np.array([cone.matrix_world @ vertex.co for vertex in cone.data.vertices])
    example = np.random.default_rng(1).random((16, 16, 3))
    faces = np.array([face.vertices for face in triangles(cone)])
    # The object itself, its mesh, and its arrays as a user writes them.
    for mesh, wanted in [
        (cone, before),
        (cone.data, before - [1, 2, 3]),
        ((before, faces), before),
    ]:
        model = dp.synthesize_on(mesh, example, atlas={"texels": 64}, sites=300, matching={"levels": 1})
        [thing] = [thing for thing in blender.import_model(model) if thing.type == "MESH"]
        bpy.context.view_layer.update()
        after = np.array([thing.matrix_world @ vertex.co for vertex in thing.data.vertices])
        # GLB has float32.
        assert np.allclose(after.min(0), wanted.min(0), atol=1e-5) and np.allclose(after.max(0), wanted.max(0), atol=1e-5)


def triangles(thing):
    thing.data.calc_loop_triangles()
    return thing.data.loop_triangles


def test_the_coordinates_of_other_programs_are_turned_if_asked(tmp_path):
    high = np.array([[0.0, 0, 0], [1, 0, 0], [0, 3, 0], [0, 0, 1]]), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    model = dp.synthesize_on(high, np.eye(16), atlas={"texels": 64}, sites=300, matching={"levels": 1})
    model.export(tmp_path / "high.glb")
    for thing in [*blender.import_model(model, up="y"), *blender.import_model(tmp_path / "high.glb")]:
        if thing.type == "MESH":
            assert max(vertex.co.z for vertex in thing.data.vertices) == 3
