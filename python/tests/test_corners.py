"""A node at two planes: from a case, in Python, and from a file."""

import numpy as np
import pytest

import percute as pc
from percute import InputError
from studies.corners import Corner


@pytest.fixture(scope="module")
def problem():
    """A box that slides along a floor into a wall."""
    return pc.Problem(
        mesh=pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8),
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700, plane="stress"),
        initial_velocity=(-20, -10),
        obstacles=[
            pc.Plane(point=(0, -2e-5), normal=(0, 1), friction=0.2, group="bottom"),
            pc.Plane(point=(-6e-5, 0), normal=(1, 0), friction=0.4, group="left"),
        ],
    )


def test_a_node_has_a_row_for_each_plane(problem):
    nodes = problem.contact_nodes
    assert len(nodes) == 11 + 9
    assert np.unique(nodes).size == 19
    history = pc.simulate(problem, end=20e-6, courant=0.9)
    rows = np.flatnonzero(nodes == 0)
    reaction = history.reaction[:, rows]
    assert (reaction[:, 0, 1] > 0).any() and (reaction[:, 1, 0] > 0).any()
    # Each in its cone: along x at the floor, along y at the wall.
    assert (np.abs(reaction[:, 0, 0]) <= 0.2 * reaction[:, 0, 1] * (1 + 1e-9)).all()
    assert (np.abs(reaction[:, 1, 1]) <= 0.4 * reaction[:, 1, 0] * (1 + 1e-9)).all()


def test_files_give_the_same_estimate(problem, tmp_path):
    path = tmp_path / "corner.vtkhdf"
    history = pc.simulate(problem, end=20e-6, courant=0.9)
    stored = pc.simulate(problem, end=20e-6, courant=0.9, store=path)
    opened = pc.open(path)
    estimates = [pc.estimate(one) for one in (history, stored, opened)]
    assert len({(e.sup, e.mean) for e in estimates}) == 1
    assert (opened.reaction == history.reaction).all()
    assert estimates[0].trust == "limited"
    assert "in the corner of two planes" in str(estimates[0].verdict)
    assert len(history.to_pandas()) > 0


def test_histories_of_other_programs_are_refused(problem):
    history = pc.simulate(problem, end=20e-6, courant=0.9)
    with pytest.raises(InputError, match="node 0 may touch two"):
        pc.estimate(pc.History.from_arrays(problem, history.time, history.displacement, reaction=history.reaction))


def test_the_verdict_knows_corners(problem):
    estimates = [pc.estimate(pc.simulate(problem, end=end, courant=0.9)) for end in (4e-6, 20e-6)]
    for estimate, expected in zip(estimates, ("0.7 to 3.5", "0.89 to 1.7"), strict=True):
        assert expected in estimate.verdict


def test_two_planes_have_no_restitution(problem):
    rebound = pc.simulate(problem, end=60e-6, courant=0.9).rebound
    assert rebound.restitution is None
    assert rebound.no_restitution == "several planes change the velocity"


@pytest.mark.parametrize(
    ("corner", "situation"),
    [
        # The impact on the floor throws the node at the corner away from the wall, which other nodes touch.
        (Corner(135.0, longer=True), "bodies in the corner of two planes"),
        (Corner(150.0), "bodies in the corner of two planes"),
        (Corner(45.0, longer=True), "bodies in an acute corner"),
        (Corner(90.0, approach=(0.0, 0.0), gaps=(0.0, 0.0), friction=(0.2, 0.2), force=(-7e7, -7e7), end=200e-6), "pressed for long"),
    ],
)
@pytest.mark.filterwarnings("ignore::percute.InputWarning", "ignore::percute.SimulationWarning")
def test_the_verdict_holds_in_the_corner_of_two_planes(corner, situation):
    """Rows of the table of docs/verdict.md, against the mesh of its references."""
    for sup, mean, (low, high) in corner.indices():
        assert low <= min(sup, mean) and max(sup, mean) <= high
    estimate = pc.estimate(pc.simulate(corner.problem(), end=corner.end, courant=0.9))
    assert situation in estimate.verdict and estimate.trust == "limited"
