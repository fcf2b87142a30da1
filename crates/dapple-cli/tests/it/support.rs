//! Creates folders with inputs for tests, and runs the command in them.

use dapple::color::{LinearRgb, LinearRgba, Normal};
use dapple::image::{
    Depth, Limits, Transfer, encode_png, read_image, write_color_alpha_png, write_color_exr,
    write_color_png, write_gray_exr, write_gray_png, write_normal_png,
};
use dapple::mesh::{CREASE, EncodedImage, Model, Surface};
use dapple::mesh_io::write_model;
use dapple::raster::Raster;
use dapple::synth::{Atlas, textured_model};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// The side of the test images, in pixels.
const SIDE: u32 = 64;
/// The side of the texture of `shell.glb`, in texels.
pub(crate) const SHELL_SIDE: u32 = 256;

/// Text of a recipe with an image.
pub(crate) const ROCK: &str = r#"
dapple = 1
seed = 3
extent = [4.0, 4.0]

[nodes.cells.worley]
value = "f2_minus_f1"

[nodes.lichen.image]
file = "photo.png"

[material]
height = "cells"
albedo = "lichen"
"#;

/// A temporary folder for a test, removed on drop.
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// Creates an empty folder.
    pub(crate) fn new(name: &str) -> Self {
        // Tests run at the same time, and two may choose one name.
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("dapple-command-{}-{count}-{name}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// Creates a folder with all inputs that the examples of the help texts use.
    pub(crate) fn with_inputs(name: &str) -> Self {
        let folder = Self::new(name);
        for name in ["photo", "albedo", "rock", "grass", "sand", "stones"] {
            write_color_png(folder.path(&format!("{name}.png")), &color(), Depth::Eight).unwrap();
        }
        for name in ["height", "mask", "cracks", "rock_height", "grass_height"] {
            write_gray_png(folder.path(&format!("{name}.png")), &gray(), Depth::Sixteen).unwrap();
        }
        let leaf = |x: u32, y: u32| LinearRgba {
            color: LinearRgb::new(0.1, 0.4, 0.1),
            alpha: f32::from(!(x / 8 + y / 8).is_multiple_of(3)),
        };
        let leaves = Raster::from_fn([SIDE; 2], leaf).unwrap();
        write_color_alpha_png(folder.path("leaves.png"), &leaves, Depth::Eight).unwrap();
        let scratch = |x: u32, y: u32| f32::from((28..36).contains(&x) && (20..44).contains(&y));
        let scratch = Raster::from_fn([SIDE; 2], scratch).unwrap();
        write_gray_png(folder.path("scratch.png"), &scratch, Depth::Eight).unwrap();
        for name in ["normal", "rock_normal", "grass_normal"] {
            let flat = Raster::filled([SIDE; 2], Normal::FLAT).unwrap();
            write_normal_png(folder.path(&format!("{name}.png")), &flat, Depth::Eight).unwrap();
        }
        write_gray_exr(folder.path("height.exr"), &gray()).unwrap();
        let place = |x: u32, y: u32| LinearRgb::new((x % SIDE) as f32, (y % SIDE) as f32, 0.0);
        let places = Raster::from_fn([SIDE + 9, SIDE], place).unwrap();
        write_color_exr(folder.path("places.exr"), &places).unwrap();
        // Noise without any structure repeats without a visible seam.
        write_gray_png(folder.path("grain.png"), &noise(), Depth::Eight).unwrap();
        let checker = checker();
        write_color_png(folder.path("checker.png"), &checker, Depth::Eight).unwrap();
        write_model(folder.path("model.obj"), model()).unwrap();
        write_model(folder.path("shell.glb"), shell()).unwrap();
        let stain = |x: u32, y: u32| f32::from(x.abs_diff(128) < 24 && y.abs_diff(128) < 24);
        let stain = Raster::from_fn([SHELL_SIDE; 2], stain).unwrap();
        write_gray_png(folder.path("stain.png"), &stain, Depth::Eight).unwrap();
        let directions = "x,y,z,dx,dy,dz\n0,0,0,0,0,-1\n";
        fs::write(folder.path("directions.csv"), directions).unwrap();
        let control = "x,y,value\n0.5,0.5,0\n1.5,0.6,1\n1,1.5,0.5\n0.2,1.7,0.9\n";
        fs::write(folder.path("control.csv"), control).unwrap();
        fs::write(folder.path("my-rock.toml"), ROCK).unwrap();
        folder
    }

    /// Returns the path of a file in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Returns the names of all files in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let mut names: Vec<_> = entries.map(name).collect();
        names.sort();
        names
            .into_iter()
            .map(|name| name.into_string().unwrap())
            .collect()
    }

    /// Returns the command with these arguments, to be run in this folder.
    pub(crate) fn command<S: AsRef<OsStr>>(&self, arguments: &[S]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dapple"));
        command
            .args(arguments)
            .current_dir(&self.0)
            .stdin(Stdio::null());
        command
    }

    /// Runs the command, and waits until it ends.
    pub(crate) fn run<S: AsRef<OsStr>>(&self, arguments: &[S]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a shell command. `dapple` in it is the command under test.
    #[cfg(unix)]
    pub(crate) fn shell(&self, line: &str) -> Output {
        let program = Path::new(env!("CARGO_BIN_EXE_dapple"));
        let folders = std::env::var_os("PATH").unwrap_or_default();
        let folders = std::env::split_paths(&folders);
        let own = program.parent().unwrap().to_owned();
        let path = std::env::join_paths([own].into_iter().chain(folders)).unwrap();
        Command::new("sh")
            .args(["-c", line])
            .env("PATH", path)
            .current_dir(&self.0)
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Returns the standard error of a run.
pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns the standard output of a run.
pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Checks that the run succeeded.
pub(crate) fn assert_done(output: &Output, what: &str) {
    assert_eq!(output.status.code(), Some(0), "{what}: {}", stderr(output));
}

/// Checks that the run failed with this exit code and a message that contains `part`, and did not panic.
pub(crate) fn assert_refused(output: &Output, code: i32, part: &str, what: &str) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(code), "{what}: {message}");
    assert!(message.starts_with("error: "), "{what}: {message}");
    assert!(message.contains(part), "{what} names {part:?}: {message}");
    assert!(!message.contains("panicked"), "{what}: {message}");
}

/// Returns a small model. It is built only once, since this is slow.
fn model() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(|| dapple_models::ray(300).unwrap().into())
}

/// Returns the small model with a checkerboard texture.
pub(crate) fn shell() -> &'static Model {
    static SHELL: OnceLock<Model> = OnceLock::new();
    SHELL.get_or_init(|| {
        let surface = Surface::new(model().mesh.clone()).unwrap();
        let atlas = Atlas::charts(&surface, SHELL_SIDE).unwrap();
        let code = |x: u32, y: u32| [90, 30 + 200 * ((x / 16 + y / 16) % 2) as u8, 60];
        let codes = Raster::from_fn([SHELL_SIDE; 2], code).unwrap();
        let png = encode_png(codes.view(), Transfer::Srgb).unwrap();
        let shading = surface.mesh().corner_normals(CREASE);
        textured_model(&surface, &atlas, shading, EncodedImage::new(png).unwrap()).unwrap()
    })
}

/// Returns an image of a smooth hill in color.
fn color() -> Raster<LinearRgb> {
    gray().map(|&value| LinearRgb::new(value, 0.5 * value + 0.2, 1.0 - value))
}

/// Returns a gray image of a smooth hill on a slope, with values from 0.2 to 0.8.
fn gray() -> Raster<f32> {
    let half = SIDE as f32 / 2.0;
    Raster::from_fn([SIDE; 2], |column, row| {
        let [x, y] = [column, row].map(|at| (at as f32 - half) / half);
        0.5 + 0.2 * (1.0 - x * x) * (1.0 - y * y) + 0.1 * x
    })
    .unwrap()
}

fn noise() -> Raster<f32> {
    let mut state = 1_u32;
    Raster::from_fn([SIDE; 2], |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    })
    .unwrap()
}

fn checker() -> Raster<LinearRgb> {
    Raster::from_fn([32; 2], |x, y| match (x / 8 + y / 8) % 2 {
        0 => LinearRgb::new(0.8, 0.6, 0.2),
        _ => LinearRgb::new(0.1, 0.1, 0.3),
    })
    .unwrap()
}

/// Reads the values of a gray image in a folder.
pub(crate) fn read_gray(folder: &Folder, name: &str) -> Raster<f32> {
    let image = read_image(folder.path(name), &Limits::default());
    image.unwrap().gray().unwrap()
}
