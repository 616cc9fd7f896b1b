"""Exports of histories for ParaView, pyvista and other programs."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Protocol, cast, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.arrays import integers
from percute.arrays import times as checked_times
from percute.checks import flag, names, whole, wrong
from percute.checks import path as file_name
from percute.errors import InputError
from percute.mesh import Mesh
from percute.progress import ProgressOption, shown
from percute.steps import Steps
from percute.stored import StoredEstimate
from percute.words import counted

Choice = tuple[list[int] | None, int | None, list[float] | None]


@runtime_checkable
class Estimated(Protocol):
    """What an export takes from a `percute.Estimate`."""

    @property
    def mesh(self) -> Mesh: ...
    @property
    def by_element(self) -> NDArray[np.float64]: ...


def export(
    history: Steps,
    path: str | os.PathLike[str],
    steps: ArrayLike | None,
    every: int | None,
    times: ArrayLike | None,
    fields: Iterable[str] | None,
    estimate: Estimated | str | os.PathLike[str] | None,
    overwrite: bool,
    progress: ProgressOption,
) -> list[Path]:
    """Write fields of a history; see `History.export`."""
    file, replace = os.path.abspath(file_name("path", path)), flag("overwrite", overwrite)
    choice = _choice(steps, every, times, history)
    wanted = names("fields", fields, '["stress", "velocity"]')
    error, inputs = _error(history, estimate)
    inputs += [] if history.path is None else [os.fspath(history.path)]
    with shown(progress) as tell:
        return _percute.export(history._data, file, choice, wanted, error, inputs, replace, tell)


def _choice(steps: ArrayLike | None, every: int | None, times: ArrayLike | None, history: Steps) -> Choice:
    """Check the steps; negative ones count from the end."""
    count = len(history)
    if sum(given is not None for given in (steps, every, times)) > 1:
        raise InputError("give one of `steps`, `every` and `times`, not several")
    if steps is not None:
        chosen = integers("steps", [steps] if isinstance(steps, int | np.integer) else steps, None)
        if len(chosen) == 0 or not np.all((-count <= chosen) & (chosen < count)):
            allowed = f"one step or more, from {-count} to {count - 1}: the history holds {counted(count, 'instant')}"
            if history._data.steps() is not None:
                allowed += " of its run, which are counted here; `history.steps` has their steps in the run"
            raise wrong("steps", steps, allowed)
        return (chosen % count).tolist(), None, None
    if times is not None:
        return None, None, checked_times("times", times)
    return None, None if every is None else whole("every", every), None


def _error(history: Steps, estimate: Estimated | str | os.PathLike[str] | None) -> tuple[list[float] | None, list[str]]:
    """Give e_E of the elements, and the file of the estimate."""
    if estimate is None:
        return None, []
    files = []
    if isinstance(estimate, str | os.PathLike):
        files = [file_name("estimate", estimate)]
        if not _percute.is_estimate(os.path.abspath(files[0])):
            _percute.open_history(os.path.abspath(files[0]))
            raise wrong("estimate", estimate, "an estimate, or the name of an estimate file; this file holds a history")
        stored = StoredEstimate(os.path.abspath(files[0]))
        mesh, errors = stored.mesh, stored.by_element()
    elif isinstance(estimate, Estimated):
        mesh, errors = estimate.mesh, estimate.by_element
    else:
        raise wrong("estimate", estimate, "an estimate, or the name of an estimate file")
    if mesh != history.problem.mesh:
        raise InputError("`estimate` has another mesh than the history; take the estimate of this history")
    return cast("list[float]", errors.tolist()), files
