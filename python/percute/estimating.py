"""The estimate of a history, with its options."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from percute import _percute
from percute.arrays import times
from percute.checks import flag, instance, text, warn_of_result, whole, wrong
from percute.errors import InputError
from percute.estimation import Estimate
from percute.history import History
from percute.progress import ProgressOption, shown

__all__ = ["estimate"]


def estimate(
    history: History,
    *,
    reconstruction: Literal["corrected", "consistent", "published"] | None = None,
    acceleration: Literal["closest", "rigid", "weak", "split"] | None = None,
    every: int | Literal["auto"] | None = None,
    threads: int | None = None,
    window: int | None = None,
    instants: int | ArrayLike | None = None,
    fields: bool = False,
    force: bool = False,
    progress: ProgressOption = None,
) -> Estimate:
    """Estimate the constitutive relation error of a history.

    Parameters
    ----------
    history : History
        The steps; at least two instants.
    reconstruction : {"corrected", "consistent", "published"}, optional
        How reactions become admissible contact forces: all of them, those before contact included; on the edges that touch
        throughout a step, statically equivalent; or by the paper's construction, eq. [45] to [50]. By default what the
        history's file or case states, else "corrected".
    acceleration : {"closest", "rigid", "weak", "split"}, optional
        The field that balances the tractions of an element: the one closest to the finite-element one, a rigid motion,
        the linear one that does the lumped work, or the closest one for tractions that balance less of the lumped mass,
        which needs the reconstruction "corrected". By default as stated, else "split" for plane bodies with "corrected"
        and "closest" for all others.
    every : int or "auto", optional
        The error is sampled at every so many steps, and at the end; or, with "auto", around onset, release and peaks of the contact
        force, at the ``instants`` of maps, and between them as sparsely as keeps the mean: at every step on small meshes. By default
        as stated, else "auto".
    threads : int, optional
        How many threads to use, at most 1024; one for each core by default. The result does not depend on it.
    window : int, optional
        How many sampled steps are worked on at once; more than 8 count as 8, the default. The result does not depend on it.
    instants : int or (n,) floats, optional
        Number of evenly spaced instants, or times (s), at which ``maps`` are kept: at the nearest steps. None by default.
    fields : bool, default: False
        Whether these hold the admissible fields too; it needs ``instants``.
    force : bool, default: False
        Whether a history of another program is estimated even if it contradicts itself or its problem.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    Estimate

    Warns
    -----
    InputWarning
        The last instant of a history of another program is left out, because its contact forces are not known. Or it has samples
        that are farther apart than the steps of a solver. Of a history from a file or from arrays, as for `simulate`, too.
    SimulationWarning
        The result is doubtful: the energy balance is off, no contact force acted, a field is not admissible.

    Raises
    ------
    InputError
        An argument is wrong. Or a history of another program is not consistent; the message has the likely cause.
    EstimateError
        The history cannot be estimated: fewer than two instants, or steps that do not fit the problem.
    StorageError
        The temporary file of a long flight cannot be written: no space in the folder ``TMPDIR`` or in ``/var/tmp``.
    """
    options = _options(history, reconstruction, acceleration, every)
    work = pace(threads, window)
    wanted = _wanted(instants, history)
    if flag("fields", fields) and wanted is None:
        raise InputError("`fields` needs `instants`: give the number of instants, or their times (s)")
    return _estimate(history, options, "none", work, (wanted, bool(fields), flag("force", force)), progress)


def ablated(
    history: History,
    *,
    ablation: str = "none",
    reconstruction: str | None = None,
    acceleration: str | None = None,
    every: int | None = None,
    threads: int | None = None,
    progress: ProgressOption = None,
) -> Estimate:
    """Estimate without one part of the method, for the evidence on each part; otherwise as `estimate`."""
    options = _options(history, reconstruction, acceleration, every)
    return _estimate(history, options, ablation, pace(threads, None), (None, False, False), progress)


def _options(history: History, reconstruction: str | None, acceleration: str | None, every: object) -> tuple[str, str | None, int | str]:
    """Give the options that are stated with the history where the caller gives none."""
    stated = instance("history", history, History)._data.options()
    return (
        stated[0] if reconstruction is None else text("reconstruction", reconstruction),
        stated[1] if acceleration is None else text("acceleration", acceleration),
        stated[2] if every is None else sampling(every),
    )


def _estimate(
    history: History,
    options: tuple[str, str | None, int | str],
    ablation: str,
    work: tuple[int | None, int | None],
    kept: tuple[int | list[float] | None, bool, bool],
    progress: ProgressOption,
) -> Estimate:
    """Estimate with options that have been checked."""
    reconstruction, acceleration, every = options
    instants, fields, accept = kept
    with shown(progress) as tell:
        data = _percute.estimate(history._data, reconstruction, acceleration, ablation, every, *work, instants, fields, accept, tell)
    # `simulate` has given the warnings about its problem; those about a file, or about arrays, have not been given.
    warn_of_result(data.warnings(True, history.path is not None or history._data.derived is not None))
    return Estimate._of(data, history, history._name)


def sampling(every: object) -> int | str:
    """Check at which steps the error is sampled."""
    if isinstance(every, str):
        if every != "auto":
            raise wrong("every", every, '"auto" or a whole number')
        return every
    return whole("every", every)


def pace(threads: int | None, window: int | None) -> tuple[int | None, int | None]:
    """Check threads and window."""
    return (
        None if threads is None else whole("threads", threads, most=_percute.MOST_THREADS),
        None if window is None else whole("window", window),
    )


def _wanted(instants: int | ArrayLike | None, history: History) -> int | list[float] | None:
    """Give the number of instants, or their times (s). A time may exceed the end by the digits lost in printing only."""
    if instants is None:
        return None
    if isinstance(instants, int | np.integer):
        return whole("instants", instants)
    given, end = times("instants", instants, "a number of instants, or "), float(history._data.times[-1])
    if max(given) > end * (1 + 1e-3):
        raise InputError(f"`instants` holds {max(given):g} s, but the run ends at {end:g} s; give instants before that, in seconds")
    return given
