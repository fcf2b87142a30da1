//! Applies skins and morph targets, in the pose without animation.
//!
//! Reference: The Khronos Group, *glTF 2.0 Specification*, sections 3.7.2.2 (morph targets) and 3.7.3 (skins).

use super::accessor::{Budget, Column};
use super::document::Node;
use super::transform::{cofactors, local};
use super::{Source, wrong};
use crate::MeshIoError;
use glam::{DMat4, DVec3};

/// How a mesh is transformed to scene space.
pub(super) enum Pose {
    /// The transform of the mesh's node.
    Node(DMat4),
    /// For each joint, its transform multiplied by its inverse bind matrix. The node's transform has no effect.
    Skin(Vec<DMat4>),
}

/// Joints and weights of vertices, in sets of four.
#[derive(Default)]
pub(super) struct Influences {
    joints: Vec<Column>,
    weights: Vec<Column>,
}

impl Source<'_> {
    /// Returns the transform of each node to scene space; the identity for nodes in a cycle.
    pub(super) fn worlds(&self) -> Vec<DMat4> {
        let nodes = &self.document.nodes;
        let mut is_root = vec![true; nodes.len()];
        for &child in nodes.iter().flat_map(|node| &node.children) {
            if let Some(is_root) = is_root.get_mut(child) {
                *is_root = false;
            }
        }
        let mut worlds = vec![None; nodes.len()];
        let roots = (0..nodes.len()).filter(|&node| is_root[node]);
        let mut open: Vec<_> = roots.map(|node| (node, DMat4::IDENTITY)).collect();
        while let Some((index, parent)) = open.pop() {
            let Some((node, world)) = nodes.get(index).zip(worlds.get_mut(index)) else {
                continue;
            };
            if world.is_none() {
                let transform = parent * local(node);
                *world = Some(transform);
                open.extend(node.children.iter().map(|&child| (child, transform)));
            }
        }
        worlds.into_iter().map(Option::unwrap_or_default).collect()
    }

    /// Returns the pose of a node's mesh, given the node's transform to scene space.
    pub(super) fn pose(
        &self,
        node: &Node,
        transform: DMat4,
        worlds: &[DMat4],
        budget: &mut Budget,
    ) -> Result<Pose, MeshIoError> {
        let Some(skin) = node.skin else {
            return Ok(Pose::Node(transform));
        };
        let skin = self.document.skins.get(skin);
        let skin = skin.ok_or_else(|| wrong("a node has a skin that there is not"))?;
        let inverses = match skin.inverse_bind_matrices {
            Some(accessor) => Some(self.column(accessor, false, budget)?),
            None => None,
        };
        budget.take(skin.joints.len().saturating_mul(16))?;
        let joint = |(at, &joint): (usize, &usize)| {
            let world = worlds
                .get(joint)
                .ok_or_else(|| wrong(format!("there is no node {joint}")))?;
            let Some(inverses) = &inverses else {
                return Ok(*world);
            };
            let (matrices, _) = inverses.values.as_chunks::<16>();
            let inverse = matrices.get(at).filter(|_| inverses.width == 16);
            let inverse = inverse.ok_or_else(|| wrong("a joint has no inverse bind matrix"))?;
            Ok(*world * DMat4::from_cols_array(inverse))
        };
        let joints = skin.joints.iter().enumerate().map(joint);
        Ok(Pose::Skin(joints.collect::<Result<_, MeshIoError>>()?))
    }
}

impl Influences {
    /// Adds the next set of joints and weights.
    pub(super) fn add(&mut self, joints: Column, weights: Column) {
        self.joints.push(joints);
        self.weights.push(weights);
    }

    /// Returns whether all columns have `n_vertices` elements.
    pub(super) fn fits(&self, n_vertices: usize) -> bool {
        let mut columns = self.joints.iter().chain(&self.weights);
        columns.all(|column| column.width == 4 && column.values.len() == 4 * n_vertices)
    }

    /// Returns the weighted mean of a vertex's joint matrices; `None` if the vertex has no weights.
    fn matrix(&self, vertex: usize, joints: &[DMat4]) -> Result<Option<DMat4>, MeshIoError> {
        let (mut sum, mut total) = (DMat4::ZERO, 0.0);
        for (numbers, weights) in self.joints.iter().zip(&self.weights) {
            let range = 4 * vertex..4 * vertex + 4;
            for (&number, &weight) in numbers.values[range.clone()]
                .iter()
                .zip(&weights.values[range])
            {
                if weight == 0.0 {
                    continue;
                }
                let joint = joints.get(number as usize);
                let joint = joint.ok_or_else(|| wrong("a vertex has a joint that there is not"))?;
                sum += *joint * weight;
                total += weight;
            }
        }
        Ok((total > 0.0).then(|| sum * (1.0 / total)))
    }
}

impl Pose {
    /// Transforms positions and normals of vertices to scene space.
    pub(super) fn apply(
        &self,
        influences: &Influences,
        positions: &mut [DVec3],
        normals: &mut [DVec3],
    ) -> Result<(), MeshIoError> {
        match self {
            // Without a transform all bits are preserved, including the sign of zero.
            Self::Node(transform) if *transform == DMat4::IDENTITY => {}
            Self::Node(transform) => {
                for position in positions {
                    *position = transform.transform_point3(*position);
                }
                let cofactors = cofactors(*transform);
                for normal in normals {
                    *normal = (cofactors * *normal).normalize_or_zero();
                }
            }
            Self::Skin(joints) => {
                for (vertex, position) in positions.iter_mut().enumerate() {
                    let Some(matrix) = influences.matrix(vertex, joints)? else {
                        continue;
                    };
                    *position = matrix.transform_point3(*position);
                    if let Some(normal) = normals.get_mut(vertex) {
                        *normal = (cofactors(matrix) * *normal).normalize_or_zero();
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns whether the pose mirrors the mesh, which reverses the winding of faces.
    pub(super) fn is_mirrored(&self) -> bool {
        match self {
            Self::Node(transform) => glam::DMat3::from_mat4(*transform).determinant() < 0.0,
            Self::Skin(_) => false,
        }
    }
}
