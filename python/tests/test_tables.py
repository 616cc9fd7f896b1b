"""Tables of pandas and data sets of xarray: the numbers of the arrays, with units."""

import subprocess
import sys

import numpy as np
import percute as pc
import pytest
from conftest import block


@pytest.fixture(scope="module")
def estimate(block_history: pc.History) -> pc.Estimate:
    return pc.estimate(block_history, instants=3, fields=True)


def test_a_history_over_time(block_history: pc.History) -> None:
    table = block_history.to_pandas()
    assert np.array_equal(table.index, block_history.time) and table.index.name == "time"
    assert np.array_equal(table["kinetic"], block_history.balance.kinetic)
    assert np.array_equal(table["total_force_y"], block_history.contact.resultants.force[:, 1])
    assert table.attrs["units"]["total_impulse_x"] == "N s/m" and set(table.attrs["units"]) == {"time", *table.columns}
    assert list(block_history.balance.to_pandas().columns) == list(table.columns)[:9]


def test_a_history_over_nodes(block_history: pc.History) -> None:
    table = block_history.to_pandas("nodes", step=7)
    assert list(table.columns)[:4] == ["x", "y", "displacement_x", "displacement_y"] and len(table) == 63
    assert np.array_equal(table[["displacement_x", "displacement_y"]], block_history.displacement[7])
    assert table.attrs["time"] == block_history.time[7] and table.attrs["units"]["velocity_x"] == "m/s"
    both = block_history.to_pandas("nodes", step=None)
    assert list(both.index.names) == ["time", "node"] and len(both) == 63 * len(block_history)
    assert np.array_equal(both.loc[block_history.time[7], "acceleration_y"], block_history.acceleration[7, :, 1])
    assert np.array_equal(both.loc[block_history.time[7], "y"], block_history.problem.mesh.points[:, 1])


def test_a_history_as_a_data_set(block_history: pc.History) -> None:
    data = block_history.to_xarray()
    assert data.displacement.dims == ("time", "node", "component") and data.displacement.attrs["units"] == "m"
    assert np.shares_memory(data.displacement.values, block_history.displacement)
    assert data.reaction.sel(component="y").shape == (len(block_history), 9) and "units" not in data.touching.attrs
    assert np.array_equal(data.contact_x, block_history.problem.mesh.points[block_history.contact_nodes, 0])
    assert float(data.strain.max()) == block_history.balance.strain.max()
    only = block_history.to_xarray(["velocity"])
    assert "displacement" not in only and np.array_equal(only.velocity, block_history.velocity)
    with pytest.raises(pc.InputError, match="`fields` is 'speed'; it must be names of displacement, velocity"):
        block_history.to_xarray(["speed"])


def test_contact(block_history: pc.History) -> None:
    contact = block_history.contact
    assert np.array_equal(contact.to_pandas()["total_normal_force"], contact.resultants.normal_force)
    nodes = contact.to_pandas("nodes")
    assert np.array_equal(nodes.index, contact.nodes) and np.array_equal(nodes["node_impulse_y"], contact.impulse[:, 1])
    both = contact.to_pandas("both")
    assert np.array_equal(both["pressure"].to_numpy().reshape(contact.pressure.shape), contact.pressure)
    data = contact.to_xarray()
    assert data.pressure.attrs == {"long_name": "contact pressure", "units": "Pa"}
    assert np.array_equal(data.sliding_velocity.sel(component="x"), contact.sliding_velocity[..., 0])


def test_resultants_of_each_of_several_planes() -> None:
    planes = [pc.Plane(point=(0, -1e-5), normal=(0, 1), friction=0.1, group="bottom"), pc.Plane(point=(-1e-5, 0), normal=(1, 0), friction=0.0, group="left")]
    problem = block(2, 2)
    mesh = pc.Mesh(problem.mesh.points, problem.mesh.cells, {"bottom": [[0, 1], [1, 2]], "left": [[3, 6]]})
    history = pc.simulate(pc.Problem(mesh, material=problem.material, obstacles=planes, initial_velocity=(-10, -10)), end=3e-6, courant=0.5)
    table = history.contact.to_pandas()
    assert np.array_equal(table["plane_1_normal_force"], history.contact.obstacles[1].normal_force)


def test_an_estimate(estimate: pc.Estimate) -> None:
    table = estimate.to_pandas()
    assert estimate.sources is not None
    assert np.array_equal(table["total"], estimate.over_time.total) and np.array_equal(table["source_front"], estimate.sources.over_time.front)
    assert table["error"].max() == pytest.approx(estimate.sup, rel=1e-14) and table.attrs["relative_sup"] == estimate.relative_sup
    elements = estimate.to_pandas("elements")
    assert np.array_equal(elements["by_element"], estimate.by_element) and elements.attrs["units"]["by_element"] == "(J/m)^0.5"
    worst = estimate.worst_elements(1)[0]
    assert tuple(elements.loc[worst.element, ["x", "y"]]) == worst.centroid
    both = estimate.to_pandas("both")
    assert np.array_equal(both["element_total"].to_numpy().reshape(3, -1), [each.total for each in estimate.maps])
    assert {"admissible_stress_xx", "admissible_stress_xy", "admissible_stress_yy"} < set(both) and "admissible_stress_yx" not in both
    data = estimate.to_xarray()
    assert data.accumulated.dims == ("instant", "element") and data.admissible_velocity.attrs["units"] == "m/s"
    assert data.attrs["sup"] == estimate.sup and data.attrs["reconstruction"] == "corrected"


def test_bars_and_estimates_without_maps(bar_history: pc.History) -> None:
    estimate = pc.estimate(bar_history, reconstruction="published")
    assert "source_mesh" not in estimate.to_pandas() and len(estimate.to_pandas()) == len(estimate.over_time.time)
    assert list(bar_history.to_pandas("nodes").columns)[:2] == ["x", "displacement_x"]
    assert bar_history.to_xarray().sizes["component"] == 1 and estimate.to_xarray().sizes["element"] == 40
    with pytest.raises(pc.InputError, match="the estimate has no maps; ask for them with `instants`"):
        estimate.to_pandas("both")
    for subject in (bar_history, estimate, bar_history.contact):
        for wrong in ("space", 3, None):
            with pytest.raises(pc.InputError, match="`over` is"):
                subject.to_pandas(wrong)  # type: ignore[arg-type]


def test_data_sets_can_be_stored_and_read(estimate: pc.Estimate, block_history: pc.History) -> None:
    """What netCDF cannot hold, such as a truth value as an attribute, would fail here."""
    for data in (estimate.to_xarray(), block_history.to_xarray(), block_history.contact.to_xarray()):
        for attributes in (data.attrs, *(each.attrs for each in data.variables.values())):
            assert all(isinstance(value, str | int | float) and not isinstance(value, bool) for value in attributes.values())


@pytest.mark.parametrize(("package", "thing", "call"), [("pandas", "tables", "to_pandas"), ("xarray", "data sets", "to_xarray")])
def test_without_the_package_the_way_out_is_named(package: str, thing: str, call: str) -> None:
    program = f"""
import sys
sys.modules["{package}"] = None
import percute as pc
problem = pc.Problem(pc.Mesh.bar(1.0, elements=2), material=pc.Elastic(young=1.0, density=1.0, section=1.0))
try:
    pc.simulate(problem, end=1.0, courant=0.9).{call}()
except pc.PercuteError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == f'{thing} need {package}: pip install "percute[{package}]", or pip install {package}\n'
