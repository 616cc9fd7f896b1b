"""The exact solution of bars that strike each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.arrays import broadcast
from percute.bodies import Body
from percute.checks import instance, items, number, text, whole
from percute.compared import Compared
from percute.errors import InputError
from percute.history import History
from percute.statement import Elastic
from percute.true_error import TrueError

__all__ = ["BarRow"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class BarRow(Compared):
    """Uniform bars in a row that strike each other, part, and meet again, until ``end`` (s); both ends of the row are free.

    ``bodies`` are bars as those of a `percute.Problem`, in the order of x. Places are those of the bars at the start.

    Source: Timoshenko and Goodier, Theory of Elasticity, longitudinal impact of bars (de Saint-Venant); d'Alembert.
    """

    bodies: Sequence[Body]
    end: float
    _data: _percute.BarRowData = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        bodies = tuple(items("bodies", self.bodies, Body))
        end = number("end", self.end, unit="s")
        if any(body.mesh.dimension != 1 for body in bodies):
            raise InputError("`bodies` has a plane body; the exact solution is that of bars")
        if not (bodies and 0 < end < np.inf):
            raise InputError(f"`end` is {end:g} s and `bodies` has {len(bodies)}; give a positive end and at least one bar")
        data = _percute.BarRowData.new([_numbers(body) for body in bodies], end)
        if data is None:
            raise InputError("`bodies` overlap or are not in the order of x; each bar must start where the one before ends, or behind it")
        for name, value in (("bodies", bodies), ("end", end), ("_data", data)):
            object.__setattr__(self, name, value)

    def displacement(self, body: str, x: ArrayLike, t: ArrayLike) -> Floats:
        """Displacement of a body at places ``x`` (m) and instants ``t`` (s), broadcast against each other (m)."""
        return self._evaluate("displacement", body, x, t)

    def velocity(self, body: str, x: ArrayLike, t: ArrayLike) -> Floats:
        """Velocity at places and instants as in `displacement` (m/s)."""
        return self._evaluate("velocity", body, x, t)

    def normal_force(self, body: str, x: ArrayLike, t: ArrayLike) -> Floats:
        """Normal force at places and instants as in `displacement` (N), tension positive."""
        return self._evaluate("normal_force", body, x, t)

    def contact_force(self, first: int, t: ArrayLike) -> Floats:
        """Force (N) with which bar ``first`` and the next one press on each other, at instants ``t`` (s)."""
        body = self.bodies[self._interface(first)]
        start, length = _numbers(body)[:2]
        return -self.normal_force(body.name, start + length, t)

    def contacts(self, first: int) -> Floats:
        """Beginning and end of each contact (s) of bar ``first`` and the next one, shape (contacts, 2)."""
        return np.array(self._data.contacts(self._interface(first))).reshape(-1, 2)

    def error(self, history: History) -> TrueError:
        """Give the true error of a simulation of these bars, eq. [60]; integrals are exact in space.

        Raises
        ------
        InputError
            If it is a simulation of other bodies, or longer than the solution.
        """
        self._check(instance("history", history, History))
        kinetic, elastic = np.zeros((2, len(history)))
        first = 0
        for number_of_body, body in enumerate(self.bodies):
            nodes = first + np.argsort(body.mesh.points[:, 0])
            first += len(nodes)
            places = history.problem.mesh.points[nodes, 0]
            for n, t in enumerate(history.time):
                u, v = (values[n][nodes, 0] for values in (history.displacement, history.velocity))
                own = self._of_body(number_of_body, places, u, v, float(t))
                kinetic[n] += own[0]
                elastic[n] += own[1]
        return TrueError.over(history.time, kinetic, elastic)

    def _of_body(self, number_of_body: int, places: Floats, u: Floats, v: Floats, t: float) -> tuple[float, float]:
        """Give the parts of e² in a bar (J): exact fields are constant between fronts, those of elements linear."""
        start, length, young, density, section, _ = _numbers(self.bodies[number_of_body])
        fronts = self._data.fronts(number_of_body, t)
        cuts = np.sort(np.concatenate((places, np.clip(fronts, start, start + length))))
        middle, size = (cuts[1:] + cuts[:-1]) / 2, np.diff(cuts)
        element = np.clip(np.searchsorted(places, middle, side="right") - 1, 0, len(places) - 2)
        strain, slope = (np.diff(values)[element] / np.diff(places)[element] for values in (u, v))
        speed = v[element] + slope * (middle - places[element])
        force, still = (self._data.evaluate(name, number_of_body, middle, np.full_like(middle, t)) for name in ("normal_force", "velocity"))
        kinetic = 0.5 * density * section * float(np.sum(size * ((speed - still) ** 2 + (slope * size) ** 2 / 12)))
        stiffness = young * section
        return kinetic, 0.5 * float(np.sum(size * (stiffness * strain - force) ** 2)) / stiffness

    def _check(self, history: History) -> None:
        """See that a history is that of these bodies."""
        problem = history.problem
        points = np.concatenate([body._placed().points for body in self.bodies])
        if not np.array_equal(problem.mesh.points, points):
            raise InputError("`history` is that of other bodies: its mesh is not that of `bodies`, one after the other")
        velocity = np.concatenate([np.full(len(body.mesh.points), _numbers(body)[5]) for body in self.bodies])
        if not np.array_equal(problem.initial_velocity[:, 0], velocity) or problem.initial_displacement.any():
            raise InputError("`history` has other initial velocities or displacements than `bodies`")
        if problem.material != {body.name: body.material for body in self.bodies}:
            raise InputError("`history` has other materials than `bodies`")
        if history.time[-1] > self.end * (1 + 1e-9):
            raise InputError(f"`history` ends at {history.time[-1]:g} s, after the end of the exact solution at {self.end:g} s")

    def _interface(self, first: int) -> int:
        most = len(self.bodies) - 2
        if most < 0:
            raise InputError("`bodies` is a single bar, which touches none")
        return whole("first", first, least=0, most=most)

    def _evaluate(self, quantity: str, body: str, x: ArrayLike, t: ArrayLike) -> Floats:
        names = [each.name for each in self.bodies]
        if text("body", body) not in names:
            raise InputError(f"`body` is {body!r}; the bars are {', '.join(names)}")
        start, length = _numbers(self.bodies[names.index(body)])[:2]
        places, instants = broadcast(x=x, t=t)
        outside = (places < start) | (places > start + length)
        if outside.any():
            raise InputError(f"`x` holds {places[outside][0]:g} m; it must lie in {body}, from {start:g} to {start + length:g} m")
        late = (instants < 0) | (instants > self.end)
        if late.any():
            raise InputError(f"`t` holds {instants[late][0]:g} s; it must be from 0 to the `end` of {self.end:g} s")
        found = self._data.evaluate(quantity, names.index(body), *(np.ascontiguousarray(row).reshape(-1) for row in (places, instants)))
        return found.reshape(places.shape)

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(BarRow, bodies=self.bodies, end=self.end), ()


def _numbers(body: Body) -> tuple[float, ...]:
    """Give start, L, E, ρ, S and velocity of a bar."""
    law: Elastic = body.material
    if law.section is None:
        raise InputError(f"`bodies`: the material of {body.name} has no `section`: it is not that of a bar")
    points = body._placed().points[:, 0]
    velocity = cast("tuple[float, ...]", body.velocity)[0]
    return float(points.min()), float(np.ptp(points)), law.young, law.density, law.section, float(velocity)
