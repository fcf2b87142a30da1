//! Enums with named values, whose names serve recipes, the command line and documentation.

/// An enum with named values, defined by the macro `named!`.
pub trait Named: Copy + PartialEq + 'static {
    /// All values, in the order of definition.
    const ALL: &'static [Self];

    /// Names of the values, in the same order as `ALL`.
    const NAMES: &'static [&'static str];

    /// Returns the value's name in snake case.
    fn name(self) -> &'static str;

    /// Returns the alternative names that are accepted when a value is read.
    fn aliases(self) -> &'static [&'static str];

    /// Returns the value's documentation.
    fn documentation(self) -> &'static str;

    /// Returns the value with this name or alias; `None` if there is no such value.
    #[must_use]
    fn from_name(name: &str) -> Option<Self> {
        let is_named = |value: &Self| value.name() == name || value.aliases().contains(&name);
        Self::ALL.iter().copied().find(is_named)
    }
}

/// Defines an enum whose values have names. It implements [`Named`], `Display`, serde if the feature `serde` of this
/// crate is enabled, and `JsonSchema` if `schema` is.
///
/// The name follows each value, and aliases follow the name after a bar. Each value is documented, and the first
/// sentence of its documentation is the help text on the command line.
///
/// ```
/// use dapple_raster::Named;
///
/// dapple_raster::named! {
///     /// What a cake is made in.
///     #[derive(Clone, Copy, Debug, Default, PartialEq)]
///     pub enum Tin {
///         /// A ring with a hole. It bakes evenly.
///         #[default]
///         BundtPan = "bundt_pan" | "gugelhupf",
///         /// A flat sheet.
///         Sheet = "sheet",
///     }
/// }
///
/// assert_eq!(Tin::ALL, [Tin::BundtPan, Tin::Sheet]);
/// assert_eq!(Tin::from_name("gugelhupf"), Some(Tin::BundtPan));
/// assert_eq!(Tin::default().to_string(), "bundt_pan");
/// ```
#[doc(hidden)]
#[macro_export]
macro_rules! named {
    (
        $(#[$meta:meta])*
        $visibility:vis enum $kind:ident {
            $(
                $(#[doc = $doc:literal])*
                $(#[cfg_attr $attribute:tt])*
                // The inner option never occurs: a repetition must contain a variable.
                $(#[default $($default:ident)?])?
                $value:ident = $name:literal $(| $alias:literal)*
            ),* $(,)?
        }
    ) => {
        $(#[$meta])*
        $visibility enum $kind {
            $(
                $(#[doc = $doc])*
                $(#[cfg_attr $attribute])*
                $(#[default $($default)?])?
                $value,
            )*
        }

        impl $crate::Named for $kind {
            const ALL: &'static [Self] = &[$(Self::$value),*];
            const NAMES: &'static [&'static str] = &[$($name),*];

            fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $name,)*
                }
            }

            fn aliases(self) -> &'static [&'static str] {
                match self {
                    $(Self::$value => &[$($alias),*],)*
                }
            }

            fn documentation(self) -> &'static str {
                match self {
                    $(Self::$value => concat!($($doc, "\n"),*),)*
                }
            }
        }

        impl ::core::fmt::Display for $kind {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.pad($crate::Named::name(*self))
            }
        }

        $crate::named_serde! { $kind }
        $crate::named_schema! { $kind }
    };
}

/// Implements `JsonSchema` for a named enum.
#[cfg(feature = "schema")]
#[doc(hidden)]
#[macro_export]
macro_rules! named_schema {
    ($kind:ident) => {
        impl $crate::schemars::JsonSchema for $kind {
            fn schema_name() -> ::std::borrow::Cow<'static, str> {
                stringify!($kind).into()
            }

            fn json_schema(_: &mut $crate::schemars::SchemaGenerator) -> $crate::schemars::Schema {
                $crate::named_schema::<Self>()
            }
        }
    };
}

/// Without the feature `schema`, implements nothing.
#[cfg(not(feature = "schema"))]
#[doc(hidden)]
#[macro_export]
macro_rules! named_schema {
    ($kind:ident) => {};
}

/// Implements serde for a named enum: a value is serialized as its name.
#[cfg(feature = "serde")]
#[doc(hidden)]
#[macro_export]
macro_rules! named_serde {
    ($kind:ident) => {
        impl $crate::serde::Serialize for $kind {
            fn serialize<S: $crate::serde::Serializer>(
                &self,
                serializer: S,
            ) -> ::core::result::Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::Named::name(*self))
            }
        }

        impl<'de> $crate::serde::Deserialize<'de> for $kind {
            fn deserialize<D: $crate::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> ::core::result::Result<Self, D::Error> {
                $crate::read_named(deserializer)
            }
        }
    };
}

/// Without serde, implements nothing.
#[cfg(not(feature = "serde"))]
#[doc(hidden)]
#[macro_export]
macro_rules! named_serde {
    ($kind:ident) => {};
}

/// Deserializes a value from its name.
///
/// # Errors
///
/// If there is no value with this name; the error lists all names.
#[cfg(feature = "serde")]
#[doc(hidden)]
pub fn read_named<'de, T: Named, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    deserializer.deserialize_str(Name(core::marker::PhantomData))
}

/// Visitor that deserializes a value from its name.
#[cfg(feature = "serde")]
struct Name<T>(core::marker::PhantomData<T>);

#[cfg(feature = "serde")]
impl<T: Named> serde::de::Visitor<'_> for Name<T> {
    type Value = T;

    fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "one of {}", T::NAMES.join(", "))
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<T, E> {
        T::from_name(name).ok_or_else(|| E::unknown_variant(name, T::NAMES))
    }
}

#[cfg(test)]
mod tests {
    use super::Named;

    crate::named! {
        /// A shape.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        enum Shape {
            /// Round all over. It rolls.
            Ball = "ball" | "sphere",
            /// Six squares,
            /// all alike.
            #[default]
            SixSides = "six_sides",
        }
    }

    #[test]
    fn names_lead_to_their_values_and_back() {
        for (&shape, &name) in Shape::ALL.iter().zip(Shape::NAMES) {
            assert_eq!((shape.name(), shape.to_string()), (name, name.to_owned()));
            assert_eq!(Shape::from_name(name), Some(shape));
        }
        assert_eq!(Shape::from_name("sphere"), Some(Shape::Ball));
        assert_eq!(Shape::from_name("Ball"), None, "names are exact");
        assert_eq!(Shape::default(), Shape::SixSides);
        assert_eq!(
            Shape::default().documentation(),
            " Six squares,\n all alike.\n"
        );
    }

    #[cfg(feature = "serde")]
    #[test]
    fn serde_reads_and_writes_names() {
        assert_eq!(
            serde_json::to_string(&Shape::SixSides).unwrap(),
            "\"six_sides\""
        );
        let read = serde_json::from_str::<Shape>;
        assert_eq!(read("\"sphere\"").unwrap(), Shape::Ball);
        let error = read("\"cone\"").unwrap_err().to_string();
        let expected = "unknown variant `cone`, expected `ball` or `six_sides`";
        assert!(error.starts_with(expected), "{error}");
        assert!(
            read("3")
                .unwrap_err()
                .to_string()
                .contains("one of ball, six_sides")
        );
    }
}
