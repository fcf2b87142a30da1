//! Synthesis errors: invalid exemplars, schedules, directions and other input.

use dapple_color::ColorError;
use dapple_mesh::MeshError;
use dapple_raster::RasterError;

dapple_raster::error! {
    /// A synthesis error.
    SynthError,
    /// Kind of a synthesis error, with the limit and the value.
    SynthErrorKind with Range {
        /// The number of elements is wrong.
        Count {
            /// Name of the counted elements.
            what: &'static str,
            /// Number of elements found.
            count: usize,
            /// Number of elements needed, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// A level of the exemplar is too small for a neighborhood.
        Exemplar {
            /// Index of the level, 0 the finest.
            level: usize,
            /// Size of the level in pixels.
            size: [u32; 2],
            /// Side of the neighborhood in pixels.
            side: u32,
        } => "level {level} of the exemplar has {} x {} pixels, too few for a neighborhood of side {side}", size[0], size[1];
        /// A mask leaves no usable neighborhood on a level of the exemplar.
        Masked {
            /// Index of the level, 0 the finest.
            level: usize,
        } => "the mask leaves no neighborhood on level {level} of the exemplar";
        /// The size of a map is not an integer multiple of the exemplar's.
        Detail {
            /// Size of the map in pixels.
            map: [u32; 2],
            /// Size of the exemplar in pixels.
            exemplar: [u32; 2],
        } => "a map has {} x {} pixels, which is not the {} x {} of the exemplar times a whole number",
            map[0], map[1], exemplar[0], exemplar[1];
        /// The period of a texture is not a positive multiple of 2 to the power of the number of levels.
        Period {
            /// Requested period in columns or rows.
            period: u32,
            /// Number of levels, at most 16.
            n_levels: u32,
        } => "the period is {period}, but with {n_levels} levels it must be a multiple of {}, above 0", 1 << n_levels;
        /// The source of a pixel is outside the exemplar.
        Source {
            /// Column and row of the source.
            source: [u32; 2],
            /// Size of the exemplar in pixels.
            exemplar: [u32; 2],
        } => "a pixel is from column {} and row {}, but the exemplar has {} x {} pixels",
            source[0], source[1], exemplar[0], exemplar[1];
        /// A pass reads a coarser level that has no colors yet.
        Unfilled {
            /// Index of the pass.
            pass: usize,
            /// Index of the level that the pass reads.
            level: usize,
        } => "pass {pass} reads level {level}, which no pass before it visits";
        /// A pixel of the exemplar is NaN or infinite.
        NotFinite {
            /// Column of the pixel.
            column: u32,
            /// Row of the pixel.
            row: u32,
            /// Value of the pixel.
            value: f32,
        } => "the pixel in column {column} and row {row} is {value}, but all must be finite";
        /// A direction has no component along the surface.
        Direction {
            /// Index of the direction.
            direction: usize,
        } => "direction {direction} is zero, not finite or normal to the surface";
        /// A line of text does not match the expected format.
        Text {
            /// Name of the format.
            format: &'static str,
            /// Line number, from 1.
            line: usize,
            /// Reason, as text.
            why: String,
        } => "line {line} of the {format}: {why}";
        /// The caller's callback cancelled the synthesis.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// A mesh error.
        Mesh(MeshError),
        /// A raster error, or two rasters of different sizes.
        Raster(RasterError),
        /// An error from the color crate.
        Color(ColorError),
    }
}
