"""The studies in the order of the page, and their folder."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import partial
from importlib import import_module
from pathlib import Path

from percute.errors import ExistingFileError, InputError, InputWarning, SimulationWarning, StorageError
from studies import page
from studies.page import Section
from studies.parallel import Resolution

PAGES = ("index.html", "verification.md", "numbers.json")


@dataclass(frozen=True)
class Study:
    """One part of the evidence."""

    key: str
    """Its name on the command line."""
    title: str
    """Its subject, in a line."""
    module: str
    """The module of this package whose ``compute(section, resolution)`` fills its section."""

    def compute(self, resolution: Resolution) -> Section:
        """Compute it."""
        section = Section(self.key, self.title)
        fill: Callable[[Section, Resolution], None] = import_module(f"studies.{self.module}").compute
        fill(section, replace(resolution, stage=self.key))
        return section


STUDIES: tuple[Study, ...] = (
    Study("effectivity", "How close the estimate is to the true error in 2D", "effectivity"),
    Study("speeds", "Corners, curves and inclined sides at practical speeds", "speeds"),
    Study("sources", "The sources of the error, and what a finer mesh or shorter steps change", "sources"),
    Study("adaptation", "Meshes for a wanted accuracy", "adaptation"),
    Study("ablation", "The purpose of each part of the default, and alternatives that failed", "ablation"),
    Study("bar-maps", "The paper's figures 5 and 6: the impact of a bar", "bar_maps"),
    Study("table1", "The paper's table 1: a block with friction", "table1"),
    Study("stress-maps", "The paper's figures 8 and 9: stresses and their error", "stress_maps"),
    Study("time-steps", "The paper's figure 10: the error and the time step", "time_steps"),
    Study("benchmarks", "Exact and published cases, and how the simulation converges to them", "benchmarks"),
    Study("bar-rows", "Bars that strike each other, against the exact solution", "bar_rows"),
    Study("finite-exact", "Large strains and rotations, against exact solutions", "finite_exact"),
)


def chosen(names: Sequence[str]) -> list[Study]:
    """Give the studies of these names in the order of the page; all of them if none is named."""
    known = [study.key for study in STUDIES]
    for name in names:
        if name not in known:
            close = get_close_matches(name, known, 1)
            hint = f"; did you mean `{close[0]}`?" if close else ""
            raise InputError(f'`studies`: there is no study "{name}"; the studies are {", ".join(known)}{hint}')
    return [study for study in STUDIES if not names or study.key in names]


def prepare(folder: Path, overwrite: bool) -> None:
    """Make the folder, or see that it may be used."""
    for place in (folder, folder / "figures", folder / "tables"):
        if place.exists() and not place.is_dir():
            raise StorageError(f"`folder`: cannot write {place}: it is not a folder")
    if not folder.parent.is_dir():
        raise StorageError(f"`folder`: cannot write {folder}: there is no folder {folder.parent}; create it first, or give another name")
    try:
        folder.mkdir(exist_ok=True)
        used = any(folder.iterdir())
        for name in PAGES if overwrite or not used else ():
            kept = (folder / name).exists()
            (folder / name).open("a").close()
            if not kept:
                (folder / name).unlink()
    except OSError as error:
        raise StorageError(f"cannot write {error.filename or folder}: {error.strerror}") from error
    if used and not overwrite:
        raise ExistingFileError(f"`folder`: the folder {folder} is not empty; give another name, or overwrite=True")


def run(
    folder: Path,
    studies: Iterable[Study],
    resolution: Resolution,
    overwrite: bool,
    done: Callable[[Study], object] = lambda study: None,
) -> Path:
    """Compute studies and write their folder after each, so that finished studies are never lost; give the page."""
    # Without matplotlib the import raises an error.
    figures = import_module("studies.figures")
    prepare(folder, overwrite)
    sections: list[Section] = []
    svg: dict[str, str] = {}
    for study in studies:
        with warnings.catch_warnings():
            # Slow speeds and short runs are meant here.
            warnings.simplefilter("ignore", InputWarning)
            warnings.simplefilter("ignore", SimulationWarning)
            sections.append(study.compute(resolution))
        there = [section.key for section in sections]
        write = partial(page.write, folder, sections, resolution.name, [other.key for other in STUDIES if other.key not in there], svg)
        try:
            # The numbers first: an interrupt while figures are drawn does not lose them.
            write()
            done(study)
            svg |= figures.draw(folder, sections[-1])
            write()
        except OSError as error:
            raise StorageError(f"cannot write {error.filename or folder}: {error.strerror}") from error
    return folder / PAGES[0]
