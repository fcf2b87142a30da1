//! Tests of the named parameters of recipes.

use dapple_recipe::{Input, Recipe, RecipeError, RecipeErrorKind};

const TEXT: &str = r##"dapple = 1
extent = [4.0, 4.0]

[parameters]
jitter = { value = 0.65, range = [0, 1], doc = "Disorder of the cells." }
cells = 2
low = 0.125
tint = "#c08040"
curve = "smooth"
from = [0.0, 0.25]
octave_gain = 0.3

[nodes.cells.worley]
frequency = "$cells"
scatter = { jittered = { jitter = "$jitter" } }
value = "f2_minus_f1"

[nodes.joint.worley]
frequency = "$cells"
scatter = { jittered = { jitter = "$jitter" } }

[nodes.noise.noise]
persistence = "$octave_gain"

[nodes.stones.levels]
input = "cells"
from = "$from"
to = ["$low", 1]
curve = "$curve"

[nodes.tinted.mix]
from = "$tint"
to = "#ffffff"
by = "noise"

[nodes.sum]
add = ["joint", "$low"]

[material]
height = "stones"
basecolor = "tinted"
roughness = "$low"
relief = "$low"
"##;

/// Replaces the parameter references in a recipe's text with their values, by string replacement.
fn substituted(text: &str) -> String {
    let start = text.find("[parameters]").expect("there are some");
    let end = text.find("[nodes.cells").expect("it is next");
    let mut text = [&text[..start], &text[end..]].concat();
    for (name, value) in [
        ("\"$jitter\"", "0.65"),
        ("\"$cells\"", "2"),
        ("\"$low\"", "0.125"),
        ("\"$tint\"", "\"#c08040\""),
        ("\"$curve\"", "\"smooth\""),
        ("\"$from\"", "[0.0, 0.25]"),
        ("\"$octave_gain\"", "0.3"),
    ] {
        text = text.replace(name, value);
    }
    assert!(!text.contains('$'), "{text}");
    text
}

fn refused(text: &str) -> RecipeError {
    Recipe::from_toml(text).expect_err("it is refused")
}

#[test]
fn parameters_have_the_effect_of_their_values() {
    let recipe = Recipe::from_toml(TEXT).unwrap();
    let plain = Recipe::from_toml(&substituted(TEXT)).unwrap();
    assert_eq!(format!("{:?}", recipe.nodes), format!("{:?}", plain.nodes));
    assert_eq!(recipe.material, plain.material);
    let jitter = recipe.parameters.get("jitter").unwrap();
    assert_eq!(jitter.value(), 0.65);
    assert_eq!(
        (jitter.range(), jitter.doc()),
        (Some([0.0, 1.0]), "Disorder of the cells.")
    );
    assert_eq!(recipe.parameters.iter().count(), 7);
}

#[test]
fn recipes_are_written_with_their_parameters() {
    let recipe = Recipe::from_toml(TEXT).unwrap();
    let (toml, json) = (recipe.to_toml().unwrap(), recipe.to_json().unwrap());
    assert_eq!(
        toml.matches("\"$").count(),
        TEXT.matches("\"$").count(),
        "{toml}"
    );
    for back in [Recipe::from_toml(&toml), Recipe::from_json(&json)] {
        let back = back.unwrap();
        assert_eq!(back.to_toml().unwrap(), toml);
        assert_eq!(format!("{:?}", back.nodes), format!("{:?}", recipe.nodes));
    }
    // An option that a program changes has its own value, and parameters without references are left out.
    let mut changed = recipe;
    changed.material.roughness = Input::Number(0.5);
    changed.nodes.shift_remove("tinted");
    changed.material.albedo = None;
    let toml = changed.to_toml().unwrap();
    assert!(
        toml.contains("roughness = 0.5") && toml.contains("relief = \"$low\""),
        "{toml}"
    );
    assert!(!toml.contains("tint"), "{toml}");
    assert!(Recipe::from_toml(&toml).is_ok());
}

#[test]
fn set_changes_all_options_that_share_a_parameter() {
    let mut recipe = Recipe::from_toml(TEXT).unwrap();
    recipe.set("jitter", "0.8").unwrap();
    recipe.set("parameters.low", "0.25").unwrap();
    let text = TEXT.replace("value = 0.65", "value = 0.8");
    let text = text.replace("low = 0.125", "low = 0.25");
    let other = Recipe::from_toml(&text).unwrap();
    assert_eq!(recipe.to_toml().unwrap(), other.to_toml().unwrap());
    assert_eq!(recipe.material.relief, 0.25);
    // An option may leave its parameter, and the last one takes the parameter away.
    recipe.set("stones.curve", "linear").unwrap();
    assert!(recipe.parameters.get("curve").is_none());
    recipe.set("cells.frequency", "4").unwrap();
    assert!(
        recipe.parameters.get("cells").is_some(),
        "a node still refers to it"
    );
    recipe.set("sum", "1").expect_err("it is a node");
    recipe.set("stones.from", "[\"$low\", 0.5]").unwrap();
    assert!(
        recipe.to_toml().unwrap().contains("\"$low\",\n"),
        "{}",
        recipe.to_toml().unwrap()
    );
    for (path, value, part) in [
        ("jitter", "1.5", "must be from 0 to 1"),
        ("jitter", "much", "only numbers have a range"),
        (
            "cells",
            "much",
            "the parameter `cells` does not fit `nodes.",
        ),
        ("parameters.jiter", "1", "did you mean `jitter`?"),
        ("jiter", "1", "did you mean `jitter`?"),
    ] {
        let before = recipe.to_toml().unwrap();
        let error = recipe.set(path, value).expect_err(path).to_string();
        assert!(error.contains(part), "{error}");
        assert_eq!(recipe.to_toml().unwrap(), before);
    }
}

#[test]
fn errors_of_parameters_have_the_parameter_and_the_option() {
    let unknown = refused(&TEXT.replace("\"$tint\"", "\"$tnit\""));
    let RecipeErrorKind::UnknownParameter { name, option } = unknown.kind() else {
        panic!("{unknown}");
    };
    assert_eq!(
        (name.as_str(), option.as_str()),
        ("tnit", "nodes.tinted.mix.from")
    );
    assert_eq!(unknown.nearest(), Some("tint"));
    let line = TEXT
        .lines()
        .position(|line| line.contains("\"$tint\""))
        .unwrap()
        + 1;
    assert_eq!(unknown.place().map(|place| place.line), Some(line));

    let unused = refused(&TEXT.replace("cells = 2", "cells = 2\nother = 3"));
    assert!(matches!(unused.kind(), RecipeErrorKind::UnusedParameter { name } if name == "other"));
    assert_eq!(unused.place().map(|place| place.line), Some(7));

    let unfit = refused(&TEXT.replace("curve = \"smooth\"", "curve = \"smoth\""));
    let RecipeErrorKind::Parameter {
        name,
        option,
        message,
    } = unfit.kind()
    else {
        panic!("{unfit}");
    };
    assert_eq!(
        (name.as_str(), option.as_str()),
        ("curve", "nodes.stones.levels.curve")
    );
    assert!(message.contains("did you mean `smooth`?"), "{message}");
    // The error has the position of the reference, also if an element of a list does not fit.
    let unfit = refused(&TEXT.replace("from = [0.0, 0.25]", "from = [0.0, true]"));
    let line = TEXT
        .lines()
        .position(|line| line.contains("\"$from\""))
        .unwrap()
        + 1;
    assert_eq!(unfit.place().map(|place| place.line), Some(line), "{unfit}");

    for (parameter, part) in [
        ("cells = { range = [0, 1] }", "`value` is missing"),
        ("cells = { value = 2, range = [3, 1] }", "the smaller first"),
        (
            "cells = { value = 2, range = [3, 4] }",
            "the value is 2, but it must be from 3 to 4",
        ),
        ("cells = { value = 2, docs = \"\" }", "`docs`"),
        ("cells = \"$low\"", "without `$`"),
        ("cells = [[1]]", "a list of these"),
        ("\"1 cells\" = 2", "not made of letters"),
    ] {
        let error = refused(&TEXT.replace("cells = 2", parameter));
        assert!(error.to_string().contains(part), "{error}");
        assert_eq!(error.place().map(|place| place.line), Some(6), "{error}");
    }
    let error = refused(&format!("parameters = 3\n{}", substituted(TEXT)));
    assert!(
        error.to_string().contains("a table of values by name"),
        "{error}"
    );
}
