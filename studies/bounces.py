"""The effectivity index over many contact phases: bodies that bounce under gravity."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.impacts import Case, steps_past, touched
from studies.page import Column, Section, Table, short
from studies.parallel import Resolution, Stop

PHASES = 10
PHASES_SHOWN = (1, 3, 5, PHASES)
"""Phases after which tables have the index, or after the last one."""
GRAVITY = 2.5e4
"""Acceleration over speed (1/s): bodies fly for twice the inverse of it, less what the impact has turned into vibration."""
APART = 15e-6
"""Contacts that begin so soon after one another are one phase (s)."""
END = 1.2e-3
"""End of the run that shows when phases begin (s)."""
MESHES = (1, 2)
"""Refinements of the meshes that are estimated."""
REFERENCES = (3, 4)
"""Refinements of the references, which are uniform: the fast curves and the flat edges do not need more."""
SUSTAINED = 0.6e-3
"""End of the runs at 1 m/s under so large an acceleration that a node touches nearly all the time (s)."""
SUSTAINED_GRAVITY = 1e5
"""This acceleration (m/s²)."""
SUSTAINED_REFERENCES = (2, 3)
"""Refinements of the references of these runs."""
SUSTAINED_SIZES = (62e-6, 31e-6)
"""Size of their elements at corners that come into contact (m)."""


@dataclass(frozen=True)
class Bounces:
    """The indices on one mesh, up to the end of each phase."""

    phases: int
    sup: list[float]
    mean: list[float]
    relative: float
    """ε_sup, eq. [22]."""
    kinetic: float
    """The kinetic part of the largest η, as a share."""
    moved: float
    """By how much the finer reference moves the largest true error, relative."""

    @property
    def phases_shown(self) -> list[int]:
        """The phases of the tables, as far as the run goes."""
        return [min(k, self.phases) for k in PHASES_SHOWN]


def cases() -> list[Case]:
    """Give the cases."""
    fast, slow = (0.0, -400.0), (0.0, -40.0)
    chosen = (("block", slow, 0.03e-3), ("disc", fast, 0.3e-3), ("crowned block", fast, 0.3e-3), ("trapezoid 63°", slow, 0.03e-3))
    bouncing = [
        Case(body=body, velocity=velocity, gap=gap, gravity=-GRAVITY * velocity[1], references=REFERENCES) for body, velocity, gap in chosen
    ]
    pressed = Case(velocity=(0.0, -1.0), gap=1e-6, gravity=SUSTAINED_GRAVITY, end=SUSTAINED, references=SUSTAINED_REFERENCES, sizes=SUSTAINED_SIZES)
    return [*bouncing, pressed.at(body="disc"), pressed.at(tilt=45.0)]


def _starts(history: pc.History) -> NDArray[np.float64]:
    """Give the instants at which a contact phase begins (s)."""
    touches = history.touching.any(axis=1).astype(int)
    begins = history.time[1:][np.diff(touches) > 0]
    return begins[np.diff(begins, prepend=-math.inf) > APART]


def _last_start(case: Case, stop: Stop) -> float:
    """Give the beginning of phase 11 on the first mesh, or of the last phase before the body comes to rest (s)."""
    problem = case.problem(MESHES[0])
    starts = _starts(pc.simulate(problem, **steps_past(END, case.ratio, problem), progress=stop))
    return float(starts[min(PHASES, len(starts) - 1)])


def _run(case: Case, stop: Stop) -> list[Bounces]:
    """Run a case to its end and compare it with its references."""
    end = SUSTAINED if case.sizes else _last_start(case, stop)
    histories = []
    for refinements in MESHES:
        problem = case.problem(refinements)
        histories.append(pc.simulate(problem, **steps_past(end, case.ratio, problem), progress=stop))
    last = max(float(history.time[-1]) for history in histories)
    places = np.unique(np.concatenate([touched(history) for history in histories]), axis=0)
    errors = []
    for k, refinements in enumerate(case.references):
        fine = case.problem(refinements, places, case.sizes[k]) if case.sizes else case.problem(refinements)
        errors.append(pc.true_errors(histories, fine, **steps_past(last, case.ratio, fine), progress=stop))
    return [
        _compare(history, pc.estimate(history, every=1, threads=1, progress=stop), coarse, fine)
        for history, coarse, fine in zip(histories, *errors, strict=True)
    ]


def _compare(history: pc.History, estimate: pc.Estimate, coarse: pc.TrueError, fine: pc.TrueError) -> Bounces:
    """Compare the estimate with the true error up to the end of each phase and of the flight after it."""
    starts, over = _starts(history), estimate.over_time
    sup, mean = [], []
    for until in [*starts[1:], history.time[-1]]:
        ours, theirs = over.time <= until, fine.time <= until
        sup.append(math.sqrt(over.total[ours].max() / fine.total[theirs].max()))
        means = [np.trapezoid(total, time) for total, time in ((over.total[ours], over.time[ours]), (fine.total[theirs], fine.time[theirs]))]
        mean.append(math.sqrt(means[0] / means[1]))
    parts = estimate.parts
    moved = abs(fine.sup / coarse.sup - 1.0)
    return Bounces(len(starts), sup, mean, estimate.published_relative_sup, parts.kinetic / parts.total, moved)


def add(section: Section, resolution: Resolution) -> None:
    """Compute the runs and add text and tables."""
    after = [f"{measure} after {k}" for measure in ("sup", "mean") for k in PHASES_SHOWN]
    columns = [Column("case"), Column("mesh"), Column("phases"), Column("ε sup", "%", "[22]", digits=3), Column("kinetic part", "%", digits=3)]
    columns += [*(Column(name, digits=3) for name in after), Column("references differ by", "%", digits=2)]
    caption = "Effectivity index of `corrected` after so many contact phases and the flight that follows, and at the end of the run, on each mesh."
    table = Table("bounces-runs", caption, columns, on_page=False)
    shown = [Column("case"), *(Column(f"{heading}, meshes {MESHES[0] + 1}; {MESHES[1] + 1}") for heading in ("ε sup (%)", *after))]
    summary = Table("bounces", caption, shown)
    wanted = cases()
    for case, meshes in zip(wanted, resolution.map(_run, wanted), strict=True):
        name = f"{case.name}, {-case.velocity[1]:g} m/s"
        values = [[found.sup[k - 1] for k in found.phases_shown] + [found.mean[k - 1] for k in found.phases_shown] for found in meshes]
        for refinements, found, each in zip(MESHES, meshes, values, strict=True):
            table.add(name, refinements + 1, found.phases, 100.0 * found.relative, 100.0 * found.kinetic, *each, 100.0 * found.moved)
        pairs = [[100.0 * found.relative for found in meshes], *zip(*values, strict=True)]
        summary.add(name, *("; ".join(short(value, 3) for value in pair) for pair in pairs))
    section.add(
        "### Many contact phases",
        "Bodies bounce under an acceleration that makes ten contact phases last a millisecond. Each phase adds to the error: waves have "
        "dispersed, and the next phase begins at another instant than in the reference. The true error grows to the size of the solution "
        "itself (ε), and the effectivity index then has no meaning beyond that. The bodies at 1 m/s are pressed on the plane by a larger "
        f"acceleration: their lowest node touches nearly all the time, until {1e6 * SUSTAINED:g} µs. Their references are graded to "
        f"{1e6 * SUSTAINED_SIZES[0]:g} and {1e6 * SUSTAINED_SIZES[1]:g} µm. Of the trapezoid the corrections of the auxiliary solution exceed the "
        "dispersion that the reference shows (page on reconstructions).",
        summary,
        table,
    )
