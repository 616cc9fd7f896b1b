"""Ends of surfaces that slide along the edges of the other one."""

import json

import pytest
from percute.verification import ends


def test_what_contact_does_at_an_end_does_not_hang_on_the_step() -> None:
    """With a multiplier that sets in at once, contact would push with a force like 1/Δt², and both runs would be unstable.

    The work differs by 4 % between the steps of 0.9 and of 0.1 Δt_c.
    """
    pair = ends.PAIRS[-1]
    works = []
    for courant in (0.9, 0.1):
        history = ends.pc.simulate(pair.problem(), end=pair.end, courant=courant)
        balance = json.loads(ends.estimated(history).to_json())["balance"]
        works.append(balance["work_of_contact"] / balance["initial"])
    assert works[0] < 0 and works[1] == pytest.approx(works[0], rel=0.1)


def test_ends_that_slide_have_the_indices_of_the_page() -> None:
    """A row of the page on its first mesh: 1.21 and 1.29; energy from contact would show a force that pushes out an end."""
    indices, energy = ends.PAIRS[4].run(0.9, meshes=(0,))
    assert all(1.0 < index < 1.4 for index in indices) and 0 <= energy < 1e-3
