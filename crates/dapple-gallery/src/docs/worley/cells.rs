//! Rows of documentation images about the nearest feature point, its Voronoi cell, and profiles.

use super::{basis, color_of, color_with_edges, gray, gray_with_edges};
use crate::docs::Strip;
use crate::draw::label_color;
use dapple_worley::{Combination, Profile};

/// Width and height of an image, in cells.
const CELLS: f64 = 2.5;

/// Value that F1 almost never exceeds, in cells.
const F1_MAX: f32 = 0.6;

pub(super) const FEATURE: Strip = Strip {
    name: "feature",
    caption: "Of the nearest feature point",
    render: || {
        let worley = basis();
        Ok(vec![
            gray("its distance", CELLS, |at| {
                worley.sample::<1>(at)[0].distance / F1_MAX
            })?,
            color_with_edges("its vector with x as red and y as green", CELLS, |at| {
                color_of(worley.sample::<1>(at)[0].vector, f64::from(F1_MAX))
            })?,
            color_with_edges("its id as a color", CELLS, |at| {
                label_color(worley.sample::<1>(at)[0].id as u32 % 64)
            })?,
        ])
    },
};

pub(super) const CELL_VALUE: Strip = Strip {
    name: "cell-value",
    caption: "The random number from 0, black, to 1, white",
    render: || {
        let worley = basis();
        let panel = gray_with_edges("a shade for each Voronoi cell", CELLS, |at| {
            worley.sample::<1>(at)[0].cell_value()
        })?;
        Ok(vec![panel])
    },
};

pub(super) const EDGE_DISTANCE: Strip = Strip {
    name: "edge-distance",
    caption: "Joints are where the value is below 0.04",
    render: || {
        let worley = basis();
        let cracks = worley.combine(Combination::F2_MINUS_F1);
        let joint = |value: f32| if value < 0.04 { 0.0 } else { 1.0 };
        Ok(vec![
            gray("the distance to the edge", CELLS, |at| {
                worley.edge_distance(at) / 0.4
            })?,
            gray_with_edges("joints of F2 − F1", CELLS, |at| joint(cracks.value(at)))?,
            gray_with_edges("joints of the distance to the edge", CELLS, |at| {
                joint(worley.edge_distance(at))
            })?,
        ])
    },
};

pub(super) const SPHERE_RADIUS: Strip = Strip {
    name: "sphere-radius",
    caption: "The spheres touch no other Voronoi cell than their own",
    render: || {
        let worley = basis();
        Ok(vec![
            gray_with_edges("the radius", CELLS, |at| worley.sphere_radius(at) / 0.35)?,
            gray_with_edges("the spheres", CELLS, |at| {
                let nearest = worley.sample::<1>(at)[0].distance;
                if nearest < worley.sphere_radius(at) {
                    1.0
                } else {
                    0.0
                }
            })?,
        ])
    },
};

pub(super) const SMOOTH_F1: Strip = Strip {
    name: "smooth-f1",
    caption: "White is the same distance in all",
    render: || {
        let worley = basis();
        let mut panels = vec![gray("F1", CELLS, |at| {
            worley.sample::<1>(at)[0].distance / F1_MAX
        })?];
        for radius in [0.1, 0.3] {
            let label = format!("smooth with radius {radius}");
            panels.push(gray(&label, CELLS, |at| {
                // The only error is a radius outside its range.
                worley.smooth_f1(at, radius).unwrap_or(f32::NAN) / F1_MAX
            })?);
        }
        Ok(panels)
    },
};

pub(super) const SPOTS: Strip = Strip {
    name: "profile-spots",
    caption: "Heights above F1",
    render: || {
        let f1 = basis().combine(Combination::F1);
        let panels = [0.15, 0.4].into_iter().map(|radius| {
            let spots = Profile::spots(radius)?;
            let label = format!("radius {radius}");
            gray(&label, CELLS, |at| spots.height(f1.value(at)))
        });
        panels.collect()
    },
};

pub(super) const CHANNELS: Strip = Strip {
    name: "profile-channels",
    caption: "Heights",
    render: || {
        let [f1, cracks] = [Combination::F1, Combination::F2_MINUS_F1]
            .map(|combination| basis().combine(combination));
        let [thin, wide, pit] = [0.05, 0.1, 0.2].map(Profile::channels);
        let [thin, wide, pit] = [thin?, wide?, pit?];
        Ok(vec![
            gray("width 0.05 of F2 − F1", CELLS, |at| {
                thin.height(cracks.value(at))
            })?,
            gray("width 0.1 of F2 − F1", CELLS, |at| {
                wide.height(cracks.value(at))
            })?,
            gray("width 0.2 of F1", CELLS, |at| pit.height(f1.value(at)))?,
        ])
    },
};
