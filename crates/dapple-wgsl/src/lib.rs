//! The noise of dapple in WGSL, with the same bits as on the CPU.
//!
//! The shaders are text without bindings and entry points. [`Module::source`] gives one file that needs nothing else, to
//! be copied into a `wgpu` program. [`Module::naga_oil`] gives the same text as a module for `naga_oil`, which Bevy uses.
//! The command prints both: `dapple wgsl gradient_noise_2d`.
//!
//! ```
//! use dapple_wgsl::{Module, source};
//!
//! // A complete shader: the noise, and an entry point that calls it.
//! let shader = Module::GradientNoise2d.source() + "
//!     @group(0) @binding(0) var<uniform> noise: GradientNoise;
//!     @group(0) @binding(1) var<uniform> zero: u32;
//!     @group(0) @binding(2) var<storage, read_write> heights: array<f32>;
//!     @compute @workgroup_size(64)
//!     fn main(@builtin(global_invocation_id) id: vec3<u32>) {
//!         let place = place_2d(vec2<f32>(id.xy) / 16.0);
//!         heights[id.x] = gradient_noise_2d(noise, place, zero);
//!     }";
//! assert!(shader.contains("fn gradient_noise_2d"));
//!
//! // Several modules in one file contain their shared parts once.
//! let terrain = source(&[Module::GradientNoise2d, Module::Fractal]);
//! assert_eq!(terrain.matches("fn exact_mul").count(), 1);
//! ```
//!
//! The 16 words of the uniform `noise` come from `GradientNoise::shader_words` of `dapple-noise`. `zero` is 0.
//!
//! # How the bits stay the same
//!
//! WGSL allows a compiler to fuse a product with a sum, and drivers do. They also reorder sums. Both change the last bit.
//! So every result passes through `exact`, the exclusive or of its bits with `zero`. This number is 0, but the compiler
//! must not know it: it is read from a buffer. As a constant, it has no effect.
//!
//! Everything else is exact: hashes are computed with `u32`, and a position is a cell (`i32`) and a fraction (`f32`).
//!
//! # Limits
//!
//! * The values equal `sample(cell + fraction)` of the CPU where this sum is exact in `f64`. It is for every cell if the
//!   fraction is a multiple of 2^-21, and up to 2^29 cells if it is a multiple of 2^-24.
//! * Cells are from -2^31 to 2^31 - 2, periods at most 2^31.
//! * WGSL leaves two things open: the direction of rounding, and denormal numbers. All known hardware rounds to nearest
//!   even. Denormal numbers occur where a fraction is below 2^-24 but not 0, and may then become 0.
//! * Quotients, powers and numbers of 64 bits below the least normal number are 0.
//! * The tests compare all bits on Mesa's software implementation of Vulkan, lavapipe.

#![no_std]
#![forbid(unsafe_code)]

extern crate alloc;

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write as _;

/// A module of WGSL.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Module {
    /// Sums and products that a compiler cannot fuse or reorder.
    Exact,
    /// Hashes of lattice coordinates.
    Hash,
    /// Positions in the plane, as cell and fraction.
    Place2d,
    /// Parts that gradient noise of all dimensions shares.
    GradientNoiseParts,
    /// Gradient noise in two dimensions.
    GradientNoise2d,
    /// Positions in space, as cell and fraction.
    Place3d,
    /// Positions in four dimensions, as cell and fraction.
    Place4d,
    /// Gradients of noise in three and four dimensions.
    GradientEdges,
    /// Gradient noise in three dimensions.
    GradientNoise3d,
    /// Gradient noise in four dimensions.
    GradientNoise4d,
    /// Gradient noise in two dimensions with its derivatives.
    GradientNoise2dWithGradient,
    /// Gradient noise in three dimensions with its derivatives.
    GradientNoise3dWithGradient,
    /// Sums of octaves.
    Fractal,
    /// Correctly rounded square roots.
    Root,
    /// Ids of feature points.
    CellId,
    /// Parts that Worley's basis shares in all dimensions.
    WorleyParts,
    /// Worley's basis in two dimensions: the two nearest feature points.
    Worley2d,
    /// Worley's basis in three dimensions: the two nearest feature points.
    Worley3d,
    /// Arithmetic of single numbers, with correctly rounded quotients.
    Number,
    /// Powers of numbers.
    Power,
    /// Sums and products of numbers of 64 bits.
    Double,
    /// Positions in the plane, in numbers of 64 bits.
    Position2d,
    /// Mixtures of colors in Oklab.
    Oklab,
    /// Words of a texture that a noise looks up.
    Data,
    /// Wavelet noise in two dimensions.
    WaveletNoise2d,
    /// Quotients, square roots and comparisons of numbers of 64 bits.
    DoubleQuotient,
    /// Textures of control points in two dimensions.
    Pups2d,
    /// Sines of numbers of 64 bits.
    DoubleSine,
    /// Worley's basis in four dimensions: up to four nearest feature points.
    Worley4d,
    /// Distances to edges of Voronoi cells in two dimensions.
    WorleyEdges2d,
    /// Extremes, smooth steps and lengths of numbers of 64 bits.
    DoubleFunctions,
    /// Angles of vectors.
    DoubleAngle,
    /// Curves through points.
    Spline,
    /// Parts that patterns share: lattice positions and random numbers of 64 bits.
    Lattice,
    /// Parts that all bonds of bricks share.
    Bricks,
    /// Bonds of rectangular bricks.
    Rectangles,
    /// Roof tiles and slates.
    RoofTiles,
    /// Woven cloth.
    Weave,
    /// Shapes stamped at scattered points.
    Stamps,
    /// Gabor noise and its phase.
    Gabor,
    /// Hexagonal tiles.
    Hexagons,
    /// Signed distances to simple shapes.
    Shapes,
    /// Codes of sRGB colors.
    Srgb,
    /// Hue, saturation and lightness of colors.
    Hsl,
    /// Layers blended by weights.
    Blend,
}

/// Description of a module.
struct Entry {
    module: Module,
    name: &'static str,
    text: &'static str,
    /// Modules that it uses directly.
    uses: &'static [Module],
}

macro_rules! entries {
    ($($module:ident = $name:literal [$($uses:ident),*],)*) => {
        /// All modules, in the order of the variants; a module uses only earlier ones.
        static ENTRIES: &[Entry] = &[$(Entry {
            module: Module::$module,
            name: $name,
            text: include_str!(concat!($name, ".wgsl")),
            uses: &[$(Module::$uses),*],
        }),*];

        impl Module {
            /// All modules; each uses only earlier ones.
            pub const ALL: &[Self] = &[$(Self::$module),*];
        }
    };
}

entries! {
    Exact = "exact" [],
    Hash = "hash" [],
    Place2d = "place_2d" [],
    GradientNoiseParts = "gradient_noise_parts" [Exact, Hash],
    GradientNoise2d = "gradient_noise_2d" [Exact, Hash, Place2d, GradientNoiseParts],
    Place3d = "place_3d" [],
    Place4d = "place_4d" [],
    GradientEdges = "gradient_edges" [],
    GradientNoise3d = "gradient_noise_3d" [Exact, Hash, Place3d, GradientNoiseParts, GradientEdges],
    GradientNoise4d = "gradient_noise_4d" [Exact, Hash, Place4d, GradientNoiseParts, GradientEdges],
    GradientNoise2dWithGradient = "gradient_noise_2d_with_gradient"
        [Exact, Place2d, GradientNoiseParts, GradientNoise2d],
    GradientNoise3dWithGradient = "gradient_noise_3d_with_gradient"
        [Exact, Hash, Place3d, GradientNoiseParts, GradientEdges, GradientNoise3d],
    Fractal = "fractal" [Exact],
    Root = "root" [],
    CellId = "cell_id" [],
    WorleyParts = "worley_parts" [Hash],
    Worley2d = "worley_2d" [Exact, Hash, Place2d, Root, CellId, WorleyParts],
    Worley3d = "worley_3d" [Exact, Hash, Place3d, Root, CellId, WorleyParts],
    Number = "number" [],
    Power = "power" [Number],
    Double = "double" [],
    Position2d = "position_2d" [Place2d, Double],
    Oklab = "oklab" [Double],
    Data = "data" [],
    WaveletNoise2d = "wavelet_noise_2d" [Exact, Hash, Fractal, Double, Position2d, Data],
    DoubleQuotient = "double_quotient" [Double],
    Pups2d = "pups_2d"
        [Exact, Fractal, Root, Number, Double, Position2d, Data, DoubleQuotient],
    DoubleSine = "double_sine" [Double],
    Worley4d = "worley_4d" [Exact, Hash, Place4d, Root, CellId, WorleyParts],
    WorleyEdges2d = "worley_edges_2d"
        [Hash, Place2d, WorleyParts, Worley2d, Double, DoubleQuotient],
    DoubleFunctions = "double_functions" [Double, DoubleQuotient],
    DoubleAngle = "double_angle" [Double, DoubleQuotient],
    Spline = "spline" [Double, DoubleQuotient],
    Lattice = "lattice" [CellId, WorleyParts, Double],
    Bricks = "bricks" [Hash, Double, DoubleQuotient, DoubleFunctions, Lattice],
    Rectangles = "rectangles"
        [Double, Position2d, DoubleQuotient, DoubleFunctions, Lattice, Bricks],
    RoofTiles = "roof_tiles"
        [Double, Position2d, DoubleQuotient, DoubleFunctions, Lattice, Bricks],
    Weave = "weave" [Hash, Double, Position2d, DoubleQuotient, DoubleFunctions, Lattice],
    Stamps = "stamps" [Exact, Hash, Root, Number, Double, Position2d, Data],
    Gabor = "gabor" [Hash, Double, Position2d, Data, DoubleQuotient, DoubleAngle],
    Hexagons = "hexagons"
        [Double, Position2d, DoubleQuotient, DoubleFunctions, Lattice, Bricks],
    Shapes = "shapes" [Double, Position2d, Data, DoubleQuotient, DoubleFunctions, Lattice],
    Srgb = "srgb" [Number, Data],
    Hsl = "hsl" [Number, Srgb],
    Blend = "blend" [Number, Double, DoubleQuotient, DoubleFunctions],
}

impl Module {
    fn entry(self) -> &'static Entry {
        &ENTRIES[self as usize]
    }

    /// Returns the name of the module, such as `gradient_noise_2d`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Returns the text of the module alone, without the modules that it uses.
    #[must_use]
    pub fn text(self) -> &'static str {
        self.entry().text
    }

    /// Returns the modules that this module uses directly.
    #[must_use]
    pub fn uses(self) -> &'static [Self] {
        self.entry().uses
    }

    /// Returns the module with all modules that it uses, as one file of plain WGSL.
    #[must_use]
    pub fn source(self) -> String {
        source(&[self])
    }

    /// Returns the module as a module for `naga_oil`, with the import path `dapple::NAME`. The modules that it
    /// [uses](Self::uses) must be added, too, in the order of [`ALL`](Self::ALL).
    #[must_use]
    pub fn naga_oil(self) -> String {
        let mut out = String::new();
        let _ = writeln!(out, "#define_import_path dapple::{}", self.name());
        for (used, names) in self.imports() {
            let _ = writeln!(out, "#import dapple::{used}::{{{names}}}");
        }
        out + "\n" + self.text()
    }

    /// Returns the module as a module of a WESL package. [`wesl_package`] returns all files of one.
    #[must_use]
    pub fn wesl(self) -> String {
        let mut out = String::new();
        for (used, names) in self.imports() {
            let _ = writeln!(out, "import package::{used}::{{{names}}};");
        }
        if !out.is_empty() {
            out += "\n";
        }
        out + self.text()
    }

    /// Returns, for each module that this module uses, its name and the names that are imported from it.
    fn imports(self) -> impl Iterator<Item = (&'static str, String)> {
        self.uses().iter().filter_map(move |used| {
            let names = declared(used.text()).filter(|name| mentions(self.text(), name));
            let names: Vec<_> = names.collect();
            (!names.is_empty()).then(|| (used.name(), names.join(", ")))
        })
    }
}

/// Returns modules with all modules that they use, each once, as one file of plain WGSL.
#[must_use]
pub fn source(modules: &[Module]) -> String {
    let texts: Vec<_> = with_used(modules).map(|entry| entry.text).collect();
    texts.join("\n")
}

/// Returns modules with all modules that they use as the files of a WESL package: paths and contents.
///
/// A shader imports functions by the name of the package: `import dapple::worley_2d::worley_2d;`.
///
/// # Examples
///
/// ```
/// use dapple_wgsl::{Module, wesl_package};
///
/// let files = wesl_package(&[Module::Worley2d]);
/// assert_eq!(files[0].0, "wesl.toml");
/// assert!(files.iter().any(|(path, text)| {
///     path == "shaders/worley_2d.wesl" && text.contains("import package::root::{exact_root};")
/// }));
/// ```
#[must_use]
pub fn wesl_package(modules: &[Module]) -> Vec<(String, String)> {
    let settings = "[package]\nedition = \"2026_pre\"\nroot = \"./shaders\"\n";
    let mut files = alloc::vec![(String::from("wesl.toml"), String::from(settings))];
    let modules = with_used(modules).map(|entry| entry.module);
    files.extend(modules.map(|module| {
        let path = alloc::format!("shaders/{}.wesl", module.name());
        (path, module.wesl())
    }));
    files
}

/// Returns modules with all modules that they use, each once.
fn with_used(modules: &[Module]) -> impl Iterator<Item = &'static Entry> {
    let mut needed = [false; ENTRIES.len()];
    for &module in modules {
        needed[module as usize] = true;
    }
    // A module uses only earlier ones, so one pass from the last to the first finds all.
    for entry in ENTRIES.iter().rev() {
        if needed[entry.module as usize] {
            for &used in entry.uses {
                needed[used as usize] = true;
            }
        }
    }
    ENTRIES
        .iter()
        .filter(move |entry| needed[entry.module as usize])
}

/// Returns the names of the functions, structures and constants that a module declares.
fn declared(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let mut words = line.split(|c: char| !is_name(c));
        let is_declaration = matches!(words.next(), Some("fn" | "struct" | "const"));
        is_declaration.then(|| words.next()).flatten()
    })
}

/// Returns whether the code of a module contains a name.
fn mentions(text: &str, name: &str) -> bool {
    let code = text.lines().filter_map(|line| line.split("//").next());
    code.flat_map(|line| line.split(|c: char| !is_name(c)))
        .any(|word| word == name)
}

fn is_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Returns the parameters of gradient noise as a constructor of WGSL: `GradientNoise(…)`. The words are those of
/// `GradientNoise::shader_words` of `dapple-noise`.
#[must_use]
pub fn gradient_noise_value(words: &[u32; 16]) -> String {
    let [keys, period, offset] = [0, 4, 8].map(|at| vector(&words[at..at + 4]));
    let weight = number_value(f32::from_bits(words[12]));
    alloc::format!("GradientNoise({keys}, {period}, {offset}, {weight})")
}

/// Returns the parameters of Worley's basis as a constructor of WGSL: `Worley(…)`. The words are those of
/// `Worley::shader_words` of `dapple-worley`.
#[must_use]
pub fn worley_value(words: &[u32; 24]) -> String {
    let [first, second, period, low, high] = [0, 4, 8, 12, 16].map(|at| vector(&words[at..at + 4]));
    let [least, jitter, metric] = [words[20], words[21], words[22]];
    alloc::format!(
        "Worley(array({first}, {second}), {period}, array({low}, {high}), {least}u, {jitter}u, {metric}u)"
    )
}

/// Returns the parameters of a pattern, such as `Bricks`, as a constructor of WGSL. The words are those of `shader_words` of
/// the pattern in `dapple-pattern`, in pairs.
#[must_use]
pub fn pattern_value(name: &str, words: &[[u32; 2]]) -> String {
    let pairs = words.iter();
    let pairs: Vec<_> = pairs
        .map(|[first, second]| alloc::format!("vec2({first:#x}u, {second:#x}u)"))
        .collect();
    alloc::format!("{name}({})", pairs.join(", "))
}

/// Returns a finite number as a literal of WGSL that has the same bits, except for the sign of zero.
#[must_use]
pub fn number_value(number: f32) -> String {
    let short = alloc::format!("{number:?}");
    // Compilers read decimals as numbers of 64 bits, and round these.
    match short.parse::<f64>() {
        Ok(read) if read as f32 == number => short,
        _ => alloc::format!("{:?}", f64::from(number)),
    }
}

/// Returns a number of 64 bits as the two words of the module [`Double`](Module::Double).
#[must_use]
pub fn double_value(number: f64) -> String {
    let bits = number.to_bits();
    alloc::format!("vec2({:#x}u, {:#x}u)", bits >> 32, bits & 0xffff_ffff)
}

/// Returns four words as a vector of WGSL.
fn vector(words: &[u32]) -> String {
    let words: Vec<_> = words.iter().map(|word| alloc::format!("{word}u")).collect();
    alloc::format!("vec4({})", words.join(", "))
}
