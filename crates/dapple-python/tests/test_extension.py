"""The file of the extension for Blender, which is made without it."""

from __future__ import annotations

import runpy
import tomllib
import zipfile
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / "blender/build.py"
if not SCRIPT.is_file():
    pytest.skip("the extension is in the repository", allow_module_level=True)
SCRIPT_NAMES = runpy.run_path(str(SCRIPT))
build, platform_of = SCRIPT_NAMES["build"], SCRIPT_NAMES["platform_of"]


def wheel(folder, platform):
    path = folder / f"dapple_textures-0.1.0-cp311-abi3-{platform}.whl"
    path.write_bytes(b"a wheel")
    return path


def test_the_extension_holds_its_wheels(tmp_path):
    wheels = [wheel(tmp_path, "manylinux_2_17_x86_64.manylinux2014_x86_64"), wheel(tmp_path, "win_amd64")]
    build(wheels, tmp_path / "panel.zip")
    with zipfile.ZipFile(tmp_path / "panel.zip") as extension:
        manifest = tomllib.loads(extension.read("blender_manifest.toml").decode())
        assert manifest["wheels"] == [f"./wheels/{wheel.name}" for wheel in wheels]
        assert manifest["platforms"] == ["linux-x64", "windows-x64"]
        assert extension.read(f"wheels/{wheels[0].name}") == b"a wheel"


@pytest.mark.parametrize(
    ("tag", "platform"),
    [
        ("manylinux_2_28_x86_64", "linux-x64"),
        ("linux_x86_64", "linux-x64"),
        ("macosx_11_0_arm64", "macos-arm64"),
        ("macosx_10_12_x86_64", "macos-x64"),
        ("win_arm64", "windows-arm64"),
    ],
)
def test_a_wheel_is_for_its_platform(tmp_path, tag, platform):
    assert platform_of(wheel(tmp_path, tag)) == platform


@pytest.mark.parametrize("tag", ["manylinux_2_28_aarch64", "musllinux_1_2_x86_64", "linux_aarch64", "any"])
def test_wheels_that_blender_has_no_platform_for_are_refused(tmp_path, tag):
    with pytest.raises(SystemExit, match="no platform"):
        build([wheel(tmp_path, "win_amd64"), wheel(tmp_path, tag)], tmp_path / "panel.zip")
    assert not (tmp_path / "panel.zip").exists()


def test_an_extension_without_wheels_is_refused(tmp_path):
    with pytest.raises(SystemExit, match="no wheel"):
        build([], tmp_path / "none.zip")
