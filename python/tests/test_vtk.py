"""Other libraries beside ours in one process, in any order; and what they make of our files."""

import itertools
import subprocess
import sys
from pathlib import Path

import percute as pc
import pytest
from conftest import block

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
