"""The evidence, computed again with the small effort."""

import csv
import json
from pathlib import Path
from typing import Any

import percute as pc
import pytest


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return pc.reproduce(tmp_path_factory.mktemp("evidence") / "ev", ["table1"], small=True, threads=1)


def test_a_part_is_a_page_with_figures_and_numbers(page: Path) -> None:
    folder = page.parent
    assert page == folder / "index.html" and page.read_text(encoding="utf-8").endswith("</html>\n")
    assert (folder / "verification.md").is_file() and list((folder / "figures").glob("*.png"))
    numbers = json.loads((folder / "numbers.json").read_text(encoding="utf-8"))
    assert numbers["effort"] == "small" and list(numbers["parts"]) == ["table1"]
    for name, table in numbers["parts"]["table1"]["tables"].items():
        with (folder / "tables" / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            _, *lines = csv.reader(file)
        cells = [["" if cell is None else cell for cell in row] for row in table["rows"]]
        assert [[float(x) if isinstance(y, float | int) else x for x, y in zip(a, b, strict=True)]
                for a, b in zip(lines, cells, strict=True)] == cells


def test_its_numbers_are_those_of_an_estimate(page: Path) -> None:
    """The first row of table 1, stated anew: 5×4 squares, a gap of 1.3 steps, the first step past 12 µs."""
    tables = json.loads((page.parent / "numbers.json").read_text(encoding="utf-8"))["parts"]["table1"]["tables"]
    table = tables["table1-absolute"]
    names = [column["name"] for column in table["columns"]]

    def problem(gap: float) -> pc.Problem:
        return pc.Problem(
            pc.Mesh.rectangle(0.05, 0.04, nx=5, ny=4),
            material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
            obstacles=[pc.Plane(point=(0, -gap), normal=(0, 1), friction=0.2)],
            initial_velocity=(400, -400),
        )

    step = 0.9 * problem(1.0).critical_time_step
    count = int(12e-6 // step) + 1
    history = pc.simulate(problem(1.3 * step * 400), end=count * step, step=step)
    for values in table["rows"]:
        row: dict[str, Any] = dict(zip(names, values, strict=True))
        if row["mesh"] != "5×4":
            continue
        estimate = pc.estimate(history, reconstruction=row["contact force"], acceleration=row["Γ_DA"])
        # The plane's place and T are products in another order: rounding of the last digits.
        assert estimate.sup == pytest.approx(row["e_sup"], rel=1e-9)
        assert estimate.mean == pytest.approx(row["e_mean"], rel=1e-9)


def test_what_cannot_be_is_refused(page: Path, tmp_path: Path) -> None:
    with pytest.raises(pc.ExistingFileError, match="not empty.*overwrite=True"):
        pc.reproduce(page.parent, ["table1"], small=True)
    with pytest.raises(pc.InputError, match="no part \"tabel1\".*did you mean `table1`"):
        pc.reproduce(tmp_path / "ev", ["tabel1"])
    for wrong in ("table1", [], 3, [1]):
        with pytest.raises(pc.InputError, match="`parts"):
            pc.reproduce(tmp_path / "ev", wrong)  # type: ignore[arg-type]
    with pytest.raises(pc.StorageError, match="there is no folder"):
        pc.reproduce(tmp_path / "none" / "ev", ["table1"])
    assert not list(tmp_path.iterdir())


def test_what_was_done_stays_when_it_is_interrupted(tmp_path: Path) -> None:
    heard: list[pc.Progress] = []

    def stop(progress: pc.Progress) -> None:
        heard.append(progress)
        if progress.stage == "time-steps":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        pc.reproduce(tmp_path, ["stress-maps", "time-steps"], progress=stop)
    numbers = json.loads((tmp_path / "numbers.json").read_text(encoding="utf-8"))
    assert list(numbers["parts"]) == ["stress-maps"]
    assert heard[-1].stage == "time-steps" and heard[-1].total == 1000
