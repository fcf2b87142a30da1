//! The Rust code of the built-in recipes: it is what the recipes print, it compiles, and it gives their bits.
//!
//! `DAPPLE_BLESS=1 cargo test -p dapple-tests recipe_code` writes the files anew.
#![expect(clippy::disallowed_methods, reason = "the code lies in files")]
#![expect(
    clippy::too_many_lines,
    clippy::needless_update,
    reason = "printed code is one function for all nodes, and ends every set of options with the defaults"
)]

use dapple::raster::{Field, glam::DVec2};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe};
use std::path::PathBuf;

/// The modules with the code of recipes that have a value at a single position.
macro_rules! recipes {
    ($($module:ident = $name:literal,)*) => {
        $(
            #[expect(unreachable_pub, reason = "the code is for a crate of its own")]
            mod $module;
        )*

        /// The names of the recipes whose code is compared.
        const NAMES: &[&str] = &[$($name),*];

        #[test]
        fn recipe_code_has_the_bits_of_the_recipe() {
            $({
                let material = $module::material().unwrap();
                compare($name, |at| {
                    let surface = material(at);
                    (surface.height, surface.albedo.to_array())
                });
            })*
        }
    };
}

recipes! {
    clouds = "clouds",
    coastline = "coastline",
    cow = "cow",
    craters = "craters",
    crumpled_paper = "crumpled-paper",
    crusty_skin = "crusty-skin",
    flagstone = "flagstone",
    giraffe = "giraffe",
    ice = "ice",
    marble = "marble",
    mountains = "mountains",
    polka_dots = "polka-dots",
    radial_hull = "radial-hull",
    rock = "rock",
    sea_water = "sea-water",
    spaceship_hull = "spaceship-hull",
    tinfoil = "tinfoil",
    vein_tracery = "vein-tracery",
    wood_grain = "wood-grain",
}

#[rustfmt::skip]
#[expect(unreachable_pub, reason = "the code is for a crate of its own")]
mod stone_and_grass;

/// Compares what code gives at some positions with what the recipe gives there.
fn compare(name: &str, code: impl Fn(DVec2) -> (f32, [f32; 3])) {
    let recipe = Recipe::builtin(name).unwrap();
    let plan = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
    let height = plan.height();
    let window = plan.window([41, 37]).unwrap();
    let maps = vec![MapKind::Albedo];
    let options = BakeOptions {
        size: window.size,
        maps,
        ..BakeOptions::default()
    };
    let band = Bake::new(&plan, &options).unwrap().next().unwrap().unwrap();
    let [(_, MapRows::Color(albedo))] = &band.maps[..] else {
        panic!("{name}: the albedo is a color");
    };
    for pixel in (0..41 * 37).step_by(29) {
        let (column, row) = (pixel % 41, pixel / 41);
        let at = window.position(column, row);
        let (height_of_code, albedo_of_code) = code(at);
        assert_eq!(
            height_of_code.to_bits(),
            height.sample(at).to_bits(),
            "{name}: the height at {at}"
        );
        let expected = albedo.row(row)[column as usize].to_array();
        assert_eq!(albedo_of_code, expected, "{name}: the albedo at {at}");
    }
}

#[test]
fn recipe_code_is_current() {
    let bless = std::env::var_os("DAPPLE_BLESS").is_some();
    let names: Vec<_> = Recipe::builtin_names().collect();
    let rest = names.iter().filter(|name| !NAMES.contains(name));
    assert_eq!(
        rest.collect::<Vec<_>>(),
        [&"stone-and-grass"],
        "each has code"
    );
    for name in names {
        let code = Recipe::builtin(name).unwrap().to_rust().unwrap();
        let file = format!("it/recipe_code/{}.rs", name.replace('-', "_"));
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file);
        if bless {
            std::fs::write(&path, &code).unwrap();
        }
        let found = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(found == code, "{} is not current", path.display());
    }
}

#[test]
fn code_of_a_recipe_that_sees_the_whole_tile_bakes_it() {
    let bands = stone_and_grass::bake([64, 64], &[MapKind::Height], &Images::new()).unwrap();
    let recipe = Recipe::builtin("stone-and-grass").unwrap();
    let plan = Plan::new(&recipe, &Images::new(), 0.0).unwrap();
    let options = BakeOptions {
        size: [64, 64],
        ..BakeOptions::default()
    };
    let expected = Bake::new(&plan, &options).unwrap().next().unwrap().unwrap();
    assert_eq!(bands[0].maps, expected.maps, "the heights");
}
