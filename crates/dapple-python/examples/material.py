"""Bakes a built-in material into a folder: its maps as PNG files, and a preview lit by one lamp.

    python material.py flagstone out/ 1024
"""

import sys
from pathlib import Path

import numpy as np

import dapple_textures as dp

name, folder, size = (sys.argv[1:] + ["flagstone", "out", "1024"][len(sys.argv) - 1 :])[:3]

maps = dp.Recipe.builtin(name).plan().bake(int(size), ["height", "normal", "ao", "albedo", "roughness", "orm"])
paths = dp.write_maps(folder, maps, name=name)

lamp = np.array([-0.45, 0.45, 0.77])
light = np.clip(maps["normal"] @ lamp, 0, 1) * maps["ao"] * 2
paths.append(Path(folder, f"{name}_lit.png"))
dp.write_image(paths[-1], maps["albedo"] * light[..., None])
print(*sorted(paths), sep="\n")
