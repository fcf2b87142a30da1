//! Triangulation of polygons and strips.

/// The triangles around the first corner of a polygon.
pub(crate) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let pairs = corners.iter().skip(1).zip(corners.iter().skip(2));
    pairs.map(|(&b, &c)| [corners[0], b, c])
}

/// The triangles of a strip: each corner makes one with the two before it, and every second has the opposite direction.
pub(crate) fn strip<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    let triangles = corners.windows(3).enumerate();
    triangles.map(|(i, w)| {
        if i % 2 == 0 {
            [w[0], w[1], w[2]]
        } else {
            [w[0], w[2], w[1]]
        }
    })
}
