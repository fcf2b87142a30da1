//! The macro that defines the error types of all dapple crates.

/// Defines an error type of dapple: an opaque struct, its kinds with their messages, and conversions from other
/// errors.
///
/// A kind consists of its documentation, a name, fields with documentation, and a message that refers to the fields by
/// name (or the arguments of a format string). `with Range` adds the kind `Range` for a number out of range, and the
/// functions `check` and `check_in` that return it. `from` lists kinds that wrap an error of another crate, which is also
/// the source.
///
/// ```
/// dapple_raster::error! {
///     /// Error of baking a cake.
///     CakeError,
///     /// The limit that was violated.
///     CakeErrorKind with Range {
///         /// There are too many layers.
///         Layers {
///             /// Number of layers.
///             count: u32,
///         } => "there are {count} layers, but the limit is 7";
///     }
///     from {
///         /// The raster was refused.
///         Raster(dapple_raster::RasterError),
///     }
/// }
///
/// let error = CakeError::new(CakeErrorKind::Layers { count: 9 });
/// assert_eq!(error.to_string(), "there are 9 layers, but the limit is 7");
/// assert!(CakeError::check(false, "oven", 900.0, "below 250").is_err());
/// ```
#[doc(hidden)]
#[macro_export]
macro_rules! error {
    (
        $(#[$error_doc:meta])* $error:ident,
        $(#[$kind_doc:meta])* $kind:ident $(with $range:ident)? { $($kinds:tt)* }
        $(from { $($(#[$source_doc:meta])* $source:ident($from:ty)),* $(,)? })?
    ) => {
        $(#[$error_doc])*
        ///
        /// Match on [`kind`](Self::kind); the message is for people.
        #[derive(Clone, Debug, PartialEq)]
        pub struct $error {
            kind: $kind,
        }

        impl $error {
            pub(crate) fn new(kind: $kind) -> Self {
                Self { kind }
            }

            $(#[doc = concat!("Refuses a number outside of its ", stringify!($range), ".")]
            pub(crate) fn check(
                holds: bool,
                what: &'static str,
                value: f64,
                range: &'static str,
            ) -> Result<(), Self> {
                if holds {
                    return Ok(());
                }
                Err(Self::new($kind::Range { what, value, range }))
            }

            #[doc = concat!("Refuses a number outside of a `", stringify!($range), "`.")]
            pub(crate) fn check_in(
                range: $crate::Range,
                what: &'static str,
                value: f64,
            ) -> Result<(), Self> {
                Self::check(range.holds(value), what, value, range.text)
            })?

            /// Returns the cause of the error, with the limit and the value.
            #[must_use]
            pub fn kind(&self) -> &$kind {
                &self.kind
            }
        }

        impl ::core::fmt::Display for $error {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                ::core::fmt::Display::fmt(&self.kind, f)
            }
        }

        impl ::core::error::Error for $error {
            fn source(&self) -> Option<&(dyn ::core::error::Error + 'static)> {
                match &self.kind {
                    $($($kind::$source(error) => Some(error),)*)?
                    _ => None,
                }
            }
        }

        $($(impl From<$from> for $error {
            fn from(error: $from) -> Self {
                Self::new($kind::$source(error))
            }
        })*)?

        $crate::error_kind! {
            $(#[$kind_doc])* $kind $(with $range)? { $($kinds)* }
            $(from { $($(#[$source_doc])* $source($from)),* })?
        }
    };
}

/// Defines the kinds of an error whose struct is handwritten: see [`error!`](crate::error).
#[doc(hidden)]
#[macro_export]
macro_rules! error_kind {
    (
        $(#[$kind_doc:meta])* $kind:ident $(with $range:ident)? {
            $(
                $(#[$doc:meta])*
                $variant:ident $({ $($(#[$field_doc:meta])* $field:ident: $type:ty),* $(,)? })?
                    => $text:literal $(, $argument:expr)*;
            )*
        }
        $(from { $($(#[$source_doc:meta])* $source:ident($from:ty)),* $(,)? })?
    ) => {
        $(#[$kind_doc])*
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum $kind {
            $(#[doc = concat!("A number is outside of its ", stringify!($range), ".")]
            Range {
                /// Name of the number that is out of range.
                what: &'static str,
                /// Value of the number.
                value: f64,
                /// Required range, as text.
                range: &'static str,
            },)?
            $($(#[$doc])* $variant $({ $($(#[$field_doc])* $field: $type),* })?,)*
            $($($(#[$source_doc])* $source($from),)*)?
        }

        impl ::core::fmt::Display for $kind {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                match self {
                    $(Self::Range { what, value, range } => {
                        const _: &str = stringify!($range);
                        write!(f, "the {what} is {value}, but it must be {range}")
                    })?
                    $(Self::$variant $({ $($field),* })? => write!(f, $text $(, $argument)*),)*
                    $($(Self::$source(error) => ::core::fmt::Display::fmt(error, f),)*)?
                }
            }
        }
    };
}
