//! Naive partition-of-unity parametrics, which visit every control point at every pixel: a peer and a reference for
//! checks.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013, equations 1 to 3: the weight of a control point `c` at `u` is the product of `A(p)` over its axes `r`, where
//! `p = (u − c)·r / |r|²` is clamped to [0, 1] and `A(p) = 1 − 3p² + 2p³`; the value is the weighted mean.
//!
//! It is naive, but not deliberately slow: it uses `f32`, stores axes flat in memory and already divided by their
//! squared length, and skips the remaining axes of a point once its weight is zero. Positions are in a unit torus.

/// Control points with their axes, prepared for evaluation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Naive {
    centers: Vec<[f32; 2]>,
    values: Vec<f32>,
    /// For each point, the index of its first axis in `axes`; then one more entry, the total number of axes.
    first: Vec<u32>,
    /// For each axis `r`, the vector `r / |r|²`.
    axes: Vec<[f32; 2]>,
}

impl Naive {
    /// Adds a control point of the unit torus: its position, its value and the vectors to its neighbors.
    pub(crate) fn push(
        &mut self,
        center: [f64; 2],
        value: f32,
        axes: impl IntoIterator<Item = [f64; 2]>,
    ) {
        if self.first.is_empty() {
            self.first.push(0);
        }
        self.centers.push(center.map(|x| x as f32));
        self.values.push(value);
        self.axes.extend(axes.into_iter().map(|[x, y]| {
            let length_sq = x * x + y * y;
            [(x / length_sq) as f32, (y / length_sq) as f32]
        }));
        self.first.push(self.axes.len() as u32);
    }

    /// Fills one row of an image of the unit square; `y` is the y coordinate of the row's pixel centers.
    pub(crate) fn row(&self, y: f64, row: &mut [f32]) {
        let pixel = 1.0 / row.len() as f64;
        for (column, value) in row.iter_mut().enumerate() {
            *value = self.sample([(column as f64 + 0.5) * pixel, y]);
        }
    }

    /// Returns the value at `position` in the unit square.
    pub(crate) fn sample(&self, position: [f64; 2]) -> f32 {
        let [x, y] = position.map(|coordinate| coordinate as f32);
        let (mut sum, mut total) = (0.0, 0.0);
        for ((center, value), ends) in self
            .centers
            .iter()
            .zip(&self.values)
            .zip(self.first.windows(2))
        {
            let (dx, dy) = (wrapped(x - center[0]), wrapped(y - center[1]));
            let weight = weight(dx, dy, &self.axes[ends[0] as usize..ends[1] as usize]);
            sum += weight * value;
            total += weight;
        }
        sum / total
    }
}

/// Returns the weight of a control point: the product of its axial weights at the offset `[dx, dy]` from it.
fn weight(dx: f32, dy: f32, axes: &[[f32; 2]]) -> f32 {
    let mut weight = 1.0;
    for axis in axes {
        let p = (dx * axis[0] + dy * axis[1]).max(0.0);
        if p >= 1.0 {
            return 0.0;
        }
        weight *= 1.0 - p * p * (3.0 - 2.0 * p);
    }
    weight
}

/// Wraps a coordinate difference on the unit torus to the range from -½ to ½.
fn wrapped(offset: f32) -> f32 {
    if offset > 0.5 {
        offset - 1.0
    } else if offset < -0.5 {
        offset + 1.0
    } else {
        offset
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns four points of a square grid on the torus, each with four neighbors half a torus away.
    fn grid() -> Naive {
        let mut naive = Naive::default();
        let axes = [[0.5, 0.0], [0.0, 0.5], [-0.5, 0.0], [0.0, -0.5]];
        for (center, value) in [
            ([0.25, 0.25], 1.0),
            ([0.75, 0.25], 0.0),
            ([0.25, 0.75], 0.0),
            ([0.75, 0.75], 0.0),
        ] {
            naive.push(center, value, axes);
        }
        naive
    }

    #[test]
    fn value_at_a_control_point_is_its_own() {
        let mut row = [0.0; 2];
        grid().row(0.25, &mut row);
        assert_eq!(
            row,
            [1.0, 0.0],
            "pixel centers 0.25 and 0.75 are control points"
        );
        assert_eq!(
            grid().sample([0.25, 0.25]).to_bits(),
            row[0].to_bits(),
            "one position is a pixel of its own"
        );
    }

    #[test]
    fn value_between_two_control_points_is_their_blend() {
        let mut row = [0.0; 8];
        grid().row(0.25, &mut row);
        // Pixel 3 is at 0.4375, at 3/8 of the axis to the right of the first point; pixel 0 is equally far to the
        // left.
        let p = 0.375_f32;
        let expected = 1.0 - p * p * (3.0 - 2.0 * p);
        assert!(
            (row[3] - expected).abs() < 1e-6,
            "{} is not {expected}, up to rounding of f32",
            row[3]
        );
        assert!(
            (row[0] - expected).abs() < 1e-6,
            "the torus makes it symmetric: {} is not {expected}",
            row[0]
        );
    }

    #[test]
    fn constant_values_are_reproduced() {
        let mut naive = grid();
        naive.values.fill(0.5);
        let mut row = [0.0; 33];
        naive.row(0.4, &mut row);
        assert!(
            row.iter().all(|value| (value - 0.5).abs() < 1e-6),
            "the weights add up to one: {row:?}"
        );
    }
}
