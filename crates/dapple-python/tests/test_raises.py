"""Every error that a docstring lists is raised, by a call for each of its causes, and its message says limit and value."""

from __future__ import annotations

import builtins
import inspect
import re
from pathlib import Path

import numpy as np
import pytest

import dapple_textures as dp

ROOF = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])


def noise():
    return dp.gradient_noise()


def space():
    return dp.gradient_noise(dims=3)


def colors():
    return dp.color_noise()


def nested(change):
    """A field that is changed more often than a composition may be."""
    field = noise()
    for _ in range(99):
        field = change(field)


def some():
    return dp.white_noise(dp.Domain(1), 50)


def twice():
    """Two points in the same place."""
    return dp.Points([[0.5, 0.5], [0.5, 0.5]], dp.Domain(1))


def thin():
    """Points that have too many copies near them."""
    return dp.white_noise(dp.Domain((1e9, 1e-9)), 50)


def steep():
    """A distance that changes by more than positions do."""
    return dp.constant(0.1) + dp.gradient_noise().frequency(23) * 0.09


def model():
    return dp.synthesize_on(ROOF, np.eye(16), atlas={"texels": 16}, sites=50, matching={"levels": 1})


def recipe(node):
    """The recipe of a node in TOML."""
    height = "" if "color" in node else 'height = "a"\n'
    return dp.Recipe.from_toml(f"dapple = 1\nnodes.{node}\n[material]\n{height}")


def plan():
    return recipe("a.coordinate.along = [1.0, 0.0]").plan()


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """Paths in a folder of files."""
    folder = tmp_path_factory.mktemp("files")
    (folder / "text.png").write_text("text")
    (folder / "text.toml").write_text("dapple = 1\nextnt = 3\n[material]\n")
    (folder / "damaged.obj").write_text("v 0 0 0\nf 1 2 3\n")
    dp.write_image(folder / "gray.png", np.ones((2, 2)))
    dp.write_image(folder / "gray.exr", np.ones((2, 2)))
    dp.write_image(folder / "clear.png", np.full((2, 2, 4), 0.5))
    return lambda name: str(Path(folder, name))


#: What is called, the call, the error, and a part of its message.
CALLS = [
    ("wavelet_halve", "dp.wavelet_halve(np.ones((4, 5)))", "DappleError", "a periodic side of 5 cannot be halved 1 times; its length must be a multiple of 2^1"),
    ("wavelet_halve", "dp.wavelet_halve(np.array([[1, np.nan], [1, 1]]))", "DappleError", "value 1 is NaN, but all must be finite"),
    ("wavelet_halve", "dp.wavelet_halve(np.ones((4, 4)), borders='clamped')", "DappleError", "the borders is `clamped`, but it must be one of periodic, mirror"),
    ("wavelet_double", "dp.wavelet_double(np.full((2, 2), np.inf))", "DappleError", "value 0 is inf, but all must be finite"),
    ("wavelet_double", "dp.wavelet_double(np.ones((2, 2)), borders='clamped')", "DappleError", "the borders is `clamped`, but it must be one of periodic, mirror"),
    ("wavelet_analyze", "dp.wavelet_analyze(np.ones((4, 6)), levels=2)", "DappleError", "a periodic side of 6 cannot be halved 2 times; its length must be a multiple of 2^2"),
    ("wavelet_analyze", "dp.wavelet_analyze(np.full((4, 4), np.nan))", "DappleError", "value 0 is NaN, but all must be finite"),
    ("wavelet_analyze", "dp.wavelet_analyze(np.ones((4, 4)), borders='clamped')", "DappleError", "the borders is `clamped`, but it must be one of periodic, mirror"),
    ("wavelet_synthesize", "dp.wavelet_synthesize(([np.ones((4, 4))], np.ones((3, 2))))", "DappleError", "there are 3 values, but 2 are needed"),
    ("wavelet_synthesize", "dp.wavelet_synthesize(([np.ones((4, 4))], np.ones((2, 2))), borders='clamped')", "DappleError", "the borders is `clamped`, but it must be one of periodic, mirror"),
    ("wavelet_tile", "dp.wavelet_tile(0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("wavelet_tile", "dp.wavelet_tile(6, [1.0, 1.0, 1.0])", "DappleError", "a periodic side of 6 cannot be halved 3 times; its length must be a multiple of 2^3"),
    ("wavelet_tile", "dp.wavelet_tile(8, [np.inf])", "DappleError", "value 0 is inf, but all must be finite"),
    ("blend_map", "dp.blend_map(np.ones((2, 2, 5)))", "DappleError", "the texture has 5 channels, but color is (rows, columns) for one number a pixel, or (rows, columns, 3 or 4)"),
    ("blend_map", "dp.blend_map(np.ones((2, 2)), feature_size=0.5)", "DappleError", "the feature size is 0.5, but it must be from 1 to 4096 pixels"),
    ("blend", "dp.blend([np.ones((2, 2)), np.ones((2, 3))])", "DappleError", "the raster has 3 × 2 pixels, but 2 × 2 are needed"),
    ("blend", "dp.blend([np.ones((2, 2)), np.ones((2, 2, 3))])", "DappleError", "number 1 of the layers has other maps or channels than the first"),
    ("blend", "dp.blend([])", "DappleError", "there are 0 layers, but at least 1 is needed"),
    ("blend", "dp.blend([np.ones((2, 2))] * 2, mixing='softened')", "DappleError", "mixing: `softened` is not one of `linear`, `keep_variance`, `pyramid`"),
    ("ColorField.render", "colors().render(0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("ColorField.render", "colors().render(4, extent=np.inf)", "DappleError", "the origin is 0 and the extent inf along an axis, but they must be finite, and the extent not 0"),
    ("ColorField.render", "colors().render(4, origin=(0, np.nan))", "DappleError", "the origin is NaN and the extent 2 along an axis, but they must be finite, and the extent not 0"),
    ("ColorField.render", "colors().render(4, window=np.s_[0:2])", "DappleError", "the window is slice(0, 2, None), but it must be 2 slices, as in `np.s_[100:150, 33:94]`"),
    ("ColorField.render", "colors().render(4, out=np.zeros((3, 4, 3), np.float32))", "DappleError", "`out` has the shape [3, 4, 3], but [4, 4, 3] is needed"),
    ("ColorField.sample", "colors().sample([1.0, 2.0, 3.0])", "DappleError", "positions have the shape [3], but the last axis must have 2 numbers, x first"),
    ("constant", "dp.constant(np.nan)", "DappleError", "the number NaN is not finite, as the numbers of fields must be"),
    ("Field.render", "noise().render(-1)", "DappleError", "the size is -1, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("Field.render", "noise().render(4, extent=0)", "DappleError", "the origin is 0 and the extent 0 along an axis, but they must be finite, and the extent not 0"),
    ("Field.render", "noise().render(4, origin=(1, 2, 3))", "DappleError", "the origin is (1, 2, 3), but it must be a number, or 2 numbers, x first"),
    ("Field.render", "noise().render(4, window=np.s_[2:1, 0:2])", "DappleError", "the window goes from 2 to 1 in steps of 1, but it must hold at least one pixel and go in steps of 1"),
    ("Field.render", "noise().render(4, out=np.zeros((4, 5), np.float32))", "DappleError", "`out` has the shape [4, 5], but [4, 4] is needed"),
    ("Field.render", "noise().render(4, out=np.zeros((4, 4)))", "TypeError", "`out` is an array of float64, but it must be an array of float32"),
    ("Field.sample", "noise().sample([1.0, 2.0, 3.0])", "DappleError", "positions have the shape [3], but the last axis must have 2 numbers, x first"),
    ("Field.slice", "noise().slice(1.0)", "DappleError", "a slice at 1 further coordinates is of a field with as many axes more than two"),
    ("Field.slice", "space().slice(1.0, 2.0)", "DappleError", "a slice at 2 further coordinates is of a field with as many axes more than two"),
    ("Field.frequency", "noise().frequency(np.inf)", "DappleError", "the number inf is not finite, as the numbers of fields must be"),
    ("Field.frequency", "noise().frequency([1, 2, 3])", "DappleError", "the frequency is [1, 2, 3], but it must be a number, or 2 numbers, x first"),
    ("Field.offset", "noise().offset([np.nan, 0])", "DappleError", "the number NaN is not finite, as the numbers of fields must be"),
    ("Field.offset", "noise().offset([1, 2, 3])", "DappleError", "the offset is [1, 2, 3], but it must be a number, or 2 numbers, x first"),
    ("Field.rotate", "noise().rotate(np.inf)", "DappleError", "the number inf is not finite, as the numbers of fields must be"),
    ("Field.warp", "noise().warp(noise(), noise(), np.nan)", "DappleError", "the number NaN is not finite, as the numbers of fields must be"),
    ("Field.warp", "space().warp(dp.worley(dims=4), noise(), 1.0)", "DappleError", "fields of three and of four axes are not combined: take a `slice(…)`, or fields of the same number of axes"),
    ("Field.warp", "noise().warp(noise(), noise(), 1.0, z=noise())", "DappleError", "positions of 2 axes are not displaced along z, which they lack"),
    ("Field.remap", "noise().remap((1, 1), (0, 1))", "DappleError", "the length of the range is 0, but it must be finite and not 0"),
    ("Field.remap", "noise().remap((0, np.inf), (0, 1))", "DappleError", "the number inf is not finite, as the numbers of fields must be"),
    ("Field.clamp", "noise().clamp(-np.inf, 0)", "DappleError", "a bound is -inf, but it must be finite: `minimum` and `maximum` have one bound"),
    ("Field.clamp", "noise().clamp(2, 1)", "DappleError", "the bounds are 2 and 1, but the first must not be above the second"),
    ("Field.minimum", "space().minimum(dp.worley(dims=4))", "DappleError", "fields of three and of four axes are not combined: take a `slice(…)`, or fields of the same number of axes"),
    ("Field.minimum", "nested(lambda field: field.minimum(0.5))", "DappleError", "the field is composed of operations on operations more than 60 times: add many fields in pairs, (a + b) + (c + d), or"),
    ("Field.maximum", "space().maximum(dp.worley(dims=4))", "DappleError", "fields of three and of four axes are not combined: take a `slice(…)`, or fields of the same number of axes"),
    ("Field.maximum", "nested(lambda field: field.maximum(0.5))", "DappleError", "the field is composed of operations on operations more than 60 times: add many fields in pairs, (a + b) + (c + d), or"),
    ("Field.mix", "space().mix(dp.worley(dims=4), 0.5)", "DappleError", "fields of three and of four axes are not combined: take a `slice(…)`, or fields of the same number of axes"),
    ("Field.mix", "nested(lambda field: field.mix(0.5, 0.5))", "DappleError", "the field is composed of operations on operations more than 60 times: add many fields in pairs, (a + b) + (c + d), or"),
    ("Field.fbm", "noise().fbm(octaves=33)", "DappleError", "the number of octaves is 33, but it must be from 1 to 32"),
    ("Field.fbm", "noise().fbm(octaves=0)", "DappleError", "the number of octaves is 0, but it must be from 1 to 32"),
    ("Field.fbm", "noise().fbm(gain=1.5)", "DappleError", "the gain is 1.5, but it must be from -1 to 1"),
    ("Field.fbm", "noise().fbm(lacunarity=17)", "DappleError", "the lacunarity is 17, but it must be from 1 to 16"),
    ("Field.ridged", "noise().ridged(octaves=33)", "DappleError", "the number of octaves is 33, but it must be from 1 to 32"),
    ("Field.ridged", "noise().ridged(octaves=0)", "DappleError", "the number of octaves is 0, but it must be from 1 to 32"),
    ("Field.ridged", "noise().ridged(gain=1.5)", "DappleError", "the gain is 1.5, but it must be from -1 to 1"),
    ("Field.ridged", "noise().ridged(lacunarity=17)", "DappleError", "the lacunarity is 17, but it must be from 1 to 16"),
    ("Field.billow", "noise().billow(octaves=33)", "DappleError", "the number of octaves is 33, but it must be from 1 to 32"),
    ("Field.billow", "noise().billow(octaves=0)", "DappleError", "the number of octaves is 0, but it must be from 1 to 32"),
    ("Field.billow", "noise().billow(gain=1.5)", "DappleError", "the gain is 1.5, but it must be from -1 to 1"),
    ("Field.billow", "noise().billow(lacunarity=17)", "DappleError", "the lacunarity is 17, but it must be from 1 to 16"),
    ("worley", "dp.worley(value='f9')", "DappleError", "value: `f9` is not one of `f1`, `f2`, `f3`, `f4`, `f2_minus_f1`, `f1_plus_f2`, `f3_minus_f1`, `f3_minus_f2`,"),
    ("worley", "dp.worley(dims=5)", "DappleError", "the number of axes is 5, but it must be 2, 3 or 4"),
    ("worley", "dp.worley(octaves={'count': 99})", "DappleError", "the number of octaves is 99, but it must be from 1 to 32"),
    ("Worley.features", "dp.worley().features([1.0, 2.0, 3.0])", "DappleError", "positions have the shape [3], but the last axis must have 2 numbers, x first"),
    ("Worley.features", "dp.worley().features([1.0, 2.0], count=99)", "DappleError", "the number of feature points is 99, but it must be from 1 to 4"),
    ("Worley.render_features", "dp.worley().render_features(4, count=99)", "DappleError", "the number of feature points is 99, but it must be from 1 to 4"),
    ("Worley.render_features", "dp.worley().render_features(0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("Worley.render_features", "dp.worley().render_features(4, extent=0)", "DappleError", "the origin is 0 and the extent 0 along an axis, but they must be finite, and the extent not 0"),
    ("Worley.render_features", "dp.worley().render_features(4, origin=np.nan)", "DappleError", "the origin is NaN and the extent 8 along an axis, but they must be finite, and the extent not 0"),
    ("Worley.render_features", "dp.worley().render_features(4, window=np.s_[0:2])", "DappleError", "the window is slice(0, 2, None), but it must be 2 slices, as in `np.s_[100:150, 33:94]`"),
    ("Worley.gradient", "dp.worley().gradient([1.0, 2.0, 3.0])", "DappleError", "positions have the shape [3], but the last axis must have 2 numbers, x first"),
    ("Worley.gradient", "dp.worley(value='cell_value').gradient([1.0, 2.0])", "DappleError", "`cell_value` and `edge_distance` have no gradient"),
    ("Worley.cell_points", "dp.worley().cell_points([1, 2, 3])", "DappleError", "there are 3 numbers, but 2 are needed"),
    ("gradient_noise", "dp.gradient_noise(dims=5)", "DappleError", "the number of axes is 5, but it must be 2, 3 or 4"),
    ("gradient_noise", "dp.gradient_noise(period=(1, 2, 3))", "DappleError", "the period is (1, 2, 3), but it must be a whole number of cells, or 2 numbers or None, x first"),
    ("gradient_noise", "dp.gradient_noise(octaves=40)", "DappleError", "the number of octaves is 40, but it must be from 1 to 32"),
    ("wavelet_noise", "dp.wavelet_noise(dims=4)", "DappleError", "the number of axes is 4, but it must be 2 or 3"),
    ("wavelet_noise", "dp.wavelet_noise(period=7)", "DappleError", "a periodic side of 7 cannot be halved 1 times; its length must be a multiple of 2^1"),
    ("wavelet_noise", "dp.wavelet_noise(period=2)", "DappleError", "the size of the tile is 2, but it must be at least 4"),
    ("read_image", "dp.read_image(path('text.png'))", "DappleError", "/text.png: the bytes are of no format that is known here"),
    ("read_image", "dp.read_image(path('gray.png'), max_pixels=3)", "DappleError", "/gray.png: an image of 2 × 2 pixels is larger than the limit of 3 pixels"),
    ("read_image", "dp.read_image(path('gray.exr'), layer='depth')", "DappleError", "there is no layer named \"depth\"; the layers are Y"),
    ("read_image", "dp.read_image(path('gray.png'), content='normal')", "DappleError", "the image is gray, but a normal map is needed"),
    ("read_image", "dp.read_image(path('none.png'))", "FileNotFoundError", "No such file or directory"),
    ("decode_image", "dp.decode_image(b'text')", "DappleError", "the bytes are of no format that is known here"),
    ("decode_image", "dp.decode_image(dp.encode_image(np.ones((2, 2))), max_pixels=3)", "DappleError", "an image of 2 × 2 pixels is larger than the limit of 3 pixels"),
    ("decode_image", "dp.decode_image(dp.encode_image(np.ones((2, 2)), format='exr'), layer='depth')", "DappleError", "there is no layer named \"depth\"; the layers are Y"),
    ("decode_image", "dp.decode_image(dp.encode_image(np.ones((2, 2))), content='normal')", "DappleError", "the image is gray, but a normal map is needed"),
    ("write_image", "dp.write_image(path('new.jpg'), np.ones((2, 2)))", "DappleError", "images are written as png, exr, npy or r16, and not as \"jpg\""),
    ("write_image", "dp.write_image(path('new.png'), np.ones((2, 2), int))", "DappleError", "the image is an array of int64, but pixels are floating point: divide data by its largest code, or take"),
    ("write_image", "dp.write_image(path('new.png'), np.ones((2, 2)), content='normal')", "DappleError", "the image has 1 channels, but normal is (rows, columns) for one number a pixel, or (rows, columns, 3 or 4)"),
    ("write_image", "dp.write_image(path('new.r16'), np.ones((2, 2, 3)))", "DappleError", "the image is RGB, but gray is needed"),
    ("write_image", "dp.write_image(path('new.png'), np.ones((2, 2)), depth=12)", "DappleError", "the depth is 12, but PNG has 8 or 16 bits"),
    ("write_image", "dp.write_image(path('nowhere/new.png'), np.ones((2, 2)))", "FileNotFoundError", "No such file or directory"),
    ("write_maps", "dp.write_maps(path('maps'), {'height': np.ones((2, 2))}, format='bmp')", "DappleError", "images are written as png, exr, npy or r16, and not as \"bmp\""),
    ("write_maps", "dp.write_maps(path('maps'), {'a/b': np.ones((2, 2))})", "DappleError", "`a/b.png` is no name of a file"),
    ("write_maps", "dp.write_maps(path('maps'), {'normal': np.ones((2, 2))})", "DappleError", "the image has 1 channels, but normal is (rows, columns) for one number a pixel, or (rows, columns, 3 or 4)"),
    ("write_maps", "dp.write_maps(path('maps'), {'height': np.ones((2, 2))}, depth=12)", "DappleError", "the depth is 12, but PNG has 8 or 16 bits"),
    ("write_maps", "dp.write_maps(path('text.png') + '/maps', {'height': np.ones((2, 2))})", "NotADirectoryError", "Not a directory"),
    ("encode_image", "dp.encode_image(np.ones((2, 2)), format='bmp')", "DappleError", "images are written as png, exr, npy or r16, and not as \"bmp\""),
    ("encode_image", "dp.encode_image(np.ones((2, 2), int))", "DappleError", "the image is an array of int64, but pixels are floating point: divide data by its largest code, or take"),
    ("encode_image", "dp.encode_image(np.ones((2, 2)), content='normal')", "DappleError", "the image has 1 channels, but normal is (rows, columns) for one number a pixel, or (rows, columns, 3 or 4)"),
    ("encode_image", "dp.encode_image(np.ones((2, 2, 3)), format='r16')", "DappleError", "the image is RGB, but gray is needed"),
    ("encode_image", "dp.encode_image(np.ones((2, 2)), depth=12)", "DappleError", "the depth is 12, but PNG has 8 or 16 bits"),
    ("normal_map", "dp.normal_map(np.ones((2, 2, 3)))", "DappleError", "the height has 3 channels, but 1 is needed"),
    ("ambient_occlusion", "dp.ambient_occlusion(np.ones((2, 2, 3)))", "DappleError", "the height has 3 channels, but 1 is needed"),
    ("curvature", "dp.curvature(np.ones((2, 2, 3)))", "DappleError", "the height has 3 channels, but 1 is needed"),
    ("normal_map", "dp.normal_map(np.ones((2, 2)), extent=-1.0)", "DappleError", "the extent is -1 × -1, but both must be above zero and finite"),
    ("ambient_occlusion", "dp.ambient_occlusion(np.ones((2, 2)), radius=-1.0)", "DappleError", "the radius -1 is -2 pixels, but it must be from 0 to 16384 pixels"),
    ("curvature", "dp.curvature(np.ones((2, 2)), radius=-1.0)", "DappleError", "the radius -1 is -2 pixels, but it must be from 0 to 16384 pixels"),
    ("ramp", "dp.ramp(np.ones((2, 2)), 'rainbow')", "DappleError", "the palette is `rainbow`, but it must be one of gray, lagoon, ember, terrain, cow, giraffe, labels"),
    ("ramp", "dp.ramp(np.ones((2, 2)), ['#12345'])", "DappleError", "\"#12345\" is not a color; it must be 3 or 6 hexadecimal digits, with or without #"),
    ("ramp", "dp.ramp(np.ones((2, 2)), [])", "DappleError", "a color ramp needs at least one stop"),
    ("ramp", "dp.ramp(np.ones((2, 2)), [(1.0, '#000'), (0.5, '#fff')])", "DappleError", "the stop at 0.5 follows the stop at 1, but stops must be in order"),
    ("ramp", "dp.ramp(np.ones((2, 2)), ['#000'], space='hsv')", "DappleError", "the space is `hsv`, but it must be one of oklab, srgb, linear"),
    ("srgb_from_linear", "dp.srgb_from_linear(np.ones((2, 2)), depth=12)", "DappleError", "the depth is 12, but it must be 8 or 16"),
    ("linear_from_srgb", "dp.linear_from_srgb(np.ones((2, 2)))", "TypeError", "sRGB codes are an array of uint8 or of uint16"),
    ("read_model", "dp.read_model(path('text.png'))", "DappleError", "no mesh format is named `png`; there are obj, ply, glb, gltf, off, stl"),
    ("read_model", "dp.read_model(path('damaged.obj'))", "DappleError", "this is not a valid OBJ file: line 2: a corner of a face is vertex 2, but there are 1"),
    ("read_model", "dp.read_model(path('none.obj'))", "FileNotFoundError", "No such file or directory"),
    ("mesh_report", "dp.mesh_report(7)", "DappleError", "a mesh has `.vertices` and `.faces`, or is a scene of trimesh, an object of Blender, or a pair of arrays, and not"),
    ("mesh_report", "dp.mesh_report((np.eye(3), [[0, 1, 9]]))", "DappleError", "face 0 names vertex 9, but there are only 3, from 0"),
    ("synthesize_on", "dp.synthesize_on((np.zeros((3, 3)), [[0, 1, 2]]), np.eye(16))", "DappleError", "no face of the mesh has an area"),
    ("synthesize_on", "dp.synthesize_on(ROOF, {'a': np.eye(16), 'b': np.eye(8)})", "DappleError", "the maps of an example have one size, but one has [8, 8] columns and rows, and the first [16, 16]"),
    ("synthesize_on", "dp.synthesize_on(ROOF, np.eye(16), matching={'levels': 99})", "DappleError", "there are 99 levels, but 1 to 16 are needed"),
    ("Model.export", "model().export(path('a.xyz'))", "DappleError", "no mesh format is named `xyz`; there are obj, ply, glb, stl to write"),
    ("Model.export", "model().export(path('nowhere/a.glb'))", "FileNotFoundError", "No such file or directory"),
    ("synthesize_along", "dp.synthesize_along(np.ones((2, 2)), np.zeros((32, 32)))", "DappleError", "level 2 of the exemplar has 1 x 1 pixels, too few for a neighborhood of side 7"),
    ("synthesize_along", "dp.synthesize_along(np.eye(32), np.zeros((32, 32)), np.ones((3, 3)))", "DappleError", "the raster has 32 × 32 pixels, but 3 × 3 are needed"),
    ("synthesize_along", "dp.synthesize_along(np.eye(32), np.zeros((32, 32)), matching={'levels': 99})", "DappleError", "there are 99 levels, but 1 to 16 are needed"),
    ("repair_on", "dp.repair_on(ROOF, np.eye(32), np.eye(32))", "DappleError", "the mesh has no attribute uv"),
    ("Domain", "dp.Domain(0)", "DappleError", "the domain from [0, 0] has size [0, 0], but both sides must be above 0 and at most 1e300, and the origin between -1e300"),
    ("Domain", "dp.Domain(np.nan)", "DappleError", "the domain from [0, 0] has size [NaN, NaN], but both sides must be above 0 and at most 1e300, and the origin between"),
    ("delaunay", "dp.delaunay(twice())", "DappleError", "points 0 and 1 coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger"),
    ("gabriel", "dp.gabriel(twice())", "DappleError", "points 0 and 1 coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger"),
    ("delaunay", "dp.delaunay(thin())", "DappleError", "the domain has size [1000000000, 0.000000001] and wraps, so thin that the search for neighbors goes through more than"),
    ("gabriel", "dp.gabriel(thin())", "DappleError", "the domain has size [1000000000, 0.000000001] and wraps, so thin that the search for neighbors goes through more than"),
    ("yao", "dp.yao(some(), cones=33)", "DappleError", "asked for 33 cones, but 1 to 32 are allowed"),
    ("yao", "dp.yao(twice(), cones=6)", "DappleError", "points 0 and 1 coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger"),
    ("k_nearest", "dp.k_nearest(some(), 0)", "DappleError", "asked for 0 nearest neighbors, but 1 to 500 can be had"),
    ("k_nearest", "dp.k_nearest(some(), 9999)", "DappleError", "asked for 9999 nearest neighbors, but 1 to 500 can be had"),
    ("k_nearest", "dp.k_nearest(twice(), 1)", "DappleError", "points 0 and 1 coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger"),
    ("poisson_disk", "dp.poisson_disk(dp.Domain(1), distance=0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("poisson_disk", "dp.poisson_disk(dp.Domain(1, wrap=False), distance=steep())", "DappleError", "the radius changes by 1.0433086925073642 per distance near [0.75, 0.45], but it must change by less than 1"),
    ("poisson_disk", "dp.poisson_disk(dp.Domain(1), distance=0.6)", "DappleError", "axis 0 wraps around after 1, but it must reach over two radii of 0.6"),
    ("poisson_disk", "dp.poisson_disk(dp.Domain(1), distance=1e-6)", "DappleError", "about 697000000000 points would be needed, but the limit is 67108864"),
    ("extend_poisson_disk", "dp.extend_poisson_disk(some(), 0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("extend_poisson_disk", "dp.extend_poisson_disk(some(), 0.4)", "DappleError", "points 0 and 3 are 0.20852595454373768 apart, but the radius is 0.4"),
    ("nested_poisson_disk", "dp.nested_poisson_disk(dp.Domain(1), [0.0])", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("nested_poisson_disk", "dp.nested_poisson_disk(dp.Domain(1), [0.1, 0.2])", "DappleError", "radius 1 is 0.2, but it must not be larger than the one before, 0.1"),
    ("nested_poisson_disk", "dp.nested_poisson_disk(dp.Domain(1), [1e-6])", "DappleError", "about 697000000000 points would be needed, but the limit is 67108864"),
    ("jittered_grid", "dp.jittered_grid(dp.Domain(1), 4, jitter=2.0)", "DappleError", "the jitter is 2, but it must be between 0 and 1"),
    ("jittered_grid", "dp.jittered_grid(dp.Domain(1), 4, seed=-1)", "DappleError", "the seed is -1, but it must be from 0 to 2^64 - 1"),
    ("jittered_grid", "dp.jittered_grid(dp.Domain(1), 100_000)", "DappleError", "about 10000000000 points would be needed, but the limit is 2147483648"),
    ("white_noise", "dp.white_noise(dp.Domain(1), 4, seed=2**64)", "DappleError", "the seed is 18446744073709551616, but it must be from 0 to 2^64 - 1"),
    ("Points", "dp.Points([[0.5, 0.5, 0.5]])", "DappleError", "positions have the shape [1, 3], but the last axis must have 2 numbers, x first"),
    ("Points", "dp.Points([[1.5, 0.5]], dp.Domain(1, wrap=False))", "DappleError", "point 0 at [1.5, 0.5] is not in the domain"),
    ("Points.mean_neighbor_count", "some().mean_neighbor_count('far')", "TypeError", "must be real number, not str"),
    ("Points.normalized_density", "some().normalized_density('far')", "TypeError", "must be real number, not str"),
    ("spectrum", "dp.spectrum(dp.white_noise(dp.Domain(1), 0))", "DappleError", "there is no point, but at least one is needed"),
    ("spectrum", "dp.spectrum([some(), dp.white_noise(dp.Domain(2), 9)])", "DappleError", "one set is in the domain from [0, 0] of size [2, 2] that wraps along x and y: [true, true], but the first one in that"),
    ("spectrum", "dp.spectrum(some(), highest_frequency=1e6)", "DappleError", "the spectrum would have about 100000021213204 frequencies or rings, but the limit is 65536"),
    ("spectrum", "dp.spectrum(some(), ring_width=1e-6)", "DappleError", "the spectrum would have about 2000000 frequencies or rings, but the limit is 65536"),
    ("random_values", "dp.random_values(3, seed=-1)", "DappleError", "the seed is -1, but it must be from 0 to 2^64 - 1"),
    ("random_values", "dp.random_values(-3)", "OverflowError", "can't convert negative int to unsigned"),
    ("random_labels", "dp.random_labels(3, 0)", "DappleError", "the number of labels is 0, but it must be at least 1"),
    ("random_labels", "dp.random_labels(3, 2, seed=-1)", "DappleError", "the seed is -1, but it must be from 0 to 2^64 - 1"),
    ("random_labels", "dp.random_labels(-3, 2)", "OverflowError", "can't convert negative int to unsigned"),
    ("biased_labels", "dp.biased_labels(some(), 1.5)", "DappleError", "the probability of a label is 1.5, but it must be between 0 and 1"),
    ("grouped_labels", "dp.grouped_labels(dp.delaunay(some()), (0, 17))", "DappleError", "the number of points in a group is 0, but it must be 1 to 16, the least first"),
    ("grouped_labels", "dp.grouped_labels(dp.delaunay(some()), (4, 3))", "DappleError", "the number of points in a group is 3, but it must be 1 to 16, the least first"),
    ("reference_labels", "dp.reference_labels(some(), np.full((2, 2), 1.5))", "DappleError", "the intensity in the reference image is 1.5, but it must be between 0 and 1"),
    ("random_orientations", "dp.random_orientations(3, seed=-1)", "DappleError", "the seed is -1, but it must be from 0 to 2^64 - 1"),
    ("random_orientations", "dp.random_orientations(-3)", "OverflowError", "can't convert negative int to unsigned"),
    ("outward_orientations", "dp.outward_orientations(some(), (np.nan, 0))", "DappleError", "the center is NaN, but it must be finite"),
    ("angle_orientations", "dp.angle_orientations(some(), np.inf)", "DappleError", "the angle of an orientation is inf, but it must be finite"),
    ("Partition", "dp.Partition(twice())", "DappleError", "points 0 and 1 coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger"),
    ("Partition", "dp.Partition(some(), net={'weight': 'linear'})", "DappleError", "weight: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("Partition", "dp.Partition(some(), net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("Partition.field", "dp.Partition(some()).field([1.0, 2.0])", "DappleError", "there are 2 values, but 50 are needed"),
    ("Partition.field", "dp.Partition(some()).field([np.nan] * 50)", "DappleError", "the value of a control point is NaN, but it must be finite"),
    ("Partition.weights", "dp.Partition(some()).weights([1.0, 2.0, 3.0])", "DappleError", "positions have the shape [3], but the last axis must have 2 numbers, x first"),
    ("Partition.strongest", "dp.Partition(some()).strongest(0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("Partition.strongest", "dp.Partition(some()).strongest(4, extent=0)", "DappleError", "the origin is 0 and the extent 0 along an axis, but they must be finite, and the extent not 0"),
    ("Partition.strongest", "dp.Partition(some()).strongest(4, origin=np.nan)", "DappleError", "the origin is NaN and the extent 1 along an axis, but they must be finite, and the extent not 0"),
    ("Partition.strongest", "dp.Partition(some()).strongest(4, window=np.s_[0:2])", "DappleError", "the window is slice(0, 2, None), but it must be 2 slices, as in `np.s_[100:150, 33:94]`"),
    ("pups", "dp.pups(some(), [1.0, 2.0])", "DappleError", "there are 2 values, but 50 are needed"),
    ("pups", "dp.pups(some(), [np.nan] * 50)", "DappleError", "the value of a control point is NaN, but it must be finite"),
    ("pups", "dp.pups(twice(), [1.0, 2.0])", "DappleError", "points 0 and 1 coincide, but an axis needs a direction (positions are snapped to 2^-50 to 2^-49 of the domain's larger"),
    ("pups", "dp.pups(some(), [1.0] * 50, net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("cow_progression", "dp.cow_progression(distances=(0.0, 0.1))", "DappleError", "the radius at [0, 0] is NaN, but it must be above 0 and finite"),
    ("giraffe_progression", "dp.giraffe_progression(distances=(0.0, 0.1))", "DappleError", "the radius at [0, 0] is NaN, but it must be above 0 and finite"),
    ("Recipe", "dp.Recipe({'dapple': 1, 'nodes': {'a': {'worly': {}}}, 'material': {}})", "DappleError", "at `\"worly\": {}`: unknown variant `worly`, expected one of `worley`, `pups`, `wavelet`, `noise`, `bricks`,"),
    ("Recipe.from_toml", "dp.Recipe.from_toml('dapple =')", "DappleError", "line 1, column 9: string values must be quoted, expected literal string"),
    ("Recipe.from_toml", "dp.Recipe.from_toml('dapple = 1\\nextnt = 3\\n[material]\\n')", "DappleError", "line 2, column 1: unknown field `extnt`, expected one of `dapple`, `name`, `about`, `tags`, `seed`, `extent`, `wrap`, `nodes`,"),
    ("Recipe.from_json", "dp.Recipe.from_json('{')", "DappleError", "line 1, column 1: EOF while parsing an object"),
    ("Recipe.from_json", "dp.Recipe.from_json('{\"dapple\": 1, \"nodes\": {\"a\": {\"worly\": {}}}, \"material\": {}}')", "DappleError", "line 1, column 37: unknown variant `worly`, expected one of `worley`, `pups`, `wavelet`, `noise`, `bricks`,"),
    ("Recipe.builtin", "dp.Recipe.builtin('flagston')", "DappleError", "there is no built-in recipe `flagston`; did you mean `flagstone`?"),
    ("Recipe.reference", "dp.Recipe.reference('worly')", "DappleError", "the node is `worly`, but it must be one of worley, pups, wavelet, noise, bricks, weave, shape, output, gabor, scatter,"),
    ("Recipe.with_parameters", "dp.Recipe.builtin('rock').with_parameters(sise=2)", "DappleError", "`sise`"),
    ("Recipe.with_seed", "dp.Recipe.builtin('rock').with_seed(-1)", "DappleError", "the seed is -1, but it must be from 0 to 2^64 - 1"),
    ("Recipe.wgsl", "recipe('a.worley.value = \"f4\"').wgsl()", "DappleError", "the distances F3 and F4 have no shader"),
    ("Recipe.plan", "recipe('a.image.file = \"a.png\"').plan()", "DappleError", "in the node `a`: there is no image `a.png`"),
    ("Recipe.plan", "recipe('a.noise.octaves = 99').plan()", "DappleError", "in the node `a`: the number of octaves is 99, but it must be from 1 to 16"),
    ("Plan.bake", "plan().bake(0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("Plan.bake", "plan().bake(4, window=np.s_[0:9, 0:2])", "DappleError", "the end of the region is 9, but it must be within the tile, past its first pixel"),
    ("Plan.bake", "plan().bake(4, 'heigth')", "DappleError", "the map is `heigth`, but it must be one of height, normal, ao, curvature, albedo, roughness, metallic, orm, emission, opacity, specular, clearcoat; did you"),
    ("Plan.bake", "plan().bake(4, ['height', 'height'])", "DappleError", "the map `height` is asked for twice"),
    ("Plan.bake", "recipe('a.disturb = { input = 0.5, copies = [3, 3] }').plan().bake(64)", "DappleError", "in the node `a`: the number of pixels along a side of a copy is 21.333333333333332, but it must be a whole number (size"),
    ("Plan.field", "plan().field('b')", "DappleError", "there is no node `b`"),
    ("Plan.field", "recipe('a.color = \"#fff\"').plan().field('a')", "DappleError", "`a` is a color, but a number is needed"),
    ("Plan.field", "recipe('a.tile.input = 0.5').plan().field('a')", "DappleError", "in the node `a`: it sees the whole tile, which is not at hand at single positions; bake the node `tile` or `blend_map`"),
    ("Plan.field", "recipe('a.image.file = \"a.png\"').plan(images={'a.png': np.ones((2, 2))}).field('a')", "DappleError", "fields are made again from their description, which holds no images: bake the maps of this plan instead"),
    ("shards", "dp.shards(0, 4)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("shards", "dp.shards(4, (1, 2, 3))", "DappleError", "the size is (1, 2, 3), but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("synthesize", "dp.synthesize({'a': np.eye(16), 'b': np.eye(8)}, 32)", "DappleError", "the maps of an example have one size, but one has [8, 8] columns and rows, and the first [16, 16]"),
    ("synthesize", "dp.synthesize(np.eye(16), 32, matching={'levels': 99})", "DappleError", "the number of levels is 99, but it must be from 1 to 16, and none wider than the exemplar"),
    ("repair", "dp.repair(np.eye(32), np.eye(16))", "DappleError", "the raster has 32 × 32 pixels, but 16 × 16 are needed"),
    ("repair", "dp.repair(np.eye(32), np.ones((32, 32)))", "DappleError", "the mask leaves no neighborhood on level 2 of the exemplar"),
    ("repair", "dp.repair(np.eye(32), np.eye(32), matching={'levels': 99})", "DappleError", "the number of levels is 99, but it must be from 1 to 16"),
    ("set_threads", "dp.set_threads(-1)", "DappleError", "the number of threads is -1, but it must be a whole number from 0 to 1024"),
    ("set_threads", "dp.set_threads(1025)", "DappleError", "the number of threads is 1025, but it must be a whole number from 0 to 1024"),
    ("even_out", "dp.even_out(np.ones((4, 4)), 0.5)", "DappleError", "the radius of the light is 0.5, but it must be from 1 to 65536"),
    ("resize", "dp.resize(np.ones((4, 4)), 0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("rectify", "dp.rectify(np.ones((4, 4)), [(0, 0), (9, 0), (4, 4), (0, 4)])", "DappleError", "corner 2 at (9, 0) is outside of the image of 4 × 4 pixels"),
    ("rectify", "dp.rectify(np.ones((4, 4)), [(0, 0), (0, 4), (4, 4), (4, 0)])", "DappleError", "the corners must go clockwise around a convex quadrilateral, but the cross product of the sides at corner 1 is -16; at least 1 is needed"),
    ("estimate_material", "dp.estimate_material(np.ones((4, 4)))", "DappleError", "a photograph has three channels, in linear light"),
    ("estimate_material", "dp.estimate_material(np.ones((4, 4, 3)), slope=99.0)", "DappleError", "the slope is 99, but it must be from 0 to 10"),
    ("estimate_material", "dp.estimate_material(np.ones((4, 4, 3)), slop=1.0)", "DappleError", "options: `slop` is not one of `radius`, `coarseness`, `light`, `invert`, `slope`, `delight`, `roughness`, `variation`; did you mean `slope`?"),
    ("make_tile", "dp.make_tile({'a': np.eye(16), 'b': np.eye(8)})", "DappleError", "the raster has 8 × 8 pixels, but 16 × 16 are needed"),
    ("make_tile", "dp.make_tile(np.eye(64), method='poison')", "DappleError", "method poison: `poison` is not one of `periodic`, `poisson`, `soft_cut`, `spline_project`, `periodic_then_project`,"),
    ("make_tile", "dp.make_tile(np.eye(64), method='crossfade', overlap=999)", "DappleError", "method crossfade: `crossfade` is not one of `periodic`, `poisson`, `soft_cut`, `spline_project`,"),
    ("seam_report", "dp.seam_report(np.eye(64), source=np.ones((64, 64, 3)))", "DappleError", "the source has other maps or channels than the tile"),
    ("repeat", "dp.repeat(np.eye(4), 0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("disturb", "dp.disturb(np.eye(4), 64)", "DappleError", "a margin of 28 pixels is too wide for a side of 4; at most 2 are possible"),
    ("disturb", "dp.disturb(np.eye(64), 0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("disturb", "dp.disturb(np.eye(64), 64, margin=99)", "DappleError", "a margin of 103 pixels is too wide for a side of 64; at most 32 are possible"),
    ("match_borders", "dp.match_borders([np.eye(64), np.eye(32)])", "DappleError", "the raster has 64 × 64 pixels, but 32 × 32 are needed"),
    ("match_borders", "dp.match_borders([np.eye(64)], width=0)", "DappleError", "the width is 0, but it must be at least 1"),
    ("lay_tiles", "dp.lay_tiles([], 64)", "DappleError", "there are 0 tiles, but at least 1 is needed"),
    ("lay_tiles", "dp.lay_tiles([np.eye(64), np.eye(32)], 64)", "DappleError", "the raster has 64 × 64 pixels, but 32 × 32 are needed"),
    ("lay_tiles", "dp.lay_tiles([np.eye(64)], 0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("CornerTiles", "dp.CornerTiles([])", "DappleError", "there are 0 sources, but at least 1 is needed"),
    ("CornerTiles", "dp.CornerTiles([np.eye(64), np.eye(32)])", "DappleError", "the raster has 64 × 64 pixels, but 32 × 32 are needed"),
    ("CornerTiles", "dp.CornerTiles([np.eye(64)] * 2, width=2.0)", "DappleError", "the width of the cuts is 2, but it must be above 0, at most 1"),
    ("CornerTiles.tile", "dp.CornerTiles([np.eye(64)] * 2).tile((0, 1, 2, 0))", "DappleError", "the corner color is 2, but it must be the index of a source"),
    ("CornerTiles.render", "dp.CornerTiles([np.eye(64)] * 2).render(0)", "DappleError", "the size is 0, but it must be a whole number of at least 1, or 2 numbers, rows before columns"),
    ("CornerTiles.render", "dp.CornerTiles([np.eye(64)] * 2).render(8, first=(2**70, 0))", "OverflowError", "Python int too large to convert to C"),
    ("rank_equalize", "dp.rank_equalize(np.ones((2, 2, 3)))", "DappleError", "the values has 3 channels, but 1 is needed"),
    ("rank_equalize", "dp.rank_equalize(np.full((2, 2), np.nan))", "DappleError", "the pixel in column 0 and row 0 is NaN, but all must be finite"),
    ("noise", "dp.noise(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("octaves", "dp.octaves(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("turbulence", "dp.turbulence(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("cells", "dp.cells(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("cellular_noise", "dp.cellular_noise(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("color_noise", "dp.color_noise(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("label_ramp", "dp.label_ramp(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("cow", "dp.cow(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("space_giraffe", "dp.space_giraffe(spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("noise", "dp.noise(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("octaves", "dp.octaves(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("turbulence", "dp.turbulence(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("cells", "dp.cells(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("cellular_noise", "dp.cellular_noise(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("color_noise", "dp.color_noise(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("label_ramp", "dp.label_ramp(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("cow", "dp.cow(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("space_giraffe", "dp.space_giraffe(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("cow_progression", "dp.cow_progression(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("giraffe_progression", "dp.giraffe_progression(net={'axis_scale': 99})", "DappleError", "the axis scale is 99, but it must be above 0.5 and at most 16"),
    ("noise", "dp.noise(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("octaves", "dp.octaves(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("turbulence", "dp.turbulence(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("cells", "dp.cells(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("cellular_noise", "dp.cellular_noise(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("color_noise", "dp.color_noise(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("label_ramp", "dp.label_ramp(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("cow", "dp.cow(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("space_giraffe", "dp.space_giraffe(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("cow_progression", "dp.cow_progression(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("giraffe_progression", "dp.giraffe_progression(net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("reference_texture", "dp.reference_texture(np.eye(4), spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("reference_texture", "dp.reference_texture(np.eye(4), net={'weight': 'linear'})", "DappleError", "options: `linear` is not one of `cubic`, `quintic`, `oscillating`"),
    ("iterated_reference", "dp.iterated_reference(np.eye(4), spacing=0.0)", "DappleError", "the radius is 0, but it must be above 0 and finite"),
    ("iterated_reference", "dp.iterated_reference(np.eye(4), iterations=99)", "DappleError", "the number of iterations is 99, but it must be from 1 to 16"),
    ("control_points", "dp.control_points([])", "DappleError", "there is no control point"),
    ("control_points", "dp.control_points([{'x': 9.0, 'y': 0.5, 'value': 1.0}], dp.Domain(1, wrap=False))", "DappleError", "point 0 at [9, 0.5] is not in the domain"),
    ("read_recipe", "dp.read_recipe(path('text.toml'))", "DappleError", "line 2, column 1: unknown field `extnt`, expected one of `dapple`, `name`, `about`, `tags`, `seed`, `extent`, `wrap`, `nodes`,"),
    ("read_recipe_images", "dp.read_recipe_images(recipe('a.image.file = \"clear.png\"'), path(''))", "DappleError", "/clear.png is partly transparent, which is not possible here: give its node alpha = \"drop\" or alpha = \"over:#rrggbb\""),
    ("read_recipe_images", "dp.read_recipe_images(recipe('a.image.file = \"text.png\"'), path(''))", "DappleError", "/text.png: the bytes are of no format that is known here"),
    ("read_recipe_images", "dp.read_recipe_images(recipe('a.image.file = \"none.png\"'), path(''))", "FileNotFoundError", "No such file or directory"),
]


@pytest.mark.parametrize(("call", "error", "message"), [row[1:] for row in CALLS], ids=[row[1] for row in CALLS])
def test_calls_raise_what_their_docstrings_say(call, error, message, path):
    with pytest.raises(Exception) as caught:  # noqa: PT011
        eval(call, globals() | {"path": path})
    assert type(caught.value).__name__ == error
    assert message in str(caught.value)


def documented():
    """The names of the errors in the docstring of each function, class and method of the package."""
    found = {}
    for name, thing in vars(dp).items():
        if name.startswith("_") or not (inspect.isclass(thing) or callable(thing)):
            continue
        members = {name: thing}
        if inspect.isclass(thing):
            members |= {f"{name}.{member}": getattr(thing, member) for member in vars(thing) if not member.startswith("_")}
        for member, value in members.items():
            section = re.search(r"^Raises\n------\n(.*?)(?=^\w+\n---|\Z)", inspect.getdoc(value) or "", re.DOTALL | re.MULTILINE)
            if section:
                found[member] = set(re.findall(r"^(\w+)$", section[1], re.MULTILINE))
    return found


def test_every_documented_error_has_a_call_and_no_other_is_raised():
    raised = {}
    for name, _, error, _ in CALLS:
        # The documentation names the class of all errors of files.
        is_of_file = issubclass(getattr(builtins, error, ValueError), OSError)
        raised.setdefault(name, set()).add("OSError" if is_of_file else error)
    assert raised == documented()
