"""A problem on nested meshes: estimates beside true errors against the finest."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.checks import flag, instance, text, whole
from percute.errors import InputError
from percute.estimating import pace
from percute.problem import Problem
from percute.progress import ProgressOption, shown
from percute.simulation import times_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Verification", "verify"]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Verification:
    """A problem on its mesh and on refinements of it. Arrays have a value for each level, NaN where there is none."""

    elements: NDArray[np.int64]
    """Number of elements."""
    steps: NDArray[np.int64]
    """Number of steps."""
    estimate_sup: NDArray[np.float64]
    """Largest estimated error (J^½), eq. [15]."""
    estimate_mean: NDArray[np.float64]
    """Mean estimated error (J^½), eq. [16]."""
    error_sup: NDArray[np.float64]
    """Largest true error against the finest mesh (J^½)."""
    error_mean: NDArray[np.float64]
    """Mean true error against the finest mesh (J^½)."""
    effectivity_sup: NDArray[np.float64]
    """Estimated over true error, of the largest."""
    effectivity_mean: NDArray[np.float64]
    """Estimated over true error, of the mean."""
    peak_force: NDArray[np.float64]
    """Largest normal force of all nodes together (N)."""
    impulse: NDArray[np.float64]
    """Normal impulse of all planes (N s)."""
    rebound: NDArray[np.float64]
    """Normal velocity of the centre of mass after contact (m/s)."""
    expected: tuple[float, float]
    """The range of the effectivity index on the first mesh that its verdict states."""
    orders: dict[str, float | None]
    """Observed orders of ``estimate``, ``peak_force``, ``impulse`` and ``rebound``; None where values do not converge."""
    moved: float | None
    """By how much the mean true error of the first mesh moves from the finest mesh but one to the finest, relative; None with one level."""
    fine_enough: bool | None
    """Whether that is at most 0.1."""
    _table: str

    @property
    def size(self) -> NDArray[np.float64]:
        """Element size over that of the first mesh."""
        return np.asarray(0.5 ** np.arange(len(self.elements)))

    def __str__(self) -> str:
        return self._table.rstrip()

    def __repr__(self) -> str:
        return f"<percute.Verification: {len(self.elements)} levels of {self.elements[0]} to {self.elements[-1]} elements>"

    def plot(self, *, axes: Axes | None = None, save: str | os.PathLike[str] | None = None, overwrite: bool = False) -> Axes:
        """Draw estimate and true error over the element size, both logarithmic.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes of the plot; new ones by default.
        save : str or path, optional
            A file ``.svg``, ``.png`` or ``.pdf`` for the picture.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot.
        """
        from percute.pictures import convergence

        return convergence.plot(self, axes, save, flag("overwrite", overwrite))

    @classmethod
    def _of(cls, document: dict[str, Any], table: str) -> Verification:
        levels = document["levels"]

        def column(*keys: str) -> NDArray[np.float64]:
            values = []
            for level in levels:
                value = level
                for key in keys:
                    value = None if value is None else value[key]
                values.append(np.nan if value is None else value)
            return np.array(values, np.float64)

        pairs = {f"{key}_{name}": column(key, name) for key in ("estimate", "error", "effectivity") for name in ("sup", "mean")}
        settled = document["settled"] or {}
        return cls(
            elements=np.array([level["elements"] for level in levels]),
            steps=np.array([level["steps"] for level in levels]),
            **pairs,
            **{key: column(key) for key in ("peak_force", "impulse", "rebound")},
            expected=tuple(levels[0]["expected"]),
            orders=document["orders"],
            moved=settled.get("moved"),
            fine_enough=settled.get("fine_enough"),
            _table=table,
        )


def verify(
    problem: Problem,
    *,
    end: float | None = None,
    courant: float | None = None,
    step: float | None = None,
    steps: ArrayLike | None = None,
    levels: int = 2,
    reconstruction: Literal["corrected", "consistent", "published"] = "corrected",
    threads: int | None = None,
    progress: ProgressOption = None,
) -> Verification:
    """Run a problem on its mesh and on nested refinements, and compare estimates with true errors against the finest.

    All meshes have the Courant number of the first. A level of a plane body has about eight times the work of the one before, of a bar
    four times; the finest is simulated once more for the comparison, without storing its steps. With ``progress=True`` the cost is
    printed before the work starts.

    Parameters
    ----------
    problem : Problem
        The problem.
    end, courant, step, steps
        As for `simulate`.
    levels : int, default: 2
        Number of refinements, 1 to 5.
    reconstruction : {"corrected", "consistent", "published"}, default: "corrected"
        As for `estimate`.
    threads : int, optional
        How many threads to use; one for each core by default.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    Verification

    Raises
    ------
    InputError
        An argument is wrong; or the start is too near to a plane.
    SimulationError, EstimateError
        A run failed.
    """
    instance("problem", problem, Problem)
    times = times_of(end, courant, step, steps)
    count = whole("levels", levels)
    if count > _percute.MOST_LEVELS:
        raise InputError(f"`levels` is {count}; give 1 to {_percute.MOST_LEVELS} refinements")
    named, (workers, _) = text("reconstruction", reconstruction), pace(threads, None)
    tell = print if progress is True else None
    with shown(progress) as seen:
        document, table = _percute.verification(problem._data, times, count, named, workers, tell, seen)
    return Verification._of(json.loads(document), table)
