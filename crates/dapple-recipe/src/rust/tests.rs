//! Tests of the code of recipes; that it compiles and gives the same bits is a test of the workspace.

use crate::{Recipe, RecipeErrorKind};

fn rust(nodes: &str) -> String {
    let text = format!("dapple = 1\nname = \"test\"\n{nodes}\n[material]\nheight = \"a\"\n");
    Recipe::from_toml(&text).unwrap().to_rust().unwrap()
}

#[test]
fn a_node_is_a_statement_after_what_it_is_made_of() {
    let code = rust("[nodes]\na = { add = [\"loop\", 0.5] }\n[nodes.loop.worley]\nfrequency = 4\n");
    let made = code
        .find("let loop__field")
        .or_else(|| code.find("let loop_field"))
        .unwrap();
    let value = code
        .find("let loop_: f32 = loop_field.sample(at * DVec2::new(4.0, 4.0));")
        .unwrap();
    let sum = code.find("let a: f32 = loop_ + 0.5;").unwrap();
    assert!(made < value && value < sum, "{code}");
}

#[test]
fn a_warp_is_a_block_with_a_position_of_its_own() {
    let code = rust(
        "[nodes]\nb = { distance = { center = [0, 0] } }\na = { warp = { input = \"b\", x = \"b\", y = 0, amount = 0.5 } }\n",
    );
    assert_eq!(
        code.matches("recipe::distance(at").count(),
        2,
        "once at each position:\n{code}"
    );
    assert!(
        code.contains("let at = at + 0.5 * DVec2::new(f64::from(b), 0.0);"),
        "{code}"
    );
}

#[test]
fn what_sees_the_whole_tile_is_baked() {
    let code = rust("[nodes]\na = { tile = { input = \"b\" } }\nb = { color = \"#123456\" }\n");
    assert!(
        code.contains("pub fn bake(") && code.contains("r##\""),
        "{code}"
    );
}

#[test]
fn a_color_is_refused_where_a_number_is_needed() {
    let text = "dapple = 1\n[material]\nheight = \"#fff\"\n";
    let error = Recipe::from_toml(text).unwrap().to_rust().unwrap_err();
    assert!(
        matches!(error.kind(), RecipeErrorKind::NotANumber { .. }),
        "{error}"
    );
}

#[test]
fn a_giraffe_of_the_paper_says_so() {
    let code = rust(
        "[nodes]\na = { pups = { space_giraffe = { spots = \"literal\", pairs = [5, 8] } } }\n",
    );
    assert!(
        code.contains("spots: pups::Spots::Literal") && code.contains("pairs: [5, 8]"),
        "{code}"
    );
}
