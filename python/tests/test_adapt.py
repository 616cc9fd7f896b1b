"""Meshes for a wanted accuracy, in Python and in the command."""

import json
import math
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import percute as pc
import pytest

MATERIAL = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
CASE = """
[mesh]
file = "first.msh"
[material]
young = 70e9
poisson = 0.3
density = 2700.0
plane = "stress"
[initial]
velocity = [{0!r}, {1!r}]
[[obstacle]]
point = [{2!r}, {3!r}]
normal = [{4!r}, {5!r}]
friction = 0.2
[time]
end = 40e-6
courant = 0.9
"""
ANGLE = math.radians(10.0)
NORMAL = np.array([math.sin(ANGLE), math.cos(ANGLE)])


def corner(speed: float, mesh: pc.Mesh | None = None) -> pc.Problem:
    """A block whose corner strikes a plane that is inclined by 10°."""
    body = pc.Mesh.rectangle(0.05, 0.04, nx=10, ny=8) if mesh is None else mesh
    plane = pc.Plane(point=-2.5e-7 * speed * NORMAL, normal=NORMAL, friction=0.2)
    return pc.Problem(body, material=MATERIAL, initial_velocity=-speed * NORMAL, obstacles=[plane])


def test_the_command_adapts_alike(tmp_path: Path) -> None:
    problem = corner(4.0)
    problem.mesh.write(tmp_path / "first.msh")
    (tmp_path / "case.toml").write_text(CASE.format(*(float(x) for x in (*(-4.0 * NORMAL), *(-1e-6 * NORMAL), *NORMAL))))
    found = pc.adapt(problem, target=0.45, end=40e-6, courant=0.9)
    command = [sys.executable, "-m", "percute", "adapt", "case.toml", "--target", "45%", "--json", "--quiet", "--save", "best.msh"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, encoding="utf-8")
    document = json.loads(done.stdout)
    assert done.returncode == 0 and document["reached"] and found.reached
    assert found.iterations.error.tolist() == [run["error"] for run in document["iterations"]]
    assert found.conclusion == document["conclusion"] and str(found).endswith(found.conclusion)
    assert pc.Mesh.read(tmp_path / "best.msh") == found.mesh
    assert found.iterations.branch == (None, *("graded",) * (len(found.iterations) - 1))
    assert np.isnan(found.iterations.predicted[0]) and found.iterations.smallest[-1] < found.iterations.largest[-1] / 4


def test_the_best_run_can_be_used(tmp_path: Path) -> None:
    """Its history is simulated again with the same bits; the picture has the map and the runs."""
    found = pc.adapt(corner(40.0), target=0.4, end=40e-6, courant=0.9)
    assert found.estimate is not None and found.history is not None and found.problem is not None and found.best is not None
    assert found.estimate.relative_mean == found.iterations.error[found.best]
    again = pc.estimate(found.history)
    assert (again.sup, again.mean) == (found.estimate.sup, found.estimate.mean)
    map_axes, errors = found.plot(save=tmp_path / "adapt.svg")
    assert ElementTree.parse(tmp_path / "adapt.svg").getroot().tag.endswith("svg")
    assert errors.get_xscale() == "log" and len(map_axes.collections) > 0
    np.testing.assert_allclose(errors.lines[0].get_ydata(), 100 * found.iterations.error)
    with pytest.raises(pc.InputError, match="two axes"):
        found.plot(axes=[errors])


def test_ctrl_c_keeps_the_runs() -> None:
    """The runs so far are those of the exception."""
    totals: set[int] = set()

    def stops(seen: pc.Progress) -> None:
        totals.add(seen.total)
        # Each run has another number of steps.
        if len(totals) > 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as caught:
        pc.adapt(corner(0.4), target=0.01, end=40e-6, courant=0.9, limit=1e12, progress=stops)
    adaptation = caught.value.adaptation  # type: ignore[attr-defined]
    assert 1 <= len(adaptation.iterations) <= 2 and not adaptation.reached
    assert adaptation.estimate.relative_mean == adaptation.iterations.error[adaptation.best]


def test_a_polygon_in_the_place_of_a_curve_is_warned_of() -> None:
    disc = pc.Mesh.disc(0.025, rings=6)
    problem = pc.Problem(disc, material=MATERIAL, initial_velocity=(0.0, -4.0), obstacles=[pc.Plane(point=(0, -0.025001), normal=(0, 1), friction=0.2)])
    with pytest.warns(pc.InputWarning, match="turns by up to 10° at contact nodes"):
        found = pc.adapt(problem, target=0.49, end=30e-6, courant=0.9, runs=2)
    assert len(found.warnings) == 1


@pytest.mark.skipif(shutil.which("gmsh") is None, reason="the program gmsh is not there")
def test_gmsh_meshes_the_outline_anew() -> None:
    """Groups and area stay, and the error is near the expected one."""
    found = pc.adapt(corner(40.0), target=0.4, end=40e-6, courant=0.9, mesher="gmsh")
    mesh = found.mesh
    assert found.reached and mesh is not None and set(mesh.edge_groups) == {"left", "right", "bottom", "top"}
    points = mesh.points[mesh.cells]
    sides = points[:, 1:] - points[:, :1]
    areas = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
    assert np.sum(areas) == pytest.approx(0.05 * 0.04, rel=1e-12)
    assert found.iterations.smallest[-1] < 0.35 * found.iterations.largest[-1]
    # The prototypes had 0.72 to 1.28.
    assert 0.65 < found.iterations.error[-1] / found.iterations.predicted[-1] < 1.28


def test_a_problem_on_another_mesh_is_the_same_problem() -> None:
    """A field that is linear in the body stays linear, and a uniform one uniform."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=4, ny=3)
    spin = np.column_stack([-mesh.points[:, 1], mesh.points[:, 0]])
    traction = pc.Traction(group="left", value=(0.0, -1e6))
    first = pc.Problem(mesh, material=MATERIAL, initial_velocity=spin, initial_displacement=(1e-4, 0.3e-4), tractions=[traction])
    other = first.on(pc.Mesh.rectangle(0.05, 0.04, nx=7, ny=5, diagonals="crossed"))
    exact = np.column_stack([-other.mesh.points[:, 1], other.mesh.points[:, 0]])
    np.testing.assert_allclose(other.initial_velocity, exact, atol=1e-16)
    assert np.all(other.initial_displacement == (1e-4, 0.3e-4))
    assert repr(other.tractions) == repr(first.tractions) and other.material == first.material


def test_fields_stay_in_their_bodies() -> None:
    """Nodes of two bodies at one place keep the velocities of their bodies."""
    block = pc.Mesh.rectangle(0.02, 0.01, nx=4, ny=3)
    bodies = [pc.Body(name="lower", mesh=block, material=MATERIAL), pc.Body(name="upper", mesh=block, material=MATERIAL, origin=(0.0, 0.01), velocity=(3.0, 0.0))]
    first = pc.Problem(bodies=bodies, contacts=[pc.Interface(friction=0.3, matching=False)])
    other = first.on(first.mesh.refine())
    speed = np.where(other.mesh.bodies[np.argmax(np.any(other.mesh.cells[:, :, None] == np.arange(len(other.mesh.points)), axis=1), axis=0)] == 1, 3.0, 0.0)
    np.testing.assert_array_equal(first.on(first.mesh).initial_velocity, first.initial_velocity)
    np.testing.assert_array_equal(other.initial_velocity[:, 0], speed)


@pytest.mark.skipif(shutil.which("gmsh") is None, reason="the program gmsh is not there")
def test_a_geometry_of_another_body_is_refused(tmp_path: Path) -> None:
    """The runs that are done stay."""
    (tmp_path / "other.geo").write_text('SetFactory("OpenCASCADE");\nRectangle(1) = {0, 0, 0, 0.05, 0.05};\n')
    found = pc.adapt(corner(40.0), target=0.4, end=40e-6, courant=0.9, mesher="gmsh", geometry=tmp_path / "other.geo")
    assert found.reason == "failed" and "is it the same body" in found.conclusion and len(found.iterations) == 1
    with pytest.raises(pc.InputError, match="`geometry`: there is no file"):
        pc.adapt(corner(40.0), target=0.4, end=40e-6, courant=0.9, mesher="gmsh", geometry=tmp_path / "none.geo")
