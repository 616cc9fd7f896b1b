"""The command: prints the comparisons with exact solutions."""

from __future__ import annotations

import warnings

import percute as pc
from studies.finite_exact import COMPARISONS
from studies.page import short


def main() -> None:
    """Print each comparison when it is done."""
    # Beams on coarse meshes start with short waves, whose energy the first step changes.
    warnings.simplefilter("ignore", pc.SimulationWarning)
    for comparison in COMPARISONS:
        print(f"\n{comparison.name} (halved from run to run: {comparison.halved})")
        for each in comparison.run(None).quantities:
            values = ", ".join(short(value, 6) for value in each.computed if value == value)
            if each.bound is None:
                judged = f"order {short(each.observed or 0.0, 2)}, expected {short(each.order or 0.0, 2)}"
            else:
                judged = f"off by {short(each.difference, 2)}, bound {short(each.bound, 2)}"
            print(f"  {each.name}{f' ({each.unit})' if each.unit else ''}: exact {short(each.exact, 6)}, found {values}; {judged}", flush=True)
            print(f"    {each.reason}")


if __name__ == "__main__":
    main()
