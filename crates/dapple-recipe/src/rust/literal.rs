//! Values as Rust expressions.

use dapple_color::LinearRgb;
use dapple_hash::Seed;
use dapple_pups::{AxialWeight, NetOptions, OctaveSource, Orientations, Spacing, Spots};
use dapple_raster::{Ramp, Varying};
use glam::{DVec2, DVec3};

/// A value that can be written as a Rust expression.
pub(super) trait Literal {
    fn literal(&self) -> String;
}

/// The Rust expression of a value.
pub(super) fn literal(value: &impl Literal) -> String {
    value.literal()
}

/// The fields of a struct that differ from their defaults, in a struct expression with the rest.
macro_rules! struct_literal {
    ($name:expr, $value:expr, $default:expr, [$($field:ident),* $(,)?]) => {{
        let (value, default) = (&$value, $default);
        let mut fields: Vec<String> = Vec::new();
        $({
            let field = $crate::rust::literal::literal(&value.$field);
            if field != $crate::rust::literal::literal(&default.$field) {
                fields.push(format!("{}: {field}", stringify!($field)));
            }
        })*
        if fields.is_empty() {
            format!("{}::default()", $name)
        } else {
            format!("{} {{ {}, ..{}::default() }}", $name, fields.join(", "), $name)
        }
    }};
}

pub(super) use struct_literal;

/// Types whose `Debug` is a Rust expression.
macro_rules! as_debug {
    ($($kind:ty),*) => {
        $(impl Literal for $kind {
            fn literal(&self) -> String {
                format!("{self:?}")
            }
        })*
    };
}

as_debug!(u32, f32, f64, bool);

impl<T: Literal, const N: usize> Literal for [T; N] {
    fn literal(&self) -> String {
        let parts: Vec<_> = self.iter().map(Literal::literal).collect();
        format!("[{}]", parts.join(", "))
    }
}

impl<T: Literal> Literal for Vec<T> {
    fn literal(&self) -> String {
        let parts: Vec<_> = self.iter().map(Literal::literal).collect();
        format!("vec![{}]", parts.join(", "))
    }
}

impl<T: Literal> Literal for Option<T> {
    fn literal(&self) -> String {
        match self {
            Some(value) => format!("Some({})", value.literal()),
            None => "None".to_owned(),
        }
    }
}

impl Literal for Seed {
    fn literal(&self) -> String {
        format!("Seed({})", self.0)
    }
}

impl Literal for DVec2 {
    fn literal(&self) -> String {
        format!("DVec2::new({:?}, {:?})", self.x, self.y)
    }
}

impl Literal for DVec3 {
    fn literal(&self) -> String {
        format!(
            "dapple::raster::glam::DVec3::new({:?}, {:?}, {:?})",
            self.x, self.y, self.z
        )
    }
}

impl Literal for LinearRgb {
    fn literal(&self) -> String {
        let [r, g, b] = self.to_srgb::<u8>();
        if Self::from_srgb([r, g, b]) == *self {
            format!("LinearRgb::from_srgb([0x{r:02x}_u8, 0x{g:02x}, 0x{b:02x}])")
        } else {
            format!("LinearRgb::new({:?}, {:?}, {:?})", self.r, self.g, self.b)
        }
    }
}

impl Literal for Ramp {
    fn literal(&self) -> String {
        let Self {
            from,
            to,
            start,
            end,
        } = self;
        format!(
            "dapple::raster::Ramp {{ from: {}, to: {}, start: {start:?}, end: {end:?} }}",
            from.literal(),
            to.literal()
        )
    }
}

impl Literal for Varying {
    fn literal(&self) -> String {
        match self {
            Self::Constant(value) => format!("dapple::raster::Varying::Constant({value:?})"),
            Self::Ramp(ramp) => format!("dapple::raster::Varying::Ramp({})", ramp.literal()),
            Self::GeometricRamp(ramp) => {
                format!("dapple::raster::Varying::GeometricRamp({})", ramp.literal())
            }
            // Recipes are data and have neither.
            Self::Raster { .. } | Self::Function(_) => {
                "dapple::raster::Varying::Constant(f64::NAN)".to_owned()
            }
        }
    }
}

impl Literal for Spacing {
    fn literal(&self) -> String {
        match self {
            Self::Distance(Varying::Constant(distance)) => {
                format!("pups::Spacing::from({distance:?})")
            }
            Self::Distance(distance) => format!("pups::Spacing::Distance({})", distance.literal()),
            Self::Density(density) => format!("pups::Spacing::Density({})", density.literal()),
            Self::Count(count) => format!("pups::Spacing::Count({count})"),
            other => format!("{other:?}"),
        }
    }
}

impl Literal for AxialWeight {
    fn literal(&self) -> String {
        format!("pups::AxialWeight::{self:?}")
    }
}

impl Literal for OctaveSource {
    fn literal(&self) -> String {
        format!("pups::OctaveSource::{self:?}")
    }
}

impl Literal for Spots {
    fn literal(&self) -> String {
        format!("pups::Spots::{self:?}")
    }
}

impl Literal for Orientations {
    fn literal(&self) -> String {
        match self {
            Self::None => "pups::Orientations::None".to_owned(),
            Self::Random => "pups::Orientations::Random".to_owned(),
            Self::Same(vector) => format!("pups::Orientations::Same({})", vector.literal()),
            Self::AwayFrom(center) => format!("pups::Orientations::AwayFrom({})", center.literal()),
            Self::Angle(angle) => format!("pups::Orientations::Angle({})", angle.literal()),
            other => format!("{other:?}"),
        }
    }
}

impl Literal for NetOptions {
    fn literal(&self) -> String {
        struct_literal!(
            "pups::NetOptions",
            self,
            Self::default(),
            [axis_scale, weight, orientations, strength]
        )
    }
}
