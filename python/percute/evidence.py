"""Computes the evidence on the estimate again."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from percute import _percute
from percute.checks import flag, text, wrong
from percute.checks import path as file_name
from percute.estimation import pace
from percute.progress import ProgressOption, shown

__all__ = ["reproduce"]


def reproduce(
    folder: str | os.PathLike[str],
    parts: Iterable[str] | None = None,
    *,
    small: bool = False,
    overwrite: bool = False,
    threads: int | None = None,
    progress: ProgressOption = None,
) -> Path:
    """Compute the paper's tables and figures, exact solutions and effectivity indices again, like ``percute reproduce``.

    Parameters
    ----------
    folder : str or path
        The folder for the page, the figures and the numbers; it is made unless it is there.
    parts : iterable of str, optional
        Names of the parts, such as ``["table1"]``; all of them by default. ``percute reproduce --list`` prints them.
    small : bool, default: False
        Whether only some rows of each table are computed, in seconds instead of minutes; those rows are the same.
    overwrite : bool, default: False
        Whether files in a folder that is not empty are replaced.
    threads : int, optional
        As for `estimate`.
    progress : bool or callable, optional
        As for `simulate`; the stage is the name of the part, and counted in thousandths.

    Returns
    -------
    pathlib.Path
        The page, ``index.html``. Beside it are ``verification.md``, ``numbers.json``, ``figures`` and ``tables``.

    Raises
    ------
    InputError
        There is no part of a name.
    ExistingFileError, StorageError
        The folder is not empty, or cannot be written.
    KeyboardInterrupt
        The parts that were done are in the folder, with a page of their own.
    """
    name = file_name("folder", folder)
    if isinstance(parts, str) or not (parts is None or isinstance(parts, Iterable)):
        raise wrong("parts", parts, 'names of parts, such as ["table1"], or None for all')
    names = [] if parts is None else [text(f"parts[{i}]", part) for i, part in enumerate(parts)]
    if parts is not None and not names:
        raise wrong("parts", parts, 'names of parts, such as ["table1"], or None for all')
    few, replace, (threads, _) = flag("small", small), flag("overwrite", overwrite), pace(threads, None)
    with shown(progress) as tell:
        return _percute.reproduce(os.path.abspath(name), names, few, replace, threads, tell)
