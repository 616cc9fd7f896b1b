"""Axes, units and files of pictures."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute.checks import encodable, flag, wrong
from percute.checks import path as file_name
from percute.errors import ExistingFileError, InputError, MissingFileError, PercuteError, StorageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

FIELD = "viridis"
SIGNED = "RdBu_r"
COLOURS = {
    "total": "black",
    "kinetic": "#2f79c8",
    "elastic": "#da6228",
    "strain": "#da6228",
    "contact": "#24966e",
    "dissipation": "#8a5fbf",
    "plastic_work": "#8a5fbf",
    "surface": "#2f79c8",
    "front": "#da6228",
    "dispersion": "#24966e",
    "mesh": "#9b55be",
    "work_of_loads": "#967d1e",
    "work_of_supports": "#1496af",
    "work_of_contact": "#c83c64",
    "friction": "#828791",
}
"""Colours of curves, the same in all pictures."""
ENDINGS = (".svg", ".png", ".pdf")
"""Kinds of files, by the ends of their names."""
DOTS = 150
"""Dots per inch of a .png file."""
METADATA: dict[str, dict[str, None]] = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}, ".png": {}}
"""Without dates, the same picture has the same bytes."""


def pyplot() -> Any:
    """Give matplotlib's pyplot."""
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise PercuteError('pictures need matplotlib: pip install matplotlib') from error
    return plt


def new_axes(axes: Axes | None, size: tuple[float, float] | None = None) -> Axes:
    """Give the axes of an argument, by default new ones of some size (inch)."""
    plt = pyplot()
    if axes is not None and not isinstance(axes, plt.Axes):
        raise wrong("axes", axes, "axes of matplotlib, such as `plt.subplots()[1]`")
    made: Axes = axes if axes is not None else plt.subplots(layout="constrained", figsize=size)[1]
    return made


def axes_below(axes: Sequence[Axes] | None, count: int, word: str) -> list[Axes]:
    """Give the axes of an argument, by default so many new ones, one below the other."""
    plt = pyplot()
    given = list(plt.subplots(count, 1, layout="constrained", figsize=(7.2, 8.4))[1]) if axes is None else list(np.ravel(axes))  # type: ignore[arg-type]
    if len(given) != count or not all(isinstance(each, plt.Axes) for each in given):
        raise wrong("axes", axes, f"{word} axes of matplotlib, such as `plt.subplots({count})[1]`")
    return given


def prefixed(values: Floats) -> tuple[float, str]:
    """Give a power of a thousand for readable values, and its prefix."""
    finite = np.abs(values[np.isfinite(values)])
    largest = float(finite.max(initial=0.0))
    if largest == 0.0:
        return 1.0, ""
    power = int(np.clip(np.floor(np.log10(largest) / 3), -3, 3))
    return 1000.0**power, {-3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G"}[power]


def exaggerated(scale: float) -> str:
    """Tell the factor of a displacement: in an outline, that of the deformation alone."""
    return f"displacement × {scale:.4g}" + ("" if scale == 1.0 else ", rigid motion included")


SYMBOL = re.compile(r"(?<!\w)(Δ?)([A-Za-z])(?:_([A-Za-z]+)|(?=(?:/| − )Δ?[A-Za-z]_))")
"""A letter with an index, or beside one: e_E, Δt_c, and both in Δt/Δt_c."""
POWER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d+)(?!\w)")
MINUS = re.compile(r"(?<![\w.){])-(?=\$?\d)")


def typeset(text: str) -> str:
    """Set symbols with indices, J^½, powers of ten and signs in the language of matplotlib."""

    def symbol(found: re.Match[str]) -> str:
        index = f"_{{\\mathrm{{{found[3]}}}}}" if found[3] else ""
        return f"{found[1]}${found[2]}{index}$"

    def power(found: re.Match[str]) -> str:
        base = "" if found[1] == "1" else f"{found[1]} \\times "
        return f"${base}10^{{{int(found[2])}}}$"

    return MINUS.sub("−", POWER.sub(power, SYMBOL.sub(symbol, text.replace("^½", "$^{1/2}$"))))


def writable(name: str, file: object, overwrite: object, endings: tuple[str, ...] = ENDINGS) -> str | None:
    """Check the file of a picture before anything is drawn; None without one."""
    replace = flag("overwrite", overwrite)
    if file is None:
        return None
    path = os.path.abspath(file_name(name, file))
    shown = encodable(path)
    if os.path.splitext(path)[1].lower() not in endings:
        raise InputError(f"`{name}` is {encodable(file_name(name, file))!r}; the name must end in {' or '.join(endings)}")
    folder = os.path.dirname(path)
    if not os.path.isdir(folder):
        raise MissingFileError(f"{shown}: there is no folder {encodable(folder)}; create it first, or give another name")
    if os.path.lexists(path):
        if not os.path.isfile(path):
            raise StorageError(f"{shown}: it is not a regular file")
        if not replace:
            raise ExistingFileError(f"{shown}: the file exists already; give another name, or overwrite=True")
    return path


@contextmanager
def reading(file: str) -> Iterator[None]:
    """Name the file of an error of the system."""
    try:
        yield
    except FileNotFoundError:
        raise MissingFileError(f"there is no file {file!r}") from None
    except OSError as error:
        raise StorageError(f"cannot read {file!r}: {error.strerror}") from error


@contextmanager
def writing(path: str) -> Iterator[None]:
    """Name the file of an error of the system."""
    try:
        yield
    except OSError as error:
        raise StorageError(f"{encodable(path)}: cannot be written: {error.strerror or error}") from error


@contextmanager
def replacing(path: str) -> Iterator[str]:
    """Give a name in the same folder; the file gets its own name when it is complete, and is removed otherwise."""
    ending = os.path.splitext(path)[1].lower()
    with writing(path):
        handle, temporary = tempfile.mkstemp(suffix=ending, prefix=".percute-", dir=os.path.dirname(path))
        os.close(handle)
    try:
        yield temporary
        with writing(path):
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(temporary, 0o666 & ~mask)
            os.replace(temporary, path)
    finally:
        with suppress(FileNotFoundError):
            os.remove(temporary)


def save_figure(figure: Figure, path: str | None) -> None:
    """Write a figure to a checked file; the same figure gives the same bytes."""
    if path is None:
        return
    ending = os.path.splitext(path)[1].lower()
    with replacing(path) as temporary, writing(path), pyplot().rc_context({"svg.hashsalt": "percute"}):
        figure.savefig(temporary, dpi=DOTS, metadata=METADATA[ending], bbox_inches="tight", pad_inches=0.1)


def root(axes: Axes) -> Figure:
    """Give the figure of axes."""
    figure: Any = axes.figure
    made: Figure = figure.get_figure() if hasattr(figure, "get_figure") and figure.get_figure() is not None else figure
    return made


def over_time(axes: Axes, time: Floats) -> float:
    """Prepare axes for curves over time and give the unit of time (s)."""
    seconds, prefix = prefixed(time)
    axes.set_xlabel(f"t ({prefix}s)")
    axes.margins(x=0.0)
    axes.grid(alpha=0.3)
    return seconds


def legend_beside(axes: Axes, **options: Any) -> None:
    """Put a legend on the right of the axes, where it covers no curve."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0.0, frameon=False, **options)
