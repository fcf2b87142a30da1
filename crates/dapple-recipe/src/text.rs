//! Recipes as text: TOML and JSON, with errors that name the line and the nearest valid word.

use crate::{Place, PupsNode, Recipe, RecipeError, RecipeErrorKind, SCHEMA};
use content::Content;
use serde::Deserialize as _;
use serde_json::Value;

mod content;
mod refusal;

/// The most bytes of a recipe. More than this is no recipe.
pub const MAX_TEXT: usize = 1 << 22;

impl Recipe {
    /// The recipe that a text in TOML holds.
    ///
    /// Its names and inputs are not checked here, but when it is made into a plan.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) for what is no TOML, or says what a recipe does not have, with the line and the
    /// nearest valid word; [`Schema`](RecipeErrorKind::Schema) for another version; [`Count`](RecipeErrorKind::Count)
    /// past [`MAX_TEXT`] bytes.
    pub fn from_toml(text: &str) -> Result<Self, RecipeError> {
        check_length(text)?;
        let content: Content = toml::from_str(text).map_err(|error| {
            let byte = error.span().map(|span| span.start);
            text_error(error.message()).at(byte.map(|byte| place_of(text, byte)))
        })?;
        check_version(&content)?;
        Self::deserialize(&content).map_err(|refusal| {
            let byte = refusal.byte_in_toml(text);
            text_error(&refusal.message).at(byte.map(|byte| place_of(text, byte)))
        })
    }

    /// The recipe that a text in JSON holds.
    ///
    /// # Errors
    ///
    /// Those of [`from_toml`](Self::from_toml).
    pub fn from_json(text: &str) -> Result<Self, RecipeError> {
        check_length(text)?;
        let content: Content = serde_json::from_str(text).map_err(|error| {
            let (line, column) = (error.line(), error.column());
            let full = error.to_string();
            // The reader's own words for the place are cut off, since the error tells it in ours.
            let message = full.split(" at line ").next().unwrap_or(&full);
            text_error(message).at((line > 0).then_some(Place { line, column }))
        })?;
        check_version(&content)?;
        Self::deserialize(&content)
            .map_err(|refusal| text_error(&refusal.message).at(refusal.place_in_json(text)))
    }

    /// The recipe as TOML.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if it holds what cannot be written as data, such as a function.
    pub fn to_toml(&self) -> Result<String, RecipeError> {
        toml::to_string_pretty(self).map_err(|error| text_error(&error.to_string()))
    }

    /// The recipe as JSON.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if it holds what cannot be written as data, such as a function.
    pub fn to_json(&self) -> Result<String, RecipeError> {
        serde_json::to_string_pretty(self).map_err(|error| text_error(&error.to_string()))
    }
}

fn check_length(text: &str) -> Result<(), RecipeError> {
    if text.len() > MAX_TEXT {
        return Err(RecipeError::new(RecipeErrorKind::Count {
            what: "bytes",
            count: text.len(),
            needed: "at most 4 MiB",
        }));
    }
    Ok(())
}

impl PupsNode {
    /// The texture as a value of JSON.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) if it holds what cannot be written as data, such as a function.
    pub fn to_json(&self) -> Result<Value, RecipeError> {
        serde_json::to_value(self).map_err(|error| text_error(&error.to_string()))
    }

    /// The texture of a value of JSON.
    ///
    /// # Errors
    ///
    /// [`Text`](RecipeErrorKind::Text) for what no texture has.
    pub fn from_json(value: &Value) -> Result<Self, RecipeError> {
        let content =
            Content::deserialize(value).map_err(|error| text_error(&error.to_string()))?;
        Self::deserialize(&content).map_err(|refusal| text_error(&refusal.message))
    }
}

/// Refuses a recipe of another version, whatever else is wrong with it.
fn check_version(content: &Content) -> Result<(), RecipeError> {
    let version = match content.get("dapple") {
        Some(Content::Signed(version)) => u32::try_from(*version),
        Some(Content::Unsigned(version)) => u32::try_from(*version),
        _ => return Ok(()),
    };
    match version {
        Ok(version) if version != SCHEMA => {
            Err(RecipeError::new(RecipeErrorKind::Schema { version }))
        }
        _ => Ok(()),
    }
}

/// The error of a reader, with the nearest of the words that it says it expected.
fn text_error(message: &str) -> RecipeError {
    let message = plain(&message.lines().collect::<Vec<_>>().join(" "));
    let error = RecipeError::new(RecipeErrorKind::Text {
        message: message.clone(),
    });
    // Readers write ``unknown field `densty`, expected one of `density`, `seed` ``.
    let mut words = message.split('`').skip(1).step_by(2);
    match words.next() {
        Some(written) if message.starts_with("unknown ") => error.meant(written, words),
        _ => error,
    }
}

/// The message with the names of Rust types, if it ends in one, as what is to be written.
fn plain(message: &str) -> String {
    let Some((found, expected)) = message.rsplit_once(", expected ") else {
        return message.to_owned();
    };
    let expected = match expected.split(' ').next() {
        Some("struct" | "map") => "a table",
        Some("enum" | "internally" | "adjacently") => "a word or a table",
        Some("tuple") => "a list",
        Some("f32" | "f64") => "a number",
        Some("u8" | "u16" | "u32" | "u64" | "usize") => "a whole number that is not negative",
        Some("i8" | "i16" | "i32" | "i64" | "isize") => "a whole number",
        _ => expected,
    };
    format!("{found}, expected {expected}")
}

/// The line and the column of a byte.
fn place_of(text: &str, byte: usize) -> Place {
    let before = text.get(..byte).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    Place {
        line: before.matches('\n').count() + 1,
        column: before[line_start..].chars().count() + 1,
    }
}

#[cfg(test)]
mod tests {
    use crate::{Place, Recipe, RecipeErrorKind};

    const STONES: &str = "dapple = 1\n\n[nodes.cells.worley]\nvalue = \"f2_minus_f1\"\nfrequency = 8\n\n[material]\nheight = \"cells\"\n";

    #[test]
    fn a_recipe_is_the_same_after_toml_and_json() {
        let recipe = Recipe::from_toml(STONES).unwrap();
        let toml = Recipe::from_toml(&recipe.to_toml().unwrap()).unwrap();
        let json = Recipe::from_json(&recipe.to_json().unwrap()).unwrap();
        assert_eq!(
            recipe.to_json().unwrap(),
            toml.to_json().unwrap(),
            "through TOML"
        );
        assert_eq!(
            recipe.to_json().unwrap(),
            json.to_json().unwrap(),
            "through JSON"
        );
    }

    #[test]
    fn json_keeps_every_bit_of_a_number() {
        let text = STONES.replace(
            "frequency = 8",
            "range = [0, 1]\n[nodes.wide.distance]\ncenter = [0.218446744073709551616, 1.3e-7]",
        );
        let json = Recipe::from_toml(&text).unwrap().to_json().unwrap();
        let again = Recipe::from_json(&json).unwrap().to_json().unwrap();
        assert_eq!(json, again, "written and read again");
    }

    #[test]
    fn a_wrong_word_is_told_with_its_line_and_the_nearest_valid_one() {
        let cases = [
            ("frequency", "frequenzy", 5, "frequency"),
            ("worley", "worly", 3, "worley"),
            ("f2_minus_f1", "f2-minus-f1", 4, "f2_minus_f1"),
            ("height", "heigth", 8, "height"),
            ("[material]", "[materials]", 7, "material"),
        ];
        for (right, wrong, line, nearest) in cases {
            let error = Recipe::from_toml(&STONES.replacen(right, wrong, 1)).unwrap_err();
            assert_eq!(
                error.place().map(|place| place.line),
                Some(line),
                "{wrong}: {error}"
            );
            assert_eq!(error.nearest(), Some(nearest), "{wrong}: {error}");
        }
    }

    #[test]
    fn a_wrong_value_is_told_without_names_of_types() {
        for (wrong, expected) in [
            ("octaves = 3", "a table"),
            ("metric = 3", "a word or a table"),
            ("octaves.gain = \"high\"", "a number"),
            ("octaves.count = -1", "a whole number that is not negative"),
            ("octaves.count = []", "a whole number that is not negative"),
        ] {
            let text = STONES.replace("frequency = 8", wrong);
            let error = Recipe::from_toml(&text).unwrap_err().to_string();
            assert!(
                error.ends_with(&format!("expected {expected}")),
                "{wrong}: {error}"
            );
        }
    }

    #[test]
    fn words_of_other_programs_are_read() {
        let text = |gain: &str, albedo: &str| {
            let nodes = format!(
                "frequency = 8\noctaves = {{ count = 2, {gain} = 0.7 }}\n[nodes.n.noise]\n{gain} = 0.7\n[nodes.o.pups.octaves]\n{gain} = 0.7\n[nodes.c.pups.cellular_noise]\n{gain} = 0.7\n"
            );
            STONES.replace("frequency = 8", &nodes) + &format!("{albedo} = \"cells\"\n")
        };
        let json = |gain, albedo| {
            Recipe::from_toml(&text(gain, albedo))
                .unwrap()
                .to_json()
                .unwrap()
        };
        assert_eq!(json("gain", "albedo"), json("persistence", "basecolor"));
    }

    #[test]
    fn json_errors_name_the_line_too() {
        let json = Recipe::from_toml(STONES).unwrap().to_json().unwrap();
        let error = Recipe::from_json(&json.replace("frequency", "frequenzy")).unwrap_err();
        assert_eq!(error.nearest(), Some("frequency"), "{error}");
        assert!(error.place().is_some_and(|place| place.line > 3), "{error}");
        assert!(
            !error.to_string().contains(" at line "),
            "the place is told once: {error}"
        );
    }

    #[test]
    fn a_key_that_is_there_twice_is_refused_with_its_line() {
        let json = |nodes: &str, material: &str| {
            format!(
                "{{\n\"dapple\": 1,\n\"nodes\": {{\n{nodes}\n}},\n\"material\": {{{material}}}\n}}"
            )
        };
        let a = "\"a\": {\"worley\": {}}";
        for (text, line, key) in [
            (json(&format!("{a},\n{a}"), ""), 5, "a"),
            (
                json(
                    "\"a\": {\"worley\": {\"seed\": 1,\n\"frequency\": 2, \"seed\": 3}}",
                    "",
                ),
                5,
                "seed",
            ),
            (json(a, "\"relief\": 1, \"relief\": 2"), 6, "relief"),
            (json(a, "}, \"seed\": 1, \"seed\": {"), 6, "seed"),
        ] {
            let error = Recipe::from_json(&text).expect_err(&text);
            let message = error.to_string();
            assert!(
                message.contains(&format!("`{key}` is there twice")),
                "{message}"
            );
            assert_eq!(error.place().map(|place| place.line), Some(line), "{error}");
        }
        let once = Recipe::from_json(&json(a, "")).unwrap();
        assert_eq!(once.nodes.len(), 1);
    }

    #[test]
    fn what_is_no_toml_is_told_with_its_place() {
        let error = Recipe::from_toml("dapple = 1\nseed = = 3\n").unwrap_err();
        assert!(
            matches!(error.kind(), RecipeErrorKind::Text { .. }),
            "{error}"
        );
        assert_eq!(error.place(), Some(Place { line: 2, column: 8 }), "{error}");
    }

    #[test]
    fn another_version_is_told_before_anything_else() {
        for text in ["dapple = 2\nflowers = 3\n", "dapple = 0\n"] {
            let error = Recipe::from_toml(text).unwrap_err();
            assert!(
                matches!(error.kind(), RecipeErrorKind::Schema { .. }),
                "{error}"
            );
        }
    }

    #[test]
    fn a_text_past_the_limit_is_refused() {
        let error = Recipe::from_toml(&"#".repeat(super::MAX_TEXT + 1)).unwrap_err();
        assert!(
            matches!(error.kind(), RecipeErrorKind::Count { .. }),
            "{error}"
        );
    }
}
