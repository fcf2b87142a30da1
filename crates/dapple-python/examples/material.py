"""Bakes a built-in material into a folder: its maps as PNG files, and a picture of it in the light of a lamp.

    python material.py flagstone out/ 1024
"""

import sys
from pathlib import Path

import numpy as np

import dapple_textures as dp

name, folder, size = (sys.argv[1:] + ["flagstone", "out", "1024"][len(sys.argv) - 1 :])[:3]
place = Path(folder)
place.mkdir(parents=True, exist_ok=True)

maps = dp.Recipe.builtin(name).plan().bake(int(size), ["height", "normal", "ao", "albedo", "roughness", "orm"])
for plane, pixels in maps.items():
    dp.write_image(place / f"{name}_{plane}.png", pixels, content={"normal": "normal", "orm": "data"}.get(plane))

lamp = np.array([-0.45, 0.45, 0.77])
light = np.clip(maps["normal"] @ lamp, 0, 1) * maps["ao"] * 2
dp.write_image(place / f"{name}_lit.png", maps["albedo"] * light[..., None])
print(*sorted(str(path) for path in place.glob(f"{name}_*.png")), sep="\n")
