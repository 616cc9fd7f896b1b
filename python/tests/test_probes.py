"""Fields of the elements of a history, and probes: against fields whose values are known."""

import numpy as np
import percute as pc
import pytest

YOUNG, POISSON = 2e11, 0.3


def linear(plane: str = "stress", mesh: pc.Mesh | None = None) -> pc.History:
    """A plate in flight under the uniform strain ε_xx = 1e-3, ε_xy = 2e-4, at rest at the start."""
    body = pc.Mesh.rectangle(1.0, 0.5, nx=4, ny=3) if mesh is None else mesh
    x, y = body.points.T
    field = np.column_stack([1e-3 * x + 4e-4 * y, np.zeros(len(x))])
    velocity = np.column_stack([1.0 + 0.1 * x, 0.2 * y])
    law = pc.Elastic(young=YOUNG, poisson=POISSON, density=7800.0, plane=plane)  # type: ignore[arg-type]
    problem = pc.Problem(body, material=law, initial_displacement=field, initial_velocity=velocity)
    return pc.simulate(problem, end=4e-6, step=1e-6)


@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_stress_and_strain_of_a_uniform_field(plane: str) -> None:
    history = linear(plane)
    strain = np.array([[1e-3, 2e-4], [2e-4, 0.0]])
    assert np.allclose(history.strain(0), strain, atol=1e-15)
    lame = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON)) if plane == "strain" else YOUNG * POISSON / (1 - POISSON**2)
    shear = YOUNG / (2 * (1 + POISSON))
    stress = lame * 1e-3 * np.eye(2) + 2 * shear * strain
    assert np.allclose(history.stress(0), stress, rtol=1e-11)
    across = lame * 1e-3 if plane == "strain" else 0.0
    assert np.allclose(history.pressure(0), -(stress.trace() + across) / 3, rtol=1e-11)
    a, b, c = stress[0, 0], stress[1, 1], across
    known = np.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2) + 3 * stress[0, 1] ** 2)
    assert np.allclose(history.von_mises(0), known, rtol=1e-11)


def test_energies_of_the_elements_add_up(block_history: pc.History) -> None:
    every = slice(None)
    # Sums of 96 terms.
    assert np.allclose(block_history.strain_energy(every).sum(axis=1), block_history.balance.strain, rtol=1e-12)
    assert np.allclose(block_history.kinetic_energy(every).sum(axis=1), block_history.balance.kinetic, rtol=1e-12)


def test_one_instant_or_several(block_history: pc.History) -> None:
    history = block_history
    last = len(history) - 1
    assert history.stress(3).shape == (96, 2, 2) and history.stress(slice(2, 8, 2)).shape == (3, 96, 2, 2)
    assert np.array_equal(history.stress([3, -1]), [history.stress(3), history.stress(last)])
    assert np.array_equal(history.von_mises(np.array([last])), [history.von_mises(-1)])
    for wrong in (last + 1, "x", 1.5, [0, last + 1], [[0]], [0.5], None, slice("a", "b"), True):
        with pytest.raises(pc.InputError, match="`step`"):
            history.strain(wrong)  # type: ignore[arg-type]


def test_a_point_in_an_element_is_interpolated() -> None:
    history = linear()
    for x, y in ((0.313, 0.211), (0.25, 0.1), (1.0, 0.5), (0.0, 0.5), (1.0 + 1e-12, 0.3)):
        # 1e-12 m outside the body is rounding.
        assert history.probe((x, y))[0] == pytest.approx([1e-3 * x + 4e-4 * y, 0.0], abs=2e-15)
        assert history.probe((x, y), "velocity")[0] == pytest.approx([1.0 + 0.1 * x, 0.2 * y], rel=1e-11, abs=1e-12)
    values = history.probe((0.313, 0.211), "stress")
    element = int(np.argmin(np.linalg.norm(history.problem.mesh.points[history.problem.mesh.cells].mean(axis=1) - (0.313, 0.211), axis=1)))
    assert values.shape == (5, 2, 2) and np.allclose(values, history.stress(slice(None))[:, element], rtol=1e-12, atol=1e-3)
    assert history.probe((0.313, 0.211), "acceleration").shape == (5, 2)


def test_a_group_has_a_mean_or_each_of_its_nodes() -> None:
    """On an edge of unequal parts, a linear field has the mean of its ends."""
    base = pc.Mesh.rectangle(1.0, 0.5, nx=4, ny=3)
    mesh = base.refine(where=base.points[base.cells][:, :, 0].max(axis=1) < 0.3)
    history = linear(mesh=mesh)
    bottom = np.unique(mesh.edge_groups["bottom"])
    assert history.probe("bottom")[0] == pytest.approx([0.5e-3, 0.0], rel=1e-12, abs=1e-18)
    each = history.probe("bottom", each=True)
    assert np.array_equal(each, history.displacement[:, bottom]) and each[0].mean() != pytest.approx(0.25e-3)
    strips = history.probe("right", "von_mises", each=True)
    assert strips.shape == (5, 3) and np.allclose(history.probe("right", "von_mises"), strips.mean(axis=1))


def test_groups_of_elements_with_materials() -> None:
    base = pc.Mesh.rectangle(1.0, 0.5, nx=4, ny=3)
    centroids = base.points[base.cells].mean(axis=1)
    mesh = pc.Mesh(base.points, base.cells, base.edge_groups, {"soft": np.flatnonzero(centroids[:, 0] < 0.5), "hard": np.flatnonzero(centroids[:, 0] > 0.5)})
    law = {name: pc.Elastic(young=young, poisson=0.0, density=7800.0, plane="stress") for name, young in (("soft", 1e10), ("hard", 2e11))}
    field = np.column_stack([1e-3 * mesh.points[:, 0], np.zeros(20)])
    history = pc.simulate(pc.Problem(mesh, material=law, initial_displacement=field), end=2e-6, step=1e-6)
    assert history.probe("soft", "stress")[0, 0, 0] == pytest.approx(1e7) and history.probe("hard", "stress")[0, 0, 0] == pytest.approx(2e8)
    assert history.probe("hard")[0, 0] == pytest.approx(0.75e-3) and history.probe((0.9, 0.1), "stress")[0, 0, 0] == pytest.approx(2e8)


def test_bars(bar_history: pc.History) -> None:
    assert np.array_equal(bar_history.probe("end"), bar_history.displacement[:, 40])
    assert np.allclose(bar_history.probe(0.05, "velocity"), bar_history.velocity[:, 20], rtol=1e-12)
    assert np.array_equal(bar_history.probe([0.0], "stress")[:, 0, 0], bar_history.stress(slice(None))[:, 0, 0, 0])


def test_what_cannot_be_read_is_told(block_history: pc.History) -> None:
    with pytest.raises(pc.InputError, match=r"`where` is \(0.06, 0.02\), 0.01 m outside the undeformed body; its nearest point is \(0.05, 0.02\) m"):
        block_history.probe((0.06, 0.02))
    with pytest.raises(pc.InputError, match="`where` is 'floor'; it must be a point or the name of a group: 'bottom'"):
        block_history.probe("floor")
    with pytest.raises(pc.InputError, match="`quantity` is 'strain_energy'; it must be one of displacement"):
        block_history.probe("bottom", "strain_energy")
    with pytest.raises(pc.InputError, match="`each` needs a group"):
        block_history.probe((0.0, 0.0), each=True)


def test_fields_in_tables(block_history: pc.History) -> None:
    table = block_history.to_pandas("elements", step=9)
    assert np.array_equal(table["stress_xy"], block_history.stress(9)[:, 0, 1]) and table.attrs["units"]["stress_xy"] == "Pa"
    assert np.array_equal(table["kinetic_energy"], block_history.kinetic_energy(9)) and "strain_yx" not in table
    data = block_history.to_xarray(["von_mises"])
    assert data.von_mises.dims == ("time", "element") and np.array_equal(data.von_mises[9], block_history.von_mises(9))
    assert np.allclose(data.element_y, table["element_y"])


@pytest.mark.parametrize("quantity", ["acceleration", "stress_xx", "stress_xy", "strain_energy"])
def test_fields_are_drawn(quantity: str, block_history: pc.History) -> None:
    import matplotlib.pyplot as plt

    axes = block_history.plot(quantity, step=12)
    assert axes.child_axes[0].get_ylabel()
    # Signed values are light: the outline of 28 edges shows the body.
    assert (28 in [len(each.get_paths()) for each in axes.collections]) == ("stress" in quantity)
    plt.close("all")
