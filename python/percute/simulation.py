"""Simulations, and the true errors of histories against one on a finer mesh."""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from percute import _percute
from percute.arrays import numbers
from percute.attached import attached
from percute.checks import encodable, flag, instance, items, optional_number, vtkhdf, warn, wrong
from percute.errors import InputError, SimulationWarning
from percute.history import History, true_errors_of
from percute.storage import storage
from percute.problem import Problem
from percute.progress import ProgressOption, shown
from percute.termination import file_closed_at_signals
from percute.true_error import TrueError

__all__ = ["simulate", "true_errors"]


def times_of(end: object, courant: float | None, step: float | None, steps: ArrayLike | None) -> _percute._Times:
    """Check the end and the steps of a run."""
    if isinstance(end, str):
        raise wrong("end", end, 'a positive number in s, or "rebound"')
    lengths = None if steps is None else np.atleast_1d(numbers("steps", steps, most=1)).tolist()
    return optional_number("end", end), optional_number("courant", courant), optional_number("step", step), lengths


def simulate(
    problem: Problem,
    *,
    end: float | Literal["rebound"] | None = None,
    courant: float | None = None,
    step: float | None = None,
    steps: ArrayLike | None = None,
    longest: float | None = None,
    after: float | None = None,
    store: str | os.PathLike[str] | None = None,
    every: int | None = None,
    times: ArrayLike | None = None,
    fields: Iterable[str] | None = None,
    overwrite: bool = False,
    long: bool = False,
    progress: ProgressOption = None,
) -> History:
    """Simulate by central differences with a lumped mass and contact multipliers, eq. [28] to [38].

    Parameters
    ----------
    problem : Problem
        What to simulate.
    end : float or "rebound"
        End T of the run (s); it may be left out with ``steps``. With "rebound" the run ends some time after the last contact, with
        planes or between bodies, has ended; a first pass of the integrator looks for this end and takes as long as a simulation
        without its estimate.
    courant : float
        Time step over the critical one, above 0 and at most 1. Give exactly one of ``courant``, ``step`` and ``steps``.
    step : float
        Time step (s). The run has equal steps of at most about this length and ends at T exactly.
    steps : (n,) floats
        Time steps (s), one by one. Steps that change so that they amplify vibrations a thousand times are refused.
    longest : float
        The latest end (s); required with ``end="rebound"``, and for this only.
    after : float, optional
        With ``end="rebound"``, how long the run goes on after the last contact (s); by default twice the time of a wave along the
        diagonal of the mesh.
    store : str or path, optional
        A file, such as ``"block.vtkhdf"``, to which the steps are written during the run; they are then not kept in memory.
        See ``docs/history.md``. Disk space for the complete file is allocated at the start.
    every : int, optional
        With ``store``: the file keeps every k-th step, and the last. Estimate, balance and contact results need all steps.
    times : (n,) floats, optional
        Instead of ``every``: the file keeps the steps nearest to these times (s), the first and the last.
    fields : list of str, optional
        With ``store``: the fields in the file, out of ``"displacement"`` (always kept), ``"velocity"``, ``"acceleration"`` and
        ``"reaction"``. By default all four if steps are left out, else displacement and reaction.
    overwrite : bool, default: False
        Whether a file that exists already is replaced.
    long : bool, default: False
        Whether a run of more than 1e10 elements times steps is allowed, which takes minutes to hours.
    progress : bool or callable, optional
        With True, progress is shown on a terminal or in a notebook. A function is called with a `Progress` about twenty
        times a second; an exception that it raises stops the run.

    Returns
    -------
    History

    Warns
    -----
    InputWarning
        The input is possible but probably a mistake: mixed units, a body that never touches, a run that needs more memory
        than is free, steps that change so that they amplify vibrations; or contact does not end before ``longest``.
    SimulationWarning
        The energy balance is off by more than 10 %.

    Raises
    ------
    InputError
        An argument is wrong; the start is too near to a plane, or the run is long without ``long``.
    SimulationError
        The run became unstable.
    ExistingFileError, StorageError
        The file exists already or cannot be written; the steps before that are in it.
    KeyboardInterrupt
        After Ctrl-C, and with ``store`` after the file is closed and complete. Like any exception that stops the run, it has the
        steps done as its ``history``; None before the first.
    """
    problem = with_planes_moved(instance("problem", problem, Problem), courant, step, steps)
    file = None if store is None else vtkhdf("store", store)
    keep = storage(every, times, fields, file)
    replace = flag("overwrite", overwrite)
    grid = instants_of(problem, end, courant, step, steps, longest, after, long, progress)
    _percute.check_run(problem._data, grid, flag("long", long))
    warn(_percute.plausibility_warnings(problem._data, grid, file is None))
    with file_closed_at_signals(file), shown(progress) as tell, history_done(problem):
        data, drift = _percute.simulate(problem._data, grid, absolute(file), keep, replace, tell)
    warn([] if drift is None else [drift], SimulationWarning)
    return History._of(data, problem, "" if file is None else encodable(file))


def with_planes_moved(problem: Problem, courant: float | None, step: float | None, steps: ArrayLike | None) -> Problem:
    """Give the problem with planes moved away on which a body starts and into which it moves."""
    _, ratio, length, lengths = times_of(None, courant, step, steps)
    moved = problem._data.with_planes_moved(ratio, length, lengths)
    return problem if moved is None else Problem._of(moved)


def instants_of(
    problem: Problem,
    end: object,
    courant: float | None,
    step: float | None,
    steps: ArrayLike | None,
    longest: float | None,
    after: float | None,
    long: bool,
    progress: ProgressOption,
) -> _percute._Times:
    """Check the end and the steps of a run; the end of one that ends with the rebound is looked for."""
    if isinstance(end, str) and end == "rebound":
        if longest is not None and steps is None:
            _percute.check_run(problem._data, times_of(longest, courant, step, steps), flag("long", long))
        end = _rebound_end(problem, times_of(None, courant, step, steps), longest, after, progress)
    elif longest is not None or after is not None:
        raise InputError('`longest` and `after` need end="rebound"; leave them out')
    return times_of(end, courant, step, steps)


def _rebound_end(problem: Problem, times: _percute._Times, longest: float | None, after: float | None, progress: ProgressOption) -> float:
    """Find the end of a run that ends with the rebound (s)."""
    _, courant, step, steps = times
    if steps is not None or (courant is None) == (step is None):
        raise InputError('end="rebound" needs exactly one of `courant` (0 to 1) and `step` (s)')
    if longest is None:
        raise InputError('end="rebound" needs `longest`: the latest end (s)')
    latest, later = optional_number("longest", longest), optional_number("after", after)
    if later is not None and later <= 0.0:
        raise InputError(f"`after` is {later:g} s; it must be positive")
    assert latest is not None
    with shown(progress) as tell:
        end, warning = _percute.rebound_end(problem._data, (courant, step), latest, later, tell)
    warn([] if warning is None else [warning])
    return end


def true_errors(
    histories: Iterable[History],
    problem: Problem,
    *,
    end: float | None = None,
    courant: float | None = None,
    step: float | None = None,
    steps: ArrayLike | None = None,
    nested: bool = True,
    progress: ProgressOption = None,
) -> list[TrueError]:
    """Simulate a problem on a fine mesh and give the true errors of histories of coarser ones against it.

    It gives what `History.error` gives for each, without keeping the steps of the reference.

    Parameters
    ----------
    histories : iterable of History
        Simulations of the same problem on meshes that are nested in that of ``problem``.
    problem : Problem
        The reference.
    end, courant, step, steps, progress
        As for `simulate`.
    nested : bool, default: True
        Whether the meshes must be nested, as for `History.error`.

    Returns
    -------
    list of percute.TrueError

    Warns
    -----
    InputWarning, SimulationWarning
        As `simulate` does, of the reference.

    Raises
    ------
    InputError
        An argument is wrong, ``problem`` is another one than that of a history, the meshes are not nested or, with
        ``nested=False``, not of the same bodies, or the reference ends too early.
    SimulationError
        The reference is unstable.
    """
    coarse = [history._data for history in items("histories", histories, History)]
    times, reference = times_of(end, courant, step, steps), instance("problem", problem, Problem)._data
    within = flag("nested", nested)
    _percute.check_run(reference, times, True)
    warn(_percute.plausibility_warnings(reference, times, False))
    with shown(progress) as tell:
        found, drift = _percute.errors_against_simulation(coarse, reference, times, within, tell)
    warn([] if drift is None else [drift], SimulationWarning)
    return true_errors_of(found, within)


def absolute(file: str | os.PathLike[str] | None) -> str | None:
    """Give a name that stays valid when the working directory changes."""
    return None if file is None else os.path.abspath(file)


def history_done(problem: Problem | None = None) -> AbstractContextManager[None]:
    """Make a `History` of the data, or of the file, that an exception has as its history; None before the first step."""

    def made(done: _percute.HistoryData | Path | History) -> History:
        if isinstance(done, Path):
            return History._at(str(done), problem, encodable(str(done)))
        return done if isinstance(done, History) else History._of(done, problem)

    return attached("history", made)
