"""Case files, and histories and estimates in files."""

from __future__ import annotations

import difflib
import os
import stat
from pathlib import Path

from percute import _percute
from percute.attached import attached
from percute.checks import encodable, flag, text, warn, warn_of_result, wrong
from percute.checks import path as file_name
from percute.errors import InputError, MissingFileError, SimulationWarning, StorageError
from percute.estimating import pace
from percute.estimation import Estimate
from percute.history import History
from percute.mesh_files import tell_of_mesh
from percute.progress import ProgressOption, shown
from percute.simulation import absolute, history_done
from percute.stored import StoredEstimate
from percute.termination import file_closed_at_signals

__all__ = ["open", "resume", "run"]


def open(path: str | os.PathLike[str]) -> History | Estimate:
    """Open a history or an estimate.

    Parameters
    ----------
    path : str or path
        A history file, of percute or of another program that follows ``docs/history.md``; or an estimate file.

    Returns
    -------
    History or Estimate
        What the file holds. The arrays of a history are views of the file, which must not change as long as they are in use.

    Raises
    ------
    MissingFileError
        There is no such file.
    FileFormatError
        The file is neither a history nor an estimate, is damaged or inconsistent, or has another layout.
    StorageError
        It cannot be read, or another program is writing it.
    """
    given = file_name("path", path)
    file = os.path.abspath(given)
    if _percute.is_estimate(file):
        return Estimate._of(StoredEstimate(file), None, encodable(given))
    return History._of(_percute.open_history(file), name=encodable(given))


def resume(path: str | os.PathLike[str], *, progress: ProgressOption = None) -> History:
    """Let the simulation of a history go on, after it was killed or stopped.

    It goes on from the newest checkpoint in the file, at most 64 steps before its end. The file then is, byte by byte, that of a
    simulation that was not interrupted. A history that holds all its steps is opened.

    Parameters
    ----------
    path : str or path
        The history file of a simulation or a run, thinned or not.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    History
        As `open` gives it; `estimate` takes it.

    Warns
    -----
    SimulationWarning
        As for `simulate`.

    Raises
    ------
    MissingFileError, FileFormatError
        As for `open`. Or another program, version or machine wrote the file, whose numbers may differ.
    StorageError
        The file cannot be written, or another process is writing it.
    SimulationError, KeyboardInterrupt
        As for `simulate`.
    """
    given = file_name("path", path)
    file = os.path.abspath(given)
    with file_closed_at_signals(file), shown(progress) as tell, history_done():
        data, drift = _percute.resume(file, tell)
    warn([] if drift is None else [drift], SimulationWarning)
    return History._of(data, name=encodable(given))


def run(
    case: str | os.PathLike[str],
    *,
    store: str | os.PathLike[str] | None = None,
    overwrite: bool = False,
    long: bool = False,
    threads: int | None = None,
    window: int | None = None,
    progress: ProgressOption = None,
) -> Estimate:
    """Run a case: simulate it and estimate the error, like ``percute run``.

    Parameters
    ----------
    case : str or path
        Name of a case file, or the text of a case (several lines of TOML).
    store : str or path, optional
        A file for the history; by default the one that the case names in ``[output]``, else it is kept in memory.
    overwrite : bool, default: False
        Whether a file that exists already is replaced.
    long : bool, default: False
        As for `simulate`.
    threads, window : int, optional
        As for `estimate`.
    progress : bool or callable, optional
        As for `simulate`.

    Returns
    -------
    Estimate
        With the simulation as its ``history``. An estimate file that the case names in ``[output]`` is written too.

    Warns
    -----
    InputWarning
        As for `simulate`, with the line.
    SimulationWarning
        As for `estimate`.

    Raises
    ------
    InputError
        The case is wrong; the message has the line. Or two of its files and the case are one.
    ExistingFileError, MissingFileError, StorageError
        A file exists already; the case cannot be read, or the files of history and estimate cannot be written. All of them are
        checked before any work. Or the temporary file of the estimate cannot be written, as for `estimate`. If the file of the history
        was moved or removed during the run, the `StorageError` has the ``estimate``.
    SimulationError, EstimateError, KeyboardInterrupt
        As for `simulate` and `estimate`.
    """
    told = None if store is None else file_name("store", store)
    replace, lasting, (threads, window) = flag("overwrite", overwrite), flag("long", long), pace(threads, window)
    with shown(progress) as tell, history_done():
        name, content, source = read_case(case)
        read = _percute.CaseData(name, content, os.path.dirname(source or ""))
        tell_of_mesh(read.import_warnings())
        asked = read.outputs(source, told, replace)
        read.check_run(lasting)
        # The working directory may change in a callback.
        file, report = absolute(asked["history"]), absolute(asked["estimate"])
        warn(read.plausibility_warnings(file is None))
        # Only an estimate file needs maps.
        instants, fields = (asked["instants"], asked["fields"]) if report is not None else (None, False)
        read, told_late = read.resolved(tell)
        warn([] if told_late is None else [told_late])
        with file_closed_at_signals(file), attached("estimate", lambda data: Estimate._of(data, None, name)):
            data = _percute.run_case(read, file, replace, (threads, window), instants, fields, report is not None, tell)
        warn_of_result(data[1].warnings(False, False))
        history = History._of(data[0], name=name)
        estimated = Estimate._of(data[1], history, name)
        try:
            if report is not None:
                estimated.save(report, overwrite=replace)
            return estimated
        except BaseException as error:
            error.history = history  # type: ignore[attr-defined]
            raise


def read_case(case: str | os.PathLike[str]) -> tuple[str, str, str | None]:
    """Name, text and file of a case: a text has several lines, the name of a file has one."""
    if isinstance(case, str) and "\n" in case:
        return "case", text("case", case), None
    if not isinstance(case, str | os.PathLike):
        raise wrong("case", case, "the name of a case file, or its text")
    path = Path(file_name("case", case))
    try:
        kind = path.stat().st_mode
        # A pipe that a shell has opened has a writer; another one may wait for ever.
        opened = os.fspath(path).startswith(("/dev/", "/proc/")) and stat.S_ISFIFO(kind)
        if not (stat.S_ISREG(kind) or stat.S_ISDIR(kind) or opened):
            raise StorageError(f"`case`: {os.fspath(path)!r} is a pipe or a device; name a case file")
        content = path.read_bytes()
        if (told := _percute.stranger(os.fspath(path), content)) is not None:
            raise InputError(f"`case`: {os.fspath(path)!r}: {told}")
        return encodable(os.fspath(path)), content.decode().replace("\r\n", "\n"), os.fspath(path)
    except FileNotFoundError:
        raise MissingFileError(f"`case`: there is no file {os.fspath(path)!r}{_similar(path)}") from None
    except IsADirectoryError:
        raise StorageError(f"`case`: {os.fspath(path)!r} is a folder; name a case file in it") from None
    except UnicodeDecodeError:
        raise InputError(f"`case`: {os.fspath(path)!r} is not UTF-8 text") from None
    except OSError as error:
        raise StorageError(f"`case`: cannot read {os.fspath(path)!r}: {error.strerror}") from error


def _similar(path: Path) -> str:
    """Suggest a file of the same folder with a similar name."""
    try:
        names = difflib.get_close_matches(path.name, os.listdir(path.parent), 1)
    except OSError:
        names = []
    return f"; did you mean {names[0]!r}?" if names else ""
