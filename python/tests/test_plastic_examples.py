"""The examples of metals that yield print what they printed, draw their pictures, and have the effectivity indices of their pages."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import percute as pc
import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "plastic"
CASES = {
    "bar": "result    sup 8.00 % (5.713 J^½ at 4.0283e-5 s), mean 7.75 %",
    "block": "result    sup 24.7 % (19.40 (J/m)^½ at 1.8684e-5 s), mean 22.9 %",
    "bracket": "result    sup 100 % (3.847 (J/m)^½ at 4.8032e-5 s), mean 84.2 %",
}


def test_all_cases_are_known() -> None:
    assert {file.stem for file in FOLDER.glob("*.toml")} == set(CASES)


@pytest.mark.filterwarnings("ignore:element 1 has a principal strain")
def test_the_case_of_the_page(tmp_path: Path) -> None:
    page = (FOLDER.parents[1] / "docs" / "plasticity.md").read_text(encoding="utf-8")
    [case] = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    # Shares that the page states; at 10 m/s stresses are those of 25 m/s, 328 MPa, times 0.4.
    for speed, share in ((50.0, 0.90), (25.0, 0.69), (10.0, 0.0)):
        (tmp_path / "block.toml").write_text(case.replace("-50.0", f"{-speed}"))
        (material,) = pc.run(tmp_path / "block.toml").deformation.materials
        assert material.yielding is not None
        assert material.yielding.share == pytest.approx(share, abs=0.005)


@pytest.mark.parametrize("name", CASES)
def test_last_lines_and_pictures(name: str, tmp_path: Path) -> None:
    picture = tmp_path / "picture.svg"
    command = [sys.executable, "-m", "percute", "run", f"{name}.toml", "--picture", str(picture)]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.rstrip().splitlines()[-1] == CASES[name]
    same = picture.read_bytes() == (FOLDER / f"{name}.svg").read_bytes()
    assert same, f"`percute run {name}.toml --picture {name}.svg --force` draws another picture"


@pytest.mark.parametrize(("name", "refined", "known"), [("bar", 3, 0.893), ("block", 2, 1.073), ("bracket", 2, 1.237)])
@pytest.mark.filterwarnings("ignore:element 1 has a principal strain", "ignore:the body turns after its last contact")
def test_as_far_from_the_truth_as_measured(name: str, refined: int, known: float) -> None:
    """Estimated over true error, the largest over time, against a refined mesh."""
    estimate = pc.run(FOLDER / f"{name}.toml")
    history = estimate.history
    assert history is not None
    problem = history.problem
    fine = pc.Problem(
        problem.mesh.refine(refined), material=problem.material, obstacles=problem.obstacles, initial_velocity=problem.initial_velocity[0]
    )
    (error,) = pc.true_errors([history], fine, end=float(history.time[-1]), courant=0.9)
    # The critical steps of case and reference are good to 1e-3, which moves the instants of impact.
    assert estimate.effectivity(error).sup == pytest.approx(known, rel=0.01)


def test_results_of_plastic_flow(tmp_path: Path) -> None:
    """Fields, balance, verdict, file and saved arrays agree; Ctrl-C and thinned histories are tested with all others."""
    with pytest.warns(pc.SimulationWarning, match="take a lower speed or load"):
        estimate = pc.run(FOLDER / "block.toml")
    history = estimate.history
    assert history is not None
    p, work = history.equivalent_plastic_strain(-1), history.plastic_work(-1)
    flow = history.plastic_strain(-1)
    # p is at least the length of the plastic strain, √(⅔ ε_p:ε_p) with the strain across, and a little more where it turns.
    across = flow[:, 0, 0] + flow[:, 1, 1]
    length = np.sqrt((np.sum(flow**2, axis=(1, 2)) + across**2) * 2 / 3)
    assert np.all(p >= length * (1 - 1e-12)) and np.all(p <= 2.0 * length + 1e-12)
    # Sums over elements and the sum of the run are added in another order.
    assert work.sum() == pytest.approx(history.balance.plastic_work[-1], rel=1e-12)
    assert history.strain_energy(-1).sum() == pytest.approx(history.balance.strain[-1], rel=1e-9)
    (material,) = estimate.deformation.materials
    assert material.yielding is not None and material.yielding.plastic is not None
    largest = material.yielding.plastic.equivalent_strain
    assert largest.value == p.max() == p[largest.element] and 0.8 < material.yielding.share < 1.0
    # On the yield surface where the last step flowed, below elsewhere.
    hardening = material.yielding.plastic.tangent_ratio / (1.0 - material.yielding.plastic.tangent_ratio) * 70e9
    assert np.all(history.von_mises(-1) <= 300e6 + hardening * p + 1e-3)
    history.save(tmp_path / "a.vtkhdf")
    stored = pc.open(tmp_path / "a.vtkhdf")
    for quantity in ("equivalent_plastic_strain", "von_mises", "plastic_work"):
        assert np.array_equal(getattr(stored, quantity)(slice(None)), getattr(history, quantity)(slice(None)))
    assert pc.estimate(stored).sup == pc.estimate(history).sup
    with pytest.raises(pc.InputError, match="are read for elastic materials"):
        pc.History.from_arrays(history.problem, history.time, history.displacement)
    with pytest.raises(pc.InputError, match="is that of an elastic bar"):
        bar = pc.run(FOLDER / "bar.toml").history
        assert bar is not None
        pc.exact.BarImpact(length=0.1, young=70e9, density=2700.0, section=0.02, speed=43.6, gap=2e-5).error(bar)
