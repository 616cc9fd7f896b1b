"""The effectivity index over the speed of the impact."""

from __future__ import annotations

from percute.verification.choices import RECONSTRUCTIONS
from percute.verification.impacts import CORNER, CURVED, FLAT, RECONSTRUCTION_OPTIONS, Case, Found, cases, contact_size
from percute.verification.page import Column, Section, Table
from percute.verification.parallel import Resolution, Stop

SCALES = (1.0, 0.1, 0.01, 0.001)
"""Speed and gap over those of the cases."""


def _scaled(run: tuple[Case, float], stop: Stop) -> Found:
    case, scale = run
    slower = case.scaled(scale).at(references=(4,))
    return slower.at(sizes=(contact_size(-slower.velocity[1]),)).finest(RECONSTRUCTION_OPTIONS, stop)


def add(section: Section, resolution: Resolution) -> None:
    """Compute the runs and add text and tables."""
    with_friction = [case for case in cases() if case.friction > 0.0]
    # The last curved body is the disc that falls straight.
    bodies = [[case for case in with_friction if case.kind == kind][-1 if kind == CURVED else 0].few() for kind in (FLAT, CURVED, CORNER)]
    bodies = list(resolution.first(1, bodies))
    found = iter(resolution.map(_scaled, [(case, scale) for case in bodies for scale in SCALES]))
    columns = [Column("body"), Column("reconstruction"), Column("speed across the plane", "m/s", digits=1)]
    columns += [Column("over the wave speed", digits=2), Column("sup", digits=3), Column("mean", digits=3)]
    caption = (
        "Effectivity index over the speed of the impact, on mesh 2 against a reference that is refined at corners that come into contact; the gap shrinks with the speed, so that all "
        "bodies touch at the same instant."
    )
    table = Table("effectivity-speeds", caption, columns, on_page=False)
    for case in bodies:
        wave_speed = case.problem(0).wave_speed
        for scale in SCALES:
            speed, one = scale * abs(case.velocity[1]), next(found)
            for r, reconstruction in enumerate(RECONSTRUCTIONS):
                table.add(case.name, reconstruction, speed, speed / wave_speed, *one.effectivity(r))
    section.add(
        "### Slow impacts",
        "Where all touching edges lie in the plane, a slower impact is the same on another scale, and the effectivity index does not "
        "change. Where a corner or a curve touches, an edge beside the first node is off the plane by its slope, at any speed. A slower "
        "body deforms less, and its zone of contact becomes smaller than an edge. `corrected` concentrates the force of such a node on a "
        "part of the edge that it chooses at each instant. The section on speeds shows more bodies and speeds. "
        "`consistent` and `published`, which drop that force, come to a limit, because they lack its impulse in any case.",
        _summary(table, bodies),
        table,
    )


def _summary(table: Table, bodies: list[Case]) -> Table:
    speeds = [f"sup at {400 * scale:g} m/s" for scale in SCALES] + [f"mean at {400 * scale:g} m/s" for scale in SCALES]
    columns = [Column("body"), Column("reconstruction"), *(Column(name, digits=3) for name in speeds)]
    summary = Table("effectivity-speeds-summary", "Effectivity index over the speed across the plane, largest error and mean.", columns)
    for case in bodies:
        for reconstruction in RECONSTRUCTIONS:
            of = {"body": case.name, "reconstruction": reconstruction}
            summary.add(*of.values(), *table.where("sup", of), *table.where("mean", of))
    return summary
