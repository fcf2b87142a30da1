//! Tests that the squares of the texture synthesized on the stingray model stay separate. At the first sites of the
//! sweep they would merge if the closest candidate were always chosen and the exemplar were sharper than the
//! neighborhoods that it is compared with.

use super::RAY;
use dapple_synth::mesh::Surface;
use dapple_synth::{Coherence, Exemplar, Matching, Options, Sources, Synthesizer};
use dapple_worley::hash::Seed;

/// Radius around a site, in multiples of the site spacing, within which two colors must occur. It is nearly the width
/// of a square, 10.7. The center of a square of the exemplar is at most 8 from its edges.
const RADIUS: f64 = 10.0;

/// Returns the fraction of sites for which all sites within [`RADIUS`] have the same color.
fn part_of_one_color(synthesizer: &Synthesizer, values: &[f32]) -> f64 {
    let hierarchy = synthesizer.hierarchy();
    let level = &hierarchy.levels()[0];
    let is_of_one_color = |site: usize| {
        let mut colors = [false; 2];
        let at = hierarchy.sites().positions()[site];
        level.grid().visit(at, RADIUS * level.spacing(), |near| {
            colors[usize::from(values[3 * near.index()] > 0.5)] = true;
        });
        colors != [true; 2]
    };
    let n_sites = hierarchy.sites().len();
    let count = (0..n_sites).filter(|&site| is_of_one_color(site)).count();
    count as f64 / n_sites as f64
}

#[test]
fn squares_of_the_ray_do_not_run_together() {
    let surface = Surface::new((RAY.model)(2000).unwrap()).unwrap();
    let ray = Synthesizer::new(surface, &RAY.directions(), &RAY.sites(512)).unwrap();
    let (image, edges) = RAY.image().unwrap();
    let exemplar = Exemplar::new(&image, edges).unwrap();
    let default = Options {
        seed: Seed(1),
        ..Options::default()
    };
    // The exemplar's own colors, not blurred as much as the neighborhoods, and the minimum distance.
    let literal = Options {
        matching: Matching::Colors,
        coherence: Coherence::Factor(0.0),
        sources: Sources::Pixel,
        ..default.clone()
    };
    let [auto, least] = [default, literal].map(|options| {
        let texture = ray.synthesize(&exemplar, &options).unwrap();
        part_of_one_color(&ray, texture.values(0))
    });
    println!("of one color: {auto} by default, {least} with the least distance");
    assert!(
        auto < 0.001,
        "{auto} of the sites are in areas of one color"
    );
    assert!(least > 0.003, "the test sees no area of one color: {least}");
}
