"""The estimated over the true error of free bodies whose motion turns the elements, for two mass terms."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import percute as pc
from numpy.typing import NDArray
from studies.block import ALUMINIUM
from studies.impacts import STEP, holds, inside
from studies.page import Column, Section, Table
from studies.parallel import Resolution, Stop

Floats = NDArray[np.float64]
ACCELERATIONS: tuple[Literal["split", "closest"], ...] = ("split", "closest")
"""Γ_DA of the estimates, all with `corrected`."""
MESHES, FEW, REFERENCE = 4, 2, 3
"""Meshes, those of a small study, and refinements from a mesh to its reference."""
SIDE, SPEED, SPIN = 0.05, 5.0, 6.0
"""Side of the square (m), largest speed of the vibrations (m/s), and that of the spinning sides over it."""
BEAM = 0.1, 0.02
"""Length and height of the beam (m)."""
ROOT, RATIO = 4.730_040_744_862_704, 0.982_502_214_576_238
"""The first root of cosh z cos z = 1, and (cosh z − cos z)/(sinh z − sin z) there."""
SHEAR = ALUMINIUM["young"] / (2.0 * (1.0 + ALUMINIUM["poisson"]))


@dataclass(frozen=True)
class Body:
    """A free body in plane strain that is thrown."""

    name: str
    sides: tuple[float, float]
    """Width and height (m)."""
    cells: tuple[int, int]
    """Cells of mesh 1 along the sides, each cut in two."""
    velocity: Callable[[Floats, Floats], tuple[Floats, Floats]]
    """Initial velocity (m/s) at places (m)."""
    end: float
    """T (s)."""

    def problem(self, refinements: int) -> pc.Problem:
        """Give the problem on one of the meshes."""
        nx, ny = (n << refinements for n in self.cells)
        mesh = pc.Mesh.rectangle(*self.sides, nx=nx, ny=ny)
        velocity = np.stack(self.velocity(*mesh.points.T), axis=1)
        return pc.Problem(mesh, material=pc.Elastic(**ALUMINIUM, plane="strain"), initial_velocity=velocity)

    def run(self, refinements: int, stop: Stop | None = None) -> list[tuple[pc.Effectivity, bool]]:
        """Give the effectivity index of each choice of Γ_DA on one of the meshes, and whether its verdict holds."""
        times: dict[str, Any] = {"end": self.end, "courant": STEP, "progress": stop}
        history = pc.simulate(self.problem(refinements), **times)
        (error,) = pc.true_errors([history], self.problem(refinements + REFERENCE), **times)
        estimates = (pc.estimate(history, every=1, acceleration=name, threads=1, progress=stop) for name in ACCELERATIONS)
        indices = [(estimate, estimate.effectivity(error)) for estimate in estimates]
        return [(index, holds(estimate, (index.sup, index.mean))) for estimate, index in indices]


def _lame(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Give the velocity of Lamé's mode of the square: shear without change of volume, no traction on the sides."""
    k = math.pi / SIDE
    return SPEED * np.cos(k * x) * np.sin(k * y), -SPEED * np.sin(k * x) * np.cos(k * y)


def _spinning(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Give that of the same mode in a square that spins."""
    (vx, vy), spin = _lame(x, y), SPIN * SPEED / (0.5 * SIDE)
    return vx - spin * (y - 0.5 * SIDE), vy + spin * (x - 0.5 * SIDE)


def _bending(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Give the velocity of the first bending mode after Euler and Bernoulli; cross sections stay at right angles."""
    k = ROOT / BEAM[0]
    deflection = np.cosh(k * x) + np.cos(k * x) - RATIO * (np.sinh(k * x) + np.sin(k * x))
    slope = k * (np.sinh(k * x) - np.sin(k * x) - RATIO * (np.cosh(k * x) + np.cos(k * x)))
    return -0.5 * SPEED * (y - 0.5 * BEAM[1]) * slope, 0.5 * SPEED * deflection


def bodies() -> list[Body]:
    """Give the bodies, each with half a period of its mode."""
    lame = SIDE / math.sqrt(2.0 * SHEAR / ALUMINIUM["density"])
    modulus = ALUMINIUM["young"] / (1.0 - ALUMINIUM["poisson"] ** 2)
    bending = math.pi / ((ROOT / BEAM[0]) ** 2 * BEAM[1] * math.sqrt(modulus / (12.0 * ALUMINIUM["density"])))
    square = (SIDE, SIDE)
    return [
        Body("square in Lamé's mode", square, (6, 6), _lame, lame),
        Body("square in Lamé's mode that spins", square, (6, 6), _spinning, lame),
        Body("beam in its first bending mode", BEAM, (10, 2), _bending, bending),
    ]


def add(section: Section, resolution: Resolution) -> None:
    """Compute the runs and add text and table."""
    runs = [(body, mesh) for body in resolution.first(1, bodies()) for mesh in range(resolution.either(FEW, MESHES))]
    found = resolution.map(lambda run, stop: run[0].run(run[1], stop), runs, lambda run: 8.0 ** run[1])
    columns = [Column("body"), Column("measure")]
    columns += [Column(f"{name}, mesh {mesh + 1}", digits=3) for name in ACCELERATIONS for mesh in range(MESHES)]
    caption = (
        "Effectivity index of `corrected` over half a period of free bodies that vibrate, with two choices of Γ_DA. Meshes are of 6² to 48² "
        f"cells (square) and 10×2 to 80×16 (beam). Each has a reference of its own, with {1 << REFERENCE} times as many cells along a side."
    )
    table = Table("effectivity-turning", caption, columns)
    of = dict(zip(((body.name, mesh) for body, mesh in runs), found, strict=True))
    for name in dict.fromkeys(body.name for body, _ in runs):
        for measure in ("sup", "mean"):
            places = [(k, (name, mesh)) for k in range(len(ACCELERATIONS)) for mesh in range(MESHES)]
            table.add(name, measure, *(getattr(of[run][k][0], measure) if run in of else None for k, run in places))
    section.add(
        "### Motion that turns the elements",
        "With `closest` the tractions of an element balance its lumped mass, which has D + 2 times the moment of the linear field ρã, and "
        "Γ_DA contains a rotation that ã does not contain. Where the motion turns the elements, this is a kinetic error of the order of the "
        "true error. The mass term of `split` leaves the skew part of a stress alone (see the page on reconstructions). A rigid spin "
        f"has no acceleration in a linear theory, and adds nothing. {inside(kept for each in found for _, kept in each)}",
        table,
    )
