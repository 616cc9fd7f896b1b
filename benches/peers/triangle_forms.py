"""Error of one triangle as quadratic forms of its loads (setup of `numpy_equilibration.py`)."""

from __future__ import annotations

import numpy as np
from block import DENSITY, ELASTICITY

GROUP = [(1, 2), (2, 0), (0, 1)]
"""Ends of the face opposite each node, counterclockwise."""
MASS = np.array(
    [
        [6, -1, -1, 0, -4, 0],
        [-1, 6, -1, 0, 0, -4],
        [-1, -1, 6, -4, 0, 0],
        [0, 0, -4, 32, 16, 16],
        [-4, 0, 0, 16, 32, 16],
        [0, -4, 0, 16, 16, 32],
    ]
)
"""180 times the mass matrix of a quadratic triangle of area 1: corners, then the middles of sides 01, 12, 20."""


def energy_form(corners: np.ndarray) -> np.ndarray:
    """Least ½∫σ:K⁻¹σ of quadratic stresses on three sub-triangles, a form of 12 tractions |e|F and 6 volume loads.

    The tractions are those of each face at its two ends; div σ is the linear volume load of the three nodes.
    """
    size = np.sqrt(np.ptp(corners[:, 0]) * np.ptp(corners[:, 1]))
    points = (corners - corners.mean(axis=0)) / size
    gram, rows, loads = np.zeros((54, 54)), [], []

    def slot(sub: int, node: int) -> int:
        return 18 * sub + 3 * node

    def balance(stress: np.ndarray, load: np.ndarray) -> None:
        rows.append(stress)
        loads.append(load)

    for sub, (p, q) in enumerate(GROUP):
        triangle = np.array([points[p], points[q], [0.0, 0.0]])
        shares = np.zeros((3, 3))
        shares[0, p] = shares[1, q] = 1.0
        shares[2] = 1.0 / 3.0
        area, gradients = linear_gradients(triangle)
        gram[18 * sub : 18 * sub + 18, 18 * sub : 18 * sub + 18] = np.kron(
            area / 180 * MASS, np.linalg.inv(ELASTICITY / ELASTICITY[0, 0])
        )
        # Shear stands once in the vector of a stress and twice in its product with a strain.
        for corner in range(3):
            for c in range(2):
                stress, load = np.zeros(54), np.zeros(18)
                for node, gradient in enumerate(quadratic_gradients(corner, gradients)):
                    stress[slot(sub, node) + c] += gradient[c]
                    stress[slot(sub, node) + 2] += gradient[1 - c]
                load[12 + c :: 2] = shares[corner]
                balance(stress, size * load)
        for node, weights in ((0, (1, 0)), (1, (0, 1)), (3, (0.5, 0.5))):
            for c in range(2):
                load = np.zeros(18)
                load[4 * sub + c], load[4 * sub + 2 + c] = weights
                balance(traction(slot(sub, node), points[p], points[q], c), load / size)
    for k in range(3):
        # The two sub-triangles at node k: it is the end of face k + 1 and the start of face k + 2 (modulo 3).
        one, other = (k + 1) % 3, (k + 2) % 3
        places = {sub: GROUP[sub].index(k) for sub in (one, other)}
        middles = {sub: 5 if places[sub] == 0 else 4 for sub in (one, other)}
        for here, there in ((places[one], places[other]), (middles[one], middles[other]), (2, 2)):
            for c in range(2):
                jump = traction(slot(one, here), points[k], 0 * points[k], c)
                balance(jump - traction(slot(other, there), points[k], 0 * points[k], c), np.zeros(18))
    conditions = np.array(rows)
    system = np.block([[gram, conditions.T], [conditions, np.zeros((len(rows), len(rows)))]])
    stresses = (np.linalg.pinv(system, rcond=1e-11) @ np.vstack([np.zeros((54, 18)), loads]))[:54]
    return 0.5 * size**2 / ELASTICITY[0, 0] * stresses.T @ gram @ stresses


def linear_gradients(triangle: np.ndarray) -> tuple[float, np.ndarray]:
    """Area, and gradients of the barycentric coordinates."""
    matrix = np.linalg.inv(np.column_stack([np.ones(3), triangle]))
    return 0.5 / np.linalg.det(matrix), matrix[1:].T


def quadratic_gradients(corner: int, gradients: np.ndarray) -> list[np.ndarray]:
    """Gradients of the six quadratic shape functions at a corner."""
    at = np.eye(3)[corner]
    corners = [(4 * at[a] - 1) * gradients[a] for a in range(3)]
    return corners + [4 * (at[a] * gradients[b] + at[b] * gradients[a]) for a, b in ((0, 1), (1, 2), (2, 0))]


def traction(slot: int, start: np.ndarray, end: np.ndarray, c: int) -> np.ndarray:
    """Component c of |e|σn at a node, to the right of an edge."""
    dx, dy = end - start
    normal, row = (dy, -dx), np.zeros(54)
    row[slot + c], row[slot + 2] = normal[c], normal[1 - c]
    return row


def forms(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The forms of an element: elastic, of its 12 edge moments and 6 accelerations; Γ/ρ from accelerations; kinetic."""
    arms = corners - corners.mean(axis=0)
    rotation = np.column_stack([-arms[:, 1], arms[:, 0]]).ravel()
    # The nodal field and three times its rotation: the nearest one with the moment of the lumped mass.
    closest = np.eye(6) + 3 * np.outer(rotation, rotation) / (rotation @ rotation)
    to_loads = np.zeros((18, 18))
    for k in range(3):
        for c in range(2):
            a, b = 4 * k + c, 4 * k + 2 + c
            to_loads[a, [a, b]] = 4, -2
            to_loads[b, [b, a]] = 4, -2
    to_loads[12:, 12:] = DENSITY * closest
    area, _ = linear_gradients(corners)
    mass = DENSITY * area / 12 * np.kron(np.ones((3, 3)) + np.eye(3), np.eye(2))
    return to_loads.T @ energy_form(corners) @ to_loads, closest, 0.5 * mass
