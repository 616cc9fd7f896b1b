"""Histories of other programs in other units, from another origin, far apart, or with a penalty that is too stiff."""

import re
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import percute as pc
import pytest
from conftest import bar, block, disc, tilted
from studies.penalties import Springs, matrices
from spoiling import FALLS
from test_penalty import penalty

NAMES = ("displacement", "reaction", "velocity", "acceleration")
Arrays = dict[str, Any]


def arrays(history: pc.History, every: int = 1) -> Arrays:
    """Each so manyth instant."""
    return {"time": history.time[::every].copy(), **{name: np.array(getattr(history, name)[::every]) for name in NAMES}}


def cause(problem: pc.Problem, given: Arrays) -> str:
    """The message of the refusal."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        with pytest.raises(pc.InputError) as refused:
            pc.estimate(pc.History.from_arrays(problem, **given))
    return str(refused.value)


FACTORS: dict[str, tuple[str, float, str]] = {
    "times in µs": ("time", 1e6, r"`time` is not.*the steps should be 1e-6 times as long \(given in µs\?\)"),
    "times in ms": ("time", 1e3, r"`time` is not.*the steps should be 0.001 times as long \(given in ms\?\)"),
    "velocities in mm/s": ("velocity", 1e3, r"the velocities should be 0.001 times as large \(given in mm/s\?\)"),
    "displacements in mm": ("displacement", 1e3, r"the displacements should be 0.001 times as large \(given in mm\?\)"),
    **{f"times by {factor}": ("time", factor, "`time` is not.*the steps should be ") for factor in (0.8, 0.9, 1.1)},
    **{f"velocities by {factor}": ("velocity", factor, "the velocities should be ") for factor in (0.8, 0.9, 1.1)},
}


@pytest.mark.parametrize("every", [1, 2, 4])
@pytest.mark.parametrize("name", FACTORS)
def test_displacements_and_velocities_have_one_time(name: str, every: int, correct: pc.History) -> None:
    """Of all steps, and of samples up to 3.2 critical steps apart."""
    array, factor, text = FACTORS[name]
    whole = arrays(correct, every)
    said = cause(correct.problem, {**whole, array: factor * whole[array]})
    told = re.search(f"the displacements since t_0 are .* times the integral of the velocities.*Likely cause: .*{text}([0-9.]*)", said)
    assert told, said
    # Measured: less than 3 % off from samples.
    assert 0.5 < factor < 2 or not told[1], said
    assert not 0.5 < factor < 2 or float(told[1]) == pytest.approx(1 / factor, rel=0.05), said


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("courant", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("kind", [bar, block, tilted, disc])
def test_thinned_histories_pass(kind: Callable[[], pc.Problem], courant: float) -> None:
    """Whatever else is told of samples up to 45 critical steps apart, some three instants in all, their velocities fit."""
    history = pc.simulate(kind(), end=40e-6, courant=courant)
    passed = 0
    for distance in (1, 5, 10, 20, 45):
        every = max(1, round(distance / courant))
        if (len(history.time) - 1) // every < 1:
            continue
        estimate = pc.estimate(pc.History.from_arrays(history.problem, **arrays(history, every)), every=50, force=True)
        assert "integral of the velocities" not in estimate.verdict, (distance, estimate.verdict)
        passed += 1
    assert passed > 3


def test_samples_too_far_apart_are_refused_before_the_work(correct: pc.History) -> None:
    every = len(correct.time) - 1
    whole = arrays(correct, every)
    # A rigid flight of the same two instants, much farther apart: its velocities fit, in so far that nothing tells.
    whole["time"] = whole["time"] * 100
    whole["velocity"][:] = correct.problem.initial_velocity
    whole["acceleration"][:] = 0.0
    whole["reaction"][:] = 0.0
    whole["displacement"] = whole["time"][:, None, None] * whole["velocity"]
    with pytest.raises(pc.InputError, match="critical steps apart .limit 50.*store each n-th step, at most 5 critical") as refused:
        pc.estimate(pc.History.from_arrays(correct.problem, **whole), force=True)
    apart = whole["time"][1] / correct.problem.critical_time_step
    told = re.search(r"up to ([0-9.e]+) critical", str(refused.value))
    assert told and float(told[1]) == pytest.approx(apart, rel=1e-2)
    assert "force" not in str(refused.value)


SYSTEMS = {
    "mm-ms-kN-kg (GPa)": (1e-3, 1e-3, 1e3),
    "mm-ms-N-g (MPa)": (1e-3, 1e-3, 1.0),
    "mm-s-N-t (MPa)": (1e-3, 1.0, 1.0),
    "cm-µs-g (Mbar)": (1e-2, 1e-6, 1e7),
    "in-s-lbf (psi)": (0.0254, 1.0, 4.4482216152605),
}


def scaled(whole: Arrays, length: float, time: float, force: float) -> Arrays:
    units = {"time": time, "displacement": length, "reaction": force, "velocity": length / time, "acceleration": length / time**2}
    return {name: array / units[name] for name, array in whole.items()}


@pytest.mark.parametrize("given", [("reaction",), (), NAMES[1:], NAMES[2:]])
@pytest.mark.parametrize("name", SYSTEMS)
def test_systems_of_units_are_named_as_a_whole(name: str, given: tuple[str, ...], correct: pc.History) -> None:
    """Also with all arrays, where times in ms make steps of 800 critical ones."""
    whole = scaled(arrays(correct), *SYSTEMS[name])
    said = cause(correct.problem, {key: whole[key] for key in ("time", "displacement", *given)})
    length, time, _ = SYSTEMS[name]
    if time == 1.0 and not given:
        # One array alone.
        assert f"the displacements should be {length:.4g} times" in said, said
        return
    if "reaction" not in given and time == 1e-3:
        name = "mm-ms-kN-kg (GPa) or mm-ms-N-g (MPa)"
    if (name.startswith("mm-s-N-t") and given == ("reaction",)) or (time == 1.0 and "reaction" not in given and not given):
        assert "the displacements should be 0.001 times" in said, said
        return
    if time == 1.0 and "reaction" not in given:
        assert re.search(f"the arrays are in the system of units .*{re.escape(name)}", said), said
        return
    assert f"Likely cause: the arrays are in the system of units {name}, the problem in SI units: multiply displacements by {length:.6g}" in said, said
    assert re.search(FALLS, said), said


@pytest.mark.parametrize("lacks", [(), ("velocity", "acceleration"), NAMES[1:]])
def test_a_problem_in_another_system_is_named(lacks: tuple[str, ...]) -> None:
    """Problem in mm, ms, g and N beside arrays in SI units: a thickness of 1 mm beside one of 1e-3 m."""
    stated = block()
    thin = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress", thickness=1e-3)
    problem = pc.Problem(stated.mesh, material=thin, obstacles=stated.obstacles, initial_velocity=(400.0, -400.0))
    history = pc.simulate(problem, end=20e-6, courant=0.8)
    (plane,) = stated.obstacles
    other = pc.Problem(
        pc.Mesh(1e3 * stated.mesh.points, stated.mesh.cells),
        material=pc.Elastic(young=70e3, poisson=0.3, density=2.7e-3, plane="stress", thickness=1.0),
        obstacles=[pc.Plane(point=1e3 * np.asarray(plane.point), normal=(0, 1), friction=0.2)],
        initial_velocity=(400.0, -400.0),
    )
    said = cause(other, {name: array for name, array in arrays(history).items() if name not in lacks})
    assert re.search("the problem is in the system of units .*mm-ms-N-g .MPa., the arrays in SI units: give the problem in SI", said), said


def test_a_rigid_offset_is_named(correct: pc.History) -> None:
    whole = {name: array for name, array in arrays(correct).items() if name in ("time", "displacement", "reaction")}
    dimension = correct.problem.mesh.dimension
    for offset, axes in ((np.array([1e-3, 0.0]), "x"), (np.array([0.0, -2e-3]), "y"), (np.array([1e-3, 2e-3]), "x and y")):
        if dimension == 1 and axes != "x":
            continue
        shown = "0.001" if dimension == 1 else "({:.6g}, {:.6g})".format(*offset)
        said = cause(correct.problem, {**whole, "displacement": whole["displacement"] + offset[:dimension]})
        assert f"Likely cause: all displacements have the same offset of {shown} m, along {axes}: subtract it" in said, said
        assert "start is missing" not in said and "force" not in said, said
    # The first instants of a flight are missing: the way at the initial velocity.
    late = {name: array[3:] - (array[3] if name == "time" else 0.0) for name, array in whole.items()}
    flight = correct.problem.initial_velocity[0] * correct.time[3]
    if np.allclose(late["displacement"][0], flight):
        said = cause(correct.problem, late)
        told = re.search("the start is missing: it is the way of ([0-9.e-]+) s at the initial velocity", said)
        assert told and float(told[1]) == pytest.approx(correct.time[3], rel=1e-3), said


def unstable(stiffness: float, courant: float) -> tuple[pc.Problem, Arrays]:
    """Springs (Pa/m) with steps that are those of the body alone."""
    problem, _ = penalty(1e13, sideways=0.0)
    (matrix, mass), springs = matrices(problem), Springs(problem, stiffness)
    inverse, dt = np.linalg.inv(mass), courant * problem.critical_time_step
    u, v = np.zeros_like(problem.mesh.points), np.array(problem.initial_velocity)
    displacement, reaction = [], []
    for n in range(int(13e-6 / dt) + 1):
        displacement.append(u)
        reaction.append(springs.forces(u))
        v = v + (dt / 2 if n == 0 else dt) * inverse @ (reaction[-1] - (matrix @ u.ravel()).reshape(-1, 2))
        u = u + dt * v
    return problem, {"time": dt * np.arange(len(displacement)), "displacement": np.array(displacement), "reaction": np.array(reaction)}


@pytest.mark.parametrize("lacks", [(), ("reaction",)])
@pytest.mark.parametrize(("stiffness", "courant"), [(5e13, 0.8), (1e14, 0.8), (1e15, 0.8), (1e17, 0.8), (1e15, 0.2), (3e15, 0.2)])
def test_a_penalty_that_is_too_stiff_is_named(stiffness: float, courant: float, lacks: tuple[str, ...]) -> None:
    problem, whole = unstable(stiffness, courant)
    said = cause(problem, {name: array for name, array in whole.items() if name not in lacks})
    told = re.search(
        r"Likely cause: the penalty is too stiff .*the force on node ([0-9]+) is ([0-9.e]+) N/m times its penetration; with its mass of "
        r"([0-9.e-]+) kg, steps above ([0-9.e-]+) s are unstable, and they are ([0-9.e-]+) s",
        said,
    )
    assert told, said
    springs = Springs(problem, stiffness)
    own = springs.stiffness[list(springs.nodes).index(int(told[1]))]
    assert float(told[2]) == pytest.approx(own, rel=1e-2)
    assert float(told[5]) == pytest.approx(whole["time"][1], rel=1e-2) and float(told[4]) < float(told[5])
    # Stiffness of the body makes the limit smaller than that of mass and spring alone, in three digits.
    assert float(told[4]) < 2.02 * np.sqrt(float(told[3]) / own)


def test_a_stable_penalty_is_not_named() -> None:
    problem, whole = unstable(1e14, 0.2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert pc.estimate(pc.History.from_arrays(problem, **whole)).trust == "limited"
