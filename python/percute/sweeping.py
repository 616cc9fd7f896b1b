"""Sweeps: a case over values of its keys."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute import _percute, tables
from percute.checks import flag, text, whole, wrong
from percute.checks import path as file_name
from percute.errors import InputError
from percute.files import read_case
from percute.pictures import sweep as pictures
from percute.progress import Progress, ProgressOption, shown
from percute.words import counted

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray
    from distributed import Client
    from matplotlib.axes import Axes

__all__ = ["Sweep", "sweep"]

STAGE = "running cases"


class Sweep:
    """The cases of a sweep and their results, as far as they are done.

    ``sweep["relative_mean"]`` is a column of its table: an entry for each case, NaN (in texts: an empty one) where there is none.
    """

    _folder: Path
    _parameters: tuple[str, ...]
    _columns: dict[str, NDArray[Any]]
    _units: dict[str, str]

    def __init__(self) -> None:
        raise TypeError("use percute.sweep")

    @classmethod
    def _of(cls, folder: str, plan: _percute.SweepPlan, parameters: Sequence[str]) -> Sweep:
        self = object.__new__(cls)
        table = [(name, unit, json.loads(entries)) for name, unit, entries in plan.columns()]
        self._folder, self._parameters = Path(folder), tuple(parameters)
        self._columns = {name: _column(entries) for name, _, entries in table}
        self._units = {name: unit for name, unit, _ in table if unit}
        return self

    @property
    def folder(self) -> Path:
        """The folder of all cases; each has one of its own in it, with the name of the case."""
        return self._folder

    @property
    def cases(self) -> tuple[str, ...]:
        """The names of the cases."""
        return tuple(self._columns["case"])

    @property
    def parameters(self) -> tuple[str, ...]:
        """The keys that are varied."""
        return self._parameters

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns: case, status, the keys that are varied, and the results."""
        return tuple(self._columns)

    @property
    def units(self) -> dict[str, str]:
        """The units of the columns that have one."""
        return dict(self._units)

    @property
    def failures(self) -> dict[str, str]:
        """The reason of each case that failed, by its name."""
        reasons = zip(self.cases, self["failure"], strict=True)
        return {case: str(reason) for case, reason in reasons if reason}

    def __len__(self) -> int:
        return len(self.cases)

    def __getitem__(self, column: str) -> NDArray[Any]:
        if text("column", column) not in self._columns:
            known = ", ".join(self._columns)
            raise InputError(f"the table has no column `{column}`{_percute.hint(column, list(self._columns)) or f'; it has {known}'}")
        return self._columns[column]

    def document(self, case: str) -> dict[str, Any]:
        """Give the JSON document of a case that is done, as ``percute run --json`` prints it.

        Raises
        ------
        InputError
            There is no such case, or it is not done.
        """
        if text("case", case) not in self.cases:
            raise InputError(f"the sweep has no case `{case}`{_percute.hint(case, list(self.cases))}")
        status = self["status"][self.cases.index(case)]
        if status != "done":
            raise InputError(f"the case `{case}` is not done: it is {status}")
        document: dict[str, Any] = json.loads((self.folder / case / "result.json").read_text(encoding="utf-8"))
        return document

    def to_pandas(self) -> _pandas.DataFrame:
        """Make a table with one row for each case (extra ``pandas``); ``attrs["units"]`` has the units of the columns.

        ``to_parquet`` and ``to_csv`` of pandas write it to files.
        """
        table = tables.pandas().DataFrame({name: values for name, values in self._columns.items() if name != "case"}, index=list(self.cases))
        table.index.name = "case"
        table.attrs["units"] = self.units
        return table

    def to_xarray(self) -> xarray.Dataset:
        """Make a data set (extra ``xarray``): over the keys that are varied if there is a case for each combination, else over ``case``."""
        library = tables.xarray()
        results = {name: values for name, values in self._columns.items() if name not in self._parameters}
        axes = self._axes()
        if axes is None:
            data = {name: ("case", values) for name, values in self._columns.items() if name != "case"}
            found: xarray.Dataset = library.Dataset(data, coords={"case": list(self.cases)})
        else:
            # The row of each combination.
            places = [np.searchsorted(values, self[key]) for key, values in axes.items()]
            order = np.empty(tuple(len(values) for values in axes.values()), np.int64)
            order[tuple(places)] = np.arange(len(self))
            found = library.Dataset({name: (tuple(axes), values[order]) for name, values in results.items()}, coords=axes)
        for name, unit in self._units.items():
            found[name].attrs["units"] = unit
        return found

    def _axes(self) -> dict[str, NDArray[Any]] | None:
        """Give the values of each key, ascending, if each combination of them is a case."""
        axes = {key: np.unique(self[key]) for key in self._parameters}
        rows = set(zip(*(self[key] for key in self._parameters), strict=True))
        return axes if len(rows) == len(self) == np.prod([len(values) for values in axes.values()]) else None

    def plot(
        self,
        quantity: str = "relative_mean",
        *,
        over: str | Sequence[str] | None = None,
        where: Mapping[str, object] | None = None,
        axes: Axes | None = None,
        save: str | os.PathLike[str] | None = None,
        overwrite: bool = False,
    ) -> Axes:
        """Draw a column over one key, or over two.

        Parameters
        ----------
        quantity : str, default: "relative_mean"
            A column of numbers.
        over : str or two of them, optional
            One key gives a curve, two give a map with the first to the right; by default the keys that are varied.
        where : dict, optional
            Values of other keys: only cases with these are drawn.
        axes, save, overwrite
            As for `History.plot_energies`.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        InputError
            A column or key that is not there or has no numbers, or several cases at one place.
        """
        return pictures.plot(self.__getitem__, self._parameters, self._units.get(quantity), quantity, over, where, axes, save, overwrite)

    def __repr__(self) -> str:
        status = list(self["status"])
        numbers = ", ".join(f"{status.count(kind)} {kind}" for kind in ("done", "failed", "open") if kind in status)
        return f"<percute.Sweep: {counted(len(self), 'case')} over {', '.join(self._parameters)}; {numbers}>"


def sweep(
    case: str | os.PathLike[str],
    parameters: Mapping[str, Sequence[object]] | Sequence[Mapping[str, object]] | _pandas.DataFrame,
    *,
    folder: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    threads: int = 1,
    client: Client | None = None,
    overwrite: bool = False,
    long: bool = False,
    progress: ProgressOption = None,
) -> Sweep:
    """Run a case over values of its keys, each in a process and a folder of its own, like ``percute sweep``.

    A case is done if its folder has its text and the document of this version of percute. Such cases are not run again, so that the same
    call goes on after an interruption. Results of another case file or version stay, unless ``overwrite`` is true. The results are bitwise
    those of single runs.

    Parameters
    ----------
    case : str or path
        Name of the case file that is varied.
    parameters : dict of lists, or list of dicts, or pandas.DataFrame
        Values of keys, as in ``{"mesh.rectangle.nx": [10, 20], "obstacle.0.friction": [0.0, 0.3]}``: all combinations of the lists are
        cases, the last key fastest. Or one dict, or one row, for each case. Names of files are relative to the case file.
    folder : str or path, optional
        The folder of all cases; by default named after the case, in the working directory.
    jobs : int, optional
        How many processes run at a time; by default one for each core.
    threads : int, default: 1
        How many threads each process uses; the results do not depend on it.
    client : distributed.Client, optional
        A client of Dask, whose workers run the cases (extra ``sweep``). All of them must see ``folder`` and the files of the case. A case whose
        worker is lost is run again by another.
    overwrite : bool, default: False
        Whether all cases are run and replace what is in their folders.
    long : bool, default: False
        As for `simulate`.
    progress : bool or callable, optional
        As for `simulate`, with the number of cases.

    Returns
    -------
    Sweep
        A case that fails does not stop the others; its reason is in ``failures``.

    Raises
    ------
    InputError
        A key that the case does not have, no value, or a mistake in the first case.
    ExistingFileError
        There are results of another case file or another version of percute in the folder.
    MissingFileError, StorageError
        The case cannot be read, or the folder cannot be written.
    KeyboardInterrupt
        The processes have been stopped; what is done stays.
    """
    _, _, file = read_case(case)
    if file is None:
        raise InputError("`case` is the text of a case; a sweep needs the name of a case file")
    place = os.path.abspath(f"{Path(file).stem}-sweep" if folder is None else file_name("folder", folder))
    parts = _parts(parameters)
    count = None if jobs is None else whole("jobs", jobs)
    way = (_command(), count, whole("threads", threads, most=_percute.MOST_THREADS), flag("long", long), flag("overwrite", overwrite))
    plan = _percute.SweepPlan(os.path.abspath(file), place, [(keys, json.dumps(rows)) for keys, rows in parts], way[3])
    if client is not None and not way[4]:
        plan.keep_results()
    with shown(progress) as tell:
        if client is None:
            plan.run([name for name, _ in plan.cases()], way, tell)
        else:
            _on_workers(client, place, plan.cases(), way, tell)
    plan.write()
    return Sweep._of(place, plan, [key for keys, _ in parts for key in keys])


def _command() -> list[str]:
    """Give the command of this Python's percute."""
    return [sys.executable, "-m", "percute"]


def _on_workers(
    client: Any, folder: str, cases: list[tuple[str, str]], way: _percute._Way, tell: Callable[[Progress], object] | None
) -> None:
    """Run cases on the workers of Dask."""
    try:
        from distributed import as_completed
    except ImportError as error:
        raise InputError('`client` needs Dask: pip install "percute[sweep]", or pip install distributed') from error
    names, texts = zip(*cases, strict=True)
    # Whether a case is done depends on the folder, not on the arguments alone.
    futures = client.map(_run_case, [folder] * len(cases), names, texts, [way[2:]] * len(cases), pure=False)
    try:
        for done, future in enumerate(as_completed(futures), 1):  # type: ignore[no-untyped-call]
            # A case whose workers were all lost stays open.
            if future.status == "error" and not _is_lost(future.exception()):
                future.result()
            if tell is not None:
                tell(Progress(STAGE, done, len(cases)))
    finally:
        client.cancel([future for future in futures if not future.done()])


def _is_lost(error: BaseException) -> bool:
    from distributed.scheduler import KilledWorker

    return isinstance(error, KilledWorker)


def _run_case(folder: str, name: str, content: str, rest: tuple[int, bool, bool]) -> None:
    """Run one case, in a process that is started here."""
    _percute.sweep_case(folder, name, content, (_command(), 1, *rest))


def _parts(parameters: object) -> list[tuple[list[str], list[list[object]]]]:
    """Give lists of keys, each with rows of values."""
    if hasattr(parameters, "to_dict"):
        parameters = parameters.to_dict("records")
    if isinstance(parameters, Mapping):
        parts = [([_key(key)], [[_plain(key, value)] for value in _list(key, values)]) for key, values in parameters.items()]
    elif isinstance(parameters, Sequence) and not isinstance(parameters, str) and all(isinstance(row, Mapping) for row in parameters):
        keys = [_key(key) for key in parameters[0]] if parameters else []
        for i, row in enumerate(parameters):
            if set(row) != set(keys):
                raise InputError(f"`parameters`: entry {i} has the keys {', '.join(map(str, row))}, but the first has {', '.join(keys)}")
        parts = [(keys, [[_plain(key, row[key]) for key in keys] for row in parameters])]
    else:
        raise wrong("parameters", parameters, "a dict with a list of values for each key, or a list of dicts")
    if not any(keys for keys, _ in parts):
        raise InputError("`parameters` names no key; give values, as in {'obstacle.0.friction': [0.0, 0.3]}")
    return parts


def _key(key: object) -> str:
    return text("a key in `parameters`", key)


def _list(key: str, values: object) -> list[object]:
    if isinstance(values, np.ndarray):
        return list(values)
    if isinstance(values, Sequence) and not isinstance(values, str | bytes):
        return list(values)
    raise InputError(f"`parameters`: `{key}` is {values!r}; it must be a list of values, as in [0.0, 0.3]")


def _plain(key: str, value: object) -> object:
    """Give a value of a case as JSON has it."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, float) and not np.isfinite(value):
        raise InputError(f"`parameters`: `{key}` has the value {value}; numbers must be finite")
    if isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, list | tuple):
        return [_plain(key, each) for each in value]
    raise InputError(f"`parameters`: `{key}` has the value {value!r}; a case holds numbers, texts, True, False and lists of these")


def _column(entries: list[Any]) -> NDArray[Any]:
    """Give numbers as such, NaN where there is none, and anything else as texts."""
    numbers = [entry for entry in entries if entry is not None]
    if numbers and all(isinstance(entry, int | float) and not isinstance(entry, bool) for entry in numbers):
        whole_numbers = len(numbers) == len(entries) and all(isinstance(entry, int) for entry in numbers)
        column = np.array([np.nan if entry is None else entry for entry in entries], np.int64 if whole_numbers else np.float64)
    else:
        column = np.array(["" if entry is None else str(entry) for entry in entries], object)
    column.flags.writeable = False
    return column
