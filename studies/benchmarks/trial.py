"""Runs of the case files, and the quantities that are compared with exact ones."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

import percute as pc
from studies.parallel import Stop

CASES = Path(__file__).with_name("cases")
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """One quantity, its exact value and the computed ones, the finest last."""

    name: str
    unit: str
    exact: float
    reason: str
    """Why the difference falls with this order, or stays within this bound."""
    order: float | None = None
    """The power of what is halved from run to run."""
    bound: float | None = None
    computed: Sequence[float] = field(default=(), compare=False)

    @property
    def difference(self) -> float:
        """Computed less exact, in the last run."""
        return self.computed[-1] - self.exact

    @property
    def observed(self) -> float | None:
        """The mean order over the runs; None if the difference is only bounded."""
        if self.order is None or len(self.computed) < 2:
            return None
        return float(np.log2(abs((self.computed[0] - self.exact) / self.difference))) / (len(self.computed) - 1)


@dataclass(frozen=True)
class Curve:
    """A quantity over time in the first run, the coarsest."""

    name: str
    unit: str
    time: Floats
    time_unit: str
    exact: Floats
    computed: Floats


@dataclass(frozen=True)
class Outcome:
    """The results of a case."""

    quantities: list[Quantity]
    curve: Curve | None = None


def filled(quantities: Sequence[Quantity], runs: Sequence[Sequence[float]]) -> list[Quantity]:
    """Give the quantities with what each run computed of them."""
    columns = zip(*runs, strict=True)
    return [replace(each, computed=[float(value) for value in column]) for each, column in zip(quantities, columns, strict=True)]


def bar(length: float, elements: int) -> str:
    """Give the value of the key ``bar`` of a case."""
    return f"{{ length = {length!r}, elements = {elements} }}"


def rectangle(width: float, height: float, nx: int, ny: int) -> str:
    """Give the value of the key ``rectangle`` of a case."""
    return f"{{ width = {width!r}, height = {height!r}, nx = {nx}, ny = {ny} }}"


def values(array: ArrayLike) -> str:
    """Give a list of numbers, or of vectors, as a case has it."""
    return repr(np.asarray(array).tolist())


class Trial:
    """A run of the case file of this name, with other values for some keys."""

    def __init__(self, name: str, stop: Stop | None, **settings: object) -> None:
        text = (CASES / f"{name}.toml").read_text(encoding="utf-8")
        for key, value in settings.items():
            text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
            assert count > 0, f"{name}.toml: no line sets `{key}`"
        self.estimate = pc.run(text, threads=1, progress=stop)
        assert self.estimate.history is not None
        self.history = self.estimate.history
        self.time = self.history.time
        self.step = float(self.time[-1]) / (len(self.time) - 1)
        self.masses = self.history.problem.mass
        self.mass = float(self.masses.sum())
        self.resultants = self.history.contact.resultants

    def mean(self, field: Floats) -> Floats:
        """Average a nodal field with the masses: displacements give the path of the centre of mass."""
        averaged: Floats = np.einsum("k,tkc->tc", self.masses, field) / self.mass
        return averaged

    @property
    def path(self) -> Floats:
        """Displacement of the centre of mass over time (m)."""
        return self.mean(self.history.displacement)

    @property
    def energy(self) -> Floats:
        """Kinetic plus strain energy over time (J)."""
        return self.history.balance.kinetic + self.history.balance.strain

    def mean_force(self, start: float, end: float) -> float:
        """Mean normal force at the t_n between two times (N)."""
        between = (self.time >= start) & (self.time <= end)
        return float(self.resultants.normal_force[between].mean())
