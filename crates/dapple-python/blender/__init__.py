"""The panel "dapple" in Blender: bakes a recipe with a size and a seed into a material of the active object."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, PointerProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

# Blender shows what a dynamic list returned, so its words have to stay alive.
_NAMES: list[tuple[str, str, str]] = []

#: Seconds after the last change until a material is baked again.
_DELAY = 0.3


def _builtin(_self, _context):
    import dapple_textures as dp

    if not _NAMES:
        _NAMES.extend((name, name.replace("-", " ").title(), "A built-in recipe") for name in dp.Recipe.builtin_names())
        _NAMES.append(("FILE", "File …", "A recipe of your own, in TOML or JSON"))
    return _NAMES


def _changed(settings, _context):
    """Bakes again shortly after the last change, if the material is set to follow changes."""
    if settings.follow and _material_of(bpy.context) is not None:
        if bpy.app.timers.is_registered(_follow):
            bpy.app.timers.unregister(_follow)
        bpy.app.timers.register(_follow, first_interval=_DELAY)


def _follow():
    bpy.ops.dapple.bake()


class DappleSettings(bpy.types.PropertyGroup):
    """The settings of the panel."""

    recipe: EnumProperty(name="Recipe", items=_builtin, update=_changed)
    path: StringProperty(name="File", subtype="FILE_PATH", update=_changed)
    size: EnumProperty(
        name="Size",
        items=[(str(side), f"{side} × {side}", "Pixels of a tile") for side in (256, 512, 1024, 2048, 4096)],
        default="1024",
        update=_changed,
    )
    # Blender's numbers have 32 bits, and seeds have 64.
    seed: StringProperty(name="Seed", description="0 to 2^64 - 1; empty: that of the recipe", update=_changed)
    scale: FloatProperty(name="Copies", description="Copies of the tile across the UV map", default=1.0, min=0.001, update=_changed)
    displacement: BoolProperty(name="Displacement", description="Move the surface by the height, too", update=_changed)
    follow: BoolProperty(name="Follow", description="Bake again at every change", default=True)


def _plan(settings):
    """Returns the plan for the settings of the panel."""
    import dapple_textures as dp

    name = bpy.path.abspath(settings.path) if settings.recipe == "FILE" else settings.recipe
    recipe = dp.read_recipe(name)
    if settings.seed.strip():
        recipe = recipe.with_seed(int(settings.seed))
    return recipe.plan(images=dp.read_recipe_images(recipe, Path(name).parent))


def _material_of(context):
    """Returns the material of the active object if this package baked it."""
    thing = context.active_object
    material = thing and thing.active_material
    return material if material is not None and "dapple_textures" in material else None


class DAPPLE_OT_bake(bpy.types.Operator):
    """Bake the recipe into a material of the active object"""

    bl_idname = "dapple.bake"
    bl_label = "Bake material"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        thing = context.active_object
        return thing is not None and hasattr(thing.data, "materials")

    def execute(self, context):
        from dapple_textures import blender

        settings = context.scene.dapple
        made = _material_of(context)
        try:
            plan = _plan(settings)
            is_new = made is None
            if is_new:
                # Another object may have the same recipe with another seed.
                made = bpy.data.materials.new(plan.recipe.name or "dapple")
            try:
                blender.bake_into(
                    made, plan, int(settings.size), displacement=settings.displacement, scale=settings.scale
                )
            except Exception:
                if is_new:
                    bpy.data.materials.remove(made)
                raise
        except (ValueError, OSError) as error:
            # The last good material stays.
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        thing = context.active_object
        if thing.active_material is None:
            thing.data.materials.append(made)
        else:
            thing.active_material = made
        return {"FINISHED"}


class DAPPLE_OT_import(bpy.types.Operator, ImportHelper):
    """Import a model that `dapple synth` or the Python package made, with all its maps"""

    bl_idname = "dapple.import_model"
    bl_label = "Import model"
    filename_ext = ".glb"
    filter_glob: StringProperty(default="*.glb", options={"HIDDEN"})

    def execute(self, _context):
        from dapple_textures import blender

        try:
            things = blender.import_model(self.filepath)
        except (ValueError, OSError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{len(things)} objects")
        return {"FINISHED"}


class DAPPLE_PT_panel(bpy.types.Panel):
    """The panel in the sidebar of the 3D view."""

    bl_idname = "DAPPLE_PT_panel"
    bl_label = "dapple"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "dapple"

    def draw(self, context):
        layout, settings = self.layout, context.scene.dapple
        layout.use_property_split = True
        layout.prop(settings, "recipe")
        if settings.recipe == "FILE":
            layout.prop(settings, "path")
        for name in ("size", "seed", "scale", "displacement", "follow"):
            layout.prop(settings, name)
        layout.operator(DAPPLE_OT_bake.bl_idname, icon="MATERIAL")
        layout.operator(DAPPLE_OT_import.bl_idname, icon="IMPORT")


_CLASSES = (DappleSettings, DAPPLE_OT_bake, DAPPLE_OT_import, DAPPLE_PT_panel)


def register():
    """Registers the panel and its operators."""
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.dapple = PointerProperty(type=DappleSettings)


def unregister():
    """Removes the panel and its operators."""
    del bpy.types.Scene.dapple
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
