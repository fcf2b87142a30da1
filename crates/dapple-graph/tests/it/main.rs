//! Tests of graphs against searches through all pairs, through the public interface.

mod delaunay_oracle;
mod other_graphs;
mod thin;
mod voronoi;
