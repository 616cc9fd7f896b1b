"""Effectivity indices of corners and curves that strike another body, in random cases: a figure of ``docs/bodies.md``.

``python -m studies.random_strikes`` prints them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
import percute as pc
from studies.block import ALUMINIUM
from studies.bodies import STEEL
from studies.struck import FINER, indices, refined

MATERIALS: dict[str, dict[str, Any]] = {"aluminium": ALUMINIUM, "steel": STEEL, "plastic": {"young": 3e9, "poisson": 0.38, "density": 1200.0}}
SEED, COUNT = 1, 50
"""Seed of the cases, number of cases in the middle of a plate and beside its end."""
SIZE = 32e-6
"""Size of the elements of the reference where the bodies touch (m), times the size of the case."""
WIDTH, HEIGHT, RADIUS = 0.06, 0.025, 0.01
"""Width of the plate, height of plate and block, radius of a disc (m), times the size of the case."""


@dataclass(frozen=True)
class Strike:
    """A block or a disc that strikes a plate."""

    body: str
    materials: tuple[str, str]
    plane: Literal["stress", "strain"]
    size: float
    tilt: float
    """°; a block stands on its left corner."""
    place: float
    """Where it strikes, over the width of the plate."""
    covered: float
    """The part of the edge beside the corner that the plate faces, on the coarse mesh; 1 in the middle."""
    speed: float
    """Over the wave speed."""
    along: float
    """Velocity along the plate over the speed."""
    friction: float
    cells: tuple[int, int]
    """Along block and plate."""
    passages: float
    """End, in passages of a wave through the plate."""

    @property
    def wave(self) -> float:
        """The lower of the wave speeds of both bodies (m/s), that of a bar."""
        return min(math.sqrt(MATERIALS[name]["young"] / MATERIALS[name]["density"]) for name in self.materials)

    @property
    def end(self) -> float:
        """End of the run (s)."""
        return self.passages * HEIGHT * self.size / self.wave

    def problem(self, refinements: int, size: float = 0.0) -> pc.Problem:
        """Give the problem on one of the meshes, with elements of a size (m) where the bodies touch."""
        scale, (columns, plate_columns), speed = self.size, self.cells, self.speed * self.wave
        gap, place = 0.25 * HEIGHT * scale / self.wave * speed, self.place * WIDTH * scale
        if self.body == "disc":
            mesh, low, turn = pc.Mesh.disc(RADIUS * scale, rings=3), [(0.0, -RADIUS * scale)], 0.0
            origin = (place, (HEIGHT + RADIUS) * scale + gap)
        else:
            mesh = pc.Mesh.rectangle(0.04 * scale, HEIGHT * scale, nx=columns, ny=max(2, round(0.625 * columns)))
            low, turn = [(0.0, 0.0), (self.covered * 0.04 * scale / columns, 0.0)], self.tilt
            origin = (place, HEIGHT * scale + gap)
        plate = pc.Mesh.rectangle(WIDTH * scale, HEIGHT * scale, nx=plate_columns, ny=max(2, round(0.42 * plate_columns)))
        struck = [(place, HEIGHT * scale), (WIDTH * scale, HEIGHT * scale)]
        if self.covered == 1.0:
            low, struck = low[:1], struck[:1]
        mesh, plate = refined(mesh, refinements, size, low), refined(plate, refinements, size, struck)
        above, below = (pc.Elastic(**MATERIALS[name], plane=self.plane) for name in self.materials)
        velocity = (self.along * speed, -speed)
        bodies = [
            pc.Body(name="plate", mesh=plate, material=below),
            pc.Body(name="body", mesh=mesh, material=above, rotation=turn, origin=origin, velocity=velocity),
        ]
        return pc.Problem(bodies=bodies, contacts=[pc.Interface(bodies=("body", "plate"), friction=self.friction)])

    def indices(self) -> list[float]:
        """Give the effectivity indices of sup and mean on all meshes."""
        return indices(self.problem, self.problem(FINER, SIZE * self.size), self.end)

    def __str__(self) -> str:
        part = "" if self.covered == 1.0 else f", {self.covered:.3g} of an edge covered"
        body = "disc" if self.body == "disc" else f"block tilted by {self.tilt:.1f}°{part}"
        return (
            f"{body}, {self.materials[0]} on {self.materials[1]}, plane {self.plane}, size {self.size:.2f}, {self.speed:.1e} of the wave speed, "
            f"μ = {self.friction:g}, {self.cells[0]} and {self.cells[1]} cells, {self.passages:.1f} passages"
        )


def strikes(seed: int, count: int, *, beside_end: bool) -> list[Strike]:
    """Give random cases, in the middle of the plate or beside its end, where more than a 16th of an edge is covered."""
    random = np.random.default_rng([seed, int(beside_end)])

    def one() -> Strike:
        tilt, size, speed = float(random.uniform(2.0, 45.0)), float(10.0 ** random.uniform(-1.0, 1.0)), float(10.0 ** random.uniform(-4.5, -1.3))
        above, below = (str(name) for name in random.choice(list(MATERIALS), 2))
        plane, friction = cast("Literal['stress', 'strain']", str(random.choice(["stress", "strain"]))), float(random.choice([0.0, 0.2, 0.5]))
        cells = (int(random.integers(4, 9)), int(random.integers(5, 13)))
        covered = float(random.choice([random.uniform(0.07, 1.0), 0.125, 0.25, 0.5])) if beside_end else 1.0
        place = float(random.uniform(0.2, 0.8))
        if beside_end:
            place = 1.0 - covered * 0.04 / cells[0] * math.cos(math.radians(tilt)) / WIDTH
        body = "disc" if not beside_end and random.uniform() < 0.2 else "block"
        along = 0.0 if beside_end else float(random.uniform(-0.5, 0.5))
        return Strike(body, (above, below), plane, size, tilt, place, covered, speed, along, friction, cells, float(random.uniform(1.6, 6.0)))

    return [one() for _ in range(count)]


def main() -> None:
    """Print the indices of each case, and their range."""
    for title, beside_end in (("in the middle of the plate", False), ("beside its end", True)):
        print(f"## {title}")
        found: list[float] = []
        for strike in strikes(SEED, COUNT, beside_end=beside_end):
            of_strike = strike.indices()
            found.extend(of_strike)
            print(f"{strike}: {', '.join(f'{index:.2f}' for index in of_strike)}", flush=True)
        print(f"{len(found)} indices from {min(found):.2f} to {max(found):.2f}")


if __name__ == "__main__":
    main()
