//! Tests of reading and writing recipes as text, and of errors with positions.

use dapple_recipe::{MAX_TEXT, Place, Recipe, RecipeError, RecipeErrorKind};

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
fn a_mark_changes_neither_recipes_nor_the_places_of_errors() {
    let json = Recipe::from_toml(STONES).unwrap().to_json().unwrap();
    let marked = |text: &str| format!("\u{feff}{text}");
    for recipe in [
        Recipe::from_toml(&marked(STONES)).unwrap(),
        Recipe::from_json(&json).unwrap(),
        Recipe::from_json(&marked(&json)).unwrap(),
    ] {
        assert_eq!(recipe.to_json().unwrap(), json);
    }
    let wrong = "dapple = 1\n".replace('1', "one");
    let place = |text: &str| Recipe::from_toml(text).unwrap_err().place();
    assert_eq!(place(&marked(&wrong)), place(&wrong), "{wrong}");
    // UTF-16 without a mark is a text in UTF-8 with zeros.
    let wide: String = STONES.chars().flat_map(|c| [c, '\0']).collect();
    for error in [Recipe::from_toml(&wide), Recipe::from_json(&wide)] {
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains("the text is UTF-16, but must be UTF-8"),
            "{error}"
        );
    }
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
        ("octaves = [3]", "a table"),
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
fn options_are_read_by_themselves_with_the_words_of_recipes() {
    use dapple_recipe::read_options;
    use dapple_worley::{Metric, Octaves, Scatter};
    use serde_json::json;

    let refused =
        |error: RecipeError| (error.kind().to_string(), error.nearest().map(str::to_owned));
    let octaves = |value| refused(read_options::<Octaves>(&value).unwrap_err());
    let (message, _) = octaves(json!(4));
    assert_eq!(message, "found the number `4`, expected a table");
    let (_, nearest) = octaves(json!({ "count": 4, "gian": 0.5 }));
    assert_eq!(nearest.as_deref(), Some("gain"));
    let scatter = |value| refused(read_options::<Scatter>(&value).unwrap_err()).0;
    let needed = "is written with options: a table with the one key `jittered`, whose value is a table of jitter";
    assert_eq!(scatter(json!("jittered")), format!("`jittered` {needed}"));
    assert_eq!(scatter(json!({ "jittered": {} })), "`jitter` is missing");
    let (message, _) = refused(read_options::<Metric>(&json!("minkowski")).unwrap_err());
    assert_eq!(
        message,
        "`minkowski` is written with a value: a table with the one key `minkowski`"
    );
    assert_eq!(
        read_options::<Metric>(&json!("manhattan")).unwrap(),
        Metric::Manhattan
    );
    let error = read_options::<[f32; 3]>(&json!([0, 0.5, 1, 1])).unwrap_err();
    assert_eq!(
        error.kind().to_string(),
        "found a list of 4 values, expected 3"
    );
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
        format!("{{\n\"dapple\": 1,\n\"nodes\": {{\n{nodes}\n}},\n\"material\": {{{material}}}\n}}")
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
    let error = Recipe::from_toml(&"#".repeat(MAX_TEXT + 1)).unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::Count { .. }),
        "{error}"
    );
}

#[test]
fn set_equals_the_text_with_another_value() {
    let text = |jitter: &str, from: &str, seed: &str| {
        format!(
            r#"
            dapple = 1
            seed = {seed}
            [nodes.cells.worley]
            scatter = {{ jittered = {{ jitter = {jitter} }} }}
            [nodes.stones.levels]
            input = "cells"
            from = {from}
            curve = "smooth"
            [material]
            height = "stones"
            "#
        )
    };
    let read = |text: &str| Recipe::from_toml(text).expect("it is valid");
    let mut recipe = read(&text("0.8", "[0.0, 0.3]", "7"));
    for (path, value) in [
        ("cells.scatter.jittered.jitter", "0.25"),
        ("stones.from", "[0.1, 0.4]"),
        ("stones.curve", "linear"),
        ("seed", "9"),
        ("material.relief", "2"),
        ("extent", "[4, 4.5]"),
    ] {
        recipe.set(path, value).expect("it is valid");
    }
    let mut expected = read(&text("0.25", "[0.1, 0.4]", "9").replace("smooth", "linear"));
    expected.material.relief = 2.0;
    expected.extent = [4.0, 4.5];
    assert_eq!(
        recipe.to_json().expect("data"),
        expected.to_json().expect("data")
    );
}

#[test]
fn set_refuses_what_recipes_do_not_have_and_changes_nothing() {
    let mut recipe = Recipe::builtin("flagstone").expect("it is built in");
    let before = recipe.to_json().expect("data");
    let node = recipe.nodes.keys().next().expect("it has nodes").clone();
    for (path, value, nearest) in [
        ("matreial.relief", "1", Some("material")),
        ("material.releif", "1", Some("relief")),
        ("material.relief", "high", None),
        ("material.relief", "1\nheight = 2", None),
        ("material.relief", "nan", None),
        ("seed", "-1", None),
        ("nodes", "{}", None),
        ("", "1", None),
        (node.as_str(), "1", None),
        (&format!("{node}."), "1", None),
        (&format!("{node}.no.such.option"), "1", None),
    ] {
        let error = recipe.set(path, value).expect_err(path);
        assert_eq!(error.nearest(), nearest, "{path} = {value}: {error}");
        assert_eq!(recipe.to_json().expect("data"), before, "{path}");
    }
}
