//! Tests of the replies of a session.

use crate::render_host::{Page, of_type};
use dapple_studio::{Graph, Hello};
use serde_json::{Value, json};

/// Returns the part of a text that JavaScript finds at the UTF-16 positions `from` and `to` of an item.
fn part(text: &str, item: &Value) -> String {
    let units: Vec<u16> = text.encode_utf16().collect();
    let at = |name: &str| item[name].as_u64().unwrap() as usize;
    String::from_utf16(&units[at("from")..at("to")]).unwrap()
}

#[test]
fn a_change_of_the_recipe_is_a_change_of_the_text() {
    let mut page = Page::open("flagstone");
    let before = page.session.document().text().to_owned();
    let op = json!({ "op": "set", "path": ["nodes", "plate", "levels", "from", 1], "value": 0.2 });
    let replies = page.ask(json!({ "type": "patch", "rev": 0, "ops": [op], "drag": true }));
    let edits = of_type(&replies, "edits")[0];
    assert_eq!((&edits["rev"], &edits["drag"]), (&json!(1), &json!(true)));
    assert_eq!(edits["changes"].as_array().unwrap().len(), 1);
    assert_eq!(part(&before, &edits["changes"][0]), "14");
    assert_eq!(
        page.session.document().text(),
        before.replace("[0.06, 0.14]", "[0.06, 0.2]")
    );
    assert_eq!(
        of_type(&replies, "values")[0]["recipe"]["nodes"]["plate"]["levels"]["from"],
        json!([0.06, 0.2])
    );
}

#[test]
fn parameters_are_listed_in_the_order_of_the_text_and_are_no_nodes() {
    let text = "dapple = 1\n[parameters]\nwear = 0.25\namount = 0.5\n[nodes.sum]\nadd = [\"$wear\", \"$amount\"]\n\
                [material]\nheight = \"sum\"\n";
    let mut page = Page::default();
    let replies = page.ask(json!({ "type": "doc", "rev": 1, "text": text }));
    let values = of_type(&replies, "values")[0];
    assert_eq!(values["parameters"], json!(["wear", "amount"]));
    assert_eq!(values["recipe"]["nodes"]["sum"]["add"][0], "$wear");
    let graph = serde_json::to_value(Graph::new(page.session.document(), None)).unwrap();
    let inputs = &graph["nodes"][0]["inputs"];
    assert_eq!(
        (&inputs[0]["node"], &inputs[0]["value"]),
        (&Value::Null, &json!("$wear"))
    );
}

#[test]
fn the_greeting_names_the_maps_that_a_material_may_lack() {
    let hello = serde_json::to_value(Hello::new()).unwrap();
    let optional = json!(["emission", "opacity", "specular", "clearcoat"]);
    assert_eq!(hello["optional_maps"], optional);
    let lava = |one: &&Value| one["name"] == "lava";
    let lava = hello["builtins"].as_array().unwrap().iter().find(lava);
    assert!(
        lava.unwrap()["tags"]
            .as_array()
            .unwrap()
            .contains(&json!("volcano"))
    );
}

#[test]
fn a_change_of_an_older_text_is_stale_and_a_whole_text_wins() {
    let mut page = Page::open("cow");
    let ops = json!([{ "op": "set", "path": ["seed"], "value": 2 }]);
    let patch = |rev: u64| json!({ "type": "patch", "rev": rev, "ops": ops });
    page.ask(patch(0));
    assert_eq!(page.ask(patch(0)), [json!({ "type": "stale", "rev": 1 })]);
    page.ask(json!({ "type": "doc", "rev": 7, "text": "dapple = 1\n[material]\n" }));
    assert_eq!(page.ask(patch(7))[0]["rev"], 8);
}

#[test]
fn mistakes_are_told_where_they_are_written() {
    for (text, place, node) in [
        (
            "# é 𝄞\ndapple = 1\n[nodes.a.worley]\nfrequncy = 1\n[material]\n",
            "frequncy",
            json!("a"),
        ),
        ("dapple = 1\n[material]\nheight = [\n", "\n", json!(null)),
        ("dapple = 2\n[material]\n", "2", json!(null)),
    ] {
        let mut page = Page::default();
        let replies = page.ask(json!({ "type": "doc", "rev": 1, "text": text }));
        let item = &of_type(&replies, "diagnostics")[0]["items"][0];
        assert_eq!(
            (part(text, item).as_str(), &item["node"]),
            (place, &node),
            "{item}"
        );
    }
    // Errors that only a plan detects.
    for (nodes, place, node) in [
        (
            "[nodes.a.noise]\nfrequency = 2.0 # é\noctaves = 99\n",
            "99",
            "a",
        ),
        (
            "[nodes.a.noise]\nfrequency = 2.5\n[nodes.b.worley]\nfrequency = 2.1\n",
            "2.1",
            "b",
        ),
        (
            "[nodes.a.levels]\ninput = \"bb\"\n[nodes.b.worley]\n",
            "\"bb\"",
            "a",
        ),
        (
            "[nodes.a]\nadd = [0.5, \"#ff0000\"]\n[nodes.b.levels]\ninput = \"a\"\n",
            "\"a\"",
            "b",
        ),
        (
            "[nodes.a.levels]\ninput = \"b\"\n[nodes.b]\nadd = [\"a\"]\n",
            "\"b\"",
            "a",
        ),
        ("[nodes.a.image]\nfile = \"no.png\"\n", "\"no.png\"", "a"),
        ("[nodes.a.ramp]\ninput = 0.5\n", "a", "a"),
    ] {
        let text = format!("dapple = 1 # é𝄞\nextent = [4.0, 4.0]\n{nodes}[material]\n");
        let mut page = Page::default();
        page.ask(json!({ "type": "doc", "rev": 1, "text": text }));
        let (replies, _) = page.draw();
        let item = &of_type(&replies, "diagnostics")[0]["items"][0];
        assert_eq!(part(&text, item), place, "{text}: {item}");
        assert!(item["node"] == node || item["node"].is_null(), "{item}");
    }
}

#[test]
fn the_graph_says_what_each_node_is_made_of() {
    let text = "dapple = 1\n[nodes.a.worley]\n[nodes.c]\nadd = [\"a\", 0.5]\n[nodes.b.mix]\nfrom = \"c\"\nto = \"#ff0000\"\nby = 0.5\n[material]\nalbedo = \"b\"\n";
    let mut page = Page::default();
    page.ask(json!({ "type": "doc", "rev": 3, "text": text }));
    let (replies, _) = page.draw();
    let graph = of_type(&replies, "graph")[0];
    let [a, c, b] = [0, 1, 2].map(|index| &graph["nodes"][index]);
    assert_eq!(
        (&a["name"], &a["kind"], &a["inputs"]),
        (&json!("a"), &json!("worley"), &json!([]))
    );
    assert_eq!(
        c["inputs"][0],
        json!({ "label": "1", "path": ["add", 0], "node": "a", "value": "a" })
    );
    assert_eq!(
        (&b["is_color"], &c["is_color"], &b["is_global"]),
        (&json!(true), &json!(false), &json!(false))
    );
    assert_eq!(graph["material"]["albedo"]["node"], "b");
    assert_eq!(graph["order"], json!(["a", "c", "b"]));
    let [from, to] = [0, 1].map(|index| b["span"][index].as_u64().unwrap() as usize);
    assert_eq!(
        &text[from..to],
        "[nodes.b.mix]\nfrom = \"c\"\nto = \"#ff0000\"\nby = 0.5"
    );
}

#[test]
fn points_of_a_cow_become_text_with_the_same_picture() {
    let text =
        "dapple = 1\n[nodes.hide.pups.cow]\nspacing = 0.2\n\n[material]\nheight = \"hide\"\n";
    let mut page = Page::default();
    page.ask(json!({ "type": "doc", "rev": 0, "text": text }));
    page.ask(json!({ "type": "view", "size": [64, 64], "maps": ["height"], "draft": false, "paused": false }));
    let (_, before) = page.draw();
    let ops = json!([{ "op": "make_points", "node": "hide" }]);
    let replies = page.ask(json!({ "type": "patch", "rev": 0, "ops": ops }));
    assert_eq!(replies[0]["type"], "edits", "{replies:?}");
    let (_, after) = page.draw();
    assert_eq!(after[0].pixels, before[0].pixels);
    assert!(
        page.session.document().text().contains("\n    { "),
        "points have lines of their own"
    );
    let refused = page.ask(
        json!({ "type": "patch", "rev": 1, "ops": [{ "op": "make_points", "node": "none" }] }),
    );
    assert_eq!(refused[0]["type"], "refused");
}
