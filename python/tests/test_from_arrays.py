"""Histories made of arrays."""

import json
import pickle
from typing import Any

import numpy as np
import percute as pc
import pytest
from conftest import bar, block
from numpy.typing import NDArray

Case = tuple[pc.Problem, pc.History, pc.History]


@pytest.fixture(scope="module", params=[bar, block])
def case(request: pytest.FixtureRequest) -> Case:
    """A problem, its history, and the same with one step more, all in contact at the end."""
    problem = request.param()
    steps = [2e-7] * 40
    return problem, pc.simulate(problem, steps=steps), pc.simulate(problem, steps=[*steps, 2e-7])


def arrays(history: pc.History, *names: str) -> dict[str, NDArray[Any]]:
    return {name: getattr(history, name) for name in names}


def test_all_arrays_give_the_history_back(case: Case) -> None:
    problem, ours, _ = case
    theirs = pc.History.from_arrays(problem, ours.time, **arrays(ours, "displacement", "reaction", "touching"))
    first, second = pc.estimate(ours), pc.estimate(theirs)
    assert theirs.derived == () and theirs.complete and first.by_element.tobytes() == second.by_element.tobytes()


@pytest.mark.filterwarnings("ignore::percute.InputWarning")
def test_no_force_is_derived_off_the_planes() -> None:
    """A wrong value in flight makes a residual at a contact node, but no contact force."""
    problem = block(8, 6)
    ours = pc.simulate(problem, end=3e-6, courant=0.2)
    first = int(np.flatnonzero(ours.reaction.any(axis=(1, 2)))[0])
    wrong = ours.displacement.copy()
    wrong[first // 2, ours.contact_nodes[4], 1] += 1e-6
    assert first > 2 and not pc.History.from_arrays(problem, ours.time, wrong).reaction[: first - 1].any()


@pytest.mark.parametrize("given", [("displacement",), ("displacement", "reaction")])
def test_missing_arrays_are_derived(case: Case, given: tuple[str, ...]) -> None:
    problem, ours, longer = case
    held = arrays(longer, *given)
    if "reaction" in held:
        held["reaction"] = held["reaction"][:-1]
    with pytest.warns(pc.InputWarning, match="the last instant, 8.2e-6 s, is left out"):
        theirs = pc.History.from_arrays(problem, longer.time, **held)
    assert theirs.derived == tuple(name for name in ("reaction", "touching") if name not in given)
    assert np.array_equal(theirs.time, ours.time) and np.array_equal(theirs.touching, ours.touching)
    # Rounding of the second difference of displacements.
    assert np.allclose(theirs.reaction, ours.reaction, rtol=0, atol=1e-11 * np.abs(ours.reaction).max())
    first, second = pc.estimate(ours), pc.estimate(theirs)
    assert second.sup == pytest.approx(first.sup, rel=1e-9) and second.mean == pytest.approx(first.mean, rel=1e-9)
    assert list(theirs.derived) == json.loads(second.to_json())["derived"]


def test_a_force_of_rounding_does_not_touch() -> None:
    # 50 µm at 20 m/s are 25 steps: the plane is reached exactly, and a solver of one's own may have a force of rounding.
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=8, ny=5)
    problem = pc.Problem(
        mesh,
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700, plane="stress"),
        obstacles=[pc.Plane(point=(0, -50e-6), normal=(0, 1), friction=0)],
        initial_velocity=(0, -20),
    )
    ours = pc.simulate(problem, end=6e-6, step=1e-7)
    assert not ours.reaction[24].any() and ours.reaction[25].any()
    reaction = ours.reaction.copy()
    reaction[24, :, 1] = 1e-14 * reaction[..., 1].max()
    theirs = pc.History.from_arrays(problem, ours.time, displacement=ours.displacement, reaction=reaction)
    assert np.array_equal(theirs.touching, ours.touching[: len(theirs)])
    cut = pc.History.from_arrays(problem, ours.time, displacement=ours.displacement, reaction=ours.reaction)
    # The force itself is far below rounding of the others.
    assert pc.estimate(theirs).sup == pytest.approx(pc.estimate(cut).sup, rel=1e-9)


def test_accelerations_give_the_last_forces(case: Case, recwarn: pytest.WarningsRecorder) -> None:
    problem, ours, _ = case
    theirs = pc.History.from_arrays(problem, ours.time, **arrays(ours, "displacement", "velocity", "acceleration"))
    assert not recwarn.list and len(theirs) == len(ours)
    assert np.allclose(theirs.reaction, ours.reaction, rtol=0, atol=1e-11 * np.abs(ours.reaction).max())
    estimate = pc.estimate(theirs)
    assert dict(estimate.supplied) == {"velocity": True, "acceleration": True}
    assert estimate.sup == pytest.approx(pc.estimate(ours).sup, rel=1e-9)


def test_single_precision_is_enough(case: Case) -> None:
    problem, ours, longer = case
    single = {name: array.astype(np.float32) for name, array in arrays(longer, "displacement").items()}
    with pytest.warns(pc.InputWarning, match="last instant"):
        theirs = pc.History.from_arrays(problem, longer.time.astype(np.float32), **single)
    assert np.array_equal(theirs.touching, ours.touching)
    # 40 steps: a rounding of 6e-8 of the path grows by 4 · 40 in the second difference.
    assert np.allclose(theirs.reaction, ours.reaction, rtol=0, atol=1e-5 * np.abs(ours.reaction).max())
    assert pc.estimate(theirs).sup == pytest.approx(pc.estimate(ours).sup, rel=1e-3)


def test_without_contact_nothing_is_derived(recwarn: pytest.WarningsRecorder) -> None:
    ours = pc.simulate(block(), end=3e-7, courant=0.5)
    assert not ours.touching.any()
    recwarn.clear()
    theirs = pc.History.from_arrays(ours.problem, ours.time, ours.displacement)
    assert not recwarn.list and theirs.derived == () and len(theirs) == len(ours) and not theirs.reaction.any()


def test_forces_of_all_nodes_or_in_another_order(case: Case) -> None:
    problem, ours, _ = case
    nodes = ours.contact_nodes
    whole = np.zeros_like(ours.displacement)
    whole[:, nodes] = ours.reaction
    touching = np.zeros(whole.shape[:2], dtype="u1")
    touching[:, nodes] = ours.touching
    of_all = pc.History.from_arrays(problem, ours.time, ours.displacement, whole, touching)
    turned = pc.History.from_arrays(
        problem, ours.time, ours.displacement, ours.reaction[:, ::-1], ours.touching[:, ::-1], contact_nodes=nodes[::-1]
    )
    for theirs in (of_all, turned):
        assert np.array_equal(theirs.reaction, ours.reaction) and np.array_equal(theirs.touching, ours.touching)
    top = int(problem.mesh.points.sum(axis=1).argmax())
    whole[3, top] = 1.0
    with pytest.raises(pc.InputError, match=f"`reaction` is not zero at node {top},.*is the order of the nodes that of the mesh"):
        pc.History.from_arrays(problem, ours.time, ours.displacement, whole)


def test_a_history_of_arrays_can_be_pickled(case: Case) -> None:
    problem, ours, longer = case
    with pytest.warns(pc.InputWarning):
        derived = pc.History.from_arrays(problem, longer.time, longer.displacement)
    given = pc.History.from_arrays(problem, ours.time, **arrays(ours, "displacement", "velocity", "acceleration"))
    for history in (derived, given):
        again = pickle.loads(pickle.dumps(history))
        assert again.derived == history.derived
        assert pc.estimate(again).by_element.tobytes() == pc.estimate(history).by_element.tobytes()


def wrong(history: pc.History) -> dict[str, tuple[dict[str, Any], str]]:
    u, r, touching = history.displacement, history.reaction, history.touching
    broken = u.copy()
    broken[3, 2, 1] = np.nan
    return {
        "transposed": ({"displacement": u.transpose(1, 0, 2)}, r"`displacement` has the shape .*It is transposed: give np.transpose\(displacement, \(1, 0, 2\)\)"),
        "shape": ({"displacement": u[:, :-1]}, r"`displacement` has the shape .*must have .*\(instants, nodes, dimension\)"),
        "half": ({"displacement": u.astype(np.float16)}, "`displacement` is an array of float16"),
        "masked": ({"reaction": np.ma.masked_less(r, 0)}, "`reaction` is a masked array"),
        "masked touching": ({"touching": np.ma.masked_array(touching)}, "`touching` is a masked array"),
        "list of half": ({"displacement": list(u.astype(np.float16))}, "`displacement` is an array of float16"),
        "list of masked": ({"displacement": [np.ma.masked_greater(x, 1e-3) for x in u]}, "`displacement` holds masked arrays"),
        "lists of masked": ({"reaction": tuple([np.ma.masked_array(x)] for x in r[0])}, "`reaction` holds masked arrays"),
        "list of masked touching": ({"touching": [np.ma.masked_array(x) for x in touching]}, "`touching` holds masked arrays"),
        "masked instant": ({"time": [*history.time[:-1].tolist(), np.ma.masked]}, "`time` holds masked arrays"),
        "nan": ({"displacement": broken}, r"`displacement` is nan at \[3, 2, 1\]"),
        "nan force": ({"reaction": np.where(np.arange(len(r))[:, None, None] == 2, np.nan, r)}, r"`reaction` is nan at \[2, 0, 0\]"),
        "touching": ({"touching": 2.0 * touching}, "`touching` is an array of float64"),
        "velocity": ({"velocity": u[:-1]}, "`velocity` has the shape"),
        "node": ({"contact_nodes": [9999]}, "`contact_nodes` holds 9999"),
        "twice": ({"contact_nodes": [1, 1]}, "`contact_nodes` holds node 1 twice"),
        "time": ({"time": history.time + 1e-6}, "`time`: the first instant is 1e-6 s; it must be 0"),
        "times": ({"time": history.time[None]}, "`time` has the shape"),
    }


@pytest.mark.parametrize("name", list(wrong(pc.simulate(block(), end=4e-6, courant=0.9))))
def test_wrong_arrays_are_refused_by_name(name: str, block_history: pc.History) -> None:
    change, message = wrong(block_history)[name]
    held = {"time": block_history.time, **arrays(block_history, "displacement", "reaction", "touching")}
    with pytest.raises(pc.InputError, match=message):
        pc.History.from_arrays(block_history.problem, **{**held, **change})
