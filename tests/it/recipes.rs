//! Checks the statements about recipes in the README of `dapple-recipe`.
#![expect(clippy::disallowed_methods, reason = "the workspace is made of files")]

use dapple::color::LinearRgb;
use dapple::raster::{Field, Raster};
use dapple::recipe::{
    Bake, BakeOptions, Images, KINDS, MapKind, Picture, Plan, Recipe, RecipeError,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

const README: &str = include_str!("../../crates/dapple-recipe/README.md");

/// Recipe to which the README's example nodes are added. The nodes `a` and `b` are scalars; `c` is a color.
const AROUND: &str = r##"
dapple = 1
extent = [8.0, 8.0]

[material]
albedo = "x"

[nodes]
a = { noise = { frequency = 1.0, octaves = 1 } }
b = { coordinate = { along = [0.125, 0.0] } }
c = { ramp = { input = "a", palette = "lagoon" } }
wall = { bricks = {} }
"##;

/// Returns the rows of the README's tables of nodes, as pairs of the node's kind and its example.
fn rows() -> impl Iterator<Item = (&'static str, &'static str)> {
    README.lines().filter_map(|line| {
        let (kind, rest) = line.strip_prefix("| `")?.split_once('`')?;
        let example = rest.strip_suffix("` |")?.rsplit_once(" | `")?.1;
        example
            .starts_with(&format!("{kind} = "))
            .then_some((kind, example))
    })
}

fn bake(text: &str) -> Result<(), RecipeError> {
    let photo = Raster::from_fn([16, 16], |x, y| LinearRgb::gray((x ^ y) as f32 / 15.0))?;
    let images = Images::from([("photo.png".into(), Picture::Colors(Arc::new(photo)))]);
    let plan = Plan::new(&Recipe::from_toml(text)?, &images, 0.0)?;
    let maps = MapKind::ALL.to_vec();
    let options = BakeOptions {
        size: [32, 32],
        maps,
        ..BakeOptions::default()
    };
    Bake::new(&plan, &options)?.try_for_each(|band| band.map(|_| ()))
}

#[test]
fn readme_has_an_example_of_every_kind_of_node() {
    let kinds: Vec<_> = rows().map(|(kind, _)| kind).collect();
    for kind in KINDS {
        assert!(kinds.contains(&kind), "no row of a table is about `{kind}`");
    }
    assert_eq!(kinds.len(), KINDS.len(), "a row for each kind: {kinds:?}");
}

#[test]
fn readme_examples_of_nodes_bake() {
    for (kind, example) in rows() {
        let text = format!("{AROUND}x = {{ {example} }}\n");
        assert_eq!(bake(&text).err(), None, "the example of `{kind}`");
    }
}

#[test]
fn readme_recipes_bake() {
    let blocks = README.split("```toml\n").skip(1);
    for block in blocks.filter_map(|block| block.split("```").next()) {
        // Blocks without a version add nodes to the first recipe.
        let recipe = match block.starts_with("dapple") {
            true => block.to_owned(),
            false => format!("{}\n{block}", self::block("toml")),
        };
        assert_eq!(bake(&recipe).err(), None, "{recipe}");
    }
}

#[test]
fn readme_shows_errors_as_they_are() {
    let errors = [
        ("curve =", "curv ="),
        ("input = \"joint\"", "input = \"joints\""),
        ("by = \"stones\"", "by = \"gray\""),
        ("extent = [8.0, 8.0]", "extent = [8.5, 8.0]"),
    ]
    .map(|(right, wrong)| {
        let broken = block("toml").replacen(right, wrong, 1);
        let error = bake(&broken).expect_err(wrong);
        format!("{error}\n")
    });
    assert_eq!(errors.concat(), block("text"), "the errors of the README");
}

/// Returns the README's first code block in `language`.
fn block(language: &str) -> &'static str {
    let start = format!("```{language}\n");
    let block = README.split(&start).nth(1).expect("a block");
    block.split("```").next().expect("its end")
}

#[test]
fn readme_names_every_key_of_the_material_and_every_map() {
    let recipe = Recipe::builtin("flagstone").expect("a recipe");
    let text = recipe.to_json().expect("it is data");
    let material = text.split("\"material\"").nth(1).expect("a material");
    let keys = material.split('"').skip(1).step_by(2);
    for key in keys.filter(|key| material.contains(&format!("\"{key}\":"))) {
        assert!(
            README.contains(&format!("| `{key}` |")),
            "no row is about the key `{key}`"
        );
    }
    for map in MapKind::ALL {
        let name = map.name();
        assert!(
            README.contains(&format!("`{name}`")),
            "no row is about `{name}`"
        );
    }
}

#[test]
fn fur_has_no_bands_across_its_height() {
    for name in ["cow", "giraffe"] {
        let recipe = Recipe::builtin(name).expect("a recipe");
        let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
        let window = plan.window([256; 2]).expect("a window");
        let height = plan.height().expect("a height");
        let height = height.to_raster(&window).expect("its values");
        let means = Raster::from_fn([1, 256], |_, row| {
            height.row(row).iter().sum::<f32>() / 256.0
        });
        let rows = means.expect("a row for each").statistics().deviation;
        let contrast = rows / height.statistics().deviation;
        // Independent pixels have a contrast of 1/16 between rows. Hair that is 2 pixels wide has 0.07 to 0.10.
        assert!(contrast < 0.13, "{name}: rows differ by {contrast}");
    }
}

/// Returns the Rust files of a folder and its subfolders.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let files = paths.flat_map(|path| {
        if path.is_dir() {
            sources(&path)
        } else {
            vec![path]
        }
    });
    files
        .filter(|path| path.extension().is_some_and(|ending| ending == "rs"))
        .collect()
}

#[test]
fn kinds_of_nodes_and_textures_are_named_by_their_tables_alone() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let matched = |text: &str| {
        // A variant of `Node` or `PupsNode` begins with an uppercase letter followed by a lowercase one.
        let mut after = text.split("Node::").skip(1).map(str::as_bytes);
        after.any(|name| {
            matches!(name, [first, second, ..] if first.is_ascii_uppercase() && second.is_ascii_lowercase())
        })
    };
    let folders = [
        "dapple-recipe/src",
        "dapple-pups/src",
        "dapple-cli/src/commands/pups",
    ];
    for path in folders
        .iter()
        .flat_map(|folder| sources(&crates.join(folder)))
    {
        let text = fs::read_to_string(&path).expect("a text");
        assert!(
            !matched(&text),
            "{} matches on a kind of node",
            path.display()
        );
    }
}
