"""The command ``percute plot``."""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from percute import animation_pictures
from percute.errors import ExistingFileError, FileFormatError, InputError, MissingFileError, PercuteError
from percute.estimating import estimate
from percute.estimation import Estimate
from percute.files import open as open_file
from percute.files import run
from percute.history import History
from percute.pictures import canvas
from percute.field_pictures import MOTION, SCALARS, STRESSES
from percute.progress import shown
from percute.verifying import Verification

HDF5 = b"\x89HDF\r\n\x1a\n"
"""The first bytes of histories and estimate files."""
DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

KINDS = {
    "map": "the error of each element",
    "over-time": "the error over time with its parts",
    "sources": "the error over time with its sources",
    "energies": "energies and works over time",
    "force": "the contact force over time",
    "pressure": "the contact pressure along the surface over time",
    "field": "a field on the deformed body",
    "animation": "a field on the moving body (.gif or .mp4)",
    "convergence": "errors and contact over the element size; FILE is the document of `percute verify CASE --json`, no case and no history",
}
OPTIONS = {"quantity": ("field", "animation"), "step": ("field",), "scale": ("map", "field", "animation"), "plane": ("pressure",), "frames": ("animation",)}
"""Options that belong to some kinds only."""
OF_THE_ERROR = ("map", "over-time", "sources")
WORDS = {"`save`": "--save", "`path`": "--save", "overwrite=True": "--force", "force=True": "--accept-inconsistent", "`case`: ": ""} | {f"`{name}`": f"--{name}" for name in OPTIONS}
"""Words of Python, and those of the command."""


def _parser() -> argparse.ArgumentParser:
    text = "Draw a picture: the same as from Python. A history is estimated first if the picture shows the error; a case is run."
    kinds = "\n".join(f"  {name:12} {told}" for name, told in KINDS.items())
    parser = argparse.ArgumentParser(
        "percute plot", description=text, epilog=f"kinds:\n{kinds}", allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="a history, an estimate file or a case; for --kind convergence only the document of `percute verify CASE --json` (to run a case and draw this: `percute verify CASE --picture FILE`)")
    parser.add_argument("--kind", choices=list(KINDS), default="map", metavar="KIND", help="what is drawn, see below [default: map]")
    parser.add_argument("--save", "-o", "--output", type=Path, metavar="FILE", help="the picture (.svg, .png or .pdf) [default: FILE-KIND.png in this folder]")
    quantities = [*MOTION, *SCALARS, "stress", *STRESSES]
    parser.add_argument("--quantity", choices=quantities, metavar="NAME", help=f"the field: {', '.join(quantities)} [default: von_mises, of a bar stress]")
    parser.add_argument("--step", type=int, metavar="N", help="the instant of a field; negative ones count from the end [default: -1]")
    parser.add_argument("--scale", type=float, metavar="X", help="by how much the displacement, rigid motion included, is exaggerated [default: 1; of a map 0, undeformed]")
    parser.add_argument("--plane", type=int, metavar="K", help="the plane of a pressure [default: the one with the largest force]")
    parser.add_argument("--frames", type=int, metavar="N", help="number of frames of an animation [default: 60]")
    parser.add_argument("--accept-inconsistent", action="store_true", help="estimate a history of another program although it contradicts itself or its problem")
    parser.add_argument("--force", "--overwrite", action="store_true", help="replace files that are there")
    parser.add_argument("--quiet", action="store_true", help="no progress and no warnings on standard error")
    return parser


def _subject(given: argparse.Namespace, tell: Any) -> History | Estimate:
    """Read or compute the subject of a picture."""
    file: Path = given.file
    with canvas.reading(str(file)), file.open("rb") as stream:
        binary = stream.read(len(HDF5)) == HDF5 or file.suffix.lower() == ".vtkhdf"
    found = open_file(file) if binary else run(file, overwrite=given.force, progress=tell)
    if isinstance(found, History):
        return estimate(found, force=given.accept_inconsistent, progress=tell) if given.kind in OF_THE_ERROR else found
    return found


def _verification(file: Path) -> Verification:
    """Read the document of `percute verify --json`."""
    with canvas.reading(str(file)):
        content = file.read_bytes()
    try:
        return Verification._of(json.loads(content), "")
    except (ValueError, KeyError, TypeError, IndexError, AttributeError):
        kind = "a history or an estimate file" if content.startswith(HDF5) else "a case" if file.suffix.lower() == ".toml" else "another file"
        raise InputError(
            f"{str(file)!r} is {kind}; --kind convergence draws the document of `percute verify CASE --json` and nothing else; "
            "`percute verify CASE --picture FILE` runs a case on finer meshes and draws this"
        ) from None


def _history(subject: History | Estimate) -> History:
    history = subject if isinstance(subject, History) else subject.history
    if history is None:
        raise InputError("an estimate file has no displacements; name its history or its case")
    return history


def draw(subject: History | Estimate, given: argparse.Namespace, save: Path, tell: Any) -> None:
    """Draw a picture with the methods of histories and estimates."""
    options = {name: value for name in OPTIONS if (value := getattr(given, name)) is not None}
    options |= {"save": save, "overwrite": given.force}
    if given.kind in OF_THE_ERROR:
        assert isinstance(subject, Estimate)
        if given.kind == "map":
            subject.plot_map(**options)
        else:
            subject.plot_over_time("parts" if given.kind == "over-time" else "sources", **options)
    elif given.kind == "animation":
        history = _history(subject)
        history.animate(options.pop("save"), progress=tell, **options)
    elif given.kind == "field":
        history = _history(subject)
        options.setdefault("quantity", "stress" if history.problem.mesh.dimension == 1 else "von_mises")
        history.plot(**options)
    else:
        {"energies": subject.plot_energies, "force": subject.plot_force, "pressure": subject.plot_pressure}[given.kind](**options)


def _said(error: PercuteError, file: Path) -> str:
    """Give the message of an error in the words of the command, with the file as it was named."""
    message = str(error).replace(os.path.abspath(file), str(file))
    for word, ours in WORDS.items():
        message = message.replace(word, ours)
    return message


def main(arguments: Sequence[str]) -> int:
    """Run the command with these arguments, without its name, and return its exit code."""
    parser = _parser()
    given = parser.parse_args(arguments)
    for name, kinds in OPTIONS.items():
        if getattr(given, name) is not None and given.kind not in kinds:
            parser.error(f"--{name} belongs to --kind {' or '.join(kinds)}, not to {given.kind}")
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name) and signal.getsignal(getattr(signal, name)) == signal.SIG_DFL:
            signal.signal(getattr(signal, name), signal.default_int_handler)
    moves = given.kind == "animation"
    save = given.save or Path(f"{given.file.stem}-{given.kind}{'.gif' if moves else '.png'}")
    try:
        canvas.pyplot().switch_backend("Agg")
        canvas.writable("save", save, given.force, animation_pictures.ENDINGS if moves else canvas.ENDINGS)
        with warnings.catch_warnings(), shown(not given.quiet) as tell:
            warnings.simplefilter("ignore" if given.quiet else "always")
            warnings.showwarning = lambda message, *_, **__: print(f"warning: {message}", file=sys.stderr)
            if given.kind == "convergence":
                _verification(given.file).plot(save=save, overwrite=given.force)
            else:
                draw(_subject(given, tell), given, save, tell)
    except KeyboardInterrupt:
        print("interrupted: no picture", file=sys.stderr)
        return INTERRUPTED
    except PercuteError as error:
        print(f"error: {_said(error, given.file)}", file=sys.stderr)
        return BAD_INPUT if isinstance(error, ExistingFileError | FileFormatError | InputError | MissingFileError) else FAILED
    try:
        print(save, flush=True)
    except OSError as error:
        # What could not be written would be written again at the end of the process.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            print(f"error: cannot write the result: {error.strerror}", file=sys.stderr)
        return FAILED
    return DONE
