//! Tests that edits of texts change the data as edits of the data do.

use super::{Op, Part, apply, spliced};
use crate::Document;
use crate::data::json_of_table;
use crate::schema::{Found, Role, roles};
use dapple::recipe::{Images, Plan, Recipe};
use proptest::prelude::*;
use serde_json::{Value as Json, json};
use std::collections::BTreeSet;
use toml_edit::DocumentMut;

const TEXT: &str = r##"# A texture.
dapple = 1 # the first version
seed = 7

# Cells.
[nodes.cells.worley] # a header
value = "f2_minus_f1" # a value
scatter = { jittered = { jitter = 0.65 } }

[nodes.sum]
add = [
    "cells", # first
    0.50, # second
]

[nodes]
tint.ramp = { input = "cells", colors = ["#000000", "#ffffff"] }
grain.noise.seed = "cells"
grain.noise.octaves = 3

[[nodes.dots.pups.points.points]]
x = 0.25
y = 0.5
value = 1.0

# The other point.
[[nodes.dots.pups.points.points]]
x = 0.75
y = 0.5
value = 0.0

[material]
height = "sum" # the height
"##;

fn path(text: &str) -> Vec<Part> {
    let part = |word: &str| {
        word.parse()
            .map_or_else(|_| Part::Key(word.to_owned()), Part::Index)
    };
    text.split('.').map(part).collect()
}

fn set(at: &str, value: Json) -> Op {
    Op::Set {
        path: path(at),
        value,
    }
}

fn data(text: &str) -> Json {
    json_of_table(&text.parse::<DocumentMut>().unwrap())
}

/// Returns the text with one line replaced.
fn with_line(old: &str, new: &str) -> String {
    assert!(TEXT.contains(old), "{old}");
    TEXT.replacen(old, new, 1)
}

#[test]
fn a_value_is_all_that_changes() {
    for (at, value, old, new) in [
        ("seed", json!(8), "seed = 7", "seed = 8"),
        (
            "nodes.cells.worley.value",
            json!("f1"),
            "\"f2_minus_f1\" #",
            "\"f1\" #",
        ),
        (
            "nodes.cells.worley.scatter.jittered.jitter",
            json!(1),
            "jitter = 0.65",
            "jitter = 1.0",
        ),
        ("nodes.sum.add.1", json!(0.75), "0.50, #", "0.75, #"),
        ("nodes.sum.add", json!(["cells", 2]), "0.50, #", "2.0, #"),
        (
            "nodes.tint.ramp.colors.1",
            json!("#ff0000"),
            "\"#ffffff\"",
            "\"#ff0000\"",
        ),
        (
            "nodes.grain.noise.octaves",
            json!(4),
            "octaves = 3",
            "octaves = 4",
        ),
        (
            "nodes.dots.pups.points.points.1.x",
            json!(0.5),
            "x = 0.75",
            "x = 0.5",
        ),
        ("material.height", json!(0.5), "\"sum\" #", "0.5 #"),
    ] {
        assert_eq!(
            apply(TEXT, &[set(at, value)]).unwrap(),
            with_line(old, new),
            "{at}"
        );
    }
    // The number is formatted differently but equal, so the text stays the same.
    assert_eq!(
        apply(TEXT, &[set("nodes.sum.add.1", json!(0.5))]).unwrap(),
        TEXT
    );
}

#[test]
fn new_values_are_written_as_their_neighbors_are() {
    for (op, old, new) in [
        (
            set("material.relief", json!(0.2)),
            "height = \"sum\" # the height\n",
            "height = \"sum\" # the height\nrelief = 0.2\n",
        ),
        (
            set("nodes.tint.ramp.space", json!("linear")),
            "\"#ffffff\"] }",
            "\"#ffffff\"], space = \"linear\" }",
        ),
        (
            set("nodes.grain.noise.gain", json!(0.5)),
            "octaves = 3\n",
            "octaves = 3\ngrain.noise.gain = 0.5\n",
        ),
        (
            set("nodes.cells.worley.octaves.count", json!(2)),
            "jitter = 0.65 } }\n",
            "jitter = 0.65 } }\noctaves = { count = 2 }\n",
        ),
        (
            Op::Insert {
                path: path("nodes.sum.add"),
                index: 1,
                value: json!("tint"),
            },
            "\"cells\", # first\n",
            "\"cells\",\n    \"tint\", # first\n",
        ),
        (
            Op::Insert {
                path: path("nodes.tint.ramp.colors"),
                index: 0,
                value: json!("#123456"),
            },
            "[\"#000000\"",
            "[\"#123456\", \"#000000\"",
        ),
        (
            Op::Remove {
                path: path("nodes.tint.ramp.colors.0"),
            },
            "\"#000000\", ",
            "",
        ),
    ] {
        assert_eq!(
            apply(TEXT, std::slice::from_ref(&op)).unwrap(),
            with_line(old, new),
            "{op:?}"
        );
    }
}

#[test]
fn nodes_come_and_go_with_their_lines() {
    let add = Op::AddNode {
        name: "more".to_owned(),
        kind: "levels".to_owned(),
        value: json!({ "input": "cells" }),
    };
    let text = apply("dapple = 1\n\n[nodes.a.worley]\n\n[material]\n", &[add]).unwrap();
    assert_eq!(
        text,
        "dapple = 1\n\n[nodes.a.worley]\n\n[nodes.more.levels]\ninput = \"cells\"\n\n[material]\n"
    );
    let text = apply(
        &text,
        &[Op::RemoveNode {
            name: "a".to_owned(),
        }],
    )
    .unwrap();
    assert_eq!(
        text,
        "dapple = 1\n\n[nodes.more.levels]\ninput = \"cells\"\n\n[material]\n"
    );
    let copy = Op::DuplicateNode {
        name: "more".to_owned(),
        to: "again".to_owned(),
    };
    let text = apply(&text, &[copy]).unwrap();
    assert!(
        text.contains("\n\n[nodes.again.levels]\ninput = \"cells\"\n\n[material]"),
        "{text}"
    );
}

#[test]
fn recipes_stay_valid_without_any_of_their_nodes() {
    let mut kinds = BTreeSet::new();
    for name in Recipe::builtin_names() {
        let text = Recipe::builtin_text(name).unwrap();
        // Take the recipes with a kind of node that no earlier one has.
        let n_before = kinds.len();
        for node in data(text)["nodes"].as_object().unwrap().values() {
            kinds.extend(node.as_object().unwrap().keys().cloned());
        }
        if kinds.len() == n_before {
            continue;
        }
        for node in Recipe::from_toml(text).unwrap().nodes.keys() {
            let name = node.clone();
            let new = apply(text, &[Op::RemoveNode { name }]).unwrap();
            assert!(Recipe::from_toml(&new).is_ok(), "{new}");
            let data = data(&new);
            let is_link =
                |found: &Found<'_>| found.role == Role::Input && found.value == Some(&json!(node));
            assert!(!roles(&data).iter().any(is_link), "{new}");
        }
    }
}

#[test]
fn a_removed_link_leaves_the_default() {
    let disconnect = |at: &str| apply(TEXT, &[Op::Disconnect { path: path(at) }]).unwrap();
    assert_eq!(
        disconnect("nodes.sum.add.0"),
        with_line("    \"cells\", # first", "    0.0, # first")
    );
    assert_eq!(
        disconnect("nodes.tint.ramp.input"),
        with_line("input = \"cells\", colors", "input = 0.5, colors")
    );
    assert_eq!(
        disconnect("material.height"),
        with_line("height = \"sum\" # the height\n", "")
    );
}

#[test]
fn inputs_follow_a_node_that_is_renamed() {
    let rename = Op::RenameNode {
        name: "cells".to_owned(),
        to: "stones".to_owned(),
    };
    let text = apply(TEXT, &[rename]).unwrap();
    assert_eq!(
        text,
        TEXT.replace("\"cells\"", "\"stones\"")
            .replace("nodes.cells", "nodes.stones")
            .replace("seed = \"stones\"", "seed = \"cells\"")
            .replace("0.65 } }\n", "0.65 } }\nseed = \"cells\"\n")
    );
    let back = Op::RenameNode {
        name: "stones".to_owned(),
        to: "cells".to_owned(),
    };
    assert_eq!(apply(&text, &[back]).unwrap(), TEXT);
}

#[test]
fn a_node_looks_the_same_under_another_name_and_as_a_copy() {
    let picture = |text: &str, node: &str| {
        let recipe = Recipe::from_toml(text).unwrap();
        let plan = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
        format!("{:?}", plan.node_picture(node, [8; 2], None).unwrap())
    };
    let text = Recipe::builtin_text("flagstone").unwrap();
    for name in Recipe::from_toml(text).unwrap().nodes.into_keys() {
        let to = "another".to_owned();
        let ops = [
            Op::RenameNode {
                name: name.clone(),
                to: to.clone(),
            },
            Op::DuplicateNode {
                name: name.clone(),
                to,
            },
        ];
        for op in ops {
            let new = apply(text, std::slice::from_ref(&op)).unwrap();
            assert_eq!(picture(&new, "another"), picture(text, &name), "{op:?}");
        }
    }
}

#[test]
fn inputs_are_connected_and_lists_of_inputs_grow() {
    let connect = |node: &str, input: &str, from: Json| {
        let (node, input) = (node.to_owned(), path(input));
        Op::Connect { node, input, from }
    };
    let text = apply(TEXT, &[connect("sum", "add.2", json!("grain"))]).unwrap();
    assert_eq!(
        data(&text)["nodes"]["sum"]["add"],
        json!(["cells", 0.5, "grain"])
    );
    assert!(text.contains("0.50") && text.contains("# second"), "{text}");
    let text = apply(TEXT, &[connect("tint", "ramp.input", json!(0.5))]).unwrap();
    assert_eq!(data(&text)["nodes"]["tint"]["ramp"]["input"], json!(0.5));
    assert!(apply(TEXT, &[connect("sum", "add.4", json!(1))]).is_err());
    assert!(apply(TEXT, &[connect("none", "add.0", json!(1))]).is_err());
    assert!(apply(TEXT, &[connect("sum", "add.0", json!({}))]).is_err());
}

#[test]
fn points_are_on_lines_of_their_own() {
    let text = "dapple = 1\n\n# Spots.\n[nodes.hide.pups.cow]\nspacing = 0.2\n\n[material]\nheight = \"hide\"\n";
    let points = json!({ "cells": "weighted", "points": [{ "x": 0.5, "y": 0.25, "value": 1.0 }, { "x": 0.0, "y": 0.0, "value": 0.0 }] });
    let op = Op::MakePoints {
        node: "hide".to_owned(),
        points: Some(points.clone()),
    };
    let new = apply(text, &[op]).unwrap();
    assert_eq!(data(&new)["nodes"]["hide"]["pups"]["points"], points);
    let list = "points = [\n    { value = 1.0, x = 0.5, y = 0.25 },\n    { value = 0.0, x = 0.0, y = 0.0 },\n]\n";
    assert!(
        new.contains("\n\n# Spots.\n[nodes.hide.pups.points]\n") && new.contains(list),
        "{new}"
    );
}

#[test]
fn a_parameter_comes_and_goes_with_its_options() {
    let shared = [
        set("parameters.jitter", json!(0.65)),
        set(
            "nodes.cells.worley.scatter.jittered.jitter",
            json!("$jitter"),
        ),
        set("nodes.sum.add.1", json!("$jitter")),
    ];
    let text = apply(TEXT, &shared).unwrap();
    let with_table = "seed = 7\n\n[parameters]\njitter = 0.65\n\n# Cells.\n[nodes.cells.worley]";
    assert!(text.contains(with_table), "{text}");
    assert_eq!(
        Recipe::from_toml(&text).unwrap().parameters.iter().count(),
        1
    );
    // It stays while an option refers to it.
    let text = apply(&text, &[set("nodes.sum.add.1", json!(0.5))]).unwrap();
    assert!(text.contains("jitter = 0.65\n"), "{text}");
    // The last option leaves, alone or with its node.
    let own = set("nodes.cells.worley.scatter.jittered.jitter", json!(0.65));
    let detached = with_line("0.50, #", "0.5, #");
    assert_eq!(apply(&text, &[own]).unwrap(), detached);
    let name = "cells".to_owned();
    let text = apply(&text, &[Op::RemoveNode { name }]).unwrap();
    assert!(!text.contains("parameters"), "{text}");
    // A parameter that was not used before is left for the author.
    let unused = format!("{TEXT}\n[parameters]\nnew = 1\n");
    let edited = apply(&unused, &[set("seed", json!(8))]).unwrap();
    assert!(edited.contains("[parameters]\nnew = 1\n"), "{edited}");
}

#[test]
fn what_does_not_fit_is_refused_and_nothing_changes() {
    let hostile = [
        json!({ "op": "set", "path": [], "value": 1 }),
        json!({ "op": "set", "path": ["seed"], "value": null }),
        json!({ "op": "set", "path": ["seed", "deeper"], "value": 1 }),
        json!({ "op": "set", "path": ["seed"], "value": u64::MAX }),
        json!({ "op": "set", "path": [3], "value": 1 }),
        json!({ "op": "set", "path": ["nodes", "a b]\nx = 1"], "value": {} }),
        json!({ "op": "set", "path": ["nodes", "sum", "add", 7], "value": 1 }),
        json!({ "op": "set", "path": ["nodes", "dots", "pups", "points", "points", 0], "value": 1 }),
        json!({ "op": "remove", "path": ["nothing"] }),
        json!({ "op": "remove", "path": ["nodes", "sum", "add", 9] }),
        json!({ "op": "insert", "path": ["nodes", "sum", "add"], "index": 9, "value": 1 }),
        json!({ "op": "insert", "path": ["seed"], "index": 0, "value": 1 }),
        json!({ "op": "add_node", "name": "cells", "kind": "worley", "value": {} }),
        json!({ "op": "add_node", "name": "-", "kind": "worley", "value": {} }),
        json!({ "op": "add_node", "name": "new", "kind": "cells", "value": {} }),
        json!({ "op": "remove_node", "name": "none" }),
        json!({ "op": "rename_node", "name": "none", "to": "some" }),
        json!({ "op": "rename_node", "name": "cells", "to": "sum" }),
        json!({ "op": "rename_node", "name": "cells", "to": "a.b" }),
        json!({ "op": "duplicate_node", "name": "none", "to": "some" }),
        json!({ "op": "make_points", "node": "cells" }),
    ];
    for op in hostile {
        let op: Op = serde_json::from_value(op).unwrap();
        let first = set("seed", json!(1));
        assert!(apply(TEXT, &[first, op.clone()]).is_err(), "{op:?}");
    }
    assert!(apply("no = [", &[set("seed", json!(1))]).is_err());
    assert!(
        serde_json::from_value::<Op>(json!({ "op": "set", "path": [-1], "value": 1 })).is_err()
    );
}

/// Appends the paths of a value and of all values in it to `all`.
fn paths(value: &Json, path: &mut Vec<Part>, all: &mut Vec<Vec<Part>>) {
    if !path.is_empty() {
        all.push(path.clone());
    }
    let inner: Vec<(Part, &Json)> = match value {
        Json::Object(entries) => entries
            .iter()
            .map(|(key, value)| (Part::Key(key.clone()), value))
            .collect(),
        Json::Array(list) => list
            .iter()
            .enumerate()
            .map(|(index, value)| (Part::Index(index), value))
            .collect(),
        _ => Vec::new(),
    };
    for (part, value) in inner {
        path.push(part);
        paths(value, path, all);
        path.pop();
    }
}

fn at<'a>(value: &'a mut Json, path: &[Part]) -> &'a mut Json {
    path.iter().fold(value, |value, part| match part {
        Part::Key(key) => &mut value[key],
        Part::Index(index) => &mut value[*index],
    })
}

/// Returns whether two JSON values are equal. An integer equals a floating-point number of the same value.
fn are_equal(a: &Json, b: &Json) -> bool {
    match (a, b) {
        (Json::Number(a), Json::Number(b)) => a.as_f64() == b.as_f64(),
        (Json::Array(a), Json::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| are_equal(a, b))
        }
        (Json::Object(a), Json::Object(b)) => {
            a.len() == b.len()
                && a.iter()
                    .all(|(key, a)| b.get(key).is_some_and(|b| are_equal(a, b)))
        }
        _ => a == b,
    }
}

fn comments(text: &str) -> Vec<&str> {
    let lines = text.lines().filter_map(|line| line.split_once("# "));
    lines.map(|(_, comment)| comment).collect()
}

fn values() -> impl Strategy<Value = Json> {
    let leaf = prop_oneof![
        (-100_i64..100).prop_map(Json::from),
        (-10.0..10.0_f64).prop_map(Json::from),
        any::<bool>().prop_map(Json::from),
        "[a-z\"\\\\\n #]{0,6}".prop_map(Json::from),
    ];
    leaf.prop_recursive(2, 8, 3, |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 0..3).prop_map(Json::from),
            proptest::collection::btree_map("[a-z_]{1,4}", inner, 0..3)
                .prop_map(|entries| Json::Object(entries.into_iter().collect())),
        ]
    })
}

fn texts() -> impl Strategy<Value = &'static str> {
    let names: Vec<_> = Recipe::builtin_names().collect();
    let builtin =
        proptest::sample::select(names).prop_map(|name| Recipe::builtin_text(name).unwrap());
    prop_oneof![Just(TEXT), builtin]
}

proptest! {
    #[test]
    fn a_patched_text_has_the_patched_data(text in texts(), place in any::<prop::sample::Index>(), value in values()) {
        let mut all = Vec::new();
        let mut data_after = data(text);
        paths(&data_after, &mut Vec::new(), &mut all);
        let path = place.get(&all).clone();
        *at(&mut data_after, &path) = value.clone();
        match apply(text, &[Op::Set { path: path.clone(), value }]) {
            Ok(new) => prop_assert!(are_equal(&data(&new), &data_after), "{path:?}: {new}"),
            // The only valid refusals concern elements of an array of tables that are not tables, and invalid keys.
            Err(error) => prop_assert!(
                error.to_string().contains("tables") || error.to_string().contains("letters"),
                "{path:?}: {error}"
            ),
        }
    }

    #[test]
    fn comments_stay_where_a_value_changes(text in texts(), place in any::<prop::sample::Index>(), number in -5.0..5.0_f64) {
        let data = data(text);
        let mut all = Vec::new();
        paths(&data, &mut Vec::new(), &mut all);
        all.retain(|path| !at(&mut data.clone(), path).is_object() && !at(&mut data.clone(), path).is_array());
        let path = place.get(&all).clone();
        let new = apply(text, &[Op::Set { path, value: number.into() }]).unwrap();
        prop_assert_eq!(comments(&new), comments(text));
        prop_assert_eq!(new.lines().count(), text.lines().count());
    }
}

#[test]
fn numbers_are_replaced_as_other_changes_are_made() {
    let document = Document::new(TEXT);
    let sets = [
        set("seed", json!(9)),
        set("seed", json!(7)),
        set("nodes.cells.worley.scatter.jittered.jitter", json!(1)),
        set("nodes.sum.add.1", json!(0.5)),
        set("nodes.sum.add.1", json!(-1e-9)),
        set("nodes.grain.noise.octaves", json!(4.5)),
        set("nodes.dots.pups.points.points.1.x", json!(0.123_456_789)),
        set("nodes.dots.pups.points.points.0.value", json!(0)),
    ];
    for one in &sets {
        for other in &sets {
            let ops = [one.clone(), other.clone()];
            let expected = apply(TEXT, &ops).unwrap();
            let is_twice = matches!((one, other), (Op::Set { path: a, .. }, Op::Set { path: b, .. }) if a == b);
            let spliced = spliced(&document, &ops);
            assert_eq!(spliced, (!is_twice).then_some(expected), "{ops:?}");
        }
    }
    let vectors = Document::new("a = [ 1.0,2.5 ] # a list\nb = { c = 3 }\n");
    assert_eq!(
        spliced(
            &vectors,
            &[set("a", json!([2, 0.25])), set("b.c", json!(4))]
        )
        .as_deref(),
        Some("a = [ 2.0,0.25 ] # a list\nb = { c = 4 }\n")
    );
    for other in [
        set("nodes.cells.worley.value", json!("f1")),
        set("nodes.cells.worley.depth", json!(3)),
        set("nodes.sum.add", json!([0.5])),
        set("seed", json!(u64::MAX)),
        set("seed", json!(null)),
    ] {
        assert_eq!(
            spliced(&document, std::slice::from_ref(&other)),
            None,
            "{other:?}"
        );
    }
}
