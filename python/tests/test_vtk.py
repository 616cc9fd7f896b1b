"""Other libraries beside ours in one process, in any order; and what they make of our files."""

import itertools
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import percute as pc
import pytest
from conftest import bar, block

pytest.importorskip("vtkmodules")

# Each library reads the file in its turn, ours last of all as well.
READ = {
    "percute": "import percute; u['percute'] = percute.open(path).displacement[:]",
    "h5py": "import h5py; u['h5py'] = h5py.File(path)['VTKHDF/PointData/displacement'][:].reshape(-1, 63, 3)[..., :2]",
    "vtk": "u['vtk'] = through_vtk(path)",
}
START = """
import sys
import numpy as np
path, u = sys.argv[1], {}

def through_vtk(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    steps = []
    for n in range(reader.GetNumberOfSteps()):
        reader.SetStep(n)
        reader.Update()
        steps.append(vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("displacement"))[:, :2].copy())
    return np.array(steps)
"""
END = """
import percute
again = percute.estimate(percute.open(path)).sup
assert u["percute"].shape == u["vtk"].shape == u["h5py"].shape, {k: v.shape for k, v in u.items()}
assert np.array_equal(u["percute"], u["vtk"]) and np.array_equal(u["percute"], u["h5py"])
print(again.hex())
"""


@pytest.mark.parametrize("order", list(itertools.permutations(READ)), ids="-".join)
def test_all_read_the_same_in_one_process(order: tuple[str, ...], tmp_path: Path) -> None:
    file = tmp_path / "block.vtkhdf"
    history = pc.simulate(block(), end=6e-6, courant=0.9, store=file)
    program = "\n".join([START, *(READ[name] for name in order), END])
    done = subprocess.run([sys.executable, "-c", program, file], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [pc.estimate(history).sup.hex()]


def through_vtk(file: Path) -> tuple[list[float], np.ndarray, np.ndarray]:
    """What VTK reads of a history: the times, the points, and the displacements at all steps that it sees."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(str(file))
    steps, times = [], []
    reader.UpdateInformation()
    for n in range(reader.GetNumberOfSteps()):
        reader.SetStep(n)
        reader.Update()
        # Of a single step VTK tells no time.
        times += [reader.GetTimeValue()] if reader.GetNumberOfSteps() > 1 else []
        steps.append(vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("displacement")).copy())
    return times, vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).copy(), np.array(steps)


@pytest.mark.parametrize(("problem", "end"), [(bar(), 5e-6), (block(), 6e-6)], ids=["bar", "block"])
def test_vtk_reads_times_points_and_displacements(problem: pc.Problem, end: float, tmp_path: Path) -> None:
    history = pc.simulate(problem, end=end, courant=0.9, store=tmp_path / "history.vtkhdf")
    times, points, steps = through_vtk(tmp_path / "history.vtkhdf")
    dimension = history.displacement.shape[2]
    assert times == history.time.tolist() and len(times) > 5
    assert np.array_equal(points[:, :dimension], problem.mesh.points) and not points[:, dimension:].any()
    assert np.array_equal(steps[..., :dimension], history.displacement) and not steps[..., dimension:].any()


def test_vtk_sees_the_start_of_a_killed_run_and_all_of_it_once_recovered(tmp_path: Path) -> None:
    file = tmp_path / "killed.vtkhdf"
    program = f"""
import os, signal, percute as pc
from conftest import block
def told(progress):
    if progress.done > 400:  # after the first contact
        os.kill(os.getpid(), signal.SIGKILL)
pc.simulate(block(60, 48), end=5000 * 1e-8, step=1e-8, store={str(file)!r}, progress=told)
"""
    killed = subprocess.run([sys.executable, "-c", program], cwd=Path(__file__).parent, check=False)
    assert killed.returncode == -9
    history = pc.open(file)
    assert isinstance(history, pc.History) and not history.complete
    held = len(history.displacement)
    assert 20 < held < 5001
    assert len(through_vtk(file)[2]) == 1
    subprocess.run([sys.executable, "-m", "percute", "recover", file], capture_output=True, check=True)
    _, _, steps = through_vtk(file)
    assert np.array_equal(steps[..., :2], history.displacement)
    estimate = pc.estimate(history, every=50)
    assert estimate.steps == held - 1


def two_blocks() -> pc.Problem:
    law = pc.Elastic(young=70e9, poisson=0.3, density=2700, plane="stress")
    mesh = pc.Mesh.rectangle(0.04, 0.025, nx=4, ny=3)
    upper = pc.Body(name="upper", mesh=mesh, material=law, origin=(0, 0.02505), velocity=(0, -20))
    contact = pc.Interface(groups=("lower.top", "upper.bottom"), friction=0.0)
    return pc.Problem(bodies=[pc.Body(name="lower", mesh=mesh, material=law), upper], contacts=[contact])


def cells_of(reader: Any) -> Any:
    """The numbers of the bodies at the last step that VTK sees."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    reader.UpdateInformation()
    if hasattr(reader, "GetNumberOfSteps") and reader.GetNumberOfSteps() > 1:
        reader.SetStep(reader.GetNumberOfSteps() - 1)
    reader.Update()
    array = reader.GetOutput().GetCellData().GetArray("body")
    return None if array is None else vtk_to_numpy(array).copy()


def test_each_cell_has_the_number_of_its_body(tmp_path: Path) -> None:
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    problem = two_blocks()
    history = pc.simulate(problem, end=4e-6, courant=0.9, store=tmp_path / "history.vtkhdf")
    estimate = pc.estimate(history, instants=[1e-6, 2e-6])
    estimate.save(tmp_path / "estimate.vtkhdf")
    history.export(tmp_path / "export.vtkhdf", steps=[0, 3])
    history.export(tmp_path / "one.vtu", steps=[3])
    alone = pc.simulate(block(), end=4e-6, courant=0.9, store=tmp_path / "alone.vtkhdf")
    for name in ("history.vtkhdf", "estimate.vtkhdf", "export.vtkhdf", "one.vtu"):
        reader = vtkXMLUnstructuredGridReader() if name.endswith("vtu") else vtkHDFReader()
        reader.SetFileName(str(tmp_path / name))
        assert np.array_equal(cells_of(reader), np.repeat([0, 1], len(problem.mesh.cells) // 2)), name
    assert np.array_equal(pc.open(tmp_path / "history.vtkhdf").displacement, history.displacement)
    assert np.array_equal(pc.open(tmp_path / "estimate.vtkhdf").by_element, estimate.by_element)
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "alone.vtkhdf"))
    assert len(alone) > 2 and cells_of(reader) is None
