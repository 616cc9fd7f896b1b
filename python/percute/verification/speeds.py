"""The effectivity index over the speed of the impact: corners, curves and inclined sides."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import percute as pc
from percute.verification import bodies, bounces, figures
from percute.verification.impacts import FLAT, GOOD, Case, Found, contact_size, steps_past
from percute.verification.page import Column, Figure, Section, Table
from percute.verification.parallel import Resolution, Stop

SPEEDS = (400.0, 100.0, 40.0, 10.0, 4.0, 1.0, 0.4)
FEW = (400.0, 4.0)
"""Speeds across the plane (m/s), and those of a small study."""
FULL = 400.0
"""The speed of the cases (m/s)."""
REFERENCES = (3, 4)
"""Refinements of the references; the elements of the first are twice as large everywhere."""
MESHES = 3
AFTER, MOST = 5e-6, 110e-6
"""A run ends so long after the last contact on mesh 2 (s), and at this instant at most."""

Run = tuple[Case, float]


def cases() -> list[Case]:
    """Give the cases at full speed."""
    normal, oblique = (0.0, -FULL), (FULL, -FULL)
    flat = Case(velocity=normal, end=MOST, meshes=MESHES, references=REFERENCES)
    tilted = flat.at(tilt=10.0, gap=0.1e-3)
    narrow = [flat.at(body=f"trapezoid {angle}") for angle in ("63°", "45°")]
    return [
        *(tilted.at(tilt=tilt) for tilt in (5.0, 10.0, 20.0, 45.0)),
        tilted.at(tilt=-10.0, velocity=oblique),
        tilted.at(material="steel"),
        tilted.at(material="ν = 0.45", plane="strain"),
        tilted.at(body="unstructured block"),
        tilted.at(body="rounded block", gap=0.2e-3),
        flat.at(body="disc"),
        flat.at(body="disc", material="steel", velocity=oblique),
        flat.at(body="disc", material="ν = 0.45", plane="strain"),
        flat.at(body="crowned block"),
        *(case.at(velocity=velocity) for case in narrow for velocity in (normal, oblique)),
        narrow[0].at(material="ν = 0.45", plane="strain"),
        *(case.at(tilt=10.0, gap=0.1e-3) for case in narrow),
        flat.at(body="trapezoid 45° with a corner of one element"),
        *(tilted.at(body=body) for body in ("L", "frame")),
        tilted.at(body="layered block", material=bodies.LAYERS),
        flat.at(body="L", velocity=oblique),
        flat.at(body="layered block", material=bodies.LAYERS),
        flat.at(body="unstructured block", velocity=oblique),
        flat,
    ]


def _run(run: Run, stop: Stop) -> tuple[Case, list[Found | None]]:
    """Run a case at a speed through contact and release."""
    case, speed = run
    slower = case.scaled(speed / FULL)
    size = contact_size(speed)
    problem = slower.problem(1)
    history = pc.simulate(problem, **steps_past(MOST, slower.ratio, problem), progress=stop)
    touches = history.time[history.touching.any(axis=1)]
    slower = slower.at(end=min(float(touches[-1]) + AFTER, MOST), sizes=tuple(size * 2.0 ** (REFERENCES[-1] - each) for each in REFERENCES))
    return slower, slower.run([{"reconstruction": "corrected"}], stop)


def compute(section: Section, resolution: Resolution) -> None:
    """Compute the study."""
    wanted = resolution.first(1, cases())
    runs = [(case, speed) for case in wanted for speed in resolution.either(FEW, SPEEDS)]
    found = resolution.map(_run, runs, lambda run: (run[0].body == "disc") + 1.0 / run[1])
    results = list(zip(runs, found, strict=True))
    table = _table(results)
    section.add(
        "Slower impacts of bodies that touch with a corner, a curve, or an edge beside an inclined side. The gap shrinks with the speed, so "
        "that a body touches at the same instant at each speed. Each run goes on through contact and release, to T. Where a corner touches "
        "slowly, its zone of contact is smaller than any element of a uniform mesh. The meshes of the references are therefore refined "
        f"towards the corners of the outline that come into contact: to {_micrometres(SPEEDS[0])} at {SPEEDS[0]:g} m/s, to "
        f"{_micrometres(SPEEDS[-1])} at {SPEEDS[-1]:g} m/s, with a size that grows by a quarter of the distance. The table has "
        "the true error against this reference and against one with elements of twice that size everywhere.",
        Figure(
            "speeds",
            "Effectivity index of `corrected` on mesh 2 over the speed across the plane (both axes logarithmic), against the finer reference. "
            f"The band is from {GOOD[0]} to {GOOD[1]}.",
            _draw(results),
        ),
        _summary(results),
        table,
    )
    # A run of many phases takes a minute.
    if not resolution.small:
        bounces.add(section, resolution)


def _micrometres(speed: float) -> str:
    return f"{1e6 * contact_size(speed):.0f} µm"


def _table(results: Iterable[tuple[Run, tuple[Case, list[Found | None]]]]) -> Table:
    columns = [Column("case"), Column("speed across the plane", "m/s", digits=3), Column("mesh"), Column("elements"), Column("T", "µs", digits=3)]
    columns += [Column("touches from", "µs", digits=3), Column("until", "µs", digits=3), Column("impulse kept", digits=3)]
    columns += [Column("sup", digits=3), Column("mean", digits=3), Column("time of the sup", "µs", digits=3)]
    columns += [Column(f"part of {part} at the sup", "%", digits=3) for part in ("contact", "inertia", "stress")]
    columns += [Column(f"e_ref {measure}, {which} reference", "J^½") for which in ("coarser", "finer") for measure in ("sup", "mean")]
    caption = "Effectivity index over speed, on each mesh: with the parts of the largest η, and with the true error against two references."
    table = Table("speeds", caption, columns, on_page=False)
    for (_, speed), (case, found) in results:
        for mesh, each in enumerate(found):
            if each is None:
                continue
            estimate, (first, last) = each.estimates[0], each.touching or (math.nan, math.nan)
            parts = estimate.parts
            table.add(
                case.name,
                speed,
                mesh + 1,
                each.elements,
                1e6 * case.end,
                1e6 * first,
                1e6 * last,
                estimate.kept_impulse,
                *each.effectivity(0),
                1e6 * estimate.time_of_sup,
                *(100.0 * part / parts.total for part in (parts.contact, parts.kinetic, parts.elastic)),
                *(value for true in each.exact for value in (true.sup, true.mean)),
            )
    return table


def _summary(results: Sequence[tuple[Run, tuple[Case, list[Found | None]]]]) -> Table:
    """Give one row for each case: both measures on mesh 2 at each speed."""
    columns = [Column("case"), *(Column(f"{measure}, {speed:g} m/s", digits=3) for measure in ("sup", "mean") for speed in SPEEDS)]
    columns.append(Column("references differ by", "%", digits=2))
    table = Table("speeds-summary", "Effectivity index on mesh 2, and the largest difference of e_ref between both references.", columns)
    for case in dict.fromkeys(case for (case, _), _ in results):
        on_mesh = {speed: found[1] for (other, speed), (_, found) in results if other == case}
        each = [on_mesh.get(speed) for speed in SPEEDS]
        values = [math.nan if one is None else one.effectivity(0)[m] for m in range(2) for one in each]
        # A small study does not have all speeds.
        moved = math.nan if None in each else max(abs(one.exact[-1].sup / one.exact[0].sup - 1.0) for one in each if one is not None)
        table.add(case.name, *values, 100.0 * moved)
    return table


def _draw(results: Sequence[tuple[Run, tuple[Case, list[Found | None]]]]) -> figures.Drawing:
    """Draw a panel for each measure, and a curve for each case in the colour of its family."""
    panels = []
    for m, measure in enumerate(("sup", "mean")):
        curves = []
        for case in dict.fromkeys(case for (case, _), _ in results):
            on_mesh = [(speed, found[1]) for (other, speed), (_, found) in results if other == case]
            values = [math.nan if each is None else each.effectivity(0)[m] for _, each in on_mesh]
            name, colour = _family(case)
            curves.append(figures.Curve(name, [speed for speed, _ in on_mesh], values, figures.own(colour), marked=True))
        panels.append((measure, curves))
    ticks = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
    return figures.lines(panels, "speed across the plane (m/s)", "e/e_ref", log="xy", columns=2, band=GOOD, xticks=sorted(SPEEDS), yticks=ticks)


def _family(case: Case) -> tuple[str, int]:
    """Give the family of a case and its colour."""
    if case.body.startswith("trapezoid"):
        return "trapezoid", 1
    if case.body in ("disc", "rounded block", "crowned block"):
        return "curved", 2
    if case.body in ("L", "frame"):
        return f"{case.body}", 3 + (case.body == "frame")
    return ("flat", 7) if case.kind == FLAT else ("block, corner first", 0)
