"""Builds the Blender extension: `python build.py WHEEL… [-o ZIP]`, with a wheel of `dapple-textures` for each platform."""

from __future__ import annotations

import argparse
import re
import zipfile
from pathlib import Path

HERE = Path(__file__).parent

#: Blender's names of platforms, by the part of a wheel's name that says for which one it is.
PLATFORMS = {
    r"manylinux\w*_x86_64(\.|$)": "linux-x64",
    r"linux_x86_64$": "linux-x64",
    r"macosx_\d+_\d+_arm64$": "macos-arm64",
    r"macosx_\d+_\d+_x86_64$": "macos-x64",
    r"win_amd64$": "windows-x64",
    r"win_arm64$": "windows-arm64",
}


def platform_of(wheel: Path) -> str:
    """Returns Blender's name of the platform of a wheel."""
    tag = wheel.stem.rsplit("-", 1)[-1]
    for pattern, platform in PLATFORMS.items():
        if re.match(pattern, tag):
            return platform
    raise SystemExit(f"{wheel.name} is a wheel of no platform that Blender has: {', '.join(sorted(set(PLATFORMS.values())))}")


def build(wheels: list[Path], output: Path) -> None:
    """Writes the extension file with the given wheels."""
    if not wheels:
        raise SystemExit("no wheel is given")
    platforms = sorted({platform_of(wheel) for wheel in wheels})
    manifest = (HERE / "blender_manifest.toml").read_text(encoding="utf-8")
    listed = "".join(f'    "./wheels/{wheel.name}",\n' for wheel in wheels)
    manifest = manifest.replace(
        "wheels = []", f"platforms = {platforms}\nwheels = [\n{listed}]".replace("'", '"')
    )
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED) as extension:
        extension.writestr("blender_manifest.toml", manifest)
        extension.write(HERE / "__init__.py", "__init__.py")
        for wheel in wheels:
            extension.write(wheel, f"wheels/{wheel.name}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheels", nargs="+", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=Path("dapple_textures_panel.zip"))
    options = parser.parse_args()
    build(options.wheels, options.output)
