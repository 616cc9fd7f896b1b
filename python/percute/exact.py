"""Exact solutions as references for simulations and estimates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import partial
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.arrays import broadcast, numbers
from percute.bar_row import BarRow
from percute.checks import instance, number, text, whole, wrong
from percute.compared import Compared
from percute.errors import InputError
from percute.history import History
from percute.statement import Elastic
from percute.true_error import Effectivity, TrueError

__all__ = [
    "BarImpact",
    "BarMode",
    "BarRamp",
    "BarRow",
    "BlockMode",
    "BouncingBar",
    "ClampedRod",
    "Effectivity",
    "RigidSlide",
    "TrueError",
]

UNITS = {
    "length": "m", "young": "Pa", "density": "kg/m³", "section": "m²", "speed": "m/s", "gap": "m", "gravity": "m/s²", "height": "m",
    "distance": "m", "rate": "Pa/s", "amplitude": "m", "width": "m", "mass": "kg", "limit": "N",
}  # fmt: skip
"""Arguments that must be positive."""
POINTS = 8
"""Points of an element at which an error is measured. A jump inside an element is placed to 1/16 of it."""


class _Exact:
    """A closed-form solution with checked arguments; the extension has the formulas."""

    _data: _percute.ExactData
    _formulas: ClassVar[str]
    """The function of the extension that makes the formulas from the arguments."""

    def __post_init__(self) -> None:
        for name, unit in UNITS.items():
            if hasattr(self, name):
                value = number(name, getattr(self, name), unit=unit)
                if not 0 < value < np.inf:
                    raise InputError(f"`{name}` is {value:g} {unit}; it must be positive and finite")
                object.__setattr__(self, name, value)
        data = self._make(*(getattr(self, each) for each in self._arguments()))
        object.__setattr__(self, "_data", data)
        for name, value in data.constants.items():
            object.__setattr__(self, name, value)

    def _arguments(self) -> list[str]:
        return [each.name for each in fields(self) if each.init]  # type: ignore[arg-type]

    def _make(self, *values: Any) -> _percute.ExactData:
        made: _percute.ExactData = getattr(_percute.ExactData, self._formulas)(values)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(type(self), **{name: getattr(self, name) for name in self._arguments()}), ()

    def _evaluate(self, name: str, **at: ArrayLike) -> NDArray[np.float64]:
        """Evaluate a function at positions and instants, broadcast against each other."""
        rows = np.stack(broadcast(**at), axis=-1)
        return self._data.evaluate(name, rows.reshape(-1, len(at))).reshape(rows.shape[:-1])


@dataclass(frozen=True, kw_only=True)
class _Bar(_Exact, Compared):
    """An exact solution of a uniform bar on [0, L]. On a wave front, fields have their values behind it."""

    length: float
    young: float
    density: float
    section: float

    def displacement(self, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """Displacement at the positions ``x`` in [0, L] (m) and instants ``t`` (s), broadcast against each other (m)."""
        return self._at("displacement", x, t)

    def velocity(self, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """Velocity (m/s), likewise."""
        return self._at("velocity", x, t)

    def normal_force(self, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """Normal force (N), tension positive, likewise."""
        return self._at("normal_force", x, t)

    def error(self, history: History) -> TrueError:
        """Give the true error of a simulation of this bar, eq. [60].

        Integrals over elements are sums over their parts.

        Raises
        ------
        InputError
            If it is a simulation of another one.
        """
        mesh = instance("history", history, History).problem.mesh
        if history._data.variables:
            raise InputError("the exact solution is that of an elastic bar, and the material of `history` yields")
        if mesh.dimension != 1:
            raise InputError("`history` is that of a plane body; the exact solution is that of a bar")
        if abs(mesh.size / self.length - 1) > 1e-9:
            raise InputError(f"`history` is that of a bar of length {mesh.size:g} m, and the exact bar has length {self.length:g} m")
        ends = mesh.points[mesh.cells, 0]
        size = ends[:, 1] - ends[:, 0]
        s = (np.arange(POINTS) + 0.5) / POINTS
        x = ends[:, :1] + s * size[:, None]
        stiffness, inertia = self.young * self.section, self.density * self.section
        part = 0.5 / POINTS * size[:, None]
        kinetic, elastic = np.empty((2, len(history)))
        for n, t in enumerate(history.time):
            u, v = (values[n][mesh.cells, 0] for values in (history.displacement, history.velocity))
            force = stiffness * np.diff(u) / size[:, None]
            kinetic[n] = np.sum(part * inertia * (v[:, :1] + s * np.diff(v) - self.velocity(x, t)) ** 2)
            elastic[n] = np.sum(part * (force - self.normal_force(x, t)) ** 2) / stiffness
        return TrueError.over(history.time, kinetic, elastic)

    def _at(self, name: str, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        places = numbers("x", x, most=32, finite=True)
        outside = (places < 0) | (places > self.length)
        if outside.any():
            raise InputError(f"`x` holds {places[outside][0]:g} m; it must lie in the bar, from 0 to {self.length:g} m")
        return self._evaluate(name, x=x, t=t)


@dataclass(frozen=True, kw_only=True)
class _StruckBar(_Bar):
    """A bar whose end at x = 0 touches an obstacle."""

    wave_speed: float = field(init=False, repr=False, compare=False)
    """c = √(E/ρ) (m/s)."""

    def contact_force(self, t: ArrayLike) -> NDArray[np.float64]:
        """Force of the obstacle on the bar (N) at the instants ``t`` (s)."""
        return -self.normal_force(0.0, t)


@dataclass(frozen=True, kw_only=True)
class BarImpact(_StruckBar):
    """A uniform bar on [0, L], of `percute.Mesh.bar`, that moves in -x at ``speed`` towards a rigid plane at x = -``gap``.

    All arguments are positive: ``length`` (m), ``young`` (Pa), ``density`` (kg/m³), ``section`` (m²), ``speed`` (m/s) and ``gap`` (m).

    Source: Louf, Gallimard and Pelle, §7.1.
    """

    speed: float
    gap: float
    impact_time: float = field(init=False, repr=False, compare=False)
    """Time of impact (s)."""
    release_time: float = field(init=False, repr=False, compare=False)
    """Time of release from the plane, 2L/c later (s)."""
    _formulas = "bar_impact"

    def error(self, history: History) -> TrueError:
        """Give the true error of a simulation of this bar, eq. [60]; integrals are exact in space.

        Raises
        ------
        InputError
            If it is a simulation of another one.
        """
        values = [getattr(self, name) for name in self._arguments()]
        sup, mean, over_time = _percute.true_error_of_bar_impact(values, instance("history", history, History)._data)
        return TrueError(sup=sup, mean=mean, nested=True, **over_time)


@dataclass(frozen=True, kw_only=True)
class BouncingBar(_StruckBar):
    """A uniform bar that falls from ``height`` on a rigid plane under ``gravity``, in -x, and bounces periodically.

    It starts undeformed on [0, L] and at rest. The time between two contacts must be a whole number, at least 3, of periods 2L/c.

    Source: Doyen, Ern and Piperno (2011), SIAM J. Sci. Comput. 33(1), 223–249; d'Alembert.
    """

    gravity: float
    height: float
    impact_time: float = field(init=False, repr=False, compare=False)
    """Time of the first touch (s)."""
    contact_duration: float = field(init=False, repr=False, compare=False)
    """Duration of each contact, 2L/c (s)."""
    period: float = field(init=False, repr=False, compare=False)
    """Period of the motion, two bounces (s)."""
    energy: float = field(init=False, repr=False, compare=False)
    """Kinetic, strain and potential energy (J), zero at rest on the plane."""

    def _make(self, *values: Any) -> _percute.ExactData:
        data = _percute.ExactData.bouncing_bar(values)
        if data is None:
            raise InputError("`height` and `length`: the flight between two contacts must last a whole number, at least 3, of periods 2L/c")
        return data


@dataclass(frozen=True, kw_only=True)
class ClampedRod(_StruckBar):
    """A rod on [0, L], clamped at x = L, that springs back against an obstacle at the undeformed position of its end x = 0.

    It starts at rest with u₀ = (1 - x/L) ``distance``.

    Source: a benchmark of Dabaghi, Petrov, Pousin and Renard (2016), Appl. Numer. Math. 103; d'Alembert.
    """

    distance: float
    passage: float = field(init=False, repr=False, compare=False)
    """L/c (s), the time of the first touch and the duration of contact."""
    period: float = field(init=False, repr=False, compare=False)
    """3L/c (s)."""
    energy: float = field(init=False, repr=False, compare=False)
    """Kinetic plus strain energy (J)."""
    _formulas = "clamped_rod"


@dataclass(frozen=True, kw_only=True)
class BarMode(_Bar):
    """A standing wave u = A φ(x) cos(ωt + θ) of a uniform bar, with the ends in ``fixed`` fixed and the others free.

    Source: Timoshenko, Vibration Problems in Engineering.
    """

    amplitude: float
    number: int
    fixed: Literal["start", "both", "none"]
    phase: float = 0.0
    angular_frequency: float = field(init=False, repr=False, compare=False)
    """ω (rad/s)."""
    wave_number: float = field(init=False, repr=False, compare=False)
    """k (rad/m)."""
    energy: float = field(init=False, repr=False, compare=False)
    """Kinetic plus strain energy (J)."""

    def _make(self, *values: Any) -> _percute.ExactData:
        *lengths, order, fixed, phase = values
        angle = number("phase", phase, finite=True)
        data = _percute.ExactData.bar_mode([*lengths, angle], whole("number", order, most=10**6), text("fixed", fixed))
        if data is None:
            raise wrong("fixed", fixed, "'start', 'both' or 'none'")
        return data


@dataclass(frozen=True, kw_only=True)
class BarRamp(_Bar):
    """A uniform bar at rest, clamped at x = 0, with a traction on its other end that grows by ``rate`` from t = 0 on.

    Source: Timoshenko, Vibration Problems in Engineering, modal series; here in d'Alembert's form.
    """

    rate: float
    wave_speed: float = field(init=False, repr=False, compare=False)
    """c = √(E/ρ) (m/s)."""
    _formulas = "bar_ramp"


@dataclass(frozen=True, kw_only=True)
class BlockMode(_Exact):
    """A standing wave of the rectangle [0, width] × [0, height] with rollers on all sides, of pressure or shear.

    ``numbers`` are its half waves along x and y. Source: Graff, Wave Motion in Elastic Solids, §5.1.
    """

    width: float
    height: float
    material: Elastic
    wave: Literal["pressure", "shear"]
    numbers: tuple[int, int]
    amplitude: float
    phase: float = 0.0
    angular_frequency: float = field(init=False, repr=False, compare=False)
    """ω (rad/s)."""
    energy: float = field(init=False, repr=False, compare=False)
    """Kinetic plus strain energy (J)."""

    def _make(self, *values: Any) -> _percute.ExactData:
        law = instance("material", self.material, Elastic)
        if law.plane is None or law.poisson is None:
            raise InputError("`material` has no `plane` or no `poisson`: it is that of a bar")
        if self.wave not in ("pressure", "shear"):
            raise wrong("wave", self.wave, "'pressure' or 'shear'")
        across = 1 - (law.poisson if law.plane == "stress" else 2 * law.poisson)
        lame = law.young * law.poisson / ((1 + law.poisson) * across), law.young / (2 * (1 + law.poisson))
        rest = law.density, self.amplitude, number("phase", self.phase, finite=True)
        halves = [whole("numbers", each, least=0, most=10**6) for each in self.numbers]
        return _percute.ExactData.block_mode([self.width, self.height, law.thickness, *lame, *rest], halves, self.wave == "shear")

    def displacement(self, points: ArrayLike, t: float) -> NDArray[np.float64]:
        """Displacement at points, shape (n, 2), at an instant (m)."""
        x, y = numbers("points", points, most=2, finite=True).reshape(-1, 2).T
        return np.stack([self._evaluate(axis, x=x, y=y, t=t) for axis in ("x", "y")], axis=-1)


@dataclass(frozen=True, kw_only=True)
class RigidSlide(_Exact):
    """A rigid block at rest that a ``push`` (N) along a plane moves against dry friction of at most ``limit`` (N).

    The push has instants (s), from 0 on and increasing, with values (N): straight lines between, constant after the last.

    Source: Coulomb's law, eq. [2]; den Hartog (1931) for the pieces of the motion.
    """

    mass: float
    limit: float
    push: Sequence[tuple[float, float]]

    def _make(self, *values: Any) -> _percute.ExactData:
        push = numbers("push", self.push, most=2, finite=True)
        rows = [(t, f) for t, f in push.tolist()] if push.ndim == 2 and push.shape[1] == 2 else []
        data = _percute.ExactData.rigid_slide(self.mass, self.limit, rows)
        if data is None:
            raise wrong("push", self.push, "pairs of an instant (s), from 0 on and increasing, and a force (N)")
        return data

    def position(self, t: ArrayLike) -> NDArray[np.float64]:
        """Displacement at the instants ``t`` (m)."""
        return self._evaluate("position", t=t)

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """Velocity (m/s), likewise."""
        return self._evaluate("velocity", t=t)

    def friction(self, t: ArrayLike) -> NDArray[np.float64]:
        """Force of friction on the block (N), likewise."""
        return self._evaluate("friction", t=t)

    def dissipated(self, t: ArrayLike) -> NDArray[np.float64]:
        """Energy dissipated so far (J), likewise."""
        return self._evaluate("dissipated", t=t)
