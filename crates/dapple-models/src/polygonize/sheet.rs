//! A closed triangle surface with editable connectivity, used for remeshing.

use super::Cut;
use crate::{ModelError, ModelErrorKind};
use dapple_mesh::Mesh;
use glam::DVec3;

/// Triangles, with the list of incident faces of each vertex.
pub(super) struct Sheet {
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    /// For each vertex, the indices of the faces that contain it. Empty for a removed vertex.
    fans: Vec<Vec<u32>>,
    n_faces: usize,
}

/// Vertex indices that mark a removed face.
const GONE: [u32; 3] = [u32::MAX; 3];
/// Minimum cosine of the angle by which a change may rotate the normal of a face.
const TURN: f64 = 0.5;
/// Evenness above which a change may make a triangle less even, from 0 to 1.
const EVEN: f64 = 0.3;
/// Step length in smoothing, as a fraction of the distance from a vertex to the centroid of its neighbors.
const SLIDE: f64 = 0.8;

impl Sheet {
    /// Builds the surface from triangles.
    ///
    /// # Errors
    ///
    /// [`ModelErrorKind::Open`] if the surface is not closed.
    pub(super) fn new(positions: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Result<Self, ModelError> {
        let mut fans = vec![Vec::with_capacity(8); positions.len()];
        for (index, face) in (0..).zip(&faces) {
            for &vertex in face {
                fans[vertex as usize].push(index);
            }
        }
        let n_faces = faces.len();
        let sheet = Self {
            positions,
            faces,
            fans,
            n_faces,
        };
        let open = sheet.edges(|sheet, from, to| sheet.face_of(to, from).is_none());
        let edges = open.len();
        if edges > 0 {
            return Err(ModelError::new(ModelErrorKind::Open { edges }));
        }
        Ok(sheet)
    }

    pub(super) fn n_faces(&self) -> usize {
        self.n_faces
    }

    /// Collapses the shortest third of the edges, shortest first, until `count` faces are left. Edges collapsed in
    /// the same call are never adjacent.
    pub(super) fn collapse(&mut self, cut: &Cut, count: usize) {
        let mut edges: Vec<(f64, u32, u32)> = self
            .edges(|_, from, to| from < to)
            .into_iter()
            .map(|[a, b]| (self.along(a, b).length_squared(), a, b))
            .collect();
        edges.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        edges.truncate(edges.len() / 3);
        let mut touched = vec![false; self.positions.len()];
        for (_, a, b) in edges {
            if self.n_faces < count + 2 {
                break;
            }
            if !touched[a as usize] && !touched[b as usize] && self.collapse_edge(cut, a, b) {
                for neighbor in self.neighbors(a) {
                    touched[neighbor as usize] = true;
                }
                touched[a as usize] = true;
            }
        }
    }

    /// Flips edges where that increases the evenness of the less even of the two triangles.
    pub(super) fn flip(&mut self) {
        for [a, b] in self.edges(|_, from, to| from < to) {
            self.flip_edge(a, b);
        }
    }

    /// Moves every vertex along the surface toward the centroid of its neighbors.
    pub(super) fn smooth(&mut self, cut: &Cut) {
        for vertex in 0..self.positions.len() as u32 {
            let neighbors = self.neighbors(vertex);
            if neighbors.is_empty() {
                continue;
            }
            let at = self.positions[vertex as usize];
            let sum: DVec3 = neighbors.iter().fold(DVec3::ZERO, |sum, &next| {
                sum + self.positions[next as usize]
            });
            // Move within the tangent plane, then project to the surface.
            let normal = self.normal_at(&[vertex]);
            let slide = (sum / neighbors.len() as f64 - at) * SLIDE;
            let slide = slide - normal * slide.dot(normal);
            if let Some(settled) = settled(cut, at + slide, normal)
                && self.keeps_shape(&[vertex], settled, normal)
            {
                self.positions[vertex as usize] = settled;
            }
        }
    }

    /// Converts the remaining faces and vertices to a mesh.
    pub(super) fn into_mesh(self) -> Result<Mesh, ModelError> {
        let mut numbers = vec![0; self.positions.len()];
        let mut positions = Vec::new();
        for (vertex, fan) in self.fans.iter().enumerate() {
            if !fan.is_empty() {
                numbers[vertex] = positions.len() as u32;
                positions.push(self.positions[vertex]);
            }
        }
        let faces = self.faces.iter().filter(|&&face| face != GONE);
        let faces: Vec<_> = faces
            .map(|face| face.map(|vertex| numbers[vertex as usize]))
            .collect();
        Ok(Mesh::new(positions, &faces)?)
    }

    /// Merges `b` into `a` at the midpoint of the edge, if the topology and the shape of the surface allow it.
    fn collapse_edge(&mut self, cut: &Cut, a: u32, b: u32) -> bool {
        let [Some(left), Some(right)] = [self.face_of(a, b), self.face_of(b, a)] else {
            return false;
        };
        // Link condition: the ends may share only the opposite corners of the two faces. Otherwise the surface would
        // become non-manifold.
        let others = self.neighbors(b);
        let shared = self.neighbors(a);
        let shared = shared.iter().filter(|next| others.contains(next)).count();
        if shared != 2 || self.fans[a as usize].len() + others.len() < 7 {
            return false;
        }
        // Project the midpoint to the surface.
        let middle = (self.positions[a as usize] + self.positions[b as usize]) * 0.5;
        let normal = self.normal_at(&[a, b]);
        let Some(middle) = settled(cut, middle, normal) else {
            return false;
        };
        if !self.keeps_shape(&[a, b], middle, normal) {
            return false;
        }
        // Remove the two faces of the edge and attach the others to `a`.
        self.positions[a as usize] = middle;
        for face in [left, right] {
            for vertex in self.faces[face as usize] {
                self.fans[vertex as usize].retain(|&other| other != face);
            }
            self.faces[face as usize] = GONE;
        }
        self.n_faces -= 2;
        for face in core::mem::take(&mut self.fans[b as usize]) {
            self.replace(face, b, a);
        }
        true
    }

    /// Flips an edge if that increases the evenness of the less even of its two triangles and no face turns over.
    fn flip_edge(&mut self, a: u32, b: u32) {
        let [Some(left), Some(right)] = [self.face_of(a, b), self.face_of(b, a)] else {
            return;
        };
        // The edge a–b would become the edge c–d between the opposite corners, which must not exist yet.
        let [c, d] = [self.third(left, a, b), self.third(right, a, b)];
        if c == d || self.face_of(c, d).is_some() || self.face_of(d, c).is_some() {
            return;
        }
        let corners = |face: [u32; 3]| face.map(|vertex| self.positions[vertex as usize]);
        let [before, after] =
            [[[a, b, c], [b, a, d]], [[a, d, c], [d, b, c]]].map(|faces| faces.map(corners));
        let worse = |faces: [[DVec3; 3]; 2]| evenness(faces[0]).min(evenness(faces[1]));
        let normal = area_normal(before[0]) + area_normal(before[1]);
        // Compare evenness and orientation of both triangles before and after.
        let turned = after.iter().any(|&face| {
            let new = area_normal(face);
            new.dot(normal) <= TURN * new.length() * normal.length()
        });
        if turned || worse(after) <= 1.0001 * worse(before) {
            return;
        }
        // Rewire the two faces.
        self.fans[a as usize].retain(|&face| face != right);
        self.fans[b as usize].retain(|&face| face != left);
        self.faces[left as usize] = [a, d, c];
        self.faces[right as usize] = [d, b, c];
        self.fans[d as usize].push(left);
        self.fans[c as usize].push(right);
    }

    /// Returns whether the faces around `vertices` keep their orientation and evenness if all these vertices move to
    /// `to`, where the surface has the normal `normal`. Faces with two of the vertices are ignored, since they will be
    /// removed.
    fn keeps_shape(&self, vertices: &[u32], to: DVec3, normal: DVec3) -> bool {
        let (mut least_before, mut least_after) = (EVEN, EVEN);
        for &vertex in vertices {
            for &face in &self.fans[vertex as usize] {
                let face = self.faces[face as usize];
                let before = face.map(|corner| self.positions[corner as usize]);
                least_before = least_before.min(evenness(before));
                let n_moved = face
                    .iter()
                    .filter(|corner| vertices.contains(corner))
                    .count();
                if n_moved > 1 {
                    continue;
                }
                let mut after = before;
                for (corner, position) in face.into_iter().zip(&mut after) {
                    if corner == vertex {
                        *position = to;
                    }
                }
                least_after = least_after.min(evenness(after));
                let [old, new] = [before, after].map(area_normal);
                // The normal of a tiny face is unreliable, so the normal of the surrounding faces is accepted as
                // well.
                let sides = [(old, old.length()), (normal, 1.0)];
                let kept =
                    |&(side, length): &(DVec3, f64)| new.dot(side) >= TURN * new.length() * length;
                if !sides.iter().any(kept) {
                    return false;
                }
            }
        }
        least_after >= least_before
    }

    /// Returns the directed edges of the faces for which `wanted` returns true, in the order of faces.
    fn edges(&self, wanted: impl Fn(&Self, u32, u32) -> bool) -> Vec<[u32; 2]> {
        let mut edges = Vec::new();
        for &[a, b, c] in self.faces.iter().filter(|&&face| face != GONE) {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                if wanted(self, from, to) {
                    edges.push([from, to]);
                }
            }
        }
        edges
    }

    /// Returns the neighbors of a vertex: for each of its faces, the corner after it.
    fn neighbors(&self, vertex: u32) -> Vec<u32> {
        let fan = self.fans[vertex as usize].iter();
        fan.map(|&face| next(self.faces[face as usize], vertex))
            .collect()
    }

    /// Returns the face that contains the directed edge `from`–`to`.
    fn face_of(&self, from: u32, to: u32) -> Option<u32> {
        let mut fan = self.fans[from as usize].iter().copied();
        fan.find(|&face| next(self.faces[face as usize], from) == to)
    }

    /// Returns the corner of a face other than `a` and `b`.
    fn third(&self, face: u32, a: u32, b: u32) -> u32 {
        let [x, y, z] = self.faces[face as usize];
        if x != a && x != b {
            x
        } else if y != a && y != b {
            y
        } else {
            z
        }
    }

    fn replace(&mut self, face: u32, old: u32, new: u32) {
        let corners = &mut self.faces[face as usize];
        *corners = corners.map(|corner| if corner == old { new } else { corner });
        self.fans[new as usize].push(face);
    }

    fn along(&self, from: u32, to: u32) -> DVec3 {
        self.positions[to as usize] - self.positions[from as usize]
    }

    /// Returns the unit normal of the faces around several vertices.
    fn normal_at(&self, vertices: &[u32]) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for &vertex in vertices {
            for &face in &self.fans[vertex as usize] {
                let corners = self.faces[face as usize].map(|at| self.positions[at as usize]);
                sum += area_normal(corners);
            }
        }
        sum.normalize_or_zero()
    }
}

/// Returns the corner of a face that follows `corner`.
fn next([a, b, c]: [u32; 3], corner: u32) -> u32 {
    if corner == a {
        b
    } else if corner == b {
        c
    } else {
        a
    }
}

/// Moves a position along the line `along` onto the surface. Returns `None` if the secant method does not converge
/// within a few steps.
fn settled(cut: &Cut, from: DVec3, along: DVec3) -> Option<DVec3> {
    const STEPS: u32 = 8;
    let (mut at, mut distance, mut slope) = (from, cut.distance(from), 1.0);
    for _ in 0..STEPS {
        if distance.abs() <= cut.tolerance() {
            return Some(at);
        }
        let step = -distance / slope;
        if step.is_nan() || step.abs() > cut.side {
            return None;
        }
        at += along * step;
        let last = distance;
        distance = cut.distance(at);
        slope = (distance - last) / step;
    }
    None
}

/// Returns the normal of a triangle. Its length is twice the area.
fn area_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Returns the evenness of a triangle, from 0 for a degenerate triangle to 1 for an equilateral one.
fn evenness([a, b, c]: [DVec3; 3]) -> f64 {
    let sides = (b - a).length_squared() + (c - b).length_squared() + (a - c).length_squared();
    // Twice the area of an equilateral triangle, as a fraction of the sum of its squared sides.
    const EQUILATERAL: f64 = 0.288_675_134_594_812_9;
    let doubled = area_normal([a, b, c]).length();
    if sides > 0.0 {
        doubled / (sides * EQUILATERAL)
    } else {
        0.0
    }
}
