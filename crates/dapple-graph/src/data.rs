//! Serializes graphs, and validates serialized graphs.
//!
//! Positions and vectors are stored as whole numbers of lattice steps, so that no format rounds them.

use crate::delaunay::is_delaunay;
use crate::lattice::Lattice;
use crate::{Axis, Graph, GraphError, GraphErrorKind};
use dapple_points::PointIdx;
use glam::DVec2;

/// Serialized form of a graph.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Graph", deny_unknown_fields)]
pub(crate) struct GraphData {
    /// Origin of the domain.
    origin: DVec2,
    /// Length of a step.
    step: f64,
    /// Width and height of the domain, in steps.
    size: [i64; 2],
    wrap: [bool; 2],
    /// Positions of the points relative to the origin, in steps.
    sites: Vec<[i64; 2]>,
    /// Axes of each point, each given by its target and its vector in steps.
    axes: Vec<Vec<(PointIdx, [i64; 2])>>,
    /// Whether the graph was created as a Delaunay graph.
    delaunay: bool,
}

impl From<Graph> for GraphData {
    fn from(graph: Graph) -> Self {
        let lattice = &graph.lattice;
        let whole = |steps: DVec2| steps.to_array().map(|part| part as i64);
        let (origin, step) = lattice.origin_and_step();
        let row = |point| {
            let axes = graph.axes(PointIdx(point)).iter();
            axes.map(|axis| (axis.to, whole(lattice.steps(axis.vector))))
                .collect()
        };
        Self {
            origin,
            step,
            size: whole(lattice.size),
            wrap: lattice.wrap,
            sites: graph.sites.iter().map(|&site| whole(site)).collect(),
            axes: (0..graph.n_points() as u32).map(row).collect(),
            delaunay: graph.delaunay,
        }
    }
}

impl TryFrom<GraphData> for Graph {
    type Error = GraphError;

    fn try_from(data: GraphData) -> Result<Self, GraphError> {
        let GraphData { step, size, .. } = data;
        let lattice = Lattice::from_parts(data.origin, step, size, data.wrap)
            .ok_or(GraphError::new(GraphErrorKind::Lattice { step, size }))?;
        let mut sites = Vec::with_capacity(data.sites.len());
        for site in data.sites {
            let is_inside = (0..2).all(|axis| {
                let end = size[axis] - i64::from(data.wrap[axis]);
                (0..=end).contains(&site[axis])
            });
            let site = DVec2::from(site.map(|part| part as f64));
            if !is_inside {
                let position = lattice.position(site);
                return Err(GraphError::new(GraphErrorKind::Outside { position }));
            }
            sites.push(site);
        }
        let (rows, n_points) = (data.axes.len(), sites.len());
        if rows != n_points {
            let kind = GraphErrorKind::Rows { rows, n_points };
            return Err(GraphError::new(kind));
        }
        let n_axes: usize = data.axes.iter().map(Vec::len).sum();
        if u32::try_from(n_axes.max(n_points)).is_err() {
            return Err(GraphError::new(GraphErrorKind::TooManyAxes { n_axes }));
        }
        let mut offsets = vec![0];
        let mut axes = Vec::with_capacity(n_axes);
        for (from, row) in (0..).map(PointIdx).zip(data.axes) {
            for (to, steps) in row {
                let vector = lattice.vector(steps.map(|part| part as f64).into());
                // Longer vectors do not occur in a graph and would not be exact.
                if steps.iter().any(|part| part.unsigned_abs() > 1 << 53) {
                    let kind = GraphErrorKind::Vector { from, to, vector };
                    return Err(GraphError::new(kind));
                }
                axes.push(Axis { to, vector });
            }
            offsets.push(axes.len() as u32);
        }
        let mut graph = Self {
            lattice,
            sites,
            offsets,
            axes,
            symmetric: false,
            delaunay: data.delaunay,
        };
        graph.sanity_check()?;
        graph.symmetric = graph.every_axis_has_its_opposite();
        if graph.delaunay && !is_delaunay(&graph) {
            return Err(GraphError::new(GraphErrorKind::NotDelaunay));
        }
        Ok(graph)
    }
}

#[cfg(test)]
mod tests {
    use crate::{EdgeDirection, Graph, PointSet, delaunay, gabriel, k_nearest};
    use dapple_points::hash::Seed;
    use dapple_points::{Domain, white_noise};
    use glam::DVec2;
    use serde_json::{Value, json};

    fn points(wrap: [bool; 2]) -> PointSet {
        let domain = Domain {
            wrap,
            ..Domain::torus(
                DVec2::new(0.1, -1e6 / 3.0),
                DVec2::new(1.999_999_999_999_999_9, 0.7),
            )
        };
        white_noise(domain, 60, Seed(5)).unwrap()
    }

    #[test]
    fn graphs_are_read_as_they_were_written() {
        for wrap in [[false, false], [true, false], [true, true]] {
            let points = points(wrap);
            let empty = PointSet::new(*points.domain(), Vec::new()).unwrap();
            for graph in [
                delaunay(&points).unwrap(),
                delaunay(&empty).unwrap(),
                gabriel(&points).unwrap(),
                k_nearest(&points, 3, EdgeDirection::Directed).unwrap(),
            ] {
                let text = serde_json::to_string(&graph).unwrap();
                let read: Graph = serde_json::from_str(&text).unwrap();
                assert_eq!(read, graph);
                assert_eq!(read.is_symmetric(), graph.is_symmetric());
                assert_eq!(read.is_delaunay(), graph.is_delaunay());
            }
        }
        let tiny = Domain::torus(DVec2::ZERO, DVec2::new(1e-305, 1e-306));
        let tiny = delaunay(&white_noise(tiny, 9, Seed(5)).unwrap()).unwrap();
        let text = serde_json::to_string(&tiny).unwrap();
        assert_eq!(serde_json::from_str::<Graph>(&text).unwrap(), tiny);
    }

    #[test]
    fn hostile_data_is_refused() {
        let graph = delaunay(&points([true, false])).unwrap();
        let good = serde_json::to_value(&graph).unwrap();
        let read = |path: &str, value: Value| {
            let mut bad = good.clone();
            *bad.pointer_mut(path).unwrap() = value;
            serde_json::from_value::<Graph>(bad)
                .unwrap_err()
                .to_string()
        };
        let first = &good["axes"][0];
        let count = first.as_array().unwrap().len();
        let mut twice = first.as_array().unwrap().clone();
        twice.insert(0, twice[0].clone());
        let mut fewer = first.as_array().unwrap().clone();
        fewer.pop();
        assert!(count > 3);
        for (path, value, cause) in [
            ("/step", json!(0.0), "power of two"),
            ("/step", json!(-1.0), "power of two"),
            ("/step", json!(3.0), "power of two"),
            ("/step", json!(1e-320), "power of two"),
            ("/step", json!(libm::ldexp(1.0, 1000)), "power of two"),
            ("/size", json!([0, 1_i64 << 49]), "power of two"),
            ("/size", json!([1_i64 << 51, 5]), "power of two"),
            ("/size", json!([4, 5]), "power of two"),
            ("/size", json!([i64::MIN, i64::MAX]), "power of two"),
            ("/origin", json!([1e301, 0.0]), "power of two"),
            ("/sites/3", json!([-1, 0]), "outside"),
            ("/sites/3/1", json!(i64::MAX), "outside"),
            ("/sites/3/0", good["size"][0].clone(), "outside"),
            ("/sites", json!([]), "60 rows, but the set has 0 points"),
            ("/axes/0", json!([]), "Delaunay"),
            ("/axes/0", json!(twice), "order"),
            ("/axes/0", json!(fewer), "Delaunay"),
            ("/axes/0/1/0", json!(60), "names point 60"),
            ("/axes/0/1/0", json!(u32::MAX), "names point 4294967295"),
            ("/axes/0/1/0", json!(-1), "u32"),
            ("/axes/0/1/1", json!([0, 0]), "order"),
            ("/axes/0/0/1", json!([i64::MAX, 1]), "does not lead"),
            ("/axes/0/0/1", json!([1, 0]), "does not lead"),
            ("/wrap", json!([true, true]), ""),
            ("/wrap", json!([false, false]), ""),
        ] {
            let error = read(path, value.clone());
            assert!(error.contains(cause), "{path} {value}: {error}");
        }
        // A graph that incorrectly claims to be a Delaunay graph
        let mut other = serde_json::to_value(gabriel(&points([true, false])).unwrap()).unwrap();
        other["delaunay"] = json!(true);
        let error = serde_json::from_value::<Graph>(other)
            .unwrap_err()
            .to_string();
        assert!(error.contains("Delaunay"), "{error}");
    }

    #[test]
    fn changed_data_never_panics() {
        // Replace every number of a small graph by several others; whatever is read must be valid.
        let graph = delaunay(&white_noise(Domain::paper_torus(), 4, Seed(1)).unwrap()).unwrap();
        let text = serde_json::to_string(&graph).unwrap();
        let mut n_read = 0;
        for (start, _) in text.match_indices(|c: char| c.is_ascii_digit()) {
            for digit in ["0", "1", "9", "-", "99999999999"] {
                let mut changed = text.clone();
                changed.replace_range(start..=start, digit);
                if let Ok(read) = serde_json::from_str::<Graph>(&changed) {
                    read.sanity_check().unwrap();
                    assert!(read.triangles().is_ok());
                    n_read += 1;
                }
            }
        }
        assert!(n_read > 0);
    }
}
