"""Histories of other programs with mistakes."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import percute as pc
import pytest
from numpy.typing import NDArray

Parts = dict[str, Any]
"""The arrays of a history, and changes of its problem: factors (of all lengths, of those of the mesh), a shift of the plane (m), a turn of its normal (rad), another Poisson's ratio or hypothesis."""
STATED = {
    **{"density": 1.0, "young": 1.0, "speed": 1.0, "friction": 1.0, "lengths": 1.0, "mesh": 1.0, "thickness": 1.0},
    **{"plane": 0.0, "turn": 0.0, "poisson": None, "hypothesis": None},
}
Change = Callable[[Parts], Parts]
FALLS = "the norm of the residual(| over all nodes and instants| away from the planes) falls from [0-9.]+ % to"
"""What a message says of a cause that was tried."""


def parts(history: pc.History) -> Parts:
    names = ("time", "displacement", "reaction", "touching", "contact_nodes")
    return {**{name: np.array(getattr(history, name)) for name in names}, **STATED}


def shifted(rows: NDArray[Any], steps: int) -> NDArray[Any]:
    moved = np.roll(rows, steps, axis=0)
    moved[: max(steps, 0)] = 0
    return moved


def changed(name: str, change: Callable[[NDArray[Any]], Any]) -> Callable[[Parts], Parts]:
    return lambda parts: {**parts, name: change(parts[name])}


def given(problem: pc.Problem, parts: Parts) -> pc.History:
    """The history, of the changed problem."""
    old = problem.material
    assert isinstance(old, pc.Elastic)
    names = ("poisson", "plane", "thickness", "section")
    chosen = {name: getattr(old, name) for name in names if getattr(old, name) is not None}
    if problem.mesh.dimension == 1:
        chosen.pop("thickness", None)
    else:
        chosen["thickness"] = parts["thickness"] * (old.thickness or 1.0)
        chosen |= {"poisson": parts["poisson"] or old.poisson, "plane": parts["hypothesis"] or old.plane}

    def moved(plane: pc.Plane) -> pc.Plane:
        point = parts["lengths"] * (np.asarray(plane.point) + parts["plane"] * np.asarray(plane.normal))
        sin, cos, normal = np.sin(parts["turn"]), np.cos(parts["turn"]), np.asarray(plane.normal)
        turned = np.array([[cos, -sin], [sin, cos]]) @ normal if normal.size == 2 else normal
        return pc.Plane(point=point, normal=turned, friction=parts["friction"] * plane.friction)

    length = parts["lengths"] * parts["mesh"]
    mesh = pc.Mesh(length * problem.mesh.points, problem.mesh.cells) if length != 1.0 else problem.mesh
    stated = pc.Problem(
        mesh,
        material=pc.Elastic(young=parts["young"] * old.young, density=parts["density"] * old.density, **chosen),
        obstacles=[moved(plane) for plane in problem.obstacles],
        initial_velocity=parts["lengths"] * parts["speed"] * problem.initial_velocity,
    )
    arrays = {name: value for name, value in parts.items() if name not in STATED}
    moving = {name: parts["lengths"] * arrays[name] for name in ("displacement", "velocity", "acceleration") if name in arrays}
    return pc.History.from_arrays(stated, **{**arrays, **moving})


def times(name: str, factor: float) -> Change:
    return changed(name, lambda value: factor * value)


def cause(problem: pc.Problem, parts: Parts) -> str:
    """The message of the refusal."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "the last instant", pc.InputWarning)
        with pytest.raises(pc.InputError) as refused:
            pc.estimate(given(problem, parts))
    return str(refused.value)


def without(parts: Parts, *names: str) -> Parts:
    return {name: value for name, value in parts.items() if name not in names}
