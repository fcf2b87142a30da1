"""Image files: what is written comes back, atomically, as the command writes it."""

import os
import pickle
import shutil
import struct
import subprocess
import warnings

import numpy as np
import pytest
from PIL import Image

import dapple_textures as dp

RNG = np.random.default_rng(5)
GRAY = RNG.random((13, 21), np.float32)
COLOR = RNG.random((13, 21, 3), np.float32)
ALPHA = RNG.random((13, 21, 4), np.float32)
NORMAL = dp.normal_map(GRAY, relief=0.02)
COMMAND = os.environ.get("DAPPLE") or shutil.which("dapple")

#: The array, what it holds, the ending, the depth, and how far it may come back from where it was.
FILES = [
    (GRAY, "gray", "png", 16, 1 / 65535),
    (GRAY, "gray", "png", 8, 1 / 255),
    (COLOR, "color", "png", 16, 2e-5),
    (COLOR, "color", "png", 8, 5e-3),
    (ALPHA, "color", "png", 16, 2e-5),
    (NORMAL, "normal", "png", 16, 1e-4),
    (COLOR, "data", "png", 16, 1 / 65535),
    (ALPHA, "data", "png", 8, 1 / 255),
    (100 * GRAY - 50, "gray", "exr", None, 0),
    (100 * COLOR, "color", "exr", None, 0),
    (ALPHA, "color", "exr", None, 1e-6),
    (NORMAL, "normal", "exr", None, 1e-4),
    (-COLOR, "data", "exr", None, 0),
    (-ALPHA, "data", "exr", None, 0),
]


@pytest.mark.parametrize(("array", "content", "ending", "depth", "error"), FILES)
def test_arrays_come_back_from_files(tmp_path, array, content, ending, depth, error):
    path = tmp_path / f"a.{ending.upper()}"
    dp.write_image(path, array, content=content, depth=depth)
    back = dp.read_image(path, content=content)
    assert back.shape == array.shape and back.dtype == np.float32
    np.testing.assert_allclose(back, array, atol=error, rtol=0)
    assert os.listdir(tmp_path) == [path.name]
    data = path.read_bytes()
    assert data == dp.encode_image(array, ending, content=content, depth=depth)
    np.testing.assert_array_equal(dp.decode_image(data, content=content), back)
    # In other orders and types the same bytes.
    turned = np.asfortranarray(array.astype(np.float64))
    turned.flags.writeable = False
    assert dp.encode_image(turned, ending, content=content, depth=depth) == data


def test_codes_are_those_that_pillow_reads():
    png = Image.open(__import__("io").BytesIO(dp.encode_image(COLOR)))
    np.testing.assert_array_equal(np.asarray(png), dp.srgb_from_linear(COLOR))
    png = Image.open(__import__("io").BytesIO(dp.encode_image(GRAY)))
    np.testing.assert_array_equal(np.asarray(png), np.round(GRAY.astype(float) * 65535))


def test_numpy_arrays_and_raw_heights(tmp_path):
    for array in (GRAY, COLOR, ALPHA, NORMAL):
        dp.write_image(tmp_path / "a.npy", array, content="normal" if array is NORMAL else None)
        np.testing.assert_array_equal(np.load(tmp_path / "a.npy"), array)
    dp.write_image(tmp_path / "a.r16", GRAY)
    raw = np.fromfile(tmp_path / "a.r16", "<u2").reshape(GRAY.shape)
    np.testing.assert_array_equal(raw, np.round(GRAY.astype(float) * 65535))


def test_alpha_goes_where_it_is_asked_to():
    data = dp.encode_image(ALPHA, depth=16)
    stored = dp.decode_image(data)
    np.testing.assert_array_equal(dp.decode_image(data, alpha="drop"), stored[..., :3])
    over = dp.decode_image(data, alpha="over:#ffffff")
    alpha = stored[..., 3:]
    np.testing.assert_allclose(over, stored[..., :3] * alpha + (1 - alpha), atol=1e-6)
    opaque = dp.encode_image(COLOR)
    assert dp.decode_image(opaque).shape == COLOR.shape
    assert (dp.decode_image(opaque, alpha="keep")[..., 3] == 1).all()
    assert dp.decode_image(dp.encode_image(GRAY), alpha="keep").shape == (*GRAY.shape, 4)
    assert dp.decode_image(dp.encode_image(GRAY), content="color").shape == (*GRAY.shape, 3)


def exr(channels):
    """The bytes of an OpenEXR file of single precision without compression, with channels of these names."""
    names = sorted(channels)
    rows, columns = channels[names[0]].shape
    head = [("channels", "chlist", b"".join(name.encode() + struct.pack("<xiB3xii", 2, 0, 1, 1) for name in names) + b"\0")]
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    head += [("compression", "compression", b"\0"), ("dataWindow", "box2i", window), ("displayWindow", "box2i", window)]
    head += [("lineOrder", "lineOrder", b"\0"), ("pixelAspectRatio", "float", struct.pack("<f", 1))]
    head += [("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)), ("screenWindowWidth", "float", struct.pack("<f", 1))]
    data = struct.pack("<2I", 20000630, 2)
    data += b"".join(f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value for name, kind, value in head) + b"\0"
    size = 4 * len(names) * columns
    data += struct.pack(f"<{rows}Q", *(len(data) + 8 * rows + row * (8 + size) for row in range(rows)))
    for row in range(rows):
        data += struct.pack("<2i", row, size) + b"".join(channels[name][row].astype("<f4").tobytes() for name in names)
    return data


def test_layers_are_chosen_by_name(tmp_path):
    channels = {f"ViewLayer.Combined.{name}": ALPHA[..., at] for at, name in enumerate("RGBA")}
    channels |= {f"ViewLayer.DiffCol.{name}": COLOR[..., at] for at, name in enumerate("RGB")}
    data = exr(channels | {"ViewLayer.Depth.Z": GRAY})
    (tmp_path / "a.exr").write_bytes(data)
    for read, source in ((dp.read_image, tmp_path / "a.exr"), (dp.decode_image, data)):
        np.testing.assert_array_equal(read(source, layer="ViewLayer.DiffCol"), COLOR)
        np.testing.assert_array_equal(read(source, layer="ViewLayer.Depth"), GRAY)
        np.testing.assert_array_equal(read(source, content="data", layer="ViewLayer.DiffCol"), COLOR)
        assert read(source).shape == ALPHA.shape
        with pytest.raises(dp.DappleError, match="ViewLayer.DiffCol") as error:
            read(source, layer="ViewLayer.DiffColor")
        assert error.value.kind == "missing_layer"
    with pytest.raises(dp.DappleError) as error:
        dp.decode_image(dp.encode_image(COLOR), layer="Combined")
    assert error.value.kind == "no_layers"


def of_recipe(folder, data, **options):
    """What a recipe gets from an image node with these options."""
    (folder / "a.exr").write_bytes(data)
    image = {"image": {"file": "a.exr", **options}}
    recipe = dp.Recipe({"dapple": 1, "nodes": {"a": image}, "material": {"albedo": "a"}})
    return dp.read_recipe_images(recipe, folder)["a.exr"]


def test_recipes_get_several_layers_of_a_file(tmp_path):
    channels = {f"a.{name}": COLOR[..., at] for at, name in enumerate("RGB")}
    (tmp_path / "a.exr").write_bytes(exr(channels | {"depth.Z": GRAY}))
    nodes = {name: {"image": {"file": "a.exr", "layer": name}} for name in ("a", "depth")}
    material = {"albedo": "a", "height": "depth"}
    recipe = dp.Recipe({"dapple": 1, "nodes": nodes, "material": material})
    images = dp.read_recipe_images(recipe, tmp_path)
    assert set(images) == {("a.exr", "a"), ("a.exr", "depth")}
    plan = recipe.plan(images=images)
    maps = plan.bake(COLOR.shape[:2], ["albedo", "height"])
    np.testing.assert_array_equal(maps["albedo"], COLOR)
    np.testing.assert_array_equal(maps["height"], GRAY)
    again = pickle.loads(pickle.dumps(plan))
    assert again == plan
    with pytest.raises(dp.DappleError, match="with the layer `depht`"):
        recipe.plan(images=images | {("a.exr", "depht"): GRAY})


def test_recipes_get_layers_and_drop_alpha_of_openexr(tmp_path):
    half = np.full_like(GRAY, 0.5)
    colors = {name: COLOR[..., at] for at, name in enumerate("RGB")}
    layer = exr({"Y": GRAY} | {f"light.{name}": values for name, values in colors.items()})
    np.testing.assert_array_equal(of_recipe(tmp_path, layer), GRAY)
    np.testing.assert_array_equal(of_recipe(tmp_path, layer, layer="light"), COLOR)
    # OpenEXR stores colors and numbers multiplied by alpha.
    np.testing.assert_array_equal(of_recipe(tmp_path, exr(colors | {"A": half}), alpha="drop"), 2 * COLOR)
    np.testing.assert_array_equal(of_recipe(tmp_path, exr({"Y": GRAY, "A": half}), alpha="drop"), 2 * GRAY)
    # Light that covers nothing, as of a flame, is added to what lies below.
    np.testing.assert_array_equal(of_recipe(tmp_path, exr(colors | {"A": 0 * GRAY}), alpha="over:#ffffff"), COLOR + 1)
    with pytest.raises(dp.DappleError) as error:
        of_recipe(tmp_path, exr(colors | {"A": half}))
    assert error.value.kind == "alpha"
    colors["G"] = np.where(np.arange(21) == 4, np.nan, colors["G"])
    with pytest.raises(dp.DappleError, match="column 4 and row 0") as error:
        of_recipe(tmp_path, exr(colors))
    assert error.value.kind == "not_finite"


def test_photographs_are_read_and_gray_with_alpha(tmp_path):
    smooth = np.linspace(0, 255, 32).astype(np.uint8)[None, :, None].repeat(16, 0).repeat(3, 2)
    Image.fromarray(smooth).save(tmp_path / "a.jpg", quality=98)
    np.testing.assert_allclose(dp.read_image(tmp_path / "a.jpg"), dp.linear_from_srgb(smooth), atol=0.03)
    Image.fromarray(smooth[..., :2], "LA").save(tmp_path / "la.png")
    np.testing.assert_allclose(dp.read_image(tmp_path / "la.png", content="data"), smooth[..., :2] / 255, atol=1e-6)
    assert dp.read_image(tmp_path / "la.png").shape == (16, 32, 4)


@pytest.mark.parametrize("name", ["a.tif", "a.tga", "a.webp"])
@pytest.mark.parametrize("mode", ["RGB", "RGBA"])
def test_formats_that_are_only_read_have_the_codes_of_pillow(tmp_path, name, mode):
    codes = RNG.integers(0, 256, (5, 7, len(mode)), dtype=np.uint8)
    options = {"lossless": True, "exact": True} if name == "a.webp" else {}
    Image.fromarray(codes, mode).save(tmp_path / name, **options)
    np.testing.assert_array_equal(dp.read_image(tmp_path / name, content="data"), codes / np.float32(255))


def test_heights_are_read_from_floating_point_tiff_and_radiance_hdr(tmp_path):
    heights = RNG.normal(0, 1000, (5, 7)).astype(np.float32)
    Image.fromarray(heights).save(tmp_path / "a.tif")
    np.testing.assert_array_equal(dp.read_image(tmp_path / "a.tif"), heights)
    pixel = dp.decode_image(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + bytes([128, 64, 0, 137]))
    np.testing.assert_array_equal(pixel, [[[256, 128, 0]]])


@pytest.mark.skipif(COMMAND is None, reason="the command dapple is not on PATH")
@pytest.mark.parametrize(("array", "content", "ending", "depth", "error"), FILES)
def test_bytes_are_those_of_the_command(tmp_path, array, content, ending, depth, error):
    """Two copies are joined by the command; it reads what we write, and we write what it reads."""
    if content == "data" or error > 1e-3:
        pytest.skip("the command does not copy such files as they are")
    source, copy = tmp_path / f"in.{ending}", tmp_path / f"out.{ending}"
    dp.write_image(source, array, content=content, depth=depth)
    image = ["--normal", str(source)] if content == "normal" else [str(source)]
    depth = [] if depth is None else ["--format", f"png{depth}"]
    # A tile of an image along no seam that is cut: its mirror image, whose first half is the image.
    subprocess.run([COMMAND, "tile", *image, "--method", "mirror", "-o", str(copy), *depth, "-q"], check=True)
    ours = dp.read_image(source, content=content)
    if content == "normal":
        ours = dp.make_tile({"normal": ours}, method="mirror")["normal"]
    else:
        ours = dp.make_tile(ours, method="mirror")
    bits = int(depth[1][3:]) if depth else None
    assert copy.read_bytes() == dp.encode_image(ours, ending, content=content, depth=bits)


#: A tenth of the pixels are outside of the range from 0 to 1: half of them below, half above.
BEYOND = np.concatenate([np.full(10, -0.5), np.full(10, 1.5), np.linspace(0, 1, 180)]).reshape(10, 20)


@pytest.mark.parametrize("ending", ["png", "r16"])
def test_the_share_of_clipped_pixels_is_warned_of(tmp_path, ending):
    path = tmp_path / f"a.{ending}"
    with pytest.warns(dp.DappleWarning, match=r"10\.0 % of the pixels of .*a\.(png|r16) are below 0 or above 1") as seen:
        dp.write_image(path, BEYOND)
    assert path.exists() and seen[0].filename == __file__
    # A pixel counts once, however many of its channels are clipped.
    with pytest.warns(dp.DappleWarning, match=r"10\.0 % of the pixels of the image"):
        dp.encode_image(np.stack([BEYOND] * 4, axis=-1))
    with pytest.warns(dp.DappleWarning, match=r"10\.0 % of the pixels of .*height\.png"):
        dp.write_maps(tmp_path, {"height": BEYOND, "ao": np.zeros((2, 2))})


def test_a_warning_made_an_error_leaves_the_old_file(tmp_path):
    path = tmp_path / "a.png"
    dp.write_image(path, GRAY)
    before = path.read_bytes()
    with warnings.catch_warnings():
        warnings.simplefilter("error", dp.DappleWarning)
        with pytest.raises(dp.DappleWarning):
            dp.write_image(path, BEYOND)
    assert path.read_bytes() == before


def test_what_is_kept_or_hardly_clipped_is_not_warned_of(tmp_path):
    few = np.zeros((10, 20))
    few[0, 0] = 2
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # One pixel of 200, half a code of 16 bits, formats of floating point, and unit vectors.
        dp.write_image(tmp_path / "a.png", few)
        dp.write_image(tmp_path / "a.png", np.full((4, 4), 1 + 0.4 / 65535))
        dp.write_image(tmp_path / "a.exr", BEYOND)
        dp.write_image(tmp_path / "a.npy", BEYOND)
        dp.write_image(tmp_path / "a.png", NORMAL, content="normal")


def test_files_are_replaced_as_a_whole(tmp_path):
    path, link = tmp_path / "a.png", tmp_path / "link.png"
    path.write_bytes(b"old")
    path.chmod(0o640)
    link.symlink_to(path)
    dp.write_image(link, GRAY)
    assert link.is_symlink() and path.stat().st_mode & 0o777 == 0o640
    assert sorted(os.listdir(tmp_path)) == ["a.png", "link.png"]
    old = path.read_bytes()
    with pytest.raises(dp.DappleError):
        dp.write_image(path, np.full((4, 4), 0.5), depth=12)
    assert path.read_bytes() == old
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(OSError) as error:
        dp.write_image(tmp_path / "folder.png", GRAY)
    assert "folder.png" in str(error.value)
    assert sorted(os.listdir(tmp_path)) == ["a.png", "folder.png", "link.png"]


@pytest.mark.parametrize(
    ("call", "kind"),
    [
        (lambda: dp.decode_image(b"GIF89a"), "unknown_format"),
        (lambda: dp.decode_image(dp.encode_image(GRAY), max_pixels=10), "too_many_pixels"),
        (lambda: dp.decode_image(dp.encode_image(GRAY), content="colour"), "name"),
        (lambda: dp.decode_image(dp.encode_image(GRAY), content="normal"), "channels"),
        (lambda: dp.decode_image(dp.encode_image(COLOR), content="gray"), "channels"),
        (lambda: dp.decode_image(dp.encode_image(COLOR), alpha="under"), "options"),
        (lambda: dp.encode_image(COLOR, "jpg"), "format"),
        (lambda: dp.encode_image(COLOR, "exr", depth=16), "depth"),
        (lambda: dp.encode_image(COLOR, "r16"), None),
        (lambda: dp.encode_image(COLOR, content="gray"), "channels"),
        (lambda: dp.encode_image(np.zeros((4, 4, 2))), "channels"),
        (lambda: dp.encode_image(np.zeros((4, 4), np.uint8)), "type"),
        (lambda: dp.encode_image(np.zeros((0, 4))), None),
        (lambda: dp.write_image("noending", GRAY), "format"),
    ],
)
def test_what_cannot_be_is_refused(call, kind):
    with pytest.raises(dp.DappleError) as error:
        call()
    assert error.value.kind == kind or kind is None


def test_no_bytes_panic():
    for array, content, ending, depth, _ in FILES:
        data = bytearray(dp.encode_image(array, ending, content=content, depth=depth))
        for _ in range(20):
            broken = bytearray(data)
            for at in RNG.integers(0, len(data), 3):
                broken[at] ^= int(RNG.integers(1, 256))
            try:
                dp.decode_image(bytes(broken[: int(RNG.integers(1, len(data) + 1))]))
            except dp.DappleError:
                pass
