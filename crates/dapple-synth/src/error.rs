//! Why an exemplar, a schedule or a direction was refused.

use dapple_color::ColorError;
use dapple_mesh::MeshError;
use dapple_raster::RasterError;

dapple_raster::error! {
    /// Why a texture could not be made.
    SynthError,
    /// The limit that was broken.
    SynthErrorKind with Range {
        /// There are more or fewer things than needed.
        Count {
            /// The name of the counted things.
            what: &'static str,
            /// How many there are.
            count: usize,
            /// How many were needed, as text.
            needed: &'static str,
        } => "there are {count} {what}, but {needed} are needed";
        /// A level of the exemplar is too small for a neighborhood.
        Exemplar {
            /// The level, 0 the finest.
            level: usize,
            /// Its size in pixels.
            size: [u32; 2],
            /// The side of the neighborhood.
            side: u32,
        } => "level {level} of the exemplar has {} x {} pixels, too few for a neighborhood of side {side}", size[0], size[1];
        /// A mask leaves nothing of a level of the exemplar.
        Masked {
            /// The level, 0 the finest.
            level: usize,
        } => "the mask leaves no neighborhood on level {level} of the exemplar";
        /// A map is no whole number of times as large as the exemplar.
        Detail {
            /// The size of the map in pixels.
            map: [u32; 2],
            /// That of the exemplar.
            exemplar: [u32; 2],
        } => "a map has {} x {} pixels, which is not the {} x {} of the exemplar times a whole number",
            map[0], map[1], exemplar[0], exemplar[1];
        /// A texture with so many levels cannot repeat after so many pixels.
        Period {
            /// The columns or rows after which it should repeat.
            period: u32,
            /// The number of levels, which is at most 16.
            n_levels: u32,
        } => "the period is {period}, but with {n_levels} levels it must be a multiple of {}, above 0", 1 << n_levels;
        /// The source of a pixel is no pixel of the exemplar.
        Source {
            /// The column and row of the source.
            source: [u32; 2],
            /// The size of the exemplar in pixels.
            exemplar: [u32; 2],
        } => "a pixel is from column {} and row {}, but the exemplar has {} x {} pixels",
            source[0], source[1], exemplar[0], exemplar[1];
        /// A pass reads a coarser level that has no colors yet.
        Unfilled {
            /// Which pass.
            pass: usize,
            /// The level that it reads.
            level: usize,
        } => "pass {pass} reads level {level}, which no pass before it visits";
        /// A pixel of the exemplar is NaN or infinite.
        NotFinite {
            /// Its column.
            column: u32,
            /// Its row.
            row: u32,
            /// Its value.
            value: f32,
        } => "the pixel in column {column} and row {row} is {value}, but all must be finite";
        /// A direction has no part along the surface.
        Direction {
            /// Which of the directions.
            direction: usize,
        } => "direction {direction} is zero, not finite or normal to the surface";
        /// A line of a text does not follow its format.
        Text {
            /// The format.
            format: &'static str,
            /// The number of the line, from 1.
            line: usize,
            /// The reason.
            why: String,
        } => "line {line} of the {format}: {why}";
        /// The caller's callback asked to stop.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// The mesh was refused.
        Mesh(MeshError),
        /// The raster was refused, or two sizes differ.
        Raster(RasterError),
        /// The color crate refused its input.
        Color(ColorError),
    }
}
