//! The step `exchange`: bakes materials for other programs and checks them with these programs.
//!
//! A glTF plane goes to Khronos' validator, a MaterialX document to the MaterialX library, and an array to NumPy. Each
//! check runs if its program is installed, and is reported as skipped otherwise. They need Node with the package
//! `gltf-validator`, and Python with `MaterialX` and `numpy`. The environment variables `NODE_PATH` and `PYTHON` name
//! them if they are not in the usual places.

use anyhow::Context;
use std::path::{Path, PathBuf};
use xshell::{Cmd, Shell, cmd};

/// A script that validates a GLB file. It fails on errors and warnings.
const VALIDATE_GLB: &str = "
const { validateBytes } = require('gltf-validator');
const bytes = new Uint8Array(require('fs').readFileSync(process.argv[1]));
// Tangents are left to those who show it, as the specification has it (3.7.2.1).
const options = { ignoredIssues: ['MESH_PRIMITIVE_GENERATED_TANGENT_SPACE'] };
validateBytes(bytes, options).then(report => {
  const { numErrors, numWarnings, messages } = report.issues;
  console.log(`glTF: ${numErrors} errors, ${numWarnings} warnings`);
  if (numErrors + numWarnings > 0) { console.log(messages); process.exit(1); }
});
";

/// A script that validates a MaterialX document and generates a shader for its material.
const VALIDATE_MTLX: &str = "
import sys, MaterialX as mx
from MaterialX import PyMaterialXGenShader as shader, PyMaterialXGenGlsl as glsl
path = mx.getDefaultDataSearchPath()
library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), path, library)
document = mx.createDocument()
mx.readFromXmlFile(document, sys.argv[1])
document.importLibrary(library)
valid, message = document.validate()
assert valid, message
generator = glsl.GlslShaderGenerator.create()
colors = shader.DefaultColorManagementSystem.create(generator.getTarget())
colors.loadLibrary(library)
generator.setColorManagementSystem(colors)
context = shader.GenContext(generator)
context.registerSourceCodeSearchPath(path)
[material] = shader.findRenderableElements(document)
source = generator.generate('material', material, context).getSourceCode(shader.PIXEL_STAGE)
call = next(line for line in source.splitlines() if line.strip().startswith('NG_standard_surface'))
for name in ['base_color_out_cm_out', 'roughness_out', 'metallic_out', 'normal_out', 'emission_out_cm_out',
             'opacity_out', 'specular_out', 'clearcoat_out']:
    assert ' ' + name + ',' in call, (name, call)
assert 'NG_srgb_texture_to_lin_rec709_color3(base_color_out' in source
print('MaterialX: valid, with a shader of', len(source.splitlines()), 'lines')
";

/// A recipe with all maps, for files that contain a whole material.
const RECIPE: &str = "
dapple = 1
[nodes.cells.worley]
frequency = 4
[nodes.glow.ramp]
input = 'cells'
colors = ['#000000', '#ff8000']
[material]
height = 'cells'
albedo = 'glow'
roughness = 'cells'
metallic = 'cells'
emission = 'glow'
emission_strength = 3.0
opacity = 'cells'
opacity_cutoff = 0.25
specular = 'cells'
clearcoat = 'cells'
";

/// A script that reads a NumPy array.
const READ_NPY: &str = "
import sys, numpy
array = numpy.load(sys.argv[1], allow_pickle=False)
assert array.dtype == numpy.float32 and array.shape == (40, 64, 3), (array.dtype, array.shape)
assert array.flags['C_CONTIGUOUS'] and numpy.isfinite(array).all() and array.std() > 0
print('NumPy:', array.shape, array.dtype)
";

/// A program that checks a file.
struct Judge {
    /// Description of the program's requirements, for messages.
    needs: &'static str,
    /// The program and its arguments, without the code.
    program: Vec<String>,
    /// Code that fails if the requirements are not installed.
    probe: &'static str,
    code: &'static str,
    file: &'static str,
}

/// Bakes a material for each installed checker, and runs the check.
pub(super) fn exchange(shell: &Shell) -> anyhow::Result<()> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let python = || vec![python.clone(), "-c".to_owned()];
    let judges = [
        Judge {
            needs: "node with gltf-validator",
            program: vec!["node".to_owned(), "-e".to_owned()],
            probe: "require('gltf-validator')",
            code: VALIDATE_GLB,
            file: "rock.glb",
        },
        Judge {
            needs: "Python with MaterialX",
            program: python(),
            probe: "import MaterialX",
            code: VALIDATE_MTLX,
            file: "rock.mtlx",
        },
        Judge {
            needs: "Python with NumPy",
            program: python(),
            probe: "import numpy",
            code: READ_NPY,
            file: "rock.npy",
        },
    ];
    // Report judges that are not installed.
    let (here, missing): (Vec<_>, Vec<_>) = judges.iter().partition(|judge| judge.is_here(shell));
    for judge in missing {
        crate::say(&format!("skipped: there is no {}", judge.needs));
    }
    if here.is_empty() {
        return Ok(());
    }
    let dapple = command_of_tests(shell)?;
    let folder = shell.create_temp_dir()?;
    let recipe = folder.path().join("all.toml");
    shell.write_file(&recipe, RECIPE)?;
    for judge in here {
        let file = folder.path().join(judge.file);
        let bake = cmd!(
            shell,
            "{dapple} bake {recipe} --size 64x40 --quiet -o {file}"
        );
        let maps = judge.file.ends_with(".npy").then_some(["--maps", "normal"]);
        bake.quiet().args(maps.into_iter().flatten()).run()?;
        let asked = judge.command(shell, judge.code).arg(&file).quiet().run();
        asked.with_context(|| format!("{} refused {}", judge.needs, judge.file))?;
    }
    Ok(())
}

/// Returns the path of the command `dapple` built by the workspace tests. Using this one avoids another build with
/// other features.
fn command_of_tests(shell: &Shell) -> anyhow::Result<PathBuf> {
    cmd!(shell, "cargo test --quiet --workspace --no-run")
        .quiet()
        .run()?;
    let target = std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    Ok(Path::new(&target).join("debug").join("dapple"))
}

impl Judge {
    fn is_here(&self, shell: &Shell) -> bool {
        let probe = self.command(shell, self.probe).quiet().ignore_status();
        let output = probe.ignore_stdout().ignore_stderr().output();
        output.is_ok_and(|output| output.status.success())
    }

    fn command<'a>(&self, shell: &'a Shell, code: &str) -> Cmd<'a> {
        let [program, options @ ..] = self.program.as_slice() else {
            return shell.cmd("false");
        };
        shell.cmd(program).args(options).arg(code)
    }
}
