"""Histories of other programs with non-matching interfaces: read, checked and refused, in memory and from files."""

import json
import re
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import percute as pc
import pytest
from numpy.typing import NDArray
from spoiling import Parts, changed, parts, shifted

ALUMINIUM = pc.Elastic(young=70e9, poisson=0.3, density=2700, plane="stress")
STEEL = pc.Elastic(young=210e9, poisson=0.3, density=7800, plane="stress")
HEIGHT = 0.02505
"""The place of the upper bodies (m)."""


def stated(lower: list[pc.Body], upper: pc.Body, friction: float = 0.2) -> pc.Problem:
    return pc.Problem(bodies=[*lower, upper], contacts=[pc.Interface(friction=friction)])


def sliding(friction: float = 0.2, density: float = 1.0, lift: float = 0.0) -> pc.Problem:
    """Give a narrow block, the slave, that slides on a wider one; the densities of both with a factor."""
    steel, aluminium = (
        pc.Elastic(young=law.young, poisson=law.poisson, density=density * law.density, plane="stress") for law in (STEEL, ALUMINIUM)
    )
    anvil = pc.Body(name="anvil", mesh=pc.Mesh.rectangle(0.04, 0.025, nx=8, ny=5), material=steel)
    mesh = pc.Mesh.rectangle(0.02, 0.02, nx=5, ny=5)
    hammer = pc.Body(name="hammer", mesh=mesh, material=aluminium, origin=(0.008, HEIGHT + lift), velocity=(60, -20))
    return stated([anvil], hammer, friction)


def entering() -> pc.Problem:
    """Give a block that enters from beside: nodes begin to face the other surface."""
    anvil = pc.Body(name="anvil", mesh=pc.Mesh.rectangle(0.04, 0.025, nx=7, ny=5), material=ALUMINIUM)
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=9, ny=5)
    return stated([anvil], pc.Body(name="hammer", mesh=mesh, material=STEEL, origin=(0.012, HEIGHT), velocity=(-400, -20)))


def on_two() -> pc.Problem:
    """Give a block on two blocks: the slave is of two bodies."""
    mesh = pc.Mesh.rectangle(0.02, 0.025, nx=3, ny=5)
    lower = [pc.Body(name=name, mesh=mesh, material=ALUMINIUM, origin=(x, 0)) for name, x in (("left", 0), ("right", 0.02002))]
    hammer = pc.Mesh.rectangle(0.04, 0.025, nx=9, ny=5)
    return stated(lower, pc.Body(name="hammer", mesh=hammer, material=ALUMINIUM, origin=(1e-5, HEIGHT), velocity=(8, -20)))


CASES: dict[str, tuple[Callable[[], pc.Problem], float]] = {"sliding": (sliding, 16e-6), "entering": (entering, 8e-6), "on two": (on_two, 8e-6)}
Case = tuple[pc.Problem, pc.History]


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest) -> Case:
    make, end = CASES[request.param]
    problem = make()
    return problem, pc.simulate(problem, end=end, courant=0.9)


@pytest.fixture(scope="module")
def slid() -> Case:
    problem = sliding()
    return problem, pc.simulate(problem, end=16e-6, courant=0.9)


def upper(problem: pc.Problem) -> NDArray[np.bool_]:
    """Rows of the upper body, here the slave."""
    above: NDArray[np.bool_] = problem.mesh.points[problem.contact_nodes, 1] > 0.02502
    return above


def given(problem: pc.Problem, held: Parts) -> pc.History:
    names = ("time", "displacement", "reaction", "touching", "velocity", "acceleration", "contact_nodes")
    return pc.History.from_arrays(problem, **{name: held[name] for name in names if name in held})


def figures(estimate: pc.Estimate) -> dict[str, float]:
    return {name: value for name, value in (estimate.consistency or {}).items() if value is not None}


def stored(history: pc.History, held: Parts, path: Path) -> Path:
    """The file of another program."""
    pc.simulate(history.problem, steps=np.diff(history.time), store=path)
    with h5py.File(path, "r+") as file:
        file["percute"].attrs["program"] = "another program"
        del file["percute/contact"]
        file["percute/contact/nodes"] = held["contact_nodes"]
        for name in ("reaction", "touching"):
            if name in held:
                file[f"percute/contact/{name}"] = held[name].astype("u1" if name == "touching" else "f8")
    return path


def test_a_correct_history_gives_the_same_bits(case: Case, tmp_path: Path) -> None:
    problem, ours = case
    whole = parts(ours)
    expected = pc.estimate(ours)
    assert ours.touching[:, upper(problem)].any() and ours.touching[:, ~upper(problem)].any()
    without_status = {name: value for name, value in whole.items() if name != "touching"}
    histories = {
        "arrays": given(problem, whole),
        "touching derived": given(problem, without_status),
        "file": pc.open(stored(ours, whole, tmp_path / "theirs.vtkhdf")),
    }
    for name, theirs in histories.items():
        assert isinstance(theirs, pc.History)
        estimate = pc.estimate(theirs)
        assert theirs.derived == (("touching",) if name == "touching derived" else ()), name
        assert np.array_equal(theirs.touching, ours.touching), name
        assert estimate.by_element.tobytes() == expected.by_element.tobytes(), name
        found = figures(estimate)
        # Rounding of the second difference of the displacements; weighted gaps and sums have a few roundings.
        assert 0 < found["balance"] < 1e-11
        assert 0 < found["interface_balance"] < 1e-14 and found["gap_under_force"] < 1e-14 and found["penetration"] < 1e-14
        assert found["cone"] < 1e-14 and found.get("slip", 0.0) < 1e-14 and found["touching"] == found["plane"] == 0.0
    done = subprocess.run(
        [sys.executable, "-m", "percute", "estimate", str(tmp_path / "theirs.vtkhdf"), "--json"], capture_output=True, text=True, check=True
    )
    assert json.loads(done.stdout)["consistency"]["interface_balance"] == figures(estimate)["interface_balance"]


def test_single_precision_is_enough(case: Case) -> None:
    problem, ours = case
    single = {name: np.asarray(getattr(ours, name), dtype=np.float32) for name in ("displacement", "reaction")}
    theirs = pc.History.from_arrays(problem, ours.time, **single)
    estimate = pc.estimate(theirs)
    assert np.array_equal(theirs.touching, ours.touching)
    # Roundings of 6e-8 in sums of some hundred steps.
    assert figures(estimate)["interface_balance"] < 1e-6 and figures(estimate)["balance"] < 1e-3
    assert estimate.sup == pytest.approx(pc.estimate(ours).sup, rel=1e-3)


def test_the_last_forces_may_be_missing() -> None:
    """Contact goes on at the end: the last instant is left out, and the estimate is that of a run that is a step shorter."""
    problem = sliding()
    steps = [2e-7] * 40
    ours, longer = pc.simulate(problem, steps=steps), pc.simulate(problem, steps=[*steps, 2e-7])
    assert longer.reaction[-1].any()
    zero = np.concatenate([longer.reaction[:-1], np.zeros_like(longer.reaction[-1:])])
    for reaction in (longer.reaction[:-1], zero):
        with pytest.warns(pc.InputWarning, match=r"the last instant, 8.2e-6 s, is left out"):
            theirs = pc.History.from_arrays(problem, longer.time, longer.displacement, reaction)
        assert np.array_equal(theirs.touching, ours.touching)
        assert pc.estimate(theirs).by_element.tobytes() == pc.estimate(ours).by_element.tobytes()


def test_accelerations_and_velocities_are_read(slid: Case) -> None:
    problem, ours = slid
    theirs = given(problem, {**parts(ours), "velocity": ours.velocity, "acceleration": ours.acceleration})
    assert pc.estimate(theirs).sup == pytest.approx(pc.estimate(ours).sup, rel=1e-9)


def test_missing_forces_are_refused(slid: Case, tmp_path: Path) -> None:
    problem, ours = slid
    refused = r'`reaction` is missing: .*"hammer.bottom" and "anvil.top".*from 2\.[0-9e-]+ s on; give the force on each node of both \(N\)'
    with pytest.raises(pc.InputError, match=refused):
        pc.History.from_arrays(problem, ours.time, ours.displacement)
    path = stored(ours, {"contact_nodes": ours.contact_nodes}, tmp_path / "silent.vtkhdf")
    with pytest.raises(pc.PercuteError, match=refused):
        pc.estimate(pc.open(path))
    # As long as nothing touches, none are needed.
    flight = int(np.flatnonzero(ours.reaction.any(axis=(1, 2)))[0])
    theirs = pc.History.from_arrays(problem, ours.time[:flight], ours.displacement[:flight])
    assert theirs.derived == () and not theirs.reaction.any() and len(theirs) == flight


def test_samples_are_refused(slid: Case) -> None:
    problem, ours = slid
    held = {name: np.asarray(getattr(ours, name))[::3] for name in ("time", "displacement", "reaction", "velocity", "acceleration")}
    for lacks in ((), ("velocity", "acceleration")):
        with pytest.raises(pc.InputError, match="give all steps, at most .* contact forces of non-matching interfaces are not derived between samples"):
            pc.estimate(given(problem, {name: value for name, value in held.items() if name not in lacks}))


def of_side(above: bool, change: Callable[[NDArray[Any]], Any]) -> Callable[[Parts], Parts]:
    """Change the forces on one side of the interface of ``sliding``."""

    def changed_side(held: Parts) -> Parts:
        reaction = held["reaction"].copy()
        rows = upper(sliding()) == above
        reaction[:, rows] = change(reaction[:, rows])
        return {**held, "reaction": reaction}

    return changed_side


def listed(above: bool) -> Callable[[Parts], Parts]:
    """Give the rows of one surface alone."""

    def of_one(held: Parts) -> Parts:
        rows = np.flatnonzero(upper(sliding()) == above)
        return {**held, **{name: held[name][:, rows] for name in ("reaction", "touching")}, "contact_nodes": held["contact_nodes"][rows]}

    return of_one


def exchanged(reaction: NDArray[Any]) -> NDArray[Any]:
    above = upper(sliding())
    order = np.concatenate([np.flatnonzero(above), np.flatnonzero(~above)])
    assert not np.array_equal(order, np.arange(len(order)))
    return reaction[:, order]


SPOILT: dict[str, tuple[Callable[[Parts], Parts], str]] = {
    "late": (changed("reaction", lambda r: shifted(r, 1)), "the contact forces are a step too late"),
    "early": (changed("reaction", lambda r: shifted(r, -1)), "the contact forces are a step too early"),
    "sign": (changed("reaction", lambda r: -r), "the sign of the contact forces is wrong"),
    "factor 2": (changed("reaction", lambda r: 2 * r), "the contact forces should be 0.5 times as large"),
    "factor 1000": (changed("reaction", lambda r: 1000 * r), r"the contact forces should be 0.001 times as large \(given in mN\?\)"),
    "touching nowhere": (changed("touching", np.zeros_like), "`touching` and the contact forces disagree"),
    "touching late": (changed("touching", lambda t: shifted(t, 1)), "`touching` is a step late"),
    "touching early": (changed("touching", lambda t: shifted(t, -1)), "`touching` is a step early"),
    "exchanged": (changed("reaction", exchanged), "the rows of the contact forces are in another order than `contact_nodes`"),
    "order": (changed("reaction", lambda r: r[:, ::-1]), "the rows of the contact forces are in descending order of the nodes"),
    "no master": (of_side(False, np.zeros_like), 'the contact forces on "anvil.top" are missing: give the force on each node of both surfaces'),
    "no slave": (of_side(True, np.zeros_like), 'the contact forces on "hammer.bottom" are missing: give the force on each node of both'),
    "slave alone": (listed(True), 'the contact forces on "anvil.top" are missing'),
    "master alone": (listed(False), 'the contact forces on "hammer.bottom" are missing'),
    "one sign": (of_side(False, lambda r: -r), 'the contact forces on "anvil.top" have the wrong sign: give the force on each node'),
    "one factor": (of_side(False, lambda r: 2 * r), 'the contact forces on "anvil.top" should be 0.5 times as large'),
    "steps": (changed("time", lambda t: 1.05 * t), "`time` is not that of the history: the steps should be 0.9524 times"),
}


def refusal(problem: pc.Problem, held: Parts) -> str:
    with warnings.catch_warnings():
        # A step early, the last forces are those of the first step: none.
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        history = given(problem, held)
    with pytest.raises(pc.InputError, match="not consistent") as refused:
        pc.estimate(history)
    # Whatever it is, it can be graded as it is.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert pc.estimate(history, force=True).trust == "low"
    return str(refused.value)


@pytest.mark.parametrize("name", SPOILT)
def test_spoilt_histories_are_named(name: str, slid: Case) -> None:
    spoil, cause = SPOILT[name]
    said = refusal(slid[0], spoil(parts(slid[1])))
    assert re.search(f"Likely cause: .*{cause}", said), said


def test_a_spoilt_file_is_named(slid: Case, tmp_path: Path) -> None:
    spoil, cause = SPOILT["no master"]
    path = stored(slid[1], spoil(parts(slid[1])), tmp_path / "spoilt.vtkhdf")
    done = subprocess.run([sys.executable, "-m", "percute", "estimate", str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and re.search(cause, " ".join(done.stderr.split())), done.stderr


@pytest.mark.parametrize(
    ("problem", "cause"),
    [
        (sliding(density=1.2), r"`density` is not that of the history: it should be 0.83"),
        (sliding(friction=0.1), r"`friction` or a normal is not that of the history: where nodes slide on .* is 0.2 on average, not 0.1"),
        (sliding(friction=0.3), "`friction` is not that of the history: where nodes slide on .* is 0.2 on average, not 0.3"),
        (sliding(lift=1e-5), r'the place \(`origin` of its body\) of the surface that faces "hammer.bottom" is off by 1e-5 m'),
    ],
    ids=["density", "less friction", "more friction", "place"],
)
def test_another_problem_is_named(problem: pc.Problem, cause: str, slid: Case) -> None:
    said = refusal(problem, parts(slid[1]))
    assert re.search(f"Likely cause: {cause}", said), said


def test_forces_that_are_not_opposite_are_refused(slid: Case) -> None:
    """Each body balances its forces, but those of the two are of different runs: no balance tells."""
    problem, ours = slid
    smooth = pc.simulate(sliding(friction=0.0), steps=np.diff(ours.time))
    below = problem.mesh.points[:, 1] < 0.02502
    displacement = np.where(below[:, None], ours.displacement, smooth.displacement)
    mixed = np.where(upper(problem)[:, None], smooth.reaction, ours.reaction)
    history = pc.History.from_arrays(problem, ours.time, displacement, mixed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = figures(pc.estimate(history, force=True))
    assert found["balance"] < 1e-11 and found["interface_balance"] > 0.01
    with pytest.raises(pc.InputError, match='the contact forces on "hammer.bottom" and on "anvil.top" are not opposite: give the force on each node of both'):
        pc.estimate(history)


def test_a_force_of_rounding_is_no_disagreement() -> None:
    """At 0.4 m/s with steps of 0.02 of the critical one, forces of some N move their nodes by less than 1e-12 of the bodies."""
    lower = pc.Body(name="lower", mesh=pc.Mesh.rectangle(0.04, 0.025, nx=7, ny=5), material=ALUMINIUM)
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=9, ny=5)
    upper_body = pc.Body(name="upper", mesh=mesh, material=ALUMINIUM, origin=(0.012, 0.0250002), velocity=(-0.4, -0.4))
    problem = stated([lower], upper_body, friction=0.5)
    ours = pc.simulate(problem, end=11e-6, courant=0.02)
    theirs = pc.History.from_arrays(problem, ours.time, ours.displacement, ours.reaction)
    assert 1 <= (theirs.touching != ours.touching).sum() <= 3
    assert figures(pc.estimate(theirs, every=100))["touching"] == 0.0
