"""Computes the evidence on the estimate again."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from percute.checks import flag, text, wrong
from percute.checks import path as file_name
from percute.estimating import pace
from percute.progress import ProgressOption, shown

__all__ = ["reproduce"]


def reproduce(
    folder: str | os.PathLike[str],
    studies: Iterable[str] | None = None,
    *,
    small: bool = False,
    overwrite: bool = False,
    threads: int | None = None,
    progress: ProgressOption = None,
) -> Path:
    """Compute the paper's tables and figures, exact solutions and effectivity indices again, like ``percute reproduce``.

    Figures need matplotlib (the extra ``plot``).

    Parameters
    ----------
    folder : str or path
        The folder for the page, the figures and the numbers; it is made unless it is there.
    studies : iterable of str, optional
        Names of the studies, such as ``["table1"]``; all of them by default. ``percute reproduce --list`` prints them.
    small : bool, default: False
        Whether only some rows of each table are computed, in seconds instead of minutes; those rows are the same.
    overwrite : bool, default: False
        Whether files in a folder that is not empty are replaced.
    threads : int, optional
        How many runs are computed at once, at most 1024; one for each core by default. No number depends on it.
    progress : bool or callable, optional
        As for `simulate`; the stage is the name of the study, and runs are counted.

    Returns
    -------
    pathlib.Path
        The page, ``index.html``. Beside it are ``verification.md``, ``numbers.json``, ``figures`` and ``tables``.

    Raises
    ------
    InputError
        There is no study of a name.
    PercuteError
        There is no matplotlib.
    ExistingFileError, StorageError
        The folder is not empty, or cannot be written.
    KeyboardInterrupt
        The finished studies are in the folder, with a page of their own.
    """
    from percute.verification.parallel import Resolution
    from percute.verification.studies import chosen, run

    place = Path(os.path.abspath(file_name("folder", folder)))
    allowed = 'names of studies, such as ["table1"], or None for all'
    if isinstance(studies, str) or not (studies is None or isinstance(studies, Iterable)):
        raise wrong("studies", studies, allowed)
    names = [] if studies is None else [text(f"studies[{i}]", study) for i, study in enumerate(studies)]
    if studies is not None and not names:
        raise wrong("studies", studies, allowed)
    few, replace, (threads, _) = flag("small", small), flag("overwrite", overwrite), pace(threads, None)
    with shown(progress) as tell:
        return run(place, chosen(names), Resolution(few, threads, tell=tell), replace)
