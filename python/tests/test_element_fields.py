"""Fields of the elements against formulas in NumPy."""

import numpy as np
import pytest

import percute as pc
from percute import _percute

YOUNG = {"soft": 3e9, "hard": 70e9}
POISSON = {"soft": 0.4, "hard": 0.3}
THICKNESS = 0.1


def _problem(plane):
    base = pc.Mesh.rectangle(0.05, 0.04, nx=6, ny=5)
    halves = {"soft": np.arange(0, 60, 2), "hard": np.arange(1, 60, 2)}
    mesh = pc.Mesh(base.points, base.cells, base.edge_groups, halves)
    material = {
        name: pc.Elastic(young=YOUNG[name], poisson=POISSON[name], density=2700.0, plane=plane, thickness=THICKNESS) for name in YOUNG
    }
    return pc.Problem(mesh, material=material, obstacles=[pc.Plane(point=(0, -1e-5), normal=(0.02, 1), friction=0.2, group="bottom")],
                      initial_velocity=(40, -30))


@pytest.fixture(scope="module", params=["stress", "strain"])
def history(request):
    return pc.simulate(_problem(request.param), end=8e-6, courant=0.8)


def _strain(history):
    """Strains by least squares: a plane through three points."""
    mesh = history.problem.mesh
    corners = np.concatenate([mesh.points[mesh.cells], np.ones((len(mesh.cells), 3, 1))], axis=2)
    gradient = np.linalg.solve(corners, history.displacement[:, mesh.cells])[:, :, :2]
    return (gradient + np.swapaxes(gradient, -1, -2)) / 2


def _field(history, name, rows):
    return _percute.element_field(history.problem._data, name, np.ascontiguousarray(rows))


def test_tensors_and_invariants(history):
    strain = _strain(history)
    in_strain = history.problem.material["soft"].plane == "strain"
    young, poisson = (np.resize([of["soft"], of["hard"]], 60) for of in (YOUNG, POISSON))
    shear = young / (2 * (1 + poisson))
    bulk = 2 * shear * poisson / (1 - 2 * poisson)
    tensor = np.zeros((*strain.shape[:2], 3, 3))
    tensor[..., :2, :2] = strain
    trace = np.trace(strain, axis1=-2, axis2=-1)
    tensor[..., 2, 2] = 0.0 if in_strain else -poisson / (1 - poisson) * trace
    space = 2 * shear[:, None, None] * tensor + (bulk * np.trace(tensor, axis1=-2, axis2=-1))[..., None, None] * np.eye(3)
    deviator = space - np.trace(space, axis1=-2, axis2=-1)[..., None, None] / 3 * np.eye(3)
    u = history.displacement
    # Strains lose the digits of the displacements: some 1e-16 of 3e-4 m in elements of 1e-2 m.
    close = {"rtol": 0, "atol": 1e-10 * np.abs(space).max()}
    np.testing.assert_allclose(_field(history, "strain", u), strain, rtol=0, atol=1e-10 * np.abs(strain).max())
    np.testing.assert_allclose(_field(history, "stress", u), space[..., :2, :2], **close)
    np.testing.assert_allclose(_field(history, "stress_across", u), space[..., 2, 2], **close)
    np.testing.assert_allclose(_field(history, "von_mises", u), np.sqrt(1.5 * (deviator**2).sum(axis=(-2, -1))), **close)
    np.testing.assert_allclose(_field(history, "pressure", u), -np.trace(space, axis1=-2, axis2=-1) / 3, **close)


def test_energies_sum_to_the_balance(history):
    for name, rows in (("strain", history.displacement), ("kinetic", history.velocity)):
        energy = _field(history, f"{name}_energy", rows)
        assert energy.shape == (len(history), 60)
        assert not energy.flags.writeable
        expected = getattr(history.balance, name)
        np.testing.assert_allclose(energy.sum(axis=1), expected, rtol=0, atol=1e-12 * expected.max())


def test_a_field_of_another_shape_is_refused(history):
    with pytest.raises(pc.InputError, match=r"\(instants, 42, 2\)"):
        _field(history, "stress", history.displacement[:, 1:])
