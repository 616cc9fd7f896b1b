"""The evidence on soft and skewed bodies that strike another one."""

import re
from pathlib import Path

import pytest

from studies.two_bodies import Pair, pairs, row

PAGE = (Path(__file__).parents[2] / "docs" / "bodies.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("pair", [Pair(skew=30.0), Pair(upper="plastic", facing=False)], ids=lambda pair: pair.name)
def test_the_table_of_the_page_is_that_of_its_command(pair: Pair) -> None:
    ranges, held, count = row(pair)
    # Rounding of other processors may change the last digit that is shown.
    told = re.search(rf"(?m)^\| {pair.name} \| (.*) \| (\d+) of (\d+) \|$", PAGE)
    assert told is not None and [float(each) for each in re.split(r" to | \| ", told[1])] == pytest.approx(
        [float(each) for each in re.split(r" to | \| ", " | ".join(ranges))], abs=0.011
    )
    assert (held, count) == (int(told[2]), int(told[3])) and held == count


def test_the_page_has_all_pairs_and_its_range_all_indices() -> None:
    table = PAGE[PAGE.index("two_bodies") :]
    assert [pair.name for pair in pairs()] == re.findall(r"(?m)^\| (.*?) \| [\d.]+ to ", table)
    low, high = map(float, re.findall(r"Its range is ([\d.]+) to ([\d.]+)", PAGE)[0])
    indices = [float(each) for each in re.findall(r"(?<=[ |])(\d\.\d\d)(?= )", "\n".join(line for line in table.splitlines() if " of 8 |" in line))]
    assert len(indices) == 8 * len(pairs()) and low <= min(indices) and max(indices) <= high
