"""The estimate of a random body beside its true error, and the table of many."""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass, fields

import numpy as np
import percute as pc
from studies.random_bodies.cases import RandomBody, body
from percute.words import counted

REFERENCE_COURANT = 0.9
"""Step of the reference over its critical one."""
SOUND = (0.8, 1.7)
"""Indices that a verdict with high trust may have."""
VIBRATING = (0.85, 1.3)
"""Indices that bodies which vibrate should have."""
QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)


@dataclass(frozen=True)
class Row:
    """What was found of a body; a line of the CSV file."""

    kind: str
    seed: int
    further: int
    """Further refinements of the reference."""
    shape: str
    mesh: str
    elements: int
    grading: float
    material: str
    plane: str
    poisson: float
    tilt: float
    speed: float
    speed_ratio: float
    along: float
    friction: float
    courant: float
    passages: float
    steps: int
    relative_sup: float
    sup: float
    """Index of the largest error."""
    mean: float
    """Index of the mean error."""
    low: float
    high: float
    trust: str
    inside: str
    """yes or no; empty without a range."""
    touches: str
    given: float
    """Energy that contact has given to the auxiliary solution, over the largest energy of the simulation."""
    outside_tested_range: str
    situation: str
    error: str = ""
    """Why there is no estimate."""

    @classmethod
    def of_cells(cls, cells: Sequence[str]) -> Row:
        """Read a line of the CSV file."""
        kinds = {"int": int, "float": float, "str": str}
        return cls(*(kinds[str(field.type)](cell) for field, cell in zip(fields(cls), cells, strict=True)))

    @property
    def cells(self) -> list[str]:
        """A line of the CSV file: numbers with four digits."""
        return [f"{value:.4g}" if isinstance(value, float) else str(value) for value in astuple(self)]

    @property
    def wrong(self) -> bool:
        """Whether trust is high, and an index is not sound."""
        return self.trust == "high" and not (SOUND[0] <= min(self.sup, self.mean) and max(self.sup, self.mean) <= SOUND[1])


COLUMNS = [field.name for field in fields(Row)]


def judged(kind: str, seed: int, further: int = 0) -> Row:
    """Run a body, estimate its error, and compare it with that of a simulation on a finer mesh."""
    drawn = body(kind, seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # With the digits of the file, so that a table is the same from it.
        return Row.of_cells(_judged(drawn, further).cells)


def _judged(drawn: RandomBody, further: int) -> Row:
    problem = drawn.problem()
    common = dict(
        kind=drawn.kind,
        seed=drawn.seed,
        further=further,
        shape=drawn.shape,
        mesh=drawn.mesh_kind,
        elements=len(drawn.mesh.cells),
        grading=drawn.grading,
        material=drawn.material,
        plane=str(drawn.law.plane),
        poisson=drawn.law.poisson or 0.0,
        tilt=drawn.tilt,
        speed=drawn.speed,
        speed_ratio=drawn.speed / problem.wave_speed,
        along=drawn.along,
        friction=drawn.friction,
        courant=drawn.courant,
        passages=drawn.passages,
    )
    try:
        history = pc.simulate(problem, end=drawn.end, courant=drawn.courant)
        estimate = pc.estimate(history, threads=1)
        (error,) = pc.true_errors([history], drawn.reference(further), end=drawn.end, courant=REFERENCE_COURANT)
    except pc.PercuteError as failed:
        none = dict.fromkeys(("relative_sup", "sup", "mean", "low", "high", "given"), math.nan)
        texts = dict.fromkeys(("trust", "inside", "touches", "outside_tested_range", "situation"), "")
        return Row(**common, **none, **texts, steps=0, error=str(failed).replace("\n", " "))  # type: ignore[arg-type]
    document = json.loads(estimate.to_json())
    verdict = document["verdict"]
    low, high = verdict["effectivity"] or (math.nan, math.nan)
    index = estimate.effectivity(error)
    inside = low <= min(index.sup, index.mean) and max(index.sup, index.mean) <= high
    return Row(
        **common,  # type: ignore[arg-type]
        steps=len(history.time) - 1,
        relative_sup=estimate.relative_sup,
        sup=index.sup,
        mean=index.mean,
        low=low,
        high=high,
        trust=verdict["trust"],
        inside="" if math.isnan(low) else "yes" if inside else "no",
        touches=verdict["touches"],
        given=document["auxiliary_contact_energy"],
        outside_tested_range=", ".join(verdict["outside_tested_range"]),
        situation=verdict["text"][0],
    )


HEADER = "| seed | body | mesh | elements | grading | speed over waves | passages | touches | index of sup | of mean | range | trust | inside |"


def line(row: Row) -> str:
    """Give the line of the printed table."""
    body = f"{row.shape}, {row.material}"
    if row.error:
        return f"| {row.seed} | {body} | {row.mesh} | {row.elements} | refused: {row.error} |"
    values = f"{row.elements} | {row.grading:.3g} | {row.speed_ratio:.1e} | {row.passages:.1f} | {row.touches}"
    return f"| {row.seed} | {body} | {row.mesh} | {values} | {row.sup:.2f} | {row.mean:.2f} | {row.low:g} to {row.high:g} | {row.trust} | {row.inside or '–'} |"


def summary(rows: Iterable[Row]) -> list[str]:
    """Give the share inside the stated range, the bodies of high trust with a wrong index, and quantiles."""
    done = list(rows)
    found = [row for row in done if not row.error]
    ranged = [row for row in found if row.inside]
    inside = sum(row.inside == "yes" for row in ranged)
    lines = [f"{counted(len(done), 'case')}, {len(done) - len(found)} refused, {len(found) - len(ranged)} without a range"]
    if ranged:
        lines.append(f"inside the stated range: {inside} of {len(ranged)} ({100.0 * inside / len(ranged):.1f} %)")
    for trust in ("high", "limited", "low"):
        of = [row for row in found if row.trust == trust]
        outside = [f"{row.seed} ({row.sup:.2f}, {row.mean:.2f})" for row in of if row.inside == "no"]
        lines.append(f"trust {trust}: {counted(len(of), 'case')}; outside the stated range: {', '.join(outside) or 'none'}")
    unsound = ", ".join(f"{row.seed} ({row.sup:.2f}, {row.mean:.2f})" for row in found if row.wrong)
    lines.append(f"trust high outside {SOUND[0]} to {SOUND[1]}: {unsound or 'none'}")
    free = [row for row in found if row.kind == "vibration"]
    if free:
        near = sum(VIBRATING[0] <= min(row.sup, row.mean) and max(row.sup, row.mean) <= VIBRATING[1] for row in free)
        lines.append(f"both indices of {VIBRATING[0]} to {VIBRATING[1]}: {near} of {len(free)}")
    if found:
        for name in ("sup", "mean"):
            values = np.quantile([getattr(row, name) for row in found], QUANTILES)
            lines.append(f"index of {name}, quantiles: " + ", ".join(f"{100 * part:g} % {value:.2f}" for part, value in zip(QUANTILES, values, strict=True)))
    return lines
