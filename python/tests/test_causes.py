"""Causes of inconsistent histories: units, order, instants, forces, velocities and accelerations."""

import re
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import percute as pc
import pytest
from conftest import bar, block, tilted
from numpy.typing import NDArray
from spoiling import FALLS, Change, Parts, cause, changed, given, parts, shifted, times, without

pytestmark = pytest.mark.filterwarnings("ignore:the body turns by:percute.SimulationWarning")


UNITS: dict[str, tuple[Change, str]] = {
    "u in mm": (times("displacement", 1e3), r"the displacements should be 0.001 times as large \(given in mm\?\)"),
    "u in µm": (times("displacement", 1e6), r"the displacements should be 1e-6 times as large \(given in µm\?\)"),
    "t in ms": (times("time", 1e3), r"`time` is not.*: the steps should be 0.001 times as long \(given in ms\?\)"),
    "t in µs": (times("time", 1e6), r"`time` is not.*: the steps should be 1e-6 times as long \(given in µs\?\)"),
    "E in MPa": (times("young", 1e-6), r"`young` .*should be 1e6 times as large \(given in MPa\?\)"),
    "E in GPa": (times("young", 1e-9), r"`young` .*should be 1e9 times as large \(given in GPa\?\)"),
    "density in g/cm³": (times("density", 1e-3), r"`density` .*should be 1000 times as large \(given in g/cm³\?\)"),
    "density in kg/mm³": (times("density", 1e-9), r"`density` .*should be 1e9 times as large \(given in kg/mm³\?\)"),
}


@pytest.mark.parametrize("lacks", [(), ("touching",), ("reaction", "touching")])
@pytest.mark.parametrize("name", UNITS)
def test_units_are_named(name: str, lacks: tuple[str, ...], correct: pc.History) -> None:
    change, text = UNITS[name]
    said = cause(correct.problem, without(change(parts(correct)), *lacks))
    assert re.search(text, said), said


Mistake = Callable[[pc.History, Parts], Parts]


def tangential(factor: float) -> Mistake:
    """Contact forces whose tangential parts have a factor; the normal is (0, 1)."""
    return lambda _, parts: {**parts, "reaction": parts["reaction"] * (factor, 1.0)}


def rows(order: Callable[[NDArray[Any]], NDArray[Any]]) -> Mistake:
    """Rows of contact forces in another order than the nodes that are given."""

    def mistake(_: pc.History, parts: Parts) -> Parts:
        of = order(parts["contact_nodes"])
        return {**without(parts, "touching"), "reaction": parts["reaction"][:, of]}

    return mistake


def velocities(of: Callable[[pc.History], NDArray[Any]]) -> Mistake:
    return lambda history, parts: {**parts, "velocity": of(history)}


def half_a_step(history: pc.History) -> NDArray[Any]:
    return history.velocity - 0.5 * np.diff(history.time).mean() * history.acceleration


def instant(keep: Callable[[NDArray[Any]], NDArray[Any]]) -> Mistake:
    """Rows of other instants, under the same times."""

    def mistake(_: pc.History, parts: Parts) -> Parts:
        arrays = {name: keep(parts[name]) for name in ("displacement", "reaction")}
        return {**without(parts, "touching"), **arrays, "time": parts["time"][: len(arrays["displacement"])]}

    return mistake


Told = str | tuple[str, str]
"""What is told; with two texts, the second one without contact forces."""
PLANE: dict[str, tuple[Mistake, Told]] = {
    "pressure only": (tangential(0.0), f"the contact forces have no tangential parts: .*{FALLS}"),
    "friction the other way": (tangential(-1.0), f"the tangential contact forces have the wrong sign: .*{FALLS}"),
    "pressure the other way": (
        lambda _, parts: {**parts, "reaction": parts["reaction"] * (1.0, -1.0)},
        f"the normal contact forces have the wrong sign: they push the body off .*{FALLS} less than",
    ),
    "normal part first": (
        lambda _, parts: {**parts, "reaction": parts["reaction"][..., ::-1]},
        f"the components of the contact forces are exchanged: .*{FALLS} less than",
    ),
    "half of the friction": (tangential(0.5), f"the tangential contact forces should be 2 times as large; .*{FALLS}"),
    "rows shuffled": (
        rows(lambda nodes: np.random.default_rng(2).permutation(len(nodes))),
        f"the rows .* in another order than `contact_nodes`: that of node [0-9]+ holds the force of node .*{FALLS}",
    ),
    "x and y": (lambda _, parts: {**parts, "displacement": parts["displacement"][..., ::-1]}, "the components .* are exchanged"),
    "nodes from 1": (lambda _, parts: {**parts, "displacement": np.roll(parts["displacement"], 1, axis=1)}, "those of the nodes before"),
    "all in mm": (lambda _, parts: {**parts, "lengths": 1e3}, r"Likely cause: all lengths .* should be 0.001 times as large \(given in mm\?\)"),
    "MPa and t/mm³": (
        lambda _, parts: {**parts, "young": 1e-6, "density": 1e-12},
        (
            f"`young` should be 1e6 times as large .given in MPa.*`density` should be 1e12 times as large .given in t/mm³.*{FALLS}",
            r"the density should be 1e6 times .*`young` given in MPa and `density` in t/mm³",
        ),
    ),
    "Poisson's ratio": (lambda _, parts: {**parts, "poisson": 0.35}, f"`poisson` is 0.3 in the history, not 0.35; .*{FALLS}"),
    "plane strain": (lambda _, parts: {**parts, "hypothesis": "strain"}, f'`plane` is "stress" in the history; .*{FALLS}'),
    "per metre": (lambda _, parts: {**parts, "thickness": 0.01}, "should be 0.01 times as large .given per metre of thickness"),
}

@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
@pytest.mark.parametrize("speed", [(1.0, 1.02), (1.0, 1.015), (1.02, 1.02), (-1.0, 1.0), (-1.0, -1.0), (1.0, 0.0)])
def test_another_initial_velocity_is_named(speed: tuple[float, float], lacks: tuple[str, ...], correct: pc.History) -> None:
    """Its factor is told if it has one."""
    if correct.problem.mesh.dimension == 1:
        speed = (speed[0],)  # type: ignore[assignment]
    if speed == (1.0,):
        pytest.skip("the velocity of the history")
    said = cause(correct.problem, without({**parts(correct), "speed": np.array(speed)}, *lacks))
    assert "Likely cause: `initial_velocity` is not that of the history, which starts with" in said, said
    # That of the history, to the four digits that are told: nodes whose contact force is not known do not count.
    starts = [float(v) for v in re.findall("starts with [(]?([^)]*?)[)]? m/s", said)[0].split(",")]
    assert starts == pytest.approx(np.atleast_1d(correct.problem.initial_velocity[0]), rel=1e-3), said
    factor = 1 / speed[0] if len(set(speed)) == 1 else None
    assert re.findall("([-0-9.]+) times the stated one", said) == ([] if factor is None else [f"{factor:.4g}"]), said


def test_forces_in_the_axes_of_a_plane_are_named() -> None:
    sin, cos = np.sin(0.3), np.cos(0.3)
    turn, flat = np.array([[cos, -sin], [sin, cos]]), block()
    mesh = pc.Mesh(flat.mesh.points @ turn.T, flat.mesh.cells)
    plane = pc.Plane(point=turn @ flat.obstacles[0].point, normal=turn @ (0.0, 1.0), friction=0.2)
    problem = pc.Problem(mesh, material=flat.material, obstacles=[plane], initial_velocity=turn @ (400.0, -400.0))
    whole = parts(pc.simulate(problem, end=13e-6, courant=0.8))
    local = whole["reaction"] @ turn
    for order, where in (((1, 0), "first"), ((0, 1), "last")):
        said = cause(problem, {**whole, "reaction": local[..., order]})
        assert re.search(f"in the axes of the plane, the normal part {where}: .*{FALLS} less than", said), said


@pytest.mark.parametrize("kind", [bar, block, tilted])
def test_a_mesh_in_another_unit_is_named_before_its_density(kind: Callable[[], pc.Problem]) -> None:
    correct = pc.simulate(kind(), end=20e-6, courant=0.8)
    said = cause(correct.problem, {**parts(correct), "mesh": 1e3})
    assert re.search(rf"Likely cause: the mesh should be 0.001 times as large \(given in mm\?\).*{FALLS}", said), said


@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
def test_the_terms_of_the_balance_are_told_if_no_cause_is(lacks: tuple[str, ...], correct: pc.History) -> None:
    """Of displacements that do not fit anywhere, and at few nodes."""
    whole, random = without(parts(correct), *lacks), np.random.default_rng(1)
    nodes = whole["displacement"].shape[1]
    noise = np.zeros_like(whole["displacement"])
    noise[1:, 9] = 1e-5 * random.standard_normal(noise[1:, 9].shape)
    spoilt = (
        (whole["displacement"][:, random.permutation(nodes)], "the displacements do not fit the mesh"),
        (whole["displacement"] + noise, "nodes have .* of its square .*: their rows, supports, loads or materials differ"),
    )
    for displacement, hint in spoilt:
        said = cause(correct.problem, {**whole, "displacement": displacement})
        terms = "along [xy], M a = .* N, K u = .* N, F = .* N, R = .* N; 99 % of its square are at [0-9]+ of [0-9]+ nodes"
        assert re.search(f"{terms} .*Likely cause: .*{hint}", said), said


SIGN = "the sign of the displacements is wrong"
ANY: dict[str, tuple[Mistake, Told]] = {
    # The balance inside the body holds with either sign.
    "u reversed": (lambda _, parts: {**parts, "displacement": -parts["displacement"]}, (f"{SIGN}; .*{FALLS}", f"{SIGN}; to estimate")),
    "places": (
        lambda history, parts: {**parts, "displacement": parts["displacement"] + history.problem.mesh.points},
        f"the displacements are places: subtract those of the nodes, .*{FALLS}",
    ),
    "velocities half a step early": (velocities(half_a_step), r"the middle of the step before it, v_\{n-1/2\}"),
    "velocities a step early": (
        velocities(lambda history: np.concatenate([history.velocity[1:], history.velocity[-1:]])),
        "the velocities are not those of t_n: they are a step too early",
    ),
    "velocities a step late": (
        velocities(lambda history: np.concatenate([history.velocity[:1], history.velocity[:-1]])),
        "the velocities are not those of t_n: they are a step too late",
    ),
    "an instant lost": (
        instant(lambda array: np.delete(array, 20, axis=0)),
        rf"an instant is missing between instant 19 .* and instant 20 .*: the body moves 2 times as far .*{FALLS}",
    ),
    "an instant doubled": (
        instant(lambda array: np.insert(array, 20, array[20], axis=0)[:-1]),
        f"instant 21 .* repeats the one before it.*{FALLS}",
    ),
}


@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
@pytest.mark.parametrize("name", [*ANY, *PLANE])
def test_mistakes_are_named(name: str, lacks: tuple[str, ...], correct: pc.History) -> None:
    mistake, text = {**ANY, **PLANE}[name]
    if name in PLANE and correct.problem.mesh.dimension == 1:
        pytest.skip("of plane bodies")
    spoilt = mistake(correct, parts(correct))
    if lacks and name in PLANE and np.any(spoilt["reaction"] != correct.reaction):
        pytest.skip("of the contact forces alone")
    if lacks and spoilt["thickness"] != 1.0:
        pytest.skip("without contact forces, the thickness has no effect")
    said = cause(correct.problem, without(spoilt, *lacks))
    assert re.search(text if isinstance(text, str) else text[bool(lacks)], said), said


def test_known_orders_of_rows_are_named(correct: pc.History) -> None:
    nodes, whole = correct.contact_nodes, parts(correct)
    ascending, opposite = np.argsort(nodes), np.arange(len(nodes))[::-1]
    told = {"ascending order of the nodes": ascending, "descending order of the nodes": ascending[::-1], "the opposite order": opposite}
    # Of two names of an order, the first is told.
    others = {tuple(of): name for name, of in reversed(told.items()) if np.any(of != np.arange(len(nodes)))}
    for of, name in others.items():
        said = cause(correct.problem, rows(lambda _, of=of: np.array(of))(correct, whole))  # type: ignore[misc]
        assert re.search(f"Likely cause: the rows of the contact forces are in {name}, not in that .*{FALLS}", said), said
    assert len(others) == (0 if len(nodes) == 1 else 1 if np.all(np.diff(nodes) > 0) else 3)


@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
@pytest.mark.parametrize("lost", [(20,), (11, 20)])
def test_lost_instants_are_named_by_the_times(lost: tuple[int, ...], lacks: tuple[str, ...], correct: pc.History) -> None:
    """However small the residual is; that of all others is rounding."""
    whole = without(parts(correct), "touching")
    arrays = {name: np.delete(whole[name], lost, axis=0) for name in ("time", "displacement", "reaction")}
    said = cause(correct.problem, without({**whole, **arrays}, *lacks))
    if len(lost) == 1:
        assert re.search(r"an instant is missing between instant 19 .* and instant 20 .*: that step is 2 times as long .*falls from", said), said
    else:
        assert re.search("instants are missing after instants 10, 18: these steps are 2 times as long .*falls from", said), said


@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
@pytest.mark.parametrize("kind", ["float64", "float32"])
def test_longer_steps_are_not_lost_instants(kind: str, lacks: tuple[str, ...], correct: pc.History) -> None:
    steps = np.where(np.arange(60) % 9 == 4, 2.0, 1.0) * 0.4 * correct.problem.critical_time_step
    whole = without(parts(pc.simulate(correct.problem, steps=steps)), "touching")
    arrays = {name: whole[name].astype(kind) for name in ("time", "displacement", "reaction")}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        found = pc.estimate(given(correct.problem, without({**whole, **arrays}, *lacks))).consistency or {}
    assert found["long_step"] == 0.0 and 0.0 < found["balance"] < (1e-11 if kind == "float64" else 1e-2)


@pytest.mark.parametrize("lacks", [(), ("reaction", "touching")])
@pytest.mark.parametrize(("every", "motion"), [(2, ()), (2, ("velocity",)), (4, ())])
def test_samples_within_a_critical_step_are_named(every: int, motion: tuple[str, ...], lacks: tuple[str, ...], correct: pc.History) -> None:
    history = pc.simulate(correct.problem, end=20e-6, courant=0.9 / every)
    names = ["time", "displacement", "reaction", *motion]
    whole = {**without(parts(correct), "touching"), **{name: getattr(history, name)[::every] for name in names}}
    said = cause(correct.problem, without(whole, *lacks))
    missing = "accelerations" if motion else "velocities and accelerations"
    assert re.search(f"Likely cause: the instants are samples, .* give all steps, or give {missing} too; .*{FALLS}", said), said


def test_velocities_within_the_limit_are_graded(correct: pc.History) -> None:
    whole = parts(correct)
    estimate = pc.estimate(given(correct.problem, {**whole, "velocity": 1.009 * correct.velocity}))
    # The first step alone starts with another velocity.
    assert estimate.sup == pytest.approx(pc.estimate(correct).sup, rel=0.05)
    assert (estimate.consistency or {})["initial_velocity"] == pytest.approx(0.009 / 1.009, rel=1e-6)
    said = cause(correct.problem, {**whole, "velocity": 1.02 * correct.velocity})
    assert "the velocities are not those of the displacements" in said, said
    moved = (correct.time >= 0)[:, None, None] * (5e-7 * np.ptp(correct.problem.mesh.points))
    shifted_start = given(correct.problem, without({**whole, "displacement": whole["displacement"] + moved}, "touching"))
    assert (pc.estimate(shifted_start, force=True).consistency or {})["initial_displacement"] > 1e-7


def test_a_wrong_value_and_lost_digits_are_named(correct: pc.History) -> None:
    whole = parts(correct)
    node = int(np.argmax(correct.problem.mesh.points.sum(axis=1)))
    spoilt = whole["displacement"].copy()
    spoilt[12, node] *= 1.05
    said = cause(correct.problem, without({**whole, "displacement": spoilt}, "touching"))
    assert re.search("a value of node [0-9]+, or of a node beside it, is wrong at about", said), said
    rounded = np.array([float(f"{x:.2e}") for x in whole["displacement"].ravel()]).reshape(whole["displacement"].shape)
    said = cause(correct.problem, without({**whole, "displacement": rounded}, "touching"))
    assert "the displacements are rounded to about 3 digits" in said and "write them with 9 digits or more" in said, said
    noise = 3e-4 * np.abs(whole["displacement"]).max() * np.random.default_rng(1).standard_normal(rounded.shape)
    noise[0], noise[:, correct.contact_nodes] = 0.0, 0.0
    said = cause(correct.problem, without({**whole, "displacement": whole["displacement"] + noise}, "touching"))
    assert re.search("along [xy], M a = .* N, K u = .* N, F = 0 N, R = .* N; 99 % of its square are at .* instants", said), said


def test_the_numbers_of_messages_are_short(correct: pc.History) -> None:
    whole = parts(correct)
    assert "has 0 m/s" in (said := cause(correct.problem, {**whole, "speed": 0.0})) or "has (0, 0) m/s" in said, said
    with pytest.raises(pc.InputError, match=r"the instants go down from 2(\.0+\d)?e-5 s to 0 s"):
        pc.History.from_arrays(correct.problem, correct.time[::-1].copy(), correct.displacement)
    with pytest.raises(pc.InputError, match="a single instant is given; at least 2 make a step"):
        pc.History.from_arrays(correct.problem, correct.time[:1], correct.displacement[:1])


def test_a_density_that_is_a_little_off_is_no_time_step(correct: pc.History) -> None:
    whole = parts(correct)
    # Contact forces at one node are the largest terms of the disc.
    for factor in (0.94, 1.06) if "boundary" in correct.problem.mesh.edge_groups else (0.97, 1.02, 1.03):
        said = cause(correct.problem, times("density", factor)(whole))
        assert "`density` is not that of the history" in said and "`time`" not in said, said
        said = cause(correct.problem, times("time", factor)(whole))
        assert "`time` is not that of the history" in said and "`density`" not in said, said
    # Both: the velocity at the start fits neither.
    both = times("time", 1.05)(times("density", 1.2)(whole))
    assert "`density` or `time` is not that of the history" in cause(correct.problem, both)


def test_wrong_accelerations_are_named(correct: pc.History) -> None:
    whole = parts(correct)
    for factor in (0.9, 1e3):
        for motion in ({}, {"velocity": correct.velocity}):
            said = cause(correct.problem, {**whole, **motion, "acceleration": factor * correct.acceleration})
            assert "the accelerations are not those of the displacements" in said, said


@pytest.mark.parametrize("end", [13e-6, 60e-6])
def test_a_shifted_status_is_named_however_long_the_contact(end: float) -> None:
    history = pc.simulate(bar(), end=end, courant=0.2)
    for steps, word in ((1, "late"), (-1, "early")):
        spoilt = changed("touching", lambda rows, steps=steps: shifted(rows, steps))(parts(history))
        said = cause(history.problem, spoilt)
        assert f"`touching` is a step {word}" in said, said


def test_a_small_residual_of_the_balance_limits_the_trust(correct: pc.History) -> None:
    """A modulus that is 0.3 % too large."""
    estimate = pc.estimate(given(correct.problem, times("young", 1.003)(parts(correct))))
    balance = (estimate.consistency or {})["balance"]
    assert estimate.verdict is not None
    assert (estimate.trust != "high" and "a force balance off by" in estimate.verdict) == (balance > 5e-4), estimate.verdict
    assert "a force balance off by" not in str(pc.estimate(given(correct.problem, parts(correct))).verdict)


def test_two_instants_have_no_forces_of_another_step() -> None:
    """In their step nothing has moved against the balance: no other step of forces fits better."""
    problem = block()
    history = pc.simulate(problem, end=13e-6, courant=0.9)
    first = pc.History.from_arrays(problem, history.time[:2], history.displacement[:2], history.reaction[:2])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        estimate = pc.estimate(first)
    assert "of another step" not in " ".join([estimate.verdict, *estimate.warnings])
