//! Recipes that differ in the values of sliders: they share shaders, and have the bits of the CPU.

use crate::bakes::{bake, compare, differing, options};
use crate::gpu;
use dapple_gpu::Gpu;
use dapple_recipe::{Images, Plan, Recipe, RecipeError};
use std::ops::Range;

/// Recipes with nodes of many kinds. lavapipe takes up to a minute to compile the shaders of one, so only the first is
/// compared without the variable `DAPPLE_ALL_RECIPES`.
const RECIPES: [&str; 12] = [
    "polka-dots",
    "marble",
    "giraffe",
    "flagstone",
    "canvas",
    "perforated-metal",
    "leather",
    "cracked-mud",
    "brick-wall",
    "sand-ripples",
    "hexagon-tiles",
    "wood-floor",
];

/// The numbers with a fraction in the text of a recipe, in two versions.
struct Sliders {
    text: &'static str,
    places: Vec<Range<usize>>,
    versions: [Vec<f64>; 2],
}

impl Sliders {
    fn new(text: &'static str) -> Self {
        let places = fractions(text);
        let numbers = places.iter().map(|place| text[place.clone()].parse());
        let numbers: Result<Vec<f64>, _> = numbers.collect();
        let numbers = numbers.expect("numbers");
        Self {
            text,
            places,
            versions: [numbers.clone(), numbers],
        }
    }

    /// Multiplies numbers by a factor for each version, so that equal numbers stay equal, and none is a power of two. Numbers
    /// that the recipe does not accept stay. Returns how many were changed.
    fn change(&mut self, range: Range<usize>) -> usize {
        let before = self.versions.clone();
        for (version, numbers) in self.versions.iter_mut().enumerate() {
            for index in range.clone() {
                numbers[index] *= 0.9887 - 0.02 * version as f64;
            }
        }
        if [0, 1].iter().all(|&version| self.plan(version).is_ok()) {
            return range.len();
        }
        self.versions = before;
        match range.len() {
            0 | 1 => 0,
            n => {
                let middle = range.start + n / 2;
                self.change(range.start..middle) + self.change(middle..range.end)
            }
        }
    }

    fn plan(&self, version: usize) -> Result<(Recipe, Plan), RecipeError> {
        let mut text = String::new();
        let mut end = 0;
        for (place, number) in self.places.iter().zip(&self.versions[version]) {
            text += &self.text[end..place.start];
            text += &number.to_string();
            end = place.end;
        }
        let recipe = Recipe::from_toml(&(text + &self.text[end..]))?;
        let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
        Ok((recipe, plan))
    }
}

/// Returns the places of the numbers with a fraction in a text of TOML.
fn fractions(text: &str) -> Vec<Range<usize>> {
    let mut places = Vec::new();
    let (mut is_string, mut is_comment) = (false, false);
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let digits = rest.find(|c: char| !(c.is_ascii_digit() || c == '.'));
        let digits = digits.unwrap_or(rest.len());
        let is_word = text[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        if digits > 0 && !is_string && !is_comment && !is_word {
            let number = rest[..digits].parse::<f64>();
            if number.is_ok_and(|number| number.fract() != 0.0) {
                places.push(at..at + digits);
            }
            at += digits;
            continue;
        }
        let first = rest.chars().next().unwrap_or_default();
        match first {
            '"' if !is_comment => is_string = !is_string,
            '#' if !is_string => is_comment = true,
            '\n' => is_comment = false,
            _ => {}
        }
        at += first.len_utf8();
    }
    places
}

#[test]
fn values_of_sliders_need_no_other_shader() {
    let Some(gpu) = gpu().map(Gpu::upload_values) else {
        return;
    };
    let options = options([24, 20]);
    let all = std::env::var_os("DAPPLE_ALL_RECIPES").is_some();
    let recipes = &RECIPES[..if all { RECIPES.len() } else { 1 }];
    for &name in recipes {
        let text = Recipe::builtin_text(name).expect("a recipe");
        let mut sliders = Sliders::new(text);
        let changed = sliders.change(0..sliders.places.len());
        assert!(2 * changed > sliders.places.len(), "{name}: {changed}");
        let [first, second] = [0, 1].map(|version| sliders.plan(version).expect("a plan"));
        let [a, b] = [&first, &second].map(|(_, plan)| bake(plan, &options));
        assert!(differing(&a, &b) > 0, "{name}");
        compare(&gpu, &first.0, &options);
        let compiled = gpu.compiled_shaders();
        compare(&gpu, &second.0, &options);
        assert_eq!(gpu.compiled_shaders(), compiled, "{name}");
    }
    // The self-test has one shader, and each recipe has one or more.
    assert!(gpu.compiled_shaders() > recipes.len() as u64);
}

#[test]
fn whole_numbers_zeros_and_signs_need_no_other_shader() {
    let Some(gpu) = gpu().map(Gpu::upload_values) else {
        return;
    };
    let recipe = |frequency: f64, seed: u32, low: f64| {
        Recipe::from_toml(&format!(
            r##"
            dapple = 1
            extent = [2.0, 2.0]
            seed = {seed}
            [nodes]
            cells.worley = {{ frequency = {frequency}, value = "f2_minus_f1", metric = "manhattan" }}
            hills.noise = {{ basis = "gradient", frequency = {frequency}, octaves = 2 }}
            bumps.noise = {{ basis = "pups", frequency = {frequency}, octaves = 2 }}
            waves.wavelet = {{ frequency = {frequency} }}
            sum.add = ["cells", "hills", "bumps", "waves", {low}]
            even.levels = {{ input = "sum", from = [0.1, 3.2], to = [{low}, 0.9] }}
            color.ramp = {{ input = "even", colors = ["#204060", "#f0e0d0"] }}
            [material]
            height = "even"
            albedo = "color"
            "##
        ))
        .expect("a recipe")
    };
    let options = options([33, 20]);
    compare(&gpu, &recipe(3.0, 1, 0.3), &options);
    let compiled = gpu.compiled_shaders();
    for (frequency, seed, low) in [(5.0, 1, 0.3), (5.0, 9, 0.3), (7.0, 2, 0.0), (6.0, 2, -0.25)] {
        compare(&gpu, &recipe(frequency, seed, low), &options);
        let what = format!("{frequency}, {seed}, {low}");
        assert_eq!(gpu.compiled_shaders(), compiled, "{what}");
    }
}
