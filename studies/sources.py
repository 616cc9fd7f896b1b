"""The sources of the error, and what elements or steps half as long change."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import percute as pc
from studies import mass
from studies.impacts import NORMAL, OBLIQUE, STEP, Case, steps_past
from studies.page import Column, Section, Table, percent, short
from studies.parallel import Resolution, Stop
from studies.turning import bodies

SOURCES = ("surface", "front", "dispersion", "mesh")
CLOSE = 0.2
"""A prediction of a change agrees if it is this close, relative."""
LAYERS = (0, 1, 2)
"""How often the elements at the contact are refined."""
BAR = {"length": 1.0, "young": 70e9, "density": 2700.0, "section": 1e-4}
"""A bar of aluminium (SI)."""
REFERENCE = 4
"""Refinements of the references of the impacts."""

Problem = Callable[[int], pc.Problem]


@dataclass(frozen=True)
class Subject:
    """A motion on meshes that are refined."""

    name: str
    problem: Problem
    """The problem after a number of refinements."""
    end: float
    """T (s)."""
    level: int
    """Refinements of the mesh of which changes are predicted."""
    reference: int
    """Refinements of the reference."""


@dataclass(frozen=True)
class Change:
    """A change of the mean of η, relative: expected, in a run, and of the square of the true error."""

    expected: float
    real: float
    true: float

    @property
    def off(self) -> float:
        """How far the expected change is from that of the run, relative."""
        return abs(self.expected / self.real - 1.0)


@dataclass(frozen=True)
class Halved:
    """The sources of a run, those that are expected and found on the finer mesh, and what changes."""

    before: pc.Sources
    expected: pc.Sources
    found: pc.Sources
    size: Change
    step: Change


def _bar(refinements: int) -> pc.Problem:
    """Throw a bar at a plane."""
    return pc.Problem(
        pc.Mesh.bar(BAR["length"], elements=20 << refinements),
        material=pc.Elastic(young=BAR["young"], density=BAR["density"], section=BAR["section"]),
        initial_velocity=(-5.0,),
        obstacles=[pc.Plane(point=(-1e-4,), normal=(1.0,))],
    )


def impacts() -> dict[str, Case]:
    """Give the impacts by name."""
    flat = Case(velocity=NORMAL)
    corner = flat.at(tilt=10.0, gap=0.1e-3, end=60e-6)
    disc = flat.at(body="disc", end=60e-6)
    return {
        "flat": flat,
        "flat, long": flat.at(end=40e-6),
        "flat, μ = 0.5, oblique": flat.at(velocity=OBLIQUE, friction=0.5),
        "unstructured": flat.at(body="unstructured block"),
        "ν = 0.45, plane strain": flat.at(material="ν = 0.45", plane="strain", end=30e-6),
        "unstructured, long": flat.at(body="unstructured block", end=30e-6),
        "tilted by 3°": flat.at(tilt=3.0, end=16e-6),
        "tilted by 3°, long": flat.at(tilt=3.0, end=30e-6),
        "trapezoid": flat.at(body="trapezoid 63°", end=30e-6),
        "crowned": flat.at(body="crowned block", end=30e-6),
        "corner, 400 m/s": corner,
        "corner, 4 m/s": corner.scaled(0.01),
        "disc, 400 m/s": disc,
        "disc, 4 m/s": disc.scaled(0.01),
        "crowned, 4 m/s": flat.at(body="crowned block", end=30e-6).scaled(0.01),
    }


def subjects() -> list[Subject]:
    """Give the motions."""
    of = impacts()
    wanted = [("flat", 1), ("flat", 2), ("flat, long", 1), ("flat, μ = 0.5, oblique", 1), ("flat, μ = 0.5, oblique", 2), ("unstructured", 2)]
    wanted += [(name, 1) for name in of if name not in dict(wanted)]
    wanted.append(("crowned", 2))
    found = [Subject(name, of[name].problem, of[name].end, level, REFERENCE) for name, level in wanted]
    modes = [(body.name, body.problem, body.end) for body in bodies() if "spins" not in body.name]
    modes.append(("vibrating bar", lambda refinements: mass.problem_of(20 << refinements), mass.PERIODS * math.tau / mass.FREQUENCY))
    found += [Subject(name, problem, end, 1, 4) for name, problem, end in modes]
    return [*found, Subject("bar that lands", _bar, 6e-4, 1, 5)]


def _halve(subject: Subject, stop: Stop) -> Halved:
    """Run a motion, halve its elements or its steps, and compare."""
    coarse, fine = subject.problem(subject.level), subject.problem(subject.level + 1)
    runs = [(coarse, STEP), (fine, STEP), (coarse, 0.5 * STEP)]
    histories = [pc.simulate(problem, **steps_past(subject.end, ratio, problem), progress=stop) for problem, ratio in runs]
    whole, size, step = (pc.estimate(history, every=1, threads=1, progress=stop) for history in histories)
    reference = subject.problem(subject.reference)
    last = max(float(history.time[-1]) for history in histories)
    true = [error.mean**2 for error in pc.true_errors(histories, reference, **steps_past(last, STEP, reference), progress=stop)]
    before, after = whole.sources, size.sources
    assert before is not None and after is not None
    total = before.mean.total
    return Halved(
        before.mean,
        before.halved_elements,
        after.mean,
        Change(before.halved_elements.total / total - 1.0, after.mean.total / total - 1.0, true[1] / true[0] - 1.0),
        Change(before.halved_step / total, step.mean**2 / total - 1.0, true[2] / true[0] - 1.0),
    )


def _refined(mesh: pc.Mesh, history: pc.History, times: int) -> pc.Mesh:
    """Refine the elements at the nodes that touch."""
    places = history.problem.mesh.points[history.contact_nodes[history.touching.any(axis=0)]]
    for _ in range(times):
        distance = np.linalg.norm(mesh.points[:, None] - places[None], axis=2).min(axis=1)
        mesh = mesh.refine(where=(distance[mesh.cells] < 1e-9).any(axis=1))
    return mesh


def _locally(run: tuple[str, Case], stop: Stop) -> list[pc.Sources]:
    """Give the sources on a mesh that is refined at the contact alone, so many times."""
    _, case = run
    problem = case.problem(1)
    history = pc.simulate(problem, **steps_past(case.end, STEP, problem), progress=stop)
    found = []
    for times in LAYERS:
        finer = case.on(_refined(problem.mesh, history, times))
        estimate = pc.estimate(pc.simulate(finer, **steps_past(case.end, STEP, finer), progress=stop), every=1, threads=1, progress=stop)
        assert estimate.sources is not None
        found.append(estimate.sources.mean)
    return found


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    wanted = resolution.first(2, subjects())
    found = resolution.map(_halve, wanted, lambda subject: 8.0**subject.level * subject.end)
    results = list(zip(wanted, found, strict=True))
    section.add(
        "`corrected` separates η into sources and says what elements or steps half as long would change (page on sources). Real runs show "
        "how far this is true: each motion is run with elements half as long, at the same Courant number, and with steps half as long on the same "
        "mesh. The numbers are means over time. The true error is that against a much finer mesh, squared.",
        _changes(results),
        _verdict(results),
        *_local(resolution),
        _shares(results),
    )


def _shares(results: list[tuple[Subject, Halved]]) -> Table:
    """Give the sources of each run, and on elements half as long."""
    columns = [Column("case"), Column("number of the mesh")]
    columns += [Column(f"{source}{when}", "%", digits=3) for source in SOURCES for when in ("", ", expected", ", found")]
    caption = "Sources of the mean of η in per cent of its sum: of the run, expected with elements half as long, and found there."
    table = Table("sources", caption, columns, on_page=False)
    for subject, each in results:
        total = 0.01 * each.before.total
        triples = ((getattr(each.before, s), getattr(each.expected, s), getattr(each.found, s)) for s in SOURCES)
        table.add(subject.name, subject.level + 1, *(value / total for triple in triples for value in triple))
    return table


def _changes(results: list[tuple[Subject, Halved]]) -> Table:
    """Give the changes of each run."""
    columns = [Column("case"), Column("mesh")]
    kinds = ("expected", "real", "off by", "true error")
    columns += [Column(f"{what}: {kind}", "%", digits=3) for what in ("half the size", "half the step") for kind in kinds]
    caption = "Change of the mean of η, expected and real; how far the first is from the second, relative; and that of the true error squared."
    table = Table("sources-changes", caption, columns, on_page={"mesh": 2})
    for subject, each in results:
        values = ((change.expected, change.real, change.off, change.true) for change in (each.size, each.step))
        table.add(subject.name, subject.level + 1, *(100.0 * value for row in values for value in row))
    return table


def _verdict(results: list[tuple[Subject, Halved]]) -> str:
    """Say where predictions agree with the runs, and where not."""

    def count(change: Callable[[Halved], Change]) -> str:
        off = [f"{subject.name} (mesh {subject.level + 1})" for subject, each in results if change(each).off > CLOSE]
        return f"in {len(results) - len(off)} of {len(results)} runs; not in: {'; '.join(off) or 'none'}"

    worst = max(abs(each.step.expected - each.step.real) for _, each in results)
    return (
        f"With elements half as long, the expected change is within {short(100.0 * CLOSE, 2)} % of the real one {count(lambda each: each.size)}. With "
        f"steps half as long, it is so {count(lambda each: each.step)}. The largest difference there is {percent(worst)} of η. Where contact has just begun, or a corner "
        "or a curve touches slowly, half the step changes η by a few per cent, through the instants at which nodes arrive and the forces that follow. The "
        "prediction does not contain them. It holds best where waves have accumulated dispersion."
    )


def _local(resolution: Resolution) -> tuple[str, Table]:
    """Give the sources on meshes that are refined at the contact."""
    of: Mapping[str, Case] = impacts()
    names = ("flat", "corner, 400 m/s", "corner, 4 m/s", "disc, 4 m/s", "crowned, 4 m/s")
    runs = [(name, of[name]) for name in resolution.first(1, names)]
    columns = [Column("case"), Column("refined", "times"), *(Column(source, "%", digits=3) for source in (*SOURCES, "sum"))]
    caption = "Sources of the mean of η on mesh 2, refined at the contact alone, in per cent of the sum without refinement."
    table = Table("sources-local", caption, columns, on_page=False)
    listed = []
    for (name, _), found in zip(runs, resolution.map(_locally, runs), strict=True):
        sums = [sources.total / found[0].total for sources in found]
        for times, sources, total in zip(LAYERS, found, sums, strict=True):
            table.add(name, times, *(100.0 * getattr(sources, source) / found[0].total for source in SOURCES), 100.0 * total)
        listed.append(f"{' and '.join(percent(total) for total in sums[1:])} ({name})")
    text = (
        "With only the elements refined that have a node in contact, once and twice, the mean of η falls to "
        f"{', '.join(listed)} of that without. Slow corners and curves gain what they gain from a mesh that is fine everywhere. A front "
        "does not: its energy goes on into the body and is there dispersed."
    )
    return text, table
