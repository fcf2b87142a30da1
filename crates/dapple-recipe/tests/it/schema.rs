//! Tests of the schema against the parser, with a validator for the keywords that the schema uses.

use dapple_recipe::{Images, KINDS, Plan, PupsNode, Recipe};
use serde_json::{Map, Value};

const README: &str = include_str!("../../README.md");

/// Pattern of colors in the schema.
const HEX: &str = "^#([0-9a-fA-F]{3}|[0-9a-fA-F]{6})$";

/// The reason why a value does not match a schema.
type Misfit = String;

/// Validates a recipe in TOML against the schema.
fn validate(text: &str) -> Result<(), Misfit> {
    let value: Value = toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    let root = Recipe::text_schema();
    fits(&root, &root, &value)
}

/// Validates a value against a schema. `root` is the whole schema, which holds the referenced types.
fn fits(root: &Value, schema: &Value, value: &Value) -> Result<(), Misfit> {
    let schema = match schema {
        Value::Bool(true) => return Ok(()),
        Value::Object(schema) => schema,
        other => return Err(format!("{other} fits nothing")),
    };
    for (keyword, rule) in schema {
        keyword_fits(root, schema, (keyword, rule), value)
            .map_err(|why| format!("{value}: {keyword}: {why}"))?;
    }
    Ok(())
}

fn keyword_fits(
    root: &Value,
    schema: &Map<String, Value>,
    rule: (&str, &Value),
    value: &Value,
) -> Result<(), Misfit> {
    let (keyword, rule) = rule;
    let number = |holds: fn(f64, f64) -> bool| {
        let bound = rule.as_f64().expect("a bound");
        value.as_f64().is_none_or(|number| holds(number, bound))
    };
    let length = |holds: fn(u64, u64) -> bool| {
        let bound = rule.as_u64().expect("a length");
        value
            .as_array()
            .is_none_or(|all| holds(all.len() as u64, bound))
    };
    let holds = match keyword {
        "$schema" | "title" | "description" | "default" | "format" | "deprecated" | "$defs" => true,
        "$ref" => {
            let path = rule.as_str().expect("a path").trim_start_matches('#');
            return fits(root, root.pointer(path).expect(path), value);
        }
        "type" => match rule {
            Value::Array(types) => types.iter().any(|rule| is_of(rule, value)),
            rule => is_of(rule, value),
        },
        "const" => value == rule,
        "enum" => rule.as_array().expect("words").contains(value),
        "pattern" => value
            .as_str()
            .is_none_or(|text| matches(rule.as_str().expect("text"), text)),
        "minimum" => number(|number, bound| number >= bound),
        "maximum" => number(|number, bound| number <= bound),
        "exclusiveMinimum" => number(|number, bound| number > bound),
        "exclusiveMaximum" => number(|number, bound| number < bound),
        "minItems" => length(|length, bound| length >= bound),
        "maxItems" => length(|length, bound| length <= bound),
        "items" => {
            return all_fit(
                root,
                value
                    .as_array()
                    .into_iter()
                    .flatten()
                    .map(|item| (rule, item)),
            );
        }
        "anyOf" | "oneOf" => return some_fit(root, keyword, rule, value),
        "required" | "properties" | "additionalProperties" => {
            return value
                .as_object()
                .map_or(Ok(()), |table| table_fits(root, schema, table));
        }
        keyword => panic!("the validator does not know {keyword}"),
    };
    holds.then_some(()).ok_or_else(|| rule.to_string())
}

fn all_fit<'a>(
    root: &Value,
    mut pairs: impl Iterator<Item = (&'a Value, &'a Value)>,
) -> Result<(), Misfit> {
    pairs.try_for_each(|(schema, value)| fits(root, schema, value))
}

fn some_fit(root: &Value, keyword: &str, rule: &Value, value: &Value) -> Result<(), Misfit> {
    let all = rule.as_array().expect("schemas");
    let results: Vec<_> = all.iter().map(|schema| fits(root, schema, value)).collect();
    let count = results.iter().filter(|result| result.is_ok()).count();
    if count == 1 || (keyword == "anyOf" && count > 0) {
        return Ok(());
    }
    Err(format!("{count} fit: {results:?}"))
}

fn table_fits(
    root: &Value,
    schema: &Map<String, Value>,
    table: &Map<String, Value>,
) -> Result<(), Misfit> {
    for name in schema
        .get("required")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
    {
        if !table.contains_key(name.as_str().expect("a name")) {
            return Err(format!("{name} is missing"));
        }
    }
    for (name, value) in table {
        let of_name = schema.get("properties").and_then(|known| known.get(name));
        match (of_name, schema.get("additionalProperties")) {
            (Some(schema), _) => fits(root, schema, value)?,
            (None, Some(Value::Bool(false))) => return Err(format!("`{name}` is unknown")),
            (None, Some(schema)) => fits(root, schema, value)?,
            (None, None) => {}
        }
    }
    Ok(())
}

fn is_of(rule: &Value, value: &Value) -> bool {
    match rule.as_str().expect("a type") {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the validator does not know the type {other}"),
    }
}

/// Returns whether a text matches a pattern. Only the patterns that the schema uses are supported.
fn matches(pattern: &str, text: &str) -> bool {
    let is_hex = |text: &str| {
        let digits = text.strip_prefix('#').unwrap_or_default();
        [3, 6].contains(&digits.len()) && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
    };
    match pattern {
        HEX => is_hex(text),
        r"^\$" => text.starts_with('$'),
        "^[^#]" => !text.is_empty() && !text.starts_with('#'),
        _ if pattern.starts_with("^(drop|over:") => {
            text == "drop" || text.strip_prefix("over:").is_some_and(is_hex)
        }
        _ => panic!("the validator does not know the pattern {pattern}"),
    }
}

#[test]
fn built_in_recipes_fit_the_schema_as_written_and_as_written_again() {
    for name in Recipe::builtin_names() {
        assert_eq!(
            validate(Recipe::builtin_text(name).unwrap()),
            Ok(()),
            "{name}"
        );
        let again = Recipe::builtin(name).unwrap().to_toml().unwrap();
        assert_eq!(validate(&again), Ok(()), "{name}, written again");
    }
}

#[test]
fn examples_of_the_readme_fit_the_schema() {
    let blocks = README.split("```toml\n").skip(1);
    let blocks: Vec<_> = blocks.filter_map(|rest| rest.split("```").next()).collect();
    assert!(blocks.len() >= 4, "recipes in the README");
    for block in &blocks {
        // Blocks without a version add nodes to the first recipe.
        let recipe = match block.starts_with("dapple") {
            true => (*block).to_owned(),
            false => format!("{}\n{block}", blocks[0]),
        };
        assert_eq!(validate(&recipe), Ok(()));
    }
    let mut count = 0;
    for line in README.lines() {
        let cells: Vec<_> = line.split(" | ").collect();
        let Some(example) = cells.last().and_then(|cell| cell.strip_suffix("` |")) else {
            continue;
        };
        let example = example.trim_start_matches('`');
        if !KINDS
            .iter()
            .any(|kind| example.starts_with(&format!("{kind} = ")))
        {
            continue;
        }
        count += 1;
        let text = format!("dapple = 1\n[nodes]\nx = {{ {example} }}\n[material]\n");
        assert_eq!(validate(&text), Ok(()), "{example}");
    }
    assert_eq!(count, KINDS.len(), "an example of each kind");
}

/// Returns whether a recipe with these lines is refused, as two booleans: by the parser or plan, and by the schema.
fn refused(lines: &str) -> [bool; 2] {
    let text = format!("dapple = 1\n{lines}\n");
    let text = if lines.contains("material") {
        text
    } else {
        format!("{text}[material]\n")
    };
    let plan = Recipe::from_toml(&text).and_then(|recipe| Plan::new(&recipe, &Images::new(), 0.0));
    [plan.is_err(), validate(&text).is_err()]
}

#[test]
fn numbers_out_of_range_are_refused_by_the_reader_and_the_schema() {
    for (right, wrong) in [
        ("extent = [1, 2]", "extent = [0, 2]"),
        ("[material]\nrelief = 0.1", "[material]\nrelief = 1e7"),
        (
            "nodes.a.worley.frequency = 4",
            "nodes.a.worley.frequency = 0",
        ),
        (
            "nodes.a.worley.frequency = [4, 2]",
            "nodes.a.worley.frequency = [4, -2]",
        ),
        (
            "nodes.a.wavelet.frequency = 8",
            "nodes.a.wavelet.frequency = -8",
        ),
        (
            "nodes.a.noise.frequency = 8",
            "nodes.a.noise.frequency = 1e7",
        ),
        ("nodes.a.noise.octaves = 2", "nodes.a.noise.octaves = 17"),
        ("nodes.a.noise.gain = 1", "nodes.a.noise.gain = 0"),
        (
            "nodes.a.power = { input = 1, exponent = 0.5 }",
            "nodes.a.power = { input = 1, exponent = 0 }",
        ),
        (
            "nodes.a.disturb = { input = 1, copies = [1, 2] }",
            "nodes.a.disturb = { input = 1, copies = [0, 2] }",
        ),
        (
            "nodes.a.pups.octaves.octaves = 1",
            "nodes.a.pups.octaves.octaves = 0",
        ),
        (
            "nodes.a.pups.turbulence.lacunarity = 2",
            "nodes.a.pups.turbulence.lacunarity = 1",
        ),
        (
            "nodes.a.pups.cellular_noise.gain = 0.5",
            "nodes.a.pups.cellular_noise.gain = 1.5",
        ),
        (
            "nodes.a.pups.cow.spacing = 0.1",
            "nodes.a.pups.cow.spacing = 0",
        ),
        (
            "nodes.a.pups.cells = { spacing = 0.1, points_per_cell = [1, 2] }",
            "nodes.a.pups.cells = { spacing = 0.1, points_per_cell = [0, 2] }",
        ),
        (
            "nodes.a.pups.space_giraffe.pairs = [3, 4]",
            "nodes.a.pups.space_giraffe.pairs = [2, 4]",
        ),
    ] {
        assert_range(right, wrong);
    }
}

#[test]
fn nets_out_of_range_are_refused_by_the_reader_and_the_schema() {
    for (right, wrong) in [
        (
            "nodes.a.pups.cow.net.axis_scale = 0.6",
            "nodes.a.pups.cow.net.axis_scale = 0.5",
        ),
        (
            "nodes.a.pups.cow.net = { orientations = \"random\", strength = 0.9 }",
            "nodes.a.pups.cow.net = { orientations = \"random\", strength = 1 }",
        ),
        (
            "nodes.a.pups.cow.net.fade = 1",
            "nodes.a.pups.cow.net.fade = 1.1",
        ),
        (
            "nodes.a.pups.cow.net.motion.radius = 1",
            "nodes.a.pups.cow.net.motion.radius = 0",
        ),
        (
            "nodes.a.pups.points = { points = [{ x = 0, y = 0, value = 1, orientation = [1, 0, 1] }], margin = [0, 1] }",
            "nodes.a.pups.points = { points = [{ x = 0, y = 0, value = 1, orientation = [1] }], margin = [0, 1] }",
        ),
        (
            "nodes.a.pups.points = { points = [{ x = 0, y = 0, value = 1 }], margin = [0, 1] }",
            "nodes.a.pups.points = { points = [{ x = 0, y = 0, value = 1 }], margin = [0, -1] }",
        ),
    ] {
        assert_range(right, wrong);
    }
}

/// Checks that the parser and the schema both accept the recipe `right` and refuse the recipe `wrong`.
fn assert_range(right: &str, wrong: &str) {
    assert_eq!(
        refused(right),
        [false; 2],
        "{right}: {:?}",
        validate(&format!("dapple = 1\n{right}\n"))
    );
    assert_eq!(refused(wrong), [true; 2], "{wrong}");
}

#[test]
fn options_that_no_kind_has_are_refused_by_the_reader_and_the_schema() {
    let tables = [
        "add", "subtract", "multiply", "divide", "minimum", "maximum", "absolute", "invert",
        "color", "pups",
    ];
    for kind in KINDS.into_iter().filter(|kind| !tables.contains(kind)) {
        let lines = format!("nodes.a.{kind} = {{ flavor = 1 }}");
        assert_eq!(refused(&lines), [true; 2], "{lines}");
    }
    for (kind, _) in PupsNode::KINDS {
        let lines = format!("nodes.a.pups.{kind} = {{ flavor = 1 }}");
        assert_eq!(refused(&lines), [true; 2], "{lines}");
    }
    for lines in [
        "flavor = 1",
        "nodes.a.flavor = {}",
        "[material]\nflavor = 1",
    ] {
        assert_eq!(refused(lines), [true; 2], "{lines}");
    }
}

#[test]
fn the_reference_in_the_documentation_is_that_of_the_types() {
    let page = include_str!("../../docs/reference.md");
    assert_eq!(
        page,
        Recipe::reference(),
        "write it again with `dapple recipe --reference -o crates/dapple-recipe/docs/reference.md --force`"
    );
}
