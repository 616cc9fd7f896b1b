"""Histories with contact by a penalty: soft and stiff, with friction, beside noise and real double contacts."""

import json
import re
import warnings

import numpy as np
import percute as pc
import pytest
from conftest import block, tilted
from studies.durations import Impact
from studies.penalties import matrices, row, simulated
from spoiling import FALLS, STATED, Parts, cause, given, parts, shifted, without


def penalty(
    stiffness: float, courant: float = 0.8, friction: float = 0.0, sideways: float = 50.0, consistent: bool = False
) -> tuple[pc.Problem, Parts]:
    """A block of percute's mesh with contact and friction by penalties (Pa/m), R_n from the penetration at t_n.

    At 50 m/s strains stay below 2 %.
    """
    stated = block(friction=friction)
    plane = pc.Plane(point=(0.0, -2.5e-5), normal=(0.0, 1.0), friction=friction)
    problem = pc.Problem(stated.mesh, material=stated.material, obstacles=[plane], initial_velocity=(sideways, -50.0))
    return problem, {**STATED, **simulated(problem, stiffness, courant=courant, consistent=consistent)}


@pytest.mark.parametrize("lacks", [(), ("reaction",)])
@pytest.mark.parametrize("stiffness", [1e14, 1e15, 1e16])
def test_contact_by_a_penalty_is_graded(stiffness: float, lacks: tuple[str, ...]) -> None:
    problem, whole = penalty(stiffness)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        history = given(problem, without(whole, *lacks))
        # Springs give the auxiliary solution 2 %, 12 % and 6 % of the energy back, which is no doubt.
        estimate = pc.estimate(history)
    assert estimate.trust == "limited"
    assert (estimate.consistency or {})["penalty"] > 0.9
    # Its index is outside the range of the other cases.
    assert json.loads(estimate.to_json())["verdict"]["effectivity"] is None
    assert "no range of estimate over true error is known for contact by a penalty" in estimate.verdict


@pytest.mark.filterwarnings("ignore:the last instant")
@pytest.mark.parametrize(("steps", "when"), [(1, "late"), (-1, "early")])
@pytest.mark.parametrize("courant", [0.2, 0.02])
def test_a_shift_is_named_below_the_limit_too(courant: float, steps: int, when: str) -> None:
    """With short steps, forces of a penalty change little in a step: the residual stays within its limit."""
    problem, whole = penalty(1e13, courant=courant)
    late = {**whole, "reaction": shifted(whole["reaction"], steps)}
    told = f"the contact forces are a step too {when}"
    if courant > 0.1:
        assert told in cause(problem, late)
        return
    with pytest.warns(pc.SimulationWarning, match=told):
        estimate = pc.estimate(given(problem, late))
    assert 1e-3 < (estimate.consistency or {})["balance"] < 0.01
    assert estimate.trust == "limited" and "contact forces of another step" in estimate.verdict
    # No such history is correct.
    assert "another step" not in pc.estimate(given(problem, whole)).verdict


@pytest.mark.parametrize("sideways", [0.0, 0.6, 6.0, 50.0])
def test_friction_by_a_penalty_is_graded(sideways: float) -> None:
    """Nodes that stick move by the stretch of their springs: that is no other friction."""
    problem, whole = penalty(1e14, friction=0.2, sideways=sideways)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        estimate = pc.estimate(given(problem, whole))
    assert estimate.trust == "limited" and "penalty" in estimate.verdict, estimate.verdict


@pytest.mark.parametrize("lacks", [(), ("reaction",)])
def test_a_consistent_mass_is_named(lacks: tuple[str, ...]) -> None:
    problem, whole = penalty(1e14, consistent=True)
    said = cause(problem, without(whole, *lacks))
    assert re.search(f"the accelerations fit a consistent mass matrix, but percute lumps .*{FALLS} less than", said), said


def test_an_unstable_penalty_is_named() -> None:
    problem, whole = penalty(1e13, courant=1.5)
    said = cause(problem, whole)
    assert "the contact is unstable" in said and "penalty too stiff" in said, said


def tilted_trapezoid(stiffness: float, steps: int) -> pc.History:
    """A trapezoid of steel, tilted by 4°, that strikes with one corner and then with the other, on springs (N/m)."""
    nx, ny, angle = 12, 10, np.radians(4.0)
    points = np.array([[(0.04 - 0.016 * j / ny) * (i / nx - 0.5), 0.03 * j / ny] for j in range(ny + 1) for i in range(nx + 1)])
    points = points @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    points[:, 1] -= points[:, 1].min()
    cells = []
    for a in (j * (nx + 1) + i for j in range(ny) for i in range(nx)):
        b, c, d = a + 1, a + nx + 2, a + nx + 1
        cells += [[a, b, c], [a, c, d]] if (a % (nx + 1) + a // (nx + 1)) % 2 else [[a, b, d], [b, c, d]]
    steel = pc.Elastic(young=210e9, poisson=0.3, density=7800.0, plane="strain")
    plane = pc.Plane(point=(0, -2e-5), normal=(0, 1), friction=0.3)
    problem = pc.Problem(pc.Mesh(points, cells), material=steel, obstacles=[plane], initial_velocity=(20, -40))
    matrix, mass = matrices(problem)
    dt, weights = 0.8 * problem.critical_time_step, mass.sum(axis=1)[:, None]
    u, v = np.zeros_like(points), np.tile([20.0, -40.0], (len(points), 1))
    displacement, reaction = [u], []
    for n in range(steps):
        r = np.zeros_like(u)
        r[:, 1] = stiffness * np.maximum(0, -2e-5 - points[:, 1] - u[:, 1])
        r[:, 0] = -0.3 * r[:, 1] * np.clip(v[:, 0] / 0.5, -1, 1)
        v = v + (dt / 2 if n == 0 else dt) * (r - (matrix @ u.ravel()).reshape(-1, 2)) / weights
        u = u + dt * v
        displacement.append(u)
        reaction.append(r)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        return pc.History.from_arrays(problem, dt * np.arange(steps + 1), displacement, reaction)


@pytest.mark.filterwarnings("ignore:the relative error", "ignore:the body turns by 0.11 rad")
@pytest.mark.parametrize(("stiffness", "steps", "phases"), [(5e11, 140, 1), (5e11, 400, 2), (1e11, 400, 2), (1e10, 400, 2)])
def test_nodes_that_bounce_on_a_penalty_are_one_contact(stiffness: float, steps: int, phases: int) -> None:
    """The stiffest lets all nodes go for a step after 27 µs; after 40 µs the other corner strikes, with any stiffness."""
    history = tilted_trapezoid(stiffness, steps)
    forced = (history.reaction[:, :, 1] > 0).any(axis=1)
    assert np.sum(np.diff(forced.astype(int)) > 0) == {(5e11, 140): 2, (5e11, 400): 4}.get((stiffness, steps), phases)
    estimate = pc.estimate(history)
    assert json.loads(estimate.to_json())["verdict"]["phases"] == phases
    assert ("after several contacts" in estimate.verdict) == (phases > 1), estimate.verdict
    assert "contact by a penalty" in estimate.verdict


@pytest.mark.parametrize("size", [1e-9, 1e-8])
def test_noise_is_no_penalty(size: float) -> None:
    """Nodes that touch are off their plane by the noise, and forces do not follow it."""
    history = pc.simulate(block(nx=32, ny=24), end=13e-6, courant=0.9)
    noise = size * np.random.default_rng(1).standard_normal(history.displacement.shape) * (history.time > 0)[:, None, None]
    noisy = pc.History.from_arrays(history.problem, history.time, history.displacement + noise, history.reaction, history.touching)
    estimate = pc.estimate(noisy, force=True)
    found = estimate.consistency or {}
    assert found["penetration"] > 1e-6 and found["penalty"] < 0.1
    off = re.search(r"contact nodes off their plane by (\S+) of an element", estimate.verdict)
    assert off and float(off[1]) == pytest.approx(max(found["penetration"], found["gap_under_force"]), rel=0.05)
    assert "penalty" not in estimate.verdict and estimate.trust != "high"


def test_a_turned_plane_is_no_penalty() -> None:
    """A node that slides on it goes off the plane of the problem little by little, but its force does not follow."""
    history = pc.simulate(tilted(), end=13e-6, courant=0.9)
    estimate = pc.estimate(given(history.problem, without({**parts(history), "turn": -1e-3}, "touching")), force=True)
    found = estimate.consistency or {}
    assert found["penalty"] < 0.87 and "penalty" not in estimate.verdict


def test_the_index_of_a_penalty_is_outside_the_range_without_one() -> None:
    """A row of the table of docs/verdict.md; multipliers have 0.9 to 1.6 (docs/verdict.md, trust)."""
    sup, mean, depth = row(Impact("block", 1, 0.8), 1e15)
    assert min(sup, mean) > 1.6 and 0 < depth < 0.1
