"""Makes the extension: `python build.py WHEEL… [-o ZIP]`, with a wheel of `dapple-textures` for each platform."""

from __future__ import annotations

import argparse
import zipfile
from pathlib import Path

HERE = Path(__file__).parent

#: Blender's names of platforms, by what a wheel's name ends with.
PLATFORMS = {
    "manylinux": "linux-x64",
    "linux_x86_64": "linux-x64",
    "macosx_11_0_arm64": "macos-arm64",
    "macosx_10_12_x86_64": "macos-x64",
    "win_amd64": "windows-x64",
    "win_arm64": "windows-arm64",
}


def build(wheels: list[Path], output: Path) -> None:
    """Writes the extension with these wheels."""
    platforms = sorted({place for wheel in wheels for part, place in PLATFORMS.items() if part in wheel.name})
    if not wheels or not platforms:
        raise SystemExit(f"no wheel of a platform that Blender has: {', '.join(PLATFORMS)}")
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
