"""Runs beyond the evidence: the verdict names what is outside the tested range, and the page has the indices of its command."""

import re
from pathlib import Path

import pytest
from studies.beyond import Run, runs

PAGE = (Path(__file__).parents[2] / "docs" / "verdict.md").read_text(encoding="utf-8")
ROWS = list(runs())


def test_the_page_has_all_runs() -> None:
    section = PAGE.split("### Beyond the evidence")[1].split("###")[0]
    assert re.findall(r"(?m)^\| (\w+) \| ([^|]+) \| [\d.]+ \|", section) == [(run.group, run.name) for run in ROWS]


@pytest.mark.filterwarnings("ignore::percute.SimulationWarning", "ignore::percute.InputWarning")
@pytest.mark.parametrize("run", [run for run in ROWS if run.group in ("load", "start", "bar", "layers")], ids=lambda run: run.name)
def test_the_table_of_the_page_is_that_of_its_command(run: Run) -> None:
    told = re.search(rf"(?m)^\| {run.group} \| {re.escape(run.name)} \| ([\d.]+) \| ([\d.]+) \| (.*) \|$", PAGE)
    sup, mean, named = run.row()
    assert told is not None and told[3] == (named or "–")
    # Half a unit of the last digit.
    assert [float(told[1]), float(told[2])] == pytest.approx([sup, mean], abs=0.0051)
    # What is not named is in the range of bodies that vibrate, of bars that strike a wall or of flat impacts on some elements.
    assert named or (0.85 <= min(sup, mean) and max(sup, mean) <= 1.26)
