"""Animations of fields: GIF through Pillow, MP4 through ffmpeg."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from percute.checks import encodable, number, whole, wrong
from percute.errors import PercuteError, StorageError
from percute.pictures.body import SLIM
from percute.pictures.canvas import SIGNED, Floats, pyplot, replacing, writable, writing
from percute.field_pictures import draw_field, field
from percute.progress import Progress, ProgressOption, shown
from percute.pictures.surface import view
from percute.steps import Steps

if TYPE_CHECKING:
    from matplotlib.animation import AbstractMovieWriter
    from matplotlib.figure import Figure

ENDINGS = (".gif", ".mp4")
DOTS = 100
"""Dots per inch: 640 pixels in width."""
MOST_FRAMES = 10_000


def animate(
    history: Steps,
    path: object,
    quantity: object,
    frames: object,
    rate: object,
    scale: object,
    overwrite: object,
    progress: ProgressOption,
) -> None:
    """Write a field on the moving body at evenly spaced steps."""
    plt = pyplot()
    if path is None:
        raise wrong("path", path, "the name of a file that ends in .gif or .mp4")
    file = writable("path", path, overwrite, ENDINGS)
    assert file is not None
    count = whole("frames", frames, least=2, most=MOST_FRAMES)
    per_second, factor = number("rate", rate, finite=True), number("scale", scale, finite=True)
    if not 0.1 <= per_second <= 100.0:
        raise wrong("rate", rate, "from 0.1 to 100 frames per second")
    name = ("stress" if history.problem.mesh.dimension == 1 else "von_mises") if quantity is None else quantity
    steps = np.unique(np.linspace(0, len(history) - 1, min(count, len(history))).round().astype(np.intp)).tolist()
    field(history, name, 0)  # Raises an error for an unknown quantity.
    writer = _writer(plt, os.path.splitext(file)[1].lower(), per_second)
    with shown(progress) as tell, replacing(file) as temporary, _interrupts() as check:
        span, extent = _span(history, name, steps, factor)
        figure = _figure(history, extent)
        with writing(file):
            writer.setup(figure, temporary, DOTS)
        try:
            for done, step in enumerate(steps):
                figure.clear()
                draw_field(figure.add_subplot(), history, step, factor, field(history, name, step), span, extent)
                with writing(file):
                    writer.grab_frame()
                if tell is not None:
                    tell(Progress("animating", done + 1, len(steps)))
                check()
            _finish(writer, file)
            check()
        except BaseException:
            with suppress(Exception):
                writer.finish()
            # Ctrl-C ends ffmpeg, too: its broken pipe is not the cause.
            check()
            raise


@contextmanager
def _interrupts() -> Iterator[Callable[[], None]]:
    """Keep Ctrl-C for a function that is called after each frame: within matplotlib, its exception could be lost."""
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield lambda: None
        return
    asked: list[int] = []

    def check() -> None:
        if asked:
            raise KeyboardInterrupt

    signal.signal(signal.SIGINT, lambda number, _: asked.append(number))
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _finish(writer: AbstractMovieWriter, file: str) -> None:
    """Write the rest of an animation."""
    try:
        with writing(file):
            writer.finish()
    except subprocess.CalledProcessError as error:
        raise StorageError(f"{encodable(file)}: ffmpeg cannot write it: exit code {error.returncode}; write a .gif instead") from error


def _figure(history: Steps, extent: Floats) -> Figure:
    """Make a figure that no window or notebook shows, lower for a slim body."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    sides = np.ptp(extent, axis=0)
    slim = history.problem.mesh.dimension == 2 and sides[1] < SLIM * sides[0]
    # An even number of pixels, which .mp4 needs.
    height = round(50 * (2.2 + 6.0 * sides[1] / sides[0])) / 50 if slim else 4.8
    figure = Figure(figsize=(6.4, height), dpi=DOTS, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _writer(plt: Any, ending: str, rate: float) -> AbstractMovieWriter:
    """Give the writer of a kind of file."""
    from matplotlib import animation

    if ending == ".gif":
        return animation.PillowWriter(fps=rate)  # type: ignore[arg-type]
    if not animation.FFMpegWriter.isAvailable():
        raise PercuteError("an .mp4 needs the program ffmpeg, which is not installed; install it, or write a .gif")
    # Even numbers of pixels and this format are those that all players show.
    return animation.FFMpegWriter(fps=rate, extra_args=["-pix_fmt", "yuv420p"])  # type: ignore[arg-type]


def _span(history: Steps, name: object, steps: list[int], scale: float) -> tuple[tuple[float, float], Floats]:
    """Give the range of the values at all instants, and the outermost places of the body."""
    low, high, colours = np.inf, -np.inf, ""
    planes = [np.asarray(plane.normal, dtype=np.float64).ravel() for plane in history.problem.obstacles]
    dimension = history.problem.mesh.dimension
    sides = np.vstack([np.eye(dimension), *([view(np.eye(3)).T] if dimension == 3 else []), *planes])
    outermost = []
    for step in steps:
        values, _, _, colours = field(history, name, step)
        low, high = min(low, float(values.min())), max(high, float(values.max()))
        places = history.problem.mesh.points + scale * history._displacement_at(np.array([step]))[0]
        along = places @ sides.T
        outermost.append(places[np.concatenate([along.argmin(axis=0), along.argmax(axis=0)])])
    if colours == SIGNED:
        low, high = -max(-low, high), max(-low, high)
    elif dimension > 1:
        low = min(0.0, low)
    if not low < high:
        low, high = low - 0.5, high + 0.5
    return (low, high), np.concatenate(outermost)
