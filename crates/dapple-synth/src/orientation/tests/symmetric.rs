//! Tests of fields with two and four directions: singularities, given directions, and combing.

use super::*;
use crate::bake_normals::turned as carried;
use crate::matcher::eigen;
use crate::orientation::symmetry::turned;
use crate::shapes::{geodesic_sphere, torus};
use crate::solve::System as _;
use core::f64::consts::TAU;
use dapple_mesh::{Mesh, Surface};
use glam::DVec2;

const SYMMETRIES: [Symmetry; 2] = [Symmetry::Two, Symmetry::Four];

fn field(hierarchy: &Hierarchy, directions: &[Direction], symmetry: Symmetry) -> Orientation {
    Orientation::symmetric(hierarchy, directions, Orientation::AXIS, symmetry).unwrap()
}

/// Returns the quotient of two unit complex numbers.
fn over(number: DVec2, other: DVec2) -> DVec2 {
    DVec2::new(other.x, -other.y).rotate(number)
}

fn angle(number: DVec2) -> f64 {
    libm::atan2(number.y, number.x)
}

/// Returns the index of the field in each triangle of sites, multiplied by the number of equivalent directions, and the
/// Euler characteristic of the mesh. The index is the number of turns of the field's power around the triangle, minus
/// the holonomy of the frame.
fn indices(mesh: &Mesh, normals: &[DVec3], orientation: &Orientation) -> (Vec<f64>, i64) {
    let symmetry = orientation.symmetry();
    let n = symmetry.quarters().len() as f64;
    let along: Vec<DVec3> = normals
        .iter()
        .map(|normal| normal.any_orthonormal_vector())
        .collect();
    let flat = |site: usize, vector: DVec3| {
        DVec2::new(
            vector.dot(along[site]),
            vector.dot(normals[site].cross(along[site])),
        )
    };
    let number = |site: usize| flat(site, orientation.vectors()[site]);
    let index = |face: &[dapple_mesh::VertexIdx; 3]| {
        let (mut turn, mut whole) = (0.0, DVec2::X);
        for corner in 0..3 {
            let [from, to] = [corner, (corner + 1) % 3].map(|corner| face[corner].index());
            let frame = flat(from, carried(along[to], normals[to], normals[from]));
            whole = whole.rotate(frame);
            turn += angle(symmetry.power(over(frame.rotate(number(to)), number(from))));
        }
        (turn - n * angle(whole)) / TAU
    };
    let report = mesh.report();
    assert_eq!(
        report.boundary_edges + report.non_manifold_edges,
        0,
        "not closed"
    );
    let [vertices, faces] = [mesh.positions().len(), mesh.faces().len()].map(|count| count as i64);
    let unused = report.unused_vertices as i64;
    (
        mesh.faces().iter().map(index).collect(),
        vertices - unused - faces / 2,
    )
}

/// Returns the number of singularities of a field on the finest level, the sum of their indices in n-ths of a turn, and
/// the Euler characteristic.
fn singularities(hierarchy: &Hierarchy, orientation: &Orientation) -> (usize, f64, i64) {
    let mesh = hierarchy.triangles(0).unwrap().mesh;
    let (indices, euler) = indices(&mesh, hierarchy.sites().normals(), orientation);
    for index in &indices {
        assert!(
            (index - index.round()).abs() < 1e-6,
            "{index} is not a whole number"
        );
    }
    let count = indices.iter().filter(|index| index.abs() > 0.5).count();
    (count, indices.iter().sum(), euler)
}

#[test]
fn indices_sum_to_the_euler_characteristic() {
    for (name, surface, euler) in [
        ("sphere", geodesic_sphere(4), 2),
        ("torus", torus(48, 24), 0),
        (
            "ellipsoid",
            Surface::new(moved(geodesic_sphere(4).mesh(), |at| {
                at * DVec3::new(1.0, 0.6, 2.0)
            }))
            .unwrap(),
            2,
        ),
    ] {
        let hierarchy = sites_on(surface.mesh().clone(), 3000, 3);
        for symmetry in SYMMETRIES {
            for directions in [
                &[][..],
                &[
                    toward(DVec3::X, DVec3::Y),
                    toward(DVec3::Z, DVec3::new(1.0, 0.3, 0.0)),
                ],
            ] {
                let orientation = field(&hierarchy, directions, symmetry);
                assert_tangent(&hierarchy, &orientation);
                let (count, sum, found) = singularities(&hierarchy, &orientation);
                let n = symmetry.quarters().len() as f64;
                assert_eq!(found, euler, "{name}");
                assert!(
                    (sum - n * euler as f64).abs() < 1e-6,
                    "{name} {symmetry}: {sum}"
                );
                // The minimum number of singularities, each of index 1/n. On this torus, a field of four directions is
                // smoother with some pairs of singularities inside than without any.
                if directions.is_empty() && (euler > 0 || symmetry == Symmetry::Two) {
                    assert_eq!(count as f64, n * euler as f64, "{name} {symmetry}");
                }
            }
        }
    }
}

#[test]
fn given_directions_are_turns_of_those_of_the_field() {
    let hierarchy = sites_on(sphere(), 2000, 3);
    let normals = hierarchy.sites().normals();
    let given = [
        toward(DVec3::X, DVec3::Y),
        toward(DVec3::NEG_Z, DVec3::new(0.5, 1.0, 0.0)),
    ];
    for symmetry in SYMMETRIES {
        let orientation = field(&hierarchy, &given, symmetry);
        for direction in given {
            let site = nearest(&hierarchy, direction.at);
            let wanted = tangent(direction.vector, normals[site]).unwrap();
            let found = orientation.nearest(normals, site, wanted);
            assert!(
                found.distance(wanted) < ROUNDING,
                "{symmetry}: {found} {wanted}"
            );
        }
        // Opposite vectors are equivalent directions, so they do not cancel.
        let ways = [toward(DVec3::X, DVec3::Y), toward(DVec3::X, DVec3::NEG_Y)];
        assert_eq!(
            field(&hierarchy, &ways, symmetry),
            field(&hierarchy, &ways[..1], symmetry)
        );
        let refused = [toward(DVec3::X, DVec3::ZERO)];
        assert!(Orientation::symmetric(&hierarchy, &refused, DVec3::Y, symmetry).is_err());
        assert!(Orientation::symmetric(&hierarchy, &[], DVec3::ZERO, symmetry).is_err());
    }
}

#[test]
fn field_on_a_plane_is_constant() {
    for n_levels in [1, 3] {
        let hierarchy = sites_on(square(), 1500, n_levels);
        let normals = hierarchy.sites().normals();
        for symmetry in SYMMETRIES {
            for direction in [
                None,
                Some(toward(DVec3::new(0.3, 0.6, 0.0), DVec3::new(1.0, 0.4, 0.0))),
            ] {
                let orientation = field(&hierarchy, direction.as_slice(), symmetry);
                let wanted =
                    direction.map_or(Orientation::AXIS, |direction| direction.vector.normalize());
                for (site, vector) in orientation.vectors().iter().enumerate() {
                    let near = orientation.nearest(normals, site, wanted);
                    assert!(
                        near.distance(wanted) < 1e-3,
                        "{symmetry} {site}: {near} {wanted}"
                    );
                    let first = orientation.vectors()[0];
                    assert!(
                        vector.distance(first) < 1e-2,
                        "{symmetry} {site}: another turn"
                    );
                }
            }
        }
    }
}

/// Returns the lowest eigenvalue of the system of a level, from its dense matrix.
fn naive_eigenvalue(system: &smooth::Smooth<'_>, n_sites: usize) -> f64 {
    let size = 2 * n_sites;
    let mut matrix = vec![0.0; size * size];
    for column in 0..size {
        let mut unit = vec![DVec2::ZERO; n_sites];
        unit[column / 2][column % 2] = 1.0;
        for row in 0..n_sites {
            let [x, y] = system.row(&unit, row).to_array();
            matrix[2 * row * size + column] = x;
            matrix[(2 * row + 1) * size + column] = y;
        }
    }
    for row in 0..size {
        for column in 0..row {
            let off = matrix[row * size + column] - matrix[column * size + row];
            assert!(off.abs() < 1e-9, "the matrix is not symmetric: {off}");
        }
    }
    let (values, _) = eigen(size, matrix);
    values.into_iter().fold(f64::INFINITY, f64::min)
}

#[test]
fn smoothest_field_has_the_lowest_energy() {
    let ellipsoid = moved(&sphere(), |at| at * DVec3::new(1.0, 0.7, 1.6));
    let hierarchy = sites_on(ellipsoid, 90, 1);
    let links = Links::new(&hierarchy, 0);
    let components = components(hierarchy.levels()[0].graph());
    for symmetry in SYMMETRIES {
        let level = push::Field {
            links: &links,
            normals: hierarchy.sites().normals(),
            axis: Orientation::AXIS,
            symmetry,
        };
        let mut system = smooth::Smooth::new(&level, &components);
        let wanted = naive_eigenvalue(&system, 90);
        let (_, found) = system.lowest();
        assert!(
            (found[0] / wanted - 1.0).abs() < 0.01,
            "{symmetry}: {} {wanted}",
            found[0]
        );
    }
}

#[test]
fn cuts_are_few_and_only_between_singularities() {
    let hierarchy = sites_on(sphere(), 3000, 3);
    let normals = hierarchy.sites().normals();
    let graph = hierarchy.levels()[0].graph();
    for symmetry in SYMMETRIES {
        let orientation = field(&hierarchy, &[], symmetry);
        let (mut cut, mut all) = (0, 0);
        for site in 0..graph.len() {
            for other in graph.neighbors(SiteIdx(site as u32)) {
                all += 1;
                cut +=
                    usize::from(orientation.quarters_toward(normals, site, other.index(), 0) != 0);
            }
        }
        assert!(cut * 20 < all, "{symmetry}: {cut} of {all} edges are cut");
        // Any rotation of a neighbor is matched by a rotation of the site.
        for &quarters in symmetry.quarters() {
            let site = 17;
            let other = graph.neighbors(SiteIdx(17))[0].index();
            let here = orientation.quarters_toward(normals, site, other, quarters);
            let [here, there] = [(site, here), (other, quarters)].map(|(site, quarters)| {
                turned(orientation.vectors()[site], normals[site], quarters)
            });
            assert!(here.dot(there) > 0.6, "{symmetry} {quarters}");
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn symmetric_fields_have_the_same_bits_on_any_number_of_threads() {
    let hierarchy = sites_on(sphere(), 6000, 2);
    for symmetry in SYMMETRIES {
        let [one, two, seven] = crate::shapes::on_threads(|| field(&hierarchy, &[], symmetry));
        assert_eq!(one, two);
        assert_eq!(one, seven);
    }
}

#[test]
fn parts_of_a_surface_have_fields_of_their_own() {
    let hierarchy = sites_on(two_squares(), 800, 2);
    let components = components(hierarchy.levels()[0].graph());
    let normals = hierarchy.sites().normals();
    let at = hierarchy.sites().positions()[0];
    let given = toward(at, DVec3::new(1.0, 0.5, 0.0));
    for symmetry in SYMMETRIES {
        let orientation = field(&hierarchy, &[given], symmetry);
        for (site, &component) in components.iter().enumerate() {
            let wanted = match component == components[0] {
                true => given.vector.normalize(),
                false => Orientation::AXIS,
            };
            let near = orientation.nearest(normals, site, wanted);
            assert!(
                near.distance(wanted) < 2e-3,
                "{symmetry} {site}: {near} {wanted}"
            );
        }
    }
}

#[test]
fn value_stability_symmetric() {
    let hierarchy = sites_on(sphere(), 400, 2);
    let pinned = [
        [
            [0.4218626214369437, -0.8089668502610545, 0.40939536369267604],
            [
                0.23311531124122814,
                -0.9675713382866225,
                -0.09727773121912235,
            ],
            [0.3982726009040188, -0.8501795803598142, 0.3443451996301943],
        ],
        [
            [0.4326989716618053, -0.8091996376466656, 0.3974513131885729],
            [
                0.2324828613891765,
                -0.9675658302343227,
                -0.09883361433878118,
            ],
            [0.4468431941361173, -0.8508665457498552, 0.27632821277955283],
        ],
    ];
    for (symmetry, pinned) in SYMMETRIES.into_iter().zip(pinned) {
        let orientation = field(&hierarchy, &[], symmetry);
        let found = [0, 57, 399].map(|site| orientation.vectors()[site].to_array());
        assert_eq!(found, pinned, "{symmetry}");
    }
}
