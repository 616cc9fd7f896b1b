"""The page on metals that yield has the numbers of its case, and the fields of an example agree with each other."""

import re
from pathlib import Path

import numpy as np
import percute as pc
import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "plastic"


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
