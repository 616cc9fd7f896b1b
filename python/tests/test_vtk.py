"""Other libraries beside ours in one process, in any order; and what they make of our files."""

import itertools
import subprocess
import sys
from pathlib import Path

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
    if progress.done > 20:
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
