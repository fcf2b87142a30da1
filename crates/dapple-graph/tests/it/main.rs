//! Tests of graphs against brute-force searches, through the public interface.

mod delaunay_oracle;
mod other_graphs;
mod thin;
mod voronoi;
