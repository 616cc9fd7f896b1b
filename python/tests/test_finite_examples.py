"""The examples of finite kinematics print what they printed, draw their pictures, and have the effectivity indices of their pages."""

import subprocess
import sys
from pathlib import Path

import percute as pc
import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "examples" / "finite"
CASES = {
    "rubber": "result    sup 41.7 % (7.998 (J/m)^½ at 0.0019771 s), mean 33.6 %",
    "bracket": "result    sup 92.4 % (4.091 (J/m)^½ at 0.0056323 s), mean 59.9 %",
    "cup": "result    sup 172 % (4.505 (J/m)^½ at 0.0022779 s), mean 117 %",
}


def test_all_cases_are_known() -> None:
    assert {file.stem for file in FOLDER.glob("*.toml")} == set(CASES)


@pytest.mark.parametrize("name", CASES)
def test_last_lines_and_pictures(name: str, tmp_path: Path) -> None:
    picture = tmp_path / "picture.svg"
    command = [sys.executable, "-m", "percute", "run", f"{name}.toml", "--picture", str(picture)]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.rstrip().splitlines()[-1] == CASES[name]
    same = picture.read_bytes() == (FOLDER / f"{name}.svg").read_bytes()
    assert same, f"`percute run {name}.toml --picture {name}.svg --force` draws another picture"


@pytest.mark.parametrize(("name", "known"), [("rubber", 1.177), ("bracket", 1.070)])
@pytest.mark.filterwarnings("ignore:contact gives the auxiliary solution")
def test_as_far_from_the_truth_as_measured(name: str, known: float) -> None:
    """Estimated over true error, the largest over time, against the mesh that is refined twice."""
    estimate = pc.run(FOLDER / f"{name}.toml")
    history = estimate.history
    assert history is not None
    problem = history.problem
    fine = pc.Problem(problem.mesh.refine(2), material=problem.material, obstacles=problem.obstacles, initial_velocity=problem.initial_velocity[0])
    (error,) = pc.true_errors([history], fine, end=float(history.time[-1]), courant=0.9)
    # The critical steps of case and reference are good to 1e-3, which moves the instants of impact.
    assert estimate.effectivity(error).sup == pytest.approx(known, rel=0.01)


def test_the_ring() -> None:
    done = subprocess.run([sys.executable, FOLDER / "ring.py"], capture_output=True, text=True, check=True)
    radius, turns, moment, energy, error = (line.split() for line in done.stdout.splitlines())
    # Measured: 45.19 to 50.66 mm.
    assert float(radius[6]) == pytest.approx(45.19) and float(radius[8]) == pytest.approx(50.66, abs=0.02)
    assert float(turns[1].rstrip(";")) == pytest.approx(1.784, abs=0.002)
    assert float(moment[4]) < 1e-12 and float(energy[3]) < 1e-4
    assert error[2] == "3.2"
