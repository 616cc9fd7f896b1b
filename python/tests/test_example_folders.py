"""The cases in the folders of the examples print what they printed, draw their pictures, and have the effectivity indices of their pages."""

import subprocess
import sys
from pathlib import Path

import percute as pc
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
CASES = {
    "finite/rubber": "result    sup 41.7 % (7.998 (J/m)^½ at 0.0019771 s), mean 33.6 %",
    "finite/bracket": "result    sup 92.4 % (4.091 (J/m)^½ at 0.0056323 s), mean 59.9 %",
    "finite/cup": "result    sup 172 % (4.505 (J/m)^½ at 0.0022779 s), mean 117 %",
    "plastic/bar": "result    sup 8.00 % (5.713 J^½ at 4.0283e-5 s), mean 7.75 %",
    "plastic/block": "result    sup 24.7 % (19.40 (J/m)^½ at 1.8684e-5 s), mean 22.9 %",
    "plastic/bracket": "result    sup 100 % (3.847 (J/m)^½ at 4.8032e-5 s), mean 84.2 %",
}
FINITE = pytest.mark.filterwarnings("ignore:contact gives the auxiliary solution")
PLASTIC = pytest.mark.filterwarnings("ignore:element 1 has a principal strain", "ignore:the body turns after its last contact")
INDICES = [
    pytest.param("finite/rubber", 2, 1.177, marks=FINITE),
    pytest.param("finite/bracket", 2, 1.070, marks=FINITE),
    pytest.param("plastic/bar", 3, 0.893, marks=PLASTIC),
    pytest.param("plastic/block", 2, 1.073, marks=PLASTIC),
    pytest.param("plastic/bracket", 2, 1.237, marks=PLASTIC),
]
"""Cases, refinements of the reference, and estimates over true errors, the largest over time."""


@pytest.mark.parametrize("folder", ["finite", "plastic"])
def test_all_cases_are_known(folder: str) -> None:
    assert {f"{folder}/{file.stem}" for file in (EXAMPLES / folder).glob("*.toml")} == {name for name in CASES if name.startswith(folder)}


@pytest.mark.parametrize("name", CASES)
def test_last_lines_and_pictures(name: str, tmp_path: Path) -> None:
    picture, case = tmp_path / "picture.svg", EXAMPLES / f"{name}.toml"
    command = [sys.executable, "-m", "percute", "run", case.name, "--picture", str(picture)]
    done = subprocess.run(command, cwd=case.parent, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.rstrip().splitlines()[-1] == CASES[name]
    same = picture.read_bytes() == case.with_suffix(".svg").read_bytes()
    assert same, f"`percute run {case.name} --picture {case.stem}.svg --force` draws another picture"


@pytest.mark.parametrize(("name", "refined", "known"), INDICES)
def test_as_far_from_the_truth_as_measured(name: str, refined: int, known: float) -> None:
    """Estimated over true error, the largest over time, against a refined mesh."""
    estimate = pc.run(EXAMPLES / f"{name}.toml")
    history = estimate.history
    assert history is not None
    problem = history.problem
    mesh, velocity = problem.mesh.refine(refined), problem.initial_velocity[0]
    fine = pc.Problem(mesh, material=problem.material, obstacles=problem.obstacles, initial_velocity=velocity)
    (error,) = pc.true_errors([history], fine, end=float(history.time[-1]), courant=0.9)
    # The critical steps of case and reference are good to 1e-3, which moves the instants of impact.
    assert estimate.effectivity(error).sup == pytest.approx(known, rel=0.01)
