"""Bytes that each stage moves per element and step, from the sizes of its data: `python benches/traffic.py` prints the table of docs/speed.md.

A pass over the mesh moves each of its arrays once: one that is read counts once, one that is written twice, because a line of the cache is
read before it is written. In a triangulation a node goes with two elements, three edges too, and three links of stars with each element. What is the
same for eight levels counts an eighth. Slopes and measure find the moments in the cache: they follow part by part. Elements around contact nodes
are left out.
"""

from __future__ import annotations

VECTOR, NUMBER, WRITE = 16, 8, 2
"""Bytes of a vector of a node and of a number; a written array counts this many times."""
MOTIONS = 4 * VECTOR
"""Of a node: the auxiliary solution and the three motions beside it."""
LEVELS = 8

Part = tuple[str, float, float]
"""What, bytes per node, bytes per element."""

MOTION: Part = ("u_CA and its rate, and the rate half a step before", 4 * VECTOR + NUMBER + WRITE * 3 * VECTOR, 0)
ACCELERATION: Part = ("ã", WRITE * VECTOR + NUMBER, 0)
INCREMENT: Part = ("∫ã dt", 3 * VECTOR + WRITE * VECTOR, 0)
LUMPING_INCREMENT: Part = ("the same of the lumping difference", *INCREMENT[1:])
BALANCED: Part = ("displacement and forces that are balanced", 2 * VECTOR + WRITE * 2 * VECTOR, 0)
PASS: Part = (
    "auxiliary solution and three motions: four fields, two corrections, four fields of the simulation, three results",
    WRITE * (4 * MOTIONS + 2 * 2 * VECTOR) + VECTOR + 2 * NUMBER + WRITE * 3 * VECTOR,
    104 / 2,
)
UNMEASURED: Part = ("copy of the displacement", VECTOR + WRITE * VECTOR, 0)
DIFFERENCE: Part = ("energies of the differences of the motions", MOTIONS + WRITE * 2 * MOTIONS + 2 * VECTOR + NUMBER, 104 / 2)
STARS: Part = ("stars: displacement, ã, moments on links, maps", 2 * VECTOR, WRITE * 3 * VECTOR + (88 + 32) / LEVELS)
MEASURE: Part = (
    "measure: ã, motion, its rate half a step before, ∫ã, maps, course of each element",
    5 * VECTOR,
    (88 + 12 + WRITE * 200 + 16) / LEVELS,
)
LUMPING: Part = ("lumping difference, twice, and its integral", 3 * VECTOR, 0)
SLOPES: Part = ("slopes: displacement, ã, lumping difference, maps", 3 * VECTOR, WRITE * 3 * NUMBER + (88 + 12 + 16) / LEVELS)
MINIMISATION: Part = (
    "minimisation: slopes, change, coefficients of nodes and edges, matrix",
    WRITE * 3 * NUMBER,
    WRITE * 2 * 3 * NUMBER + WRITE * 3 * NUMBER + 422 / LEVELS,
)
CHANGE: Part = ("change of the moments", 0, WRITE * 3 * VECTOR + 3 * NUMBER)

PREPARED = [MOTION, BALANCED, ACCELERATION, INCREMENT]
CORRECTED = [MOTION, PASS, ACCELERATION, INCREMENT, LUMPING_INCREMENT]
PARTS: dict[str, list[Part]] = {
    "product K·u": [
        ("14 entries and columns, a start of a row", 0, 14 * (NUMBER + 4) + NUMBER),
        ("u, K·u", VECTOR + WRITE * VECTOR, 0),
    ],
    "integrator": [("pairs of elements", 0, 40), ("u, v, forces, mass and its inverse", WRITE * 3 * VECTOR + 2 * NUMBER, 0)],
    "consistent": [*PREPARED, STARS, MEASURE],
    "corrected": [*CORRECTED, DIFFERENCE, STARS, SLOPES, MINIMISATION, CHANGE, MEASURE, LUMPING],
    "between": [*CORRECTED, UNMEASURED],
}
"""By stage, the parts of a step; those of an estimate without the integrator."""


def of_part(part: Part) -> float:
    """Bytes per element."""
    return part[1] / 2 + part[2]


def of_stage(stage: str) -> float:
    """Bytes per element and step."""
    return sum(map(of_part, PARTS[stage]))


def main() -> None:
    """Print all parts."""
    print("| stage | array | bytes per node | bytes per element | bytes in all per element |")
    print("|---|---|---|---|---|")
    for stage, parts in PARTS.items():
        for part in parts:
            print(f"| {stage} | {part[0]} | {part[1]:.0f} | {part[2]:.0f} | {of_part(part):.0f} |")
        print(f"| {stage} | all | | | {of_stage(stage):.0f} |")


if __name__ == "__main__":
    main()
