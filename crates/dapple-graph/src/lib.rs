//! Delaunay (planar and periodic), Yao, Gabriel and nearest-neighbor graphs of a point set, and their axes.
