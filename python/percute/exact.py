"""Exact solutions, against which simulations and estimates can be measured."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.checks import instance, number, numbers
from percute.errors import InputError
from percute.estimation import Estimate
from percute.history import History

__all__ = ["BarImpact", "Effectivity", "TrueError", "bar_impact"]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class TrueError:
    """The true error of a simulated bar, eq. [60]: the energy norm of the difference to the exact fields."""

    sup: float
    """Largest over the t_n (J^½)."""
    mean: float
    """√((1/T)∫e² dt) (J^½)."""
    time: NDArray[np.float64]
    """t_n (s), shape (instants,)."""
    kinetic: NDArray[np.float64]
    """Kinetic part of e² (J), shape (instants,)."""
    elastic: NDArray[np.float64]
    """Elastic part of e² (J), shape (instants,)."""
    total: NDArray[np.float64]
    """e² (J), shape (instants,)."""

    def __repr__(self) -> str:
        return f"<percute.exact.TrueError: sup {self.sup:.4g} J^½, mean {self.mean:.4g} J^½, {len(self.time)} instants>"


@dataclass(frozen=True)
class Effectivity:
    """Estimated over true error; 1 would be perfect."""

    sup: float
    """Of the largest error."""
    mean: float
    """Of the mean error."""


@dataclass(frozen=True, kw_only=True)
class BarImpact:
    """A uniform bar on [0, L] that flies in -x against a rigid plane at x = -gap; see `bar_impact`.

    Source: Louf, Gallimard and Pelle, §7.1. On the wave front itself, fields have their values behind it.
    """

    length: float
    young: float
    density: float
    section: float
    speed: float
    gap: float
    _data: _percute.BarImpactData = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        names = ("length", "young", "density", "section", "speed", "gap")
        values = [number(name, getattr(self, name)) for name in names]
        object.__setattr__(self, "_data", _percute.BarImpactData(*values))
        for name, value in zip(names, values, strict=True):
            object.__setattr__(self, name, value)

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (self.length, self.young, self.density, self.section, self.speed, self.gap)

    @property
    def wave_speed(self) -> float:
        """c = √(E/ρ) (m/s)."""
        return self._data.wave_speed

    @property
    def impact_time(self) -> float:
        """When it strikes (s)."""
        return self._data.impact_time

    @property
    def release_time(self) -> float:
        """When it leaves the plane, 2L/c later (s)."""
        return self._data.release_time

    def displacement(self, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """Displacement at the places ``x`` in [0, L] (m) and instants ``t`` (s), broadcast against each other (m)."""
        return self._at(self._data.displacement, x, t)

    def velocity(self, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """Velocity (m/s), likewise."""
        return self._at(self._data.velocity, x, t)

    def normal_force(self, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        """Normal force (N), tension positive, likewise."""
        return self._at(self._data.normal_force, x, t)

    def contact_force(self, t: ArrayLike) -> NDArray[np.float64]:
        """Force of the plane on the bar (N) at the instants ``t`` (s)."""
        return self._at(self._data.contact_force, 0.0, t)

    def error(self, history: History) -> TrueError:
        """Give the true error of a simulation of this very bar, eq. [60].

        Raises
        ------
        InputError
            If it is a simulation of another one.
        """
        sup, mean, over_time = self._data.error(instance("history", history, History)._data)
        return TrueError(sup=sup, mean=mean, **over_time)

    def effectivity(self, estimate: Estimate, history: History | None = None) -> Effectivity:
        """Give the estimated over the true error, for the largest and the mean one.

        Parameters
        ----------
        estimate : Estimate
            The estimate.
        history : History, optional
            What it is the estimate of; needed only if the estimate comes from a file.
        """
        instance("estimate", estimate, Estimate)
        measured = history if history is not None else estimate.history
        if measured is None:
            raise InputError("`history` is missing: an estimate from a file does not hold it")
        return estimate.effectivity(self.error(measured))

    def _at(self, values: Any, x: ArrayLike, t: ArrayLike) -> NDArray[np.float64]:
        places, instants = _together(
            numbers("x", x, most=32, finite=True), numbers("t", t, most=32, finite=True)
        )
        found: NDArray[np.float64] = values(places.ravel(), instants.ravel())
        return found.reshape(places.shape)


def _together(x: NDArray[np.float64], t: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    try:
        return np.broadcast_arrays(x, t)
    except ValueError:
        raise InputError(f"`x` has the shape {x.shape} and `t` {t.shape}; they cannot be broadcast") from None


def _rebuild(*values: float) -> BarImpact:
    return bar_impact(**dict(zip(("length", "young", "density", "section", "speed", "gap"), values, strict=True)))


def bar_impact(
    *, length: float, young: float, density: float, section: float, speed: float, gap: float
) -> BarImpact:
    """Give the exact impact of a uniform bar on a rigid plane.

    Parameters
    ----------
    length : float
        L (m): the undeformed bar is [0, L], as `Mesh.bar` makes it.
    young : float
        Young's modulus E (Pa).
    density : float
        Density ρ (kg/m³).
    section : float
        Section S (m²).
    speed : float
        Speed v₀ towards the plane (m/s), positive: the initial velocity is -v₀.
    gap : float
        Distance from the bar to the plane at t = 0 (m), positive: the plane goes through x = -gap.

    Returns
    -------
    BarImpact
        Its fields, and the true error and effectivity of simulations and estimates.
    """
    return BarImpact(length=length, young=young, density=density, section=section, speed=speed, gap=gap)
