//! Nodes at frequencies that are not powers of two, and nodes under a warp.

use crate::harness::{Bench, Done, Side};
use crate::row::{Case, Goal, Unit};
use anyhow::{Context as _, Result, ensure};
use dapple_hash::Seed;
use dapple_raster::{Field, FieldExt as _, Raster};
use dapple_recipe::{Images, NodeField, Plan, Recipe};
use dapple_worley::{Combination, Feature, Worley2};
use glam::DVec2;

const WORLEY: Case = Case {
    group: "recipe",
    case: "node `worley` of frequency 12, F2 − F1",
    peer: "ours, frequency 8",
    unit: Unit::NsPerPixel,
    must: Goal::CostAtMost(1.3),
    note: "",
};

const OCTAVES: Case = Case {
    case: "node `worley` of frequency 12, six octaves",
    ..WORLEY
};

const CELL_VALUE: Case = Case {
    case: "node `worley` of frequency 12, cell value",
    ..WORLEY
};

const EDGE_DISTANCE: Case = Case {
    case: "node `worley` of frequency 12, distance to the edge",
    ..WORLEY
};

const WAVELET: Case = Case {
    case: "node `wavelet` of frequency 12",
    ..WORLEY
};

/// The nodes as TOML, without their frequency.
const NODES: [(&Case, &str); 5] = [
    (&WORLEY, "worley = { value = \"f2_minus_f1\""),
    (&OCTAVES, "worley = { value = \"f1\", octaves = {}"),
    (&CELL_VALUE, "worley = { value = \"cell_value\""),
    (&EDGE_DISTANCE, "worley = { value = \"edge_distance\""),
    (&WAVELET, "wavelet = { weights = [0.5]"),
];

const WARPED: Case = Case {
    case: "node `worley` of frequency 12 under a warp, F2 − F1",
    peer: "`Worley::sample_many` at the same positions",
    ..WORLEY
};

/// Width and height of the tile in pixels.
const SIDE: u32 = 1024;

/// Number of turns per row. Each turn runs both sides.
const TURNS: u32 = 21;

/// Amplitude of the warp, in units of the plane. Positions are displaced by their coordinates times this number.
const AMOUNT: f64 = 0.37;

pub(super) fn run(bench: &mut Bench) -> Result<()> {
    for (case, node) in NODES {
        if bench.wants(case) {
            let [ours, theirs] = [12, 8].map(|frequency| {
                single(
                    &format!("nodes.n.{node}, frequency = {frequency}.0 }}"),
                    "n",
                )
            });
            row(bench, case, &ours?, &theirs?)?;
        }
    }
    warped(bench)
}

/// A recipe with a single node, ready to render.
struct Single {
    plan: Plan,
    field: NodeField,
}

/// Builds a recipe from `nodes`, its TOML, and prepares the node called `name` for rendering.
fn single(nodes: &str, name: &str) -> Result<Single> {
    let text = format!("dapple = 1\n{nodes}\n[material]\nheight = 0.5\n");
    let recipe = Recipe::from_toml(&text).context(text)?;
    let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
    let field = plan.field(name)?;
    Ok(Single { plan, field })
}

/// Returns a side that renders a node.
fn side(node: &Single) -> Result<Side<'_, Raster<f32>>> {
    let window = node.plan.window([SIDE; 2])?;
    let image = Raster::filled(window.size, 0.0)?;
    Ok(Side::new(image, move |image: &mut Raster<f32>| {
        node.field
            .render(&window, image.view_mut())
            .expect("the image has the window's size");
    }))
}

/// Checks that pixels of an image equal evaluations at single positions. Returns the number of pixels.
fn confirm(node: &Single, image: &Raster<f32>) -> Result<usize> {
    let window = node.plan.window([SIDE; 2])?;
    for index in (0..SIDE * SIDE).step_by(1009) {
        let (column, row) = (index % SIDE, index / SIDE);
        let expected = node.field.sample(window.position(column, row));
        let found = image.row(row)[column as usize];
        ensure!(
            found.to_bits() == expected.to_bits(),
            "{found} at {column}, {row}, and {expected} asked alone"
        );
    }
    Ok(window.n_pixels())
}

fn row(bench: &mut Bench, case: &Case, ours: &Single, theirs: &Single) -> Result<()> {
    bench.beside(case, TURNS, side(ours)?, side(theirs)?, |image, other| {
        Ok(Done {
            ours: confirm(ours, image)?,
            theirs: confirm(theirs, other)?,
        })
    })
}

fn warped(bench: &mut Bench) -> Result<()> {
    if !bench.wants(&WARPED) {
        return Ok(());
    }
    let nodes = format!(
        "nodes.n.worley = {{ value = \"f2_minus_f1\", frequency = 12.0, seed = 7 }}\n\
         nodes.x.coordinate = {{ along = [1.0, 0.0] }}\n\
         nodes.y.coordinate = {{ along = [0.0, 1.0] }}\n\
         nodes.w.warp = {{ input = \"n\", x = \"x\", y = \"y\", amount = {AMOUNT} }}"
    );
    let ours = single(&nodes, "w")?;
    let worley = Worley2::new(Seed(7)).with_period([Some(12); 2])?;
    let window = ours.plan.window([SIDE; 2])?;
    let at = |index: u32| {
        let position = window.position(index % SIDE, index / SIDE);
        let shift = position.map(|part| f64::from(part as f32));
        (DVec2::from(position) + AMOUNT * DVec2::from(shift)) * 12.0
    };
    let positions: Vec<DVec2> = (0..SIDE * SIDE).map(at).collect();
    let none: [Feature<DVec2>; 2] = worley.sample(DVec2::NAN);
    let theirs = Side::new(vec![none; positions.len()], |features: &mut Vec<_>| {
        worley
            .sample_many(&positions, features)
            .expect("there is room for the features of each position");
    });
    bench.beside(&WARPED, TURNS, side(&ours)?, theirs, |image, features| {
        for (value, found) in image.pixels().iter().zip(features).step_by(61) {
            let distances = found.map(|feature| feature.distance);
            let expected = Combination::F2_MINUS_F1.of(&distances);
            // F2 − F1 and −F1 + F2 are rounded in the same way.
            ensure!(*value == expected, "{value} under the warp, not {expected}");
        }
        Ok(Done::both(confirm(&ours, image)?))
    })
}
