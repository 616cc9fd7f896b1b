"""Estimates of corners with small elements, and the energy that contact gives to the auxiliary solution."""

import json
import math

import numpy as np
import percute as pc
import pytest


def corner(mesh: pc.Mesh, tilt: float, gap: float, material: pc.Elastic, refinements: int) -> pc.Problem:
    """A body of aluminium that strikes with a corner, the origin, whose elements are halved so often.

    At 0.4 m/s strains stay below 2 % in the smallest ones.
    """
    for _ in range(refinements):
        mesh = mesh.refine(where=(mesh.cells == int(np.flatnonzero((mesh.points == 0.0).all(1))[0])).any(1))
    normal = np.array([math.sin(math.radians(tilt)), math.cos(math.radians(tilt))])
    plane = pc.Plane(point=-gap * normal, normal=normal, friction=0.0)
    return pc.Problem(mesh, material=material, initial_velocity=-0.4 * normal, obstacles=[plane])


def long_block(refinements: int) -> pc.Problem:
    """The corner touches alone."""
    material = pc.Elastic(young=70e9, poisson=0.33, density=2700.0, plane="strain")
    return corner(pc.Mesh.rectangle(0.06, 0.012, nx=20, ny=4), 12.0, 1e-6, material, refinements)


def short_block(refinements: int) -> pc.Problem:
    """A second node touches after the corner."""
    material = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    return corner(pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8), 10.0, 1e-7, material, refinements)


@pytest.mark.parametrize(("problem", "end", "courants"), [(long_block(6), 2e-5, (0.9, 0.7, 0.5)), (short_block(6), 4e-5, (0.9, 0.7))])
def test_the_step_does_not_decide_on_the_estimate_of_small_elements(problem: pc.Problem, end: float, courants: tuple[float, ...]) -> None:
    """On one mesh the error is that of the mesh: it changes by 1 % with the step, in failed estimates by 25 % to 600 %."""
    estimates = [pc.estimate(pc.simulate(problem, end=end, courant=courant)) for courant in courants]
    means = [estimate.published_relative_mean for estimate in estimates]
    assert max(means) < 1.03 * min(means), means
    for estimate in estimates:
        # Measured: 0 % with the long block, and 8 % with the short one at either step; above 10 % the program warns.
        assert json.loads(estimate.to_json())["auxiliary_contact_energy"] < 0.09
        assert estimate.trust == "high"


def test_refinement_at_the_corner_does_not_raise_the_estimate() -> None:
    means = [pc.estimate(pc.simulate(long_block(count), end=2e-5, courant=0.9)).published_relative_mean for count in (4, 5, 6)]
    assert means == sorted(means, reverse=True), means
