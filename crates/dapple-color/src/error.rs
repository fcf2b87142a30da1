//! Errors from colors, ramps and maps.

use dapple_raster::RasterError;
use dapple_raster::glam::DVec2;

dapple_raster::error! {
    /// An error from a color, a ramp or a map.
    ColorError,
    /// The cause of a [`ColorError`], with the limit and the value.
    ColorErrorKind {
        /// A text is not a hexadecimal color.
        Hex {
            /// The text.
            text: String,
        } => "{text:?} is not a color; it must be 3 or 6 hexadecimal digits, with or without #";
        /// A ramp has no stop.
        NoStops => "a color ramp needs at least one stop";
        /// A number is not finite.
        NotFinite {
            /// Name of the invalid number, as in the message.
            what: &'static str,
            /// The invalid number.
            value: f64,
        } => "the {what} is {value}, but it must be finite";
        /// An extent is not above zero and finite.
        Extent {
            /// The extent.
            extent: DVec2,
        } => "the extent is {} × {}, but both must be above zero and finite", extent.x, extent.y;
        /// A radius is negative, or spans too many pixels.
        Radius {
            /// The radius.
            radius: f64,
            /// The radius in pixels, measured along the axis on which pixels are smaller.
            pixels: f64,
            /// The largest radius in pixels.
            limit: u32,
        } => "the radius {radius} is {pixels} pixels, but it must be from 0 to {limit} pixels";
        /// The fraction of a radius over which occlusion fades is not from 0 to 1.
        Fade {
            /// The fraction.
            fade: f64,
        } => "the fade is {fade}, but it must be from 0 to 1";
        /// The stops of a ramp are not in order.
        Unsorted {
            /// The first position that is smaller than the one before it.
            position: f32,
            /// The position before it.
            before: f32,
        } => "the stop at {position} follows the stop at {before}, but stops must be in order";
        /// The operation was canceled by the caller's callback.
        Cancelled => "the callback asked to stop";
    }
    from {
        /// An error in the resulting raster, such as its size.
        Raster(RasterError),
    }
}
