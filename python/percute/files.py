"""Case files, and histories and estimates in files."""

from __future__ import annotations

import os
from pathlib import Path

from percute import _percute
from percute.errors import InputError, MissingFileError, StorageError
from percute.estimation import Estimate, estimate
from percute.history import simulate
from percute.problem import Problem
from percute.progress import ProgressOption

__all__ = ["run"]


def _read(case: str | os.PathLike[str]) -> tuple[str, str]:
    """Name and text of a case: a text has several lines, the name of a file has one."""
    if isinstance(case, str) and "\n" in case:
        return "case", case
    if not isinstance(case, str | os.PathLike):
        raise InputError(f"`case` is {case!r}; it must be the name of a case file, or its text")
    path = Path(case)
    try:
        return os.fspath(path), path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise MissingFileError(f"`case`: there is no file {os.fspath(path)!r}") from None
    except UnicodeDecodeError:
        raise InputError(f"`case`: {os.fspath(path)!r} is no UTF-8 text") from None
    except OSError as error:
        raise StorageError(f"`case`: cannot read {os.fspath(path)!r}: {error.strerror}") from error
