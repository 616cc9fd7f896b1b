"""Histories of other programs with mistakes."""

from collections.abc import Callable
from typing import Any

import numpy as np
import percute as pc
from numpy.typing import NDArray

Parts = dict[str, Any]
"""The arrays of a history, and changes of its problem: factors, and a shift of the plane (m)."""
STATED = {"density": 1.0, "young": 1.0, "speed": 1.0, "friction": 1.0, "plane": 0.0}


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

    def moved(plane: pc.Plane) -> pc.Plane:
        point = np.asarray(plane.point) + parts["plane"] * np.asarray(plane.normal)
        return pc.Plane(point=point, normal=plane.normal, friction=parts["friction"] * plane.friction)

    stated = pc.Problem(
        problem.mesh,
        material=pc.Elastic(young=parts["young"] * old.young, density=parts["density"] * old.density, **chosen),
        obstacles=[moved(plane) for plane in problem.obstacles],
        initial_velocity=parts["speed"] * problem.initial_velocity,
    )
    return pc.History.from_arrays(stated, **{name: value for name, value in parts.items() if name not in STATED})
