//! Builds the hull of a space ship as a mesh: rectangular panels, each with a relief on a fine grid.

use dapple_preview::{Mesh, PreviewError};
use glam::DVec3;

/// Cross-section of the hull as x and y, from one side over the deck to the other. The underside is omitted, since it
/// is never visible.
const SECTION: [[f64; 2]; 8] = [
    [2.3, -0.2],
    [2.3, 0.25],
    [0.9, 0.75],
    [0.9, 0.95],
    [-0.9, 0.95],
    [-0.9, 0.75],
    [-2.3, 0.25],
    [-2.3, -0.2],
];

/// Extent of the hull along z. The eye is near the origin and looks along the hull.
const LENGTH: [f64; 2] = [-1.2, -26.0];

/// Blocks of the bridge, each with the center of its base and its half-side lengths.
const BLOCKS: [[[f64; 3]; 2]; 4] = [
    [[0.0, 0.95, -12.0], [0.75, 0.25, 4.0]],
    [[0.0, 1.45, -12.6], [0.5, 0.3, 2.2]],
    [[0.0, 2.05, -13.0], [0.22, 0.25, 0.6]],
    [[0.0, 2.55, -13.0], [0.8, 0.17, 0.42]],
];

/// Displacement of a panel per unit of the relief: sunken channels on the hull, raised blocks on the bridge.
const RELIEF: [f64; 2] = [-1.0, 0.5];

/// Width of the flat border of a panel, which lets adjacent panels meet.
const BORDER: f64 = 0.04;

/// A rectangular panel: a corner and two edges. Seen from outside, the second edge is to the left of the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    corner: DVec3,
    edges: [DVec3; 2],
    /// Displacement per unit of the relief.
    rise: f64,
}

impl Panel {
    /// Returns unit vectors along both edges and out of the panel.
    pub(super) fn axes(&self) -> [DVec3; 3] {
        let [u, v] = self.edges.map(DVec3::normalize);
        [u, v, u.cross(v)]
    }

    /// Returns the distance from the border, for a point given by its fractions along the edges.
    fn border_distance(&self, parts: [f64; 2]) -> f64 {
        let [u, v] = self.edges.map(DVec3::length);
        let side = |part: f64, length: f64| part.min(1.0 - part) * length;
        side(parts[0], u).min(side(parts[1], v))
    }
}

/// Returns all panels: the panels along the hull, and five for each block of the bridge.
fn panels() -> Vec<Panel> {
    let [front, back] = LENGTH;
    let mut panels = Vec::new();
    for ends in SECTION.windows(2) {
        let [from, to] = [ends[0], ends[1]].map(|[x, y]| DVec3::new(x, y, front));
        panels.push(Panel {
            corner: from,
            edges: [DVec3::Z * (back - front), to - from],
            rise: RELIEF[0],
        });
    }
    for [base, half] in BLOCKS {
        let [x, y, z] = half;
        let (base, up) = (DVec3::from(base), DVec3::Y * (2.0 * y));
        let corner = base + DVec3::new(-x, 0.0, z);
        let [right, back] = [DVec3::X * (2.0 * x), DVec3::NEG_Z * (2.0 * z)];
        let sides = [
            (corner, [right, up]),
            (corner + back, [-back, up]),
            (corner + right, [back, up]),
            (corner + up, [right, back]),
            (corner, [back, right]),
        ];
        panels.extend(sides.map(|(corner, edges)| Panel {
            corner,
            edges,
            rise: RELIEF[1],
        }));
    }
    panels
}

/// Builds the hull. `relief` returns the height of a panel at a position on it. The grid step is `step` times the
/// distance from the origin, and at least `step`.
pub(super) fn hull(step: f64, relief: impl Fn(&Panel, DVec3) -> f64) -> Result<Mesh, PreviewError> {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for panel in panels() {
        let first = positions.len() as u32;
        let [across, down] = panel.edges.map(|edge| lines(panel.corner, edge, step));
        let out = panel.axes()[2] * panel.rise;
        for &v in &down {
            for &u in &across {
                let at = panel.corner + panel.edges[0] * u + panel.edges[1] * v;
                let inside = panel.border_distance([u, v]) > BORDER;
                let height = if inside { relief(&panel, at) } else { 0.0 };
                positions.push(at + out * height);
            }
        }
        let width = across.len() as u32;
        for row in 1..down.len() as u32 {
            for column in 1..width {
                let d = first + row * width + column;
                let [a, b, c] = [d - width - 1, d - width, d - 1];
                triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
    }
    Mesh::flat(&positions, &triangles)
}

/// Returns the grid lines along an edge, as fractions of its length, with wider gaps farther from the eye.
fn lines(corner: DVec3, edge: DVec3, step: f64) -> Vec<f64> {
    let mut lines = vec![0.0];
    let mut part = 0.0;
    while part < 1.0 {
        let distance = (corner + edge * part).length().max(1.0);
        part = (part + step * distance / edge.length()).min(1.0);
        lines.push(part);
    }
    lines
}
