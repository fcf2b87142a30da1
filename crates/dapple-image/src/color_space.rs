//! Color space declared by a file, and the conversion of its codes to linear light with the primaries of ITU-R BT.709.
//!
//! References: ICC.1:2022 (three-component profiles with a matrix and curves); ITU-T H.273, 2021 (the code points of
//! `cICP`); the W3C recommendation "Portable Network Graphics (PNG) Specification (Third Edition)", 2025, section 4.3
//! (`cICP` before `iCCP` before `sRGB` before `gAMA` and `cHRM`); SMPTE RP 177 (matrices from chromaticities). A white
//! point other than D65 is adapted by the Bradford method, as in ICC profiles, so that white stays white.
//!
//! All computations use `f64` and the power function of `libm`, which gives the same bits on every machine. Colors
//! outside the gamut of BT.709 have components below 0 or above 1.

use crate::{ImageError, ImageErrorKind};
use core::fmt;
use dapple_color::LinearRgb;

/// Chromaticities x and y of red, green, blue and white.
pub(crate) type Primaries = [[f64; 2]; 4];

type Matrix = [[f64; 3]; 3];

/// White point of the illuminant D65, as in BT.709 and sRGB.
pub(crate) const D65: [f64; 2] = [0.3127, 0.329];

/// Primaries of ITU-R BT.709 and sRGB.
pub(crate) const BT709: Primaries = [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], D65];

/// Primaries of Adobe RGB (1998).
pub(crate) const ADOBE_RGB: Primaries = [[0.64, 0.33], [0.21, 0.71], [0.15, 0.06], D65];

/// Exponent of Adobe RGB (1998), 2 + 51 / 256.
pub(crate) const ADOBE_GAMMA: f64 = 563.0 / 256.0;

/// White point of the profile connection space, an approximation of D50 (ICC.1, section 6.3.4.3).
pub(crate) const D50_XYZ: [f64; 3] = [0.9642, 1.0, 0.8249];

/// Cone response matrix of the Bradford method: Lam, "Metamerism and colour constancy", 1985.
const BRADFORD: Matrix = [
    [0.8951, 0.2664, -0.1614],
    [-0.7502, 1.7135, 0.0367],
    [0.0389, -0.0685, 1.0296],
];

/// Tolerance for recognizing the matrix of an sRGB profile: largest deviation of an entry from the identity matrix.
/// Profiles round their numbers and adapt D65 in different ways.
const MATRIX_TOLERANCE: f64 = 0.003;

/// Color space declared by a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColorSpace {
    source: Source,
    conversion: Conversion,
}

/// Part of a file that declares its color space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Source {
    /// No declaration.
    #[default]
    None,
    /// Chunk `sRGB` of PNG, or a `gAMA` of 0.45455.
    Srgb,
    /// Chunk `cICP` of PNG.
    Cicp,
    /// ICC profile.
    Icc,
    /// Chunks `gAMA` and `cHRM` of PNG.
    Gamma,
    /// Color space field of Exif.
    Exif,
}

/// Conversion of codes to linear light.
#[derive(Clone, Debug, Default, PartialEq)]
enum Conversion {
    /// The sRGB conversion.
    #[default]
    Srgb,
    /// One curve per channel, then a matrix.
    Matrix(Box<MatrixSpace>),
    /// Not supported; holds the name of the unsupported feature.
    Unknown(&'static str),
}

/// Transfer curves of red, green and blue, and the matrix from their linear light to BT.709.
#[derive(Clone, Debug, PartialEq)]
struct MatrixSpace {
    matrix: Matrix,
    curves: [Curve; 3],
}

/// Transfer curve from codes to linear light, both from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Curve {
    /// The sRGB curve.
    Srgb,
    /// Inverse of the camera curve of ITU-R BT.709.
    Bt709,
    /// Power function with this exponent; 1 for linear codes.
    Power(f64),
    /// `(a x + b)^g + e` for `x ≥ d`, else `c x + f` (ICC.1, section 10.18). The order is g, a, b, c, d, e, f.
    Parametric([f64; 7]),
    /// Values at evenly spaced codes, interpolated linearly.
    Table(Vec<f64>),
}

impl Curve {
    fn light(&self, code: f64) -> f64 {
        match self {
            Self::Srgb if code <= 0.040_45 => code / 12.92,
            Self::Srgb => libm::pow((code + 0.055) / 1.055, 2.4),
            Self::Bt709 if code < 0.081 => code / 4.5,
            Self::Bt709 => libm::pow((code + 0.099) / 1.099, 1.0 / 0.45),
            Self::Power(gamma) if *gamma == 1.0 => code,
            Self::Power(gamma) => libm::pow(code, *gamma),
            Self::Parametric([g, a, b, c, d, e, f]) => {
                if code >= *d {
                    libm::pow((a * code + b).max(0.0), *g) + e
                } else {
                    c * code + f
                }
            }
            Self::Table(values) => {
                let place = code * (values.len() - 1) as f64;
                let below = (place as usize).min(values.len() - 1);
                let above = (below + 1).min(values.len() - 1);
                values[below] + (values[above] - values[below]) * (place - below as f64)
            }
        }
    }

    /// Returns whether the curve matches the sRGB curve to within half an 8-bit code.
    fn is_srgb(&self) -> bool {
        (0..=255_u8).all(|code| {
            let code = f64::from(code);
            let border = |code: f64| Self::Srgb.light(code.clamp(0.0, 255.0) / 255.0);
            let light = self.light(code / 255.0);
            // The first and the last code have a neighbor on one side only, and are exact in every sRGB profile.
            (border(code - 0.5) - 1e-4..=border(code + 0.5) + 1e-4).contains(&light)
        })
    }
}

impl ColorSpace {
    /// Creates a color space that is declared to be sRGB.
    pub(crate) fn srgb(source: Source) -> Self {
        Self {
            source,
            conversion: Conversion::Srgb,
        }
    }

    /// Creates a color space that cannot be converted; `name` describes it in errors.
    pub(crate) fn unknown(source: Source, name: &'static str) -> Self {
        Self {
            source,
            conversion: Conversion::Unknown(name),
        }
    }

    /// Creates a color space from its primaries and one curve for all channels.
    pub(crate) fn from_primaries(source: Source, primaries: Primaries, curve: Curve) -> Self {
        match bt709_from(&primaries) {
            Some(matrix) => {
                Self::from_matrix(source, matrix, [curve.clone(), curve.clone(), curve])
            }
            None => Self::unknown(source, "chromaticities that span no colors"),
        }
    }

    /// Creates the color space of an ICC matrix profile from its curves and from the columns of its matrix, in XYZ
    /// adapted to D50.
    pub(crate) fn from_columns(columns: [[f64; 3]; 3], curves: [Curve; 3]) -> Self {
        let column = |row: usize| columns.map(|column| column[row]);
        let profile = [0, 1, 2].map(column);
        let srgb = rgb_to_xyz(&BT709).and_then(|matrix| {
            let adapted = adapted(xyz_of_white(D65), D50_XYZ)?;
            inverse(&product(&adapted, &matrix))
        });
        match srgb {
            Some(srgb) => Self::from_matrix(Source::Icc, product(&srgb, &profile), curves),
            None => Self::unknown(Source::Icc, "a matrix without an inverse"),
        }
    }

    fn from_matrix(source: Source, matrix: Matrix, curves: [Curve; 3]) -> Self {
        let is_near_one = (0..9).all(|at| {
            let one = f64::from(u8::from(at / 3 == at % 3));
            (matrix[at / 3][at % 3] - one).abs() < MATRIX_TOLERANCE
        });
        let conversion = if is_near_one && curves.iter().all(Curve::is_srgb) {
            Conversion::Srgb
        } else {
            Conversion::Matrix(Box::new(MatrixSpace { matrix, curves }))
        };
        Self { source, conversion }
    }

    /// Returns whether the colors are sRGB, either declared or by default.
    #[must_use]
    pub fn is_srgb(&self) -> bool {
        self.conversion == Conversion::Srgb
    }

    /// Returns the converter from codes between 0 and `max` to linear BT.709 light; `None` for sRGB.
    ///
    /// # Errors
    ///
    /// [`ImageErrorKind::ColorSpace`] if the color space cannot be converted.
    pub(crate) fn converter(&self, max: u16) -> Result<Option<Converter>, ImageError> {
        match &self.conversion {
            Conversion::Srgb => Ok(None),
            Conversion::Unknown(name) => {
                Err(ImageError::new(ImageErrorKind::ColorSpace { found: name }))
            }
            Conversion::Matrix(space) => {
                let scale = f64::from(max);
                let table = |curve: &Curve| {
                    let codes = 0..=max;
                    codes
                        .map(|code| curve.light(f64::from(code) / scale))
                        .collect()
                };
                let tables = [0, 1, 2].map(|channel| table(&space.curves[channel]));
                let matrix = space.matrix;
                Ok(Some(Converter { matrix, tables }))
            }
        }
    }
}

/// Formats the color space for reports, such as `no color space declared` or `colors by an ICC profile, read as
/// BT.709`.
impl fmt::Display for ColorSpace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let source = match self.source {
            Source::None => return f.write_str("no color space declared"),
            Source::Srgb => return f.write_str("marked as sRGB"),
            Source::Cicp => "cICP",
            Source::Icc => "an ICC profile",
            Source::Gamma => "gAMA or cHRM",
            Source::Exif => "the color space of Exif",
        };
        match &self.conversion {
            Conversion::Srgb => write!(f, "marked as sRGB by {source}"),
            Conversion::Matrix(_) => write!(f, "colors by {source}, read as BT.709"),
            Conversion::Unknown(name) => write!(f, "colors by {source}: {name}, which is not read"),
        }
    }
}

/// Converts codes to linear light by a lookup table per channel, followed by a matrix.
pub(crate) struct Converter {
    matrix: Matrix,
    tables: [Vec<f64>; 3],
}

impl Converter {
    /// Converts the codes of one pixel.
    pub(crate) fn color(&self, codes: [u16; 3]) -> LinearRgb {
        let light = |channel: usize| self.tables[channel][usize::from(codes[channel])];
        times(&self.matrix, [0, 1, 2].map(light))
    }
}

/// Multiplies linear light by a matrix, and rounds the result to a color.
pub(crate) fn times(matrix: &Matrix, light: [f64; 3]) -> LinearRgb {
    apply(matrix, light).map(|part| part as f32).into()
}

/// Returns the matrix from linear light of `primaries` to BT.709; `None` if the primaries are collinear.
///
/// White is adapted, except for the primaries of XYZ itself, whose values are measured stimuli.
pub(crate) fn bt709_from(primaries: &Primaries) -> Option<Matrix> {
    let to_xyz = rgb_to_xyz(primaries)?;
    let from_xyz = inverse(&rgb_to_xyz(&BT709)?)?;
    let white = primaries[3];
    let is_xyz = primaries[..3] == [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];
    if is_xyz || white == D65 {
        return Some(product(&from_xyz, &to_xyz));
    }
    let adapted = adapted(xyz_of_white(white), xyz_of_white(D65))?;
    Some(product(&from_xyz, &product(&adapted, &to_xyz)))
}

/// Returns the matrix from linear light of `primaries` to XYZ. White has a luminance of 1.
fn rgb_to_xyz(primaries: &Primaries) -> Option<Matrix> {
    let [red, green, blue, white] = primaries;
    if white[1].is_nan() || white[1] <= 0.0 {
        return None;
    }
    let row = |of: fn([f64; 2]) -> f64| [red, green, blue].map(|&point| of(point));
    let columns = [row(|[x, _]| x), row(|[_, y]| y), row(|[x, y]| 1.0 - x - y)];
    let scale = apply(&inverse(&columns)?, xyz_of_white(*white));
    Some(columns.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]]))
}

fn xyz_of_white([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

/// Returns the matrix that adapts colors from one white point to another by the Bradford method. White points are in
/// XYZ.
fn adapted(from: [f64; 3], to: [f64; 3]) -> Option<Matrix> {
    let [from, to] = [from, to].map(|white| apply(&BRADFORD, white));
    let scaled = [0, 1, 2].map(|row| BRADFORD[row].map(|entry| entry * (to[row] / from[row])));
    Some(product(&inverse(&BRADFORD)?, &scaled))
}

fn apply(matrix: &Matrix, [a, b, c]: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * a + row[1] * b + row[2] * c)
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let column = |at: usize| apply(a, b.map(|row| row[at]));
    let columns = [0, 1, 2].map(column);
    [0, 1, 2].map(|row| columns.map(|column| column[row]))
}

/// Inverts a matrix by cofactors; `None` if it is singular.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let minor = |r: usize, c: usize| {
        let [r1, r2, c1, c2] = [(r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3];
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
    let inverse = [0, 1, 2].map(|row| [0, 1, 2].map(|column| minor(column, row) / determinant));
    let is_finite = inverse.iter().flatten().all(|entry| entry.is_finite());
    (determinant.abs() > 1e-9 && is_finite).then_some(inverse)
}
