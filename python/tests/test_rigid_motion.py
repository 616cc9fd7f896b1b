"""The mean motion of a body, and stretches and stresses of large strains."""

import numpy as np
import percute as pc
import pytest
from percute import InputError


def spinning(law: str = "neo_hookean", *, spin: float = 400.0, end: float = 6e-3) -> pc.History:
    """Simulate a square of rubber in free flight that moves and turns."""
    mesh = pc.Mesh.rectangle(0.04, 0.03, nx=8, ny=6)
    x, y = (mesh.points - [0.02, 0.015]).T
    velocity = np.column_stack([3.0 - spin * y, -1.0 + spin * x])
    rubber = pc.Elastic(young=10e6, poisson=0.4, density=1100.0, plane="strain", kinematics="finite", law=law)
    return pc.simulate(pc.Problem(mesh, material=rubber, initial_velocity=velocity), end=end, courant=0.8, progress=None)


def test_free_flight_keeps_its_momenta() -> None:
    """Momenta stay the same to rounding, the centre moves on a line, and the body turns by more than half a turn."""
    history = spinning()
    motion = history.rigid_motion()
    assert motion.mass == pytest.approx(1100.0 * 0.04 * 0.03, rel=1e-12)
    assert np.abs(motion.momentum - motion.momentum[0]).max() < 1e-12 * np.abs(motion.momentum).max()
    line = motion.centre[0] + np.outer(motion.time, motion.velocity[0])
    assert np.abs(motion.centre - line).max() < 1e-12
    # v_n is the mean of two half steps, x_n × v_n their sum: the scheme keeps the angular momentum of these.
    assert np.abs(motion.angular_momentum / motion.angular_momentum[0] - 1.0).max() < 1e-11
    assert motion.rotation[0] == pytest.approx(0.0, abs=1e-15)
    # A body that its spin strains turns more slowly.
    assert 0.7 * 400.0 * motion.time[-1] < motion.rotation[-1] < 400.0 * motion.time[-1]
    assert np.abs(np.diff(motion.rotation)).max() < 0.1
    steps = np.diff(motion.rotation) / np.diff(motion.time)
    assert steps.mean() == pytest.approx(motion.angular_velocity.mean(), rel=0.01)


def test_stress_and_stretches_follow_from_the_gradient() -> None:
    """P and the stretches are those of the deformation gradient and the law, by numpy."""
    history = spinning()
    mesh, moved = history.problem.mesh, history.displacement[-1]
    corners, places = mesh.points[mesh.cells], (mesh.points + moved)[mesh.cells]
    edges = [np.swapaxes(p[:, 1:] - p[:, :1], 1, 2) for p in (places, corners)]
    gradient = edges[0] @ np.linalg.inv(edges[1])
    shear, lame = 10e6 / 2.8, 10e6 * 0.4 / (1.4 * 0.2)
    inverse = np.swapaxes(np.linalg.inv(gradient), 1, 2)
    volume = np.linalg.det(gradient)[:, None, None]
    expected = shear * (gradient - inverse) + lame * np.log(volume) * inverse
    # Rounding of strains of some per cent.
    assert np.abs(history.first_piola(-1) - expected).max() < 1e-11 * np.abs(expected).max()
    stretches = np.linalg.svd(gradient, compute_uv=False)
    assert np.abs(history.principal_stretches(-1) - stretches).max() < 1e-13
    cauchy = expected @ np.swapaxes(gradient, 1, 2) / volume
    assert np.abs(history.stress(-1) - cauchy).max() < 1e-11 * np.abs(cauchy).max()
    assert history.first_piola([0, 1]).shape == (2, len(mesh.cells), 2, 2)


def test_a_bar_has_no_rotation() -> None:
    """A bar has a centre, and one stretch."""
    mesh = pc.Mesh.bar(1.0, elements=10)
    steel = pc.Elastic(young=200e9, density=7800.0, section=1e-4)
    history = pc.simulate(pc.Problem(mesh, material=steel, initial_velocity=(2.0,)), end=1e-4, courant=0.9, progress=None)
    motion = history.rigid_motion()
    assert motion.centre[-1] == pytest.approx(0.5 + 2e-4, rel=1e-12)
    assert not motion.rotation.any() and not motion.angular_momentum.any()
    assert history.principal_stretches(-1) == pytest.approx(np.ones((10, 1)))


def test_an_unknown_group_is_refused() -> None:
    """A message names the groups that there are."""
    with pytest.raises(InputError, match="`group` is 'hub'; it must be the name of a group of elements"):
        spinning(end=1e-4).rigid_motion("hub")
