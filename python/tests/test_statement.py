"""Stating a problem: values, and every mistake with the name of its argument."""

import json
import pickle
import re
from typing import Any

import numpy as np
import percute as pc
import pytest
from conftest import bar, block, block_case
from hypothesis import given
from hypothesis import strategies as st

STEEL = pc.Elastic(young=210e9, poisson=0.3, density=7800.0, plane="strain")
BAR = pc.Elastic(young=70e9, density=2700.0, section=0.02)
SQUARE: dict[str, Any] = {"points": [[0, 0], [1, 0], [1, 1], [0, 1]], "cells": [[0, 1, 2], [0, 2, 3]]}


def stack() -> pc.Problem:
    """All that can be said, at once."""
    points = [[x, y] for y in (0.0, 0.01, 0.02) for x in (0.0, 0.01, 0.02)]
    cells = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [3, 4, 7], [3, 7, 6], [4, 5, 8], [4, 8, 7]]
    groups = {"foot": [[0, 1], [1, 2]], "top": [[6, 7], [7, 8]], "left": [[0, 3], [3, 6]]}
    mesh = pc.Mesh(np.array(points), np.array(cells), groups, {"low": np.arange(4), "high": np.arange(4, 8)})
    soft = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="strain", thickness=0.5)
    high = pc.Elastic(young=210e9, poisson=0.3, density=7800.0, plane="strain", thickness=0.5)
    return pc.Problem(
        mesh,
        material={"low": soft, "high": high},
        obstacles=[pc.Plane(point=(0.0, -2e-5), normal=(0.0, 3.0), friction=0.1, group="foot")],
        supports=[pc.Support(group="left", components="x", velocity=[0.0, 0.0, 1.0], time=[0.0, 5e-6, 1e-5])],
        tractions=[
            pc.Traction(group="top", value=[[0, 0], [0, -1e6]], time=[0.0, 2e-6], profile=(1.0, (-25.0, 0.0))),
        ],
        body_forces=[pc.BodyForce(value=(0.0, -26487.0), group="low")],
        initial_velocity=(0.0, -10.0),
    )


def test_a_problem_tells_what_was_stated() -> None:
    problem = stack()
    assert isinstance(problem.material, dict) and list(problem.material) == ["low", "high"]
    assert problem.material["high"] == pc.Elastic(
        young=210e9, poisson=0.3, density=7800.0, plane="strain", thickness=0.5
    )
    assert problem.obstacles == (pc.Plane(point=(0.0, -2e-5), normal=(0.0, 3.0), friction=0.1, group="foot"),)
    assert problem.supports == (
        pc.Support(group="left", components=["x"], velocity=[[0.0], [0.0], [1.0]], time=(0.0, 5e-6, 1e-5)),
    )
    assert problem.tractions[0].profile == (1.0, (-25.0, 0.0)) and problem.tractions[0].time == (0.0, 2e-6)
    assert problem.body_forces == (pc.BodyForce(value=[0.0, -26487.0], group="low"),)
    assert repr(problem) == (
        "<percute.Problem: 8 triangles, 9 nodes, 1 obstacle, 1 support, 1 traction, 1 body force>"
    )
    assert "Plane(point=(0.0, -2e-05)" in repr(problem.obstacles)


def test_gravity_is_the_weight_of_each_material() -> None:
    """Added to other forces; the problem knows it as body forces, and pickles with them once."""
    problem = stack()
    pull = pc.BodyForce(value=(100.0, 0.0))
    heavy = pc.Problem(problem.mesh, material=problem.material, body_forces=[pull], gravity=(0.0, -9.81))
    weights = [pc.BodyForce(value=(0.0, -9.81 * density), group=group) for group, density in (("low", 2700.0), ("high", 7800.0))]
    assert heavy.body_forces == (pull, *weights)
    assert pickle.loads(pickle.dumps(heavy)).body_forces == heavy.body_forces
    column = pc.Problem(pc.Mesh.bar(1.0, elements=2), material=pc.Elastic(young=1e9, density=1000.0, section=0.1), gravity=-10.0)
    assert column.body_forces == (pc.BodyForce(value=[-1e4]),)
    # A body that falls from rest: −g t²/2 at each node, at the instants of the scheme.
    free = pc.simulate(pc.Problem(problem.mesh, material=problem.material, gravity=(0.0, -9.81)), end=1e-5, courant=0.5)
    assert np.allclose(free.displacement[-1, :, 1], -9.81 * free.time[-1] ** 2 / 2, rtol=1e-9)


def test_a_mesh_tells_what_it_is() -> None:
    mesh = stack().mesh
    assert mesh.dimension == 2 and mesh.size == pytest.approx(0.02 * 2**0.5)
    assert mesh.edge_groups["top"].tolist() == [[6, 7], [7, 8]] and mesh.element_groups["low"].tolist() == [0, 1, 2, 3]
    turned = pc.Mesh([0.0, 0.5, 1.0], [[1, 0], [1, 2]], {"end": [2]})
    assert (turned.dimension, turned.reoriented_elements, turned.cells.tolist()) == (1, 1, [[0, 1], [1, 2]])
    assert repr(turned) == "<percute.Mesh: 2 bars, 3 nodes>"


@given(st.lists(st.floats(1e-3, 1.0), min_size=1, max_size=20))
def test_masses_are_those_of_the_material(lengths: list[float]) -> None:
    """Each bar gives half its mass to each of its nodes [35]."""
    points = np.concatenate([[0.0], np.cumsum(lengths)])
    cells = np.column_stack([np.arange(len(lengths)), np.arange(1, len(lengths) + 1)])
    problem = pc.Problem(pc.Mesh(points, cells), material=BAR)
    shares = 0.5 * 2700.0 * 0.02 * np.diff(points)
    expected = np.concatenate([shares, [0.0]]) + np.concatenate([[0.0], shares])
    # Rounding of a few products.
    assert np.allclose(problem.mass, expected, rtol=1e-14, atol=0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"points": [[0, 0], [1, 0], [1, np.nan], [0, 1]]}, "node 2 has the coordinate NaN"),
        ({"points": [[0, 0, 0]]}, "`points` has the shape (1, 3)"),
        ({"points": [["a", "b"]]}, "`points` is [['a', 'b']]"),
        ({"points": [[0, 0], [1]]}, "`points`"),
        ({"cells": [[0, 1, -1]]}, "`cells`: entry 0 is -1; numbers are counted from 0"),
        ({"cells": [[0.0, 1.0, 2.0]]}, "`cells` is an array of float64"),
        ({"cells": [[0, 1]]}, "`cells` has the shape (1, 2); it must have (n, 3)"),
        ({"cells": [[0, 1, 7], [0, 2, 3]]}, "names node 7"),
        ({"edge_groups": {"a": [[0, 2]]}}, 'group "a" names the edge of nodes 0 and 2'),
        ({"edge_groups": {"a": [0, 1]}}, "`edge_groups['a']` has the shape (2,)"),
        ({"element_groups": {"a": [2]}}, 'group "a" names element 2'),
        ({"element_groups": {"a": [-2]}}, '`element_groups["a"]`: entry 0 is -2'),
    ],
)
def test_mistakes_in_a_mesh(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(pc.InputError, match=re.escape(message)):
        pc.Mesh(**(SQUARE | changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"material": pc.Elastic(young=-1, poisson=0.3, density=1, plane="stress")}, "`material.young` is -1 Pa"),
        ({"material": BAR}, "`material.section` applies to bars only"),
        ({"material": {"core": STEEL}}, '`material["core"]`: there is no group of elements "core"'),
        ({"material": 7}, "`material` is 7"),
        ({"obstacles": pc.Plane(point=(0, 0), normal=(0, 1), friction=0)}, "`obstacles` is one Plane; give a list"),
        ({"obstacles": [3]}, "`obstacles[0]` is 3; it must be a Plane"),
        ({"obstacles": [pc.Plane(point=0, normal=(0, 1), friction=0)]}, "`obstacles[0].point` has 1 numbers"),
        ({"obstacles": [pc.Plane(point=(0, 0.01), normal=(0, 1), friction=0)]}, "`obstacles[0].point`: the plane cuts through the body"),
        ({"obstacles": [pc.Plane(point=(0, 0), normal=(0, 0), friction=0)]}, "`obstacles[0]`: `normal` is [0.0, 0.0]"),
        ({"obstacles": [pc.Plane(point=(0, -1), normal=(0, 1), friction=0, group="floor")]}, "`obstacles[0].group`"),
        (
            {"tractions": [pc.Traction(group="top", value=[[0, 0]], time=[0, 1])]},
            "`tractions[0].value` has 1 entries and `time` has 2",
        ),
        (
            {"tractions": [pc.Traction(group="top", value=[[0, 0], [1, 1]], time=[1, 1])]},
            "`tractions[0].time`: `time` entry 1 is 1 s",
        ),
        ({"body_forces": [pc.BodyForce(value=(0, 1), group="core")]}, "`body_forces[0].group`"),
        ({"initial_velocity": (1, 2, 3)}, "`initial_velocity` has 3 numbers in a row"),
        ({"initial_velocity": np.zeros((3, 2))}, "`initial_velocity`: the field has 3 values"),
        ({"initial_displacement": (0, np.inf)}, "`initial_displacement`: the value at node 0 is inf"),
    ],
)
def test_mistakes_in_a_problem(changes: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"material": STEEL} | changes
    with pytest.raises(pc.InputError, match=re.escape(message)) as raised:
        pc.Problem(pc.Mesh.rectangle(1.0, 1.0, nx=2, ny=2), **arguments)
    assert isinstance(raised.value, ValueError) and isinstance(raised.value, pc.PercuteError)


AXES = """it must be "x", "y", "z" or several, as in ("x", "y")"""
BOTH: dict[str, Any] = {"components": ("x", "y")}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        # The axes are at fault, not the number of velocities that goes with them.
        ({"components": "xy"}, f"`components` is 'xy'; {AXES}"),
        ({"components": "xy", "velocity": (0.0, 1.0)}, f"`components` is 'xy'; {AXES}"),
        ({"components": ["x,y"], "velocity": (0.0, 1.0)}, f"`components` is ['x,y']; {AXES}"),
        ({"components": "w"}, f"`components` is 'w'; {AXES}"),
        ({"components": ("X",)}, f"`components` is ('X',); {AXES}"),
        ({"components": ()}, f"`components` is (); {AXES}"),
        ({**BOTH, "velocity": 1.0}, "`velocity` has 1 number; it must have 2 numbers, one for each of `components`, x, y"),
        ({"components": "y", "velocity": (0.0, 1.0)}, "`velocity` has 2 numbers; it must have 1 number, one for each of `components`, y; for a velocity that"),
        ({**BOTH, "velocity": [[0.0, 1.0], [0.0, 0.0]]}, "`velocity` has rows, but `time` is missing: give the instant of each row (s)"),
        ({**BOTH, "velocity": (0.0, 1.0), "time": (0.0, 1.0)}, "with `time` it must have a row of 2 numbers, one for each of `components`, x, y, for"),
        ({"components": "x", "velocity": [[0.0, 1.0]] * 3, "time": (0.0, 1.0, 2.0)}, "has the shape (3, 2); with `time` it must have a row of 1 number"),
    ],
)
def test_mistakes_in_a_support(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(pc.InputError, match=re.escape(message)):
        pc.Support(group="left", **arguments)


@given(st.text(max_size=3).filter(lambda name: name not in ("x", "y")), st.lists(st.floats(-1, 1), max_size=4))
def test_unknown_axes_are_named_whatever_the_velocity(name: str, velocity: list[float]) -> None:
    for components in (name, [name], ("x", name)):
        with pytest.raises(pc.InputError, match=r"`components"):
            pc.Support(group="left", components=components, velocity=velocity)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"courant": 0.9}, "`end` is missing"),
        ({"end": 1e-5}, "give exactly one of `courant`"),
        ({"end": 1e-5, "courant": 0.9, "step": 1e-8}, "give exactly one of `courant`"),
        ({"end": 1e-5, "courant": 1.5}, "`courant` is 1.5; it must be above 0 and at most 1"),
        ({"end": 1e-5, "step": 1.0}, "`step` is 1.0 s; it must be at most the critical step"),
        ({"end": -1.0, "courant": 0.9}, "`end` is -1 s"),
        ({"end": 1e-5, "steps": [1e-7, 2e-7]}, "`steps` add up to"),
        ({"steps": [1e-7, 1.0]}, "`steps[1]` is 1.0 s"),
        ({"steps": []}, "`steps` is empty"),
        ({"end": float("nan"), "courant": 0.9}, "`end` is NaN"),
    ],
)
def test_mistakes_in_time(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(pc.InputError, match=re.escape(message)):
        pc.simulate(block(), **arguments)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"reconstruction": "blunt"}, '`reconstruction`: "blunt" is not known; choose one of corrected, consistent, published'),
        ({"acceleration": "none"}, "`acceleration`"),
        ({"every": 0}, "`every` is 0; it must be at least 1"),
        ({"threads": 1.5}, "`threads` is 1.5"),
        ({"window": -1}, "`window` is -1"),
        ({"instants": [-1.0]}, "`instants`"),
        ({"instants": 0}, "`instants` is 0"),
    ],
)
def test_mistakes_in_an_estimate(arguments: dict[str, Any], message: str, bar_history: pc.History) -> None:
    with pytest.raises(pc.InputError, match=re.escape(message)):
        pc.estimate(bar_history, **arguments)


def test_a_start_that_is_too_near_names_its_plane() -> None:
    problem = pc.Problem(
        pc.Mesh.bar(1.0, elements=4),
        material=pc.Elastic(young=1.0, density=1.0, section=1.0),
        obstacles=[pc.Plane(point=-1e-6, normal=1)],
        initial_velocity=-1.0,
    )
    with pytest.raises(pc.InputError, match=re.escape("`obstacles[0].point`: node 0 starts 1.000000e-6 m")):
        pc.simulate(problem, end=1.0, courant=0.9)


def test_a_plane_that_is_struck_at_once_is_moved_by_the_least_gap() -> None:
    """The case and Python move the same plane by the same gap, v Δt/4, and the history has the moved plane."""
    case = block_case("rectangle = { width = 0.05, height = 0.04, nx = 5, ny = 4 }", speed=4.0, end=4e-6)
    found = re.search(r"point = \[[^]]*\]", case)
    assert found is not None
    stated = block(5, 4)
    histories = []
    for place in ({"gap": "auto"}, {"gap": 0.0}, {"point": (0.0, 0.0)}):
        problem = pc.Problem(
            stated.mesh, material=stated.material, obstacles=[pc.Plane(normal=(0, 1), friction=0.2, **place)], initial_velocity=(4.0, -4.0)  # type: ignore[arg-type]
        )
        assert problem.obstacles[0].point == (0.0, 0.0)
        with pytest.warns(pc.InputWarning, match=r"`obstacles\[0\].point`: plane 0 was moved back along its normal by .* at 4 m/s"):
            histories.append(pc.simulate(problem, end=4e-6, courant=0.9))
        assert problem.obstacles[0].point == (0.0, 0.0)
        with pytest.raises(pc.InputError, match="leave a gap"):
            pc.History.from_arrays(problem, time=[0.0, 1e-7], displacement=np.zeros((2, len(stated.mesh.points), 2)))
    (x, y), step = histories[0].problem.obstacles[0].point, 0.9 * stated.critical_time_step  # type: ignore[misc]
    # The least gap is rounded up by 1e-5 of it.
    assert x == 0.0 and -y == pytest.approx(0.25 * 4.0 * step, rel=2e-5)
    assert all(np.array_equal(each.displacement, histories[0].displacement) for each in histories)
    with pytest.warns(pc.InputWarning, match="plane 0 was moved back"):
        estimate = pc.run(case.replace(found[0], 'gap = "auto"'))
    assert estimate.problem.obstacles[0].point == (x, y)
    assert "moved_plane" in [each["name"] for each in json.loads(estimate.to_json())["warnings"]]
    assert estimate.sup == pc.estimate(histories[0]).sup
    with pytest.warns(pc.InputWarning, match="plane 0 was moved back"):
        verified = pc.verify(problem, end=4e-6, courant=0.9, levels=1)
    assert len(verified.elements) == 2


def test_a_plane_of_a_rebound_is_moved_too() -> None:
    bar = pc.Problem(
        pc.Mesh.bar(0.1, elements=20),
        material=pc.Elastic(young=70e9, density=2700.0, section=0.02),
        obstacles=[pc.Plane(gap="auto", normal=1)],
        initial_velocity=-1.0,
    )
    with pytest.warns(pc.InputWarning, match="plane 0 was moved back"):
        history = pc.simulate(bar, end="rebound", longest=1e-3, courant=0.9)
    assert history.contact.resultants.normal_force.max() > 0.0 and history.complete


def test_variable_steps_are_taken_as_they_are() -> None:
    steps = 1e-7 * (1 + np.arange(5) % 2)
    history = pc.simulate(bar(), steps=steps)
    assert np.array_equal(history.time, np.concatenate([[0.0], np.cumsum(steps)])) and history.complete
