"""The estimate `consistent` as batched NumPy: stresses, star problems and norms of 32 steps at a time.

For a body without contact it computes the kinetic and elastic parts of η at each step and half step, as percute does. Left out,
in its favour: contact, the motion that is compared (it is given), the reference d, the error of each element, residuals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from block import DENSITY, ELASTICITY, Block
from scipy_product import Scipy
from triangle_forms import forms

LEVELS = 32
"""Steps at a time."""
BLOCK = 256
"""Elements whose norms are computed at a time, in cache."""


def steps_of(block: Block, count: int) -> Steps:
    """The fields of steps 0 to count - 1 of a body without contact."""
    scheme, dt = Scipy(block), block.step
    shape = (*block.points.shape, count)
    fields = {name: np.zeros(shape) for name in ("u", "a", "i", "ih", "w", "wh", "v", "vh")}
    u, v, w, increment = np.zeros(shape[:2]), block.velocity(), np.zeros(shape[:2]), np.zeros(shape[:2])
    half, before = v, np.zeros(shape[:2])
    for n in range(count):
        a = -(scheme.stiffness @ u.ravel()).reshape(shape[:2]) / scheme.mass[:, None]
        if n > 0:
            fields["ih"][..., n] = increment + dt / 8 * (3 * before + a)
            increment = increment + dt / 2 * (before + a)
            fields["wh"][..., n] = w + dt / 4 * (v + half)
            fields["vh"][..., n], v = half, half + dt / 2 * a
            w = fields["wh"][..., n] + dt / 4 * (half + v)
        for name, field in (("u", u), ("a", a), ("i", increment), ("w", w), ("v", v)):
            fields[name][..., n] = field
        half = v + dt / 2 * a
        u, before = u + dt * half, a
    pairs = [(fields[f"{name}h"], fields[name]) for name in "iwv"]
    return Steps(fields["u"], fields["a"], *pairs)


@dataclass(frozen=True)
class Steps:
    """Nodal fields (nodes, 2, levels) of some steps; those in pairs half a step before each level and at it."""

    displacement: np.ndarray
    acceleration: np.ndarray
    increment: tuple[np.ndarray, np.ndarray]
    """∫a dt (m/s)."""
    motion: tuple[np.ndarray, np.ndarray]
    """u_CA (m)."""
    velocity: tuple[np.ndarray, np.ndarray]
    """u̇_CA (m/s)."""


class Stars:
    """The star problems: corners (element and local node) in counterclockwise chains around each node."""

    def __init__(self, cells: np.ndarray) -> None:
        count = cells.shape[0] * 3
        node = cells.ravel()
        after, before = np.roll(cells, -1, axis=1).ravel(), np.roll(cells, -2, axis=1).ravel()
        # A corner leaves its element by the edge to the node before, and enters it by the edge to the node after.
        entries = node * (node.max() + 1) + after
        order = np.argsort(entries)
        exits = node * (node.max() + 1) + before
        found = np.minimum(np.searchsorted(entries, exits, sorter=order), count - 1)
        following = np.where(entries[order[found]] == exits, order[found], -1)
        first = np.ones(count, dtype=bool)
        first[following[following >= 0]] = False
        open_stars = np.flatnonzero(first)
        inner = np.ones(node.max() + 1, dtype=bool)
        inner[node[open_stars]] = False
        lowest = np.unique(node, return_index=True)[1]
        corner = np.arange(count)
        self.behind = corner - corner % 3 + (corner + 1) % 3
        self.across = following - following % 3 + (following + 2) % 3
        self.groups: list[tuple[np.ndarray, ...]] = []
        self.links = 0
        self.exit, self.entry = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
        for starts, closed in ((open_stars, False), (lowest[inner], True)):
            self._chain(starts, following, closed)

    def _chain(self, starts: np.ndarray, following: np.ndarray, closed: bool) -> None:
        chain = [starts]
        while len(starts):
            corners = np.stack(chain)
            after = following[corners[-1]]
            done = after == starts if closed else after < 0
            if done.any():
                self._group(corners[:, done], closed)
            chain = [row[~done] for row in (*chain, after)]
            starts = chain[0]

    def _group(self, corners: np.ndarray, closed: bool) -> None:
        """Take in the stars with one number of elements: b = P r + (1 - P A) t for all of them."""
        size, stars = corners.shape
        unknown = size if closed else size - 1
        system = (np.eye(size) - np.roll(np.eye(size), -1, axis=1))[:, :unknown]
        inverse = np.linalg.pinv(system)
        numbers = self.links + np.arange(unknown * stars).reshape(unknown, stars)
        self.links += unknown * stars
        # Link m leaves corner m and enters the next; -1 is an end without force.
        none = np.full((1, stars), -1)
        self.exit[corners] = numbers if closed else np.vstack([numbers, none])
        self.entry[corners] = np.roll(numbers, 1, axis=0) if closed else np.vstack([none, numbers])
        if unknown:
            self.groups.append((corners, numbers, inverse, np.eye(unknown) - inverse @ system))

    def solve(self, residual: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Moments (links + 1, 2, levels), the last zero, from residuals and ∫σ∇φ of all corners."""
        moments = np.zeros((self.links + 1, *residual.shape[1:]))
        for corners, numbers, inverse, rest in self.groups:
            # Of the averaged finite-element traction on each link: |e|n/2 is −|E|∇φ of the node opposite.
            wanted = 0.5 * (force[self.across[corners[: len(numbers)]]] - force[self.behind[corners[: len(numbers)]]])
            shape = wanted.shape
            solution = inverse @ residual[corners].reshape(len(corners), -1) + rest @ wanted.reshape(shape[0], -1)
            moments[numbers] = solution.reshape(shape)
        return moments


class Equilibration:
    """All operators of a mesh, made once."""

    name = "NumPy, batched over 32 steps"

    def __init__(self, block: Block) -> None:
        cells = block.cells
        areas, _ = block.geometry()
        corners = block.points[cells]
        edges = np.round((corners - corners[:, :1]).reshape(len(cells), 6) / np.abs(corners).max(), 9)
        _, first, shape = np.unique(edges, axis=0, return_index=True, return_inverse=True)
        elastic, closest, kinetic = (np.stack(some) for some in zip(*(forms(corners[e]) for e in first), strict=True))
        # Any mesh: each element has operators of its own.
        self.elastic, self.closest, self.kinetic = elastic[shape], closest[shape], kinetic[shape]
        strain = block.strain()
        self.stress = ELASTICITY @ strain
        self.force = areas[:, None, None] * strain.transpose(0, 2, 1)
        self.share = (DENSITY * areas / 3)[:, None, None, None]
        self.start = block.velocity()[cells].reshape(-1, 6, 1)
        self.cells, self.stars = cells, Stars(cells)
        self.last = np.zeros((len(cells), 18, 1))

    def internal(self, displacement: np.ndarray, some: slice = slice(None)) -> np.ndarray:
        """∫σ∇φ (elements, 3 nodes, 2, levels) of some elements."""
        cells = self.cells[some]
        local = displacement[cells].reshape(len(cells), 6, -1)
        return (self.force[some] @ (self.stress[some] @ local)).reshape(len(cells), 3, 2, -1)

    def loads(self, displacement: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
        """Outward moments of the equilibrated tractions, 12 for each element, and its 6 accelerations."""
        force, nodal = self.internal(displacement), acceleration[self.cells]
        shape = force.shape
        residual = (force + self.share * nodal).reshape(-1, *shape[2:])
        solved = self.stars.solve(residual, force.reshape(residual.shape))
        leaving, entering = solved[self.stars.exit].reshape(shape), solved[self.stars.entry].reshape(shape)
        loads = np.empty((shape[0], 18, shape[-1]))
        moments = loads[:, :12].reshape(shape[0], 3, 2, *shape[2:])
        for i in range(3):
            # Corner i leaves by face i + 1, whose second end it is, and enters by face i + 2, whose first end it is.
            moments[:, (i + 1) % 3, 1] = leaving[:, i]
            moments[:, (i + 2) % 3, 0] = -entering[:, i]
        loads[:, 12:] = nodal.reshape(shape[0], 6, -1)
        return loads

    def elastic_part(self, loads: np.ndarray, displacement: np.ndarray, some: slice) -> np.ndarray:
        """½∫(σ_DA − σ_CA):K⁻¹(σ_DA − σ_CA) at each level (J)."""
        difference = loads.copy()
        difference[:, :12].reshape(len(loads), 3, 2, 2, -1)[:] += self.internal(displacement, some)[:, :, None]
        return np.einsum("eil,eil->l", difference, self.elastic[some] @ difference)

    def kinetic_part(self, increment: np.ndarray, velocity: np.ndarray, some: slice) -> np.ndarray:
        """½∫ρ(u̇_DA − u̇_CA)² at each level (J)."""
        cells = self.cells[some]
        local = (len(cells), 6, -1)
        misfit = self.closest[some] @ increment[cells].reshape(local)
        misfit += self.start[some] - velocity[cells].reshape(local)
        return np.einsum("eil,eil->l", misfit, self.kinetic[some] @ misfit)

    def parts(self, steps: Steps) -> np.ndarray:
        """Kinetic and elastic part (2, levels, 2) of η (J), half a step before each level and at it."""
        loads = self.loads(steps.displacement, steps.acceleration)
        result = np.zeros((2, steps.displacement.shape[-1], 2))
        for begin in range(0, len(loads), BLOCK):
            some = slice(begin, begin + BLOCK)
            after = loads[some]
            before = np.concatenate([self.last[some], after[:, :, :-1]], axis=2)
            for at, balanced in enumerate((0.5 * (before + after), after)):
                result[0, :, at] += self.kinetic_part(steps.increment[at], steps.velocity[at], some)
                result[1, :, at] += self.elastic_part(balanced, steps.motion[at], some)
        self.last = loads[:, :, -1:].copy()
        return result
