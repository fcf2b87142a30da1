"""Graphs of points."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import dapple_textures as dp


@pytest.fixture(scope="module")
def points() -> dp.Points:
    return dp.poisson_disk(dp.Domain((2, 1)), distance=0.08, seed=3)


def test_the_sketch_runs() -> None:
    domain = dp.Domain(size=(1, 1), wrap=True)
    points = dp.poisson_disk(domain, distance=0.05, seed=3)
    edges = dp.delaunay(points).edges()
    assert edges.shape == (3 * len(points), 2) and edges.dtype == np.int64
    land = dp.pups(points, values=np.random.default_rng(1).random(len(points)))
    assert land.render((64, 64)).std() > 0.1


def test_delaunay_on_a_torus_is_a_triangulation_of_it(points: dp.Points) -> None:
    graph = dp.delaunay(points)
    assert graph.is_symmetric and graph.points == points
    triangles, corners = graph.triangles(), graph.corners()
    assert triangles.shape == (2 * len(points), 3) and corners.shape == (2 * len(points), 3, 2)
    sides = corners[:, 1:] - corners[:, :1]
    areas = np.linalg.det(sides) / 2
    assert (areas > 0).all() and areas.sum() == pytest.approx(2.0, rel=1e-12)
    off = (corners - points.array[triangles]) / [2, 1]
    assert np.abs(off - off.round()).max() < 1e-12
    edges, ways = graph.edges(), graph.vectors()
    off = (points[edges[:, 0]] + ways - points[edges[:, 1]]) / [2, 1]
    assert np.abs(off - off.round()).max() < 1e-12 and (edges[:, 0] <= edges[:, 1]).all()


def test_delaunay_in_the_plane_is_that_of_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    array = np.random.default_rng(4).random((300, 2))
    graph = dp.delaunay(array)
    expected = {tuple(sorted(row)) for row in spatial.Delaunay(array).simplices.tolist()}
    assert {tuple(sorted(row)) for row in graph.triangles().tolist()} == expected
    edges = {(a, b) for row in expected for a in row for b in row if a < b}
    assert {tuple(edge) for edge in graph.edges().tolist()} == edges


def test_axes_are_compressed_rows(points: dp.Points) -> None:
    sparse = pytest.importorskip("scipy.sparse")
    for graph in [dp.delaunay(points), dp.k_nearest(points, 3), dp.yao(points), dp.gabriel(points)]:
        axes = graph.axes()
        assert len(axes.indptr) == len(points) + 1 and axes.indptr[-1] == len(axes.indices) == len(axes.vectors)
        lengths = np.linalg.norm(axes.vectors, axis=1)
        matrix = sparse.csr_array((lengths, axes.indices, axes.indptr), shape=(len(points),) * 2)
        assert (abs(matrix - matrix.T).max() == 0) == graph.is_symmetric
        n_edges = len(graph.edges())
        assert n_edges * (2 if graph.is_symmetric else 1) == len(axes.indices)


def test_nearest_points_are_those_of_a_tree(points: dp.Points) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    tree = spatial.cKDTree(points, boxsize=[2, 1])
    _, expected = tree.query(points, 4)
    axes = dp.k_nearest(points, 3).axes()
    found = np.sort(axes.indices.reshape(-1, 3), axis=1)
    assert np.array_equal(found, np.sort(expected[:, 1:], axis=1))


def test_graphs_are_made_again_from_their_description(points: dp.Points) -> None:
    graphs = [dp.delaunay(points), dp.gabriel(points), dp.yao(points, cones=8), dp.k_nearest(points, 5, symmetric=True)]
    for graph in graphs:
        again = pickle.loads(pickle.dumps(graph))
        assert again == graph and np.array_equal(again.axes().vectors, graph.axes().vectors)
    assert graphs[0] != graphs[1] and "points" in repr(graphs[0])


def test_few_points_are_welcome() -> None:
    assert dp.delaunay([[0.5, 0.5]], domain=dp.Domain(1)).triangles().tolist() == [[0, 0, 0], [0, 0, 0]]
    assert dp.delaunay([[0, 0], [1, 0]]).edges().tolist() == [[0, 1]]
    assert dp.delaunay([[0, 0], [1, 0], [2, 0]]).triangles().shape == (0, 3)
    empty = dp.delaunay(np.zeros((0, 2)))
    assert empty.edges().shape == (0, 2) and empty.triangles().shape == (0, 3) and empty.corners().shape == (0, 3, 2)


def test_bad_graphs_are_refused_with_their_kind() -> None:
    kinds = {
        "coincident": lambda: dp.delaunay([[0, 0], [0, 0], [1, 1]]),
        "neighbors": lambda: dp.k_nearest([[0, 0], [1, 1]], 5),
        "cones": lambda: dp.yao([[0, 0], [1, 1]], cones=0),
        "kind": lambda: dp.gabriel([[0, 0], [1, 1]]).triangles(),
        "different_domains": lambda: dp.delaunay(dp.Points([[0, 0]], dp.Domain(1)), domain=dp.Domain(2)),
        "thin": lambda: dp.delaunay(dp.white_noise(dp.Domain((1, 1e-12)), 100)),
    }
    for kind, call in kinds.items():
        with pytest.raises(dp.DappleError) as error:
            call()
        assert error.value.kind == kind
    with pytest.raises(TypeError):
        dp.k_nearest([[0, 0], [1, 1]], 1.5)


def test_points_closer_than_a_step_coincide_and_the_error_says_so() -> None:
    assert "2**-50" in (dp.delaunay.__doc__ or "")
    # The step is between 1e13 * 2**-50 and 1e13 * 2**-49: 0.0089 to 0.0178.
    with pytest.raises(dp.DappleError, match=r"points 0 and 1 coincide.*2\^-50") as error:
        dp.delaunay([[0, 0], [0.003, 0], [0, 1], [1e13, 0]])
    assert error.value.kind == "coincident"
    assert len(dp.delaunay([[0, 0], [0.02, 0], [0, 1], [1e13, 0]]).triangles()) > 0


def test_threads_do_not_change_graphs() -> None:
    before = dp.threads()
    points = dp.white_noise(dp.Domain(1), 20_000, seed=2)
    try:
        found = []
        for count in [1, 2]:
            dp.set_threads(count)
            graph = dp.delaunay(points)
            found.append((graph.axes(), graph.triangles()))
        for one, two in zip([*found[0][0], found[0][1]], [*found[1][0], found[1][1]], strict=True):
            assert np.array_equal(one, two)
    finally:
        dp.set_threads(before)
