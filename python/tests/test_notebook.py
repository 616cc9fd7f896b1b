"""What a notebook shows: well-formed, escaped, small, and with the numbers of the object."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from conftest import bar, block


def parsed(shown: str) -> ElementTree.Element:
    """As XML: every tag is closed, every special character escaped."""
    return ElementTree.fromstring(shown.replace("<br>", "<br/>"))


def cells(shown: str) -> dict[str, str]:
    rows = parsed(shown).findall(".//tr")
    return {"".join(row[0].itertext()): "".join(row[1].itertext()) for row in rows}


def test_a_mesh_and_a_problem() -> None:
    base = block()
    mesh = pc.Mesh(base.mesh.points, base.mesh.cells, {"a<b>&": base.mesh.edge_groups["bottom"]})
    assert cells(mesh._repr_html_()) == {"mesh": "96 triangles, 63 nodes", "size": "50 × 40 mm", "edge groups": "a<b>& (8)"}
    path = parsed(mesh._repr_html_()).find(".//{http://www.w3.org/2000/svg}path")
    assert path is not None and path.attrib["d"].count("Z") == 96
    told = cells(base._repr_html_())
    assert told["material"].startswith("E = 7e+10 Pa") and told["plane"] == "friction 0.2, normal (0, 1)"
    assert told["mass"] == "5.4 kg" and "at most 565.7 m/s" in told["speed at the start"]


def test_a_history_in_memory_and_in_a_file(block_history: pc.History, tmp_path: Path) -> None:
    assert cells(block_history._repr_html_())["instants"] == f"{len(block_history)} to 13 µs"
    file = tmp_path / "<b>.vtkhdf"
    stored = pc.simulate(block(), end=13e-6, courant=0.9, store=file)
    assert cells(stored._repr_html_())["steps are"] == f"in {file}"


def test_an_estimate_has_its_errors_and_a_map(block_history: pc.History) -> None:
    estimate = pc.estimate(block_history)
    shown = estimate._repr_html_()
    told = cells(shown)
    assert told["largest error"].startswith(f"{100 * estimate.relative_sup:.3g} %") and "(J/m)½" in told["mean error"]
    assert (told["trust"], told["verdict"]) == (estimate.trust, estimate.verdict)
    paths = parsed(shown).findall(".//{http://www.w3.org/2000/svg}path")
    assert sum(path.attrib["d"].count("Z") for path in paths) == 96
    worst = next(path for path in paths if path.attrib["fill"] == "#fde725")
    x, y = block_history.problem.mesh.points[block_history.problem.mesh.cells[estimate.worst_elements(1)[0].element, 0]]
    # 50 mm are 194 pixels, and y points downwards.
    assert f"{3 + x / 0.05 * 194:.1f} {3 + (0.04 - y) / 0.05 * 194:.1f}" in worst.attrib["d"]


def test_large_meshes_have_an_outline_and_bars_a_strip(bar_history: pc.History) -> None:
    disc = pc.Mesh.disc(1.0, rings=30)
    assert len(disc.cells) == 5400 and len(disc._repr_html_()) < 6000
    estimate = pc.estimate(bar_history)
    for shown in (bar()._repr_html_(), bar().mesh._repr_html_(), bar_history._repr_html_(), estimate._repr_html_()):
        assert len(parsed(shown).findall(".//{http://www.w3.org/2000/svg}rect")) == 40
    flat = pc.estimate(bar_history)
    flat.__dict__["by_element"] = np.zeros(40)
    assert "nan" not in flat._repr_html_().lower()


@pytest.mark.parametrize("kind", ["Mesh", "Problem", "History", "Estimate"])
def test_matplotlib_is_not_needed(kind: str) -> None:
    program = """
import sys
sys.modules["matplotlib"] = None
import percute as pc
mesh = pc.Mesh.bar(1.0, elements=4)
problem = pc.Problem(mesh, material=pc.Elastic(young=1.0, density=1.0, section=1.0), initial_velocity=0.1)
history = pc.simulate(problem, end=1.0, courant=0.9)
shown = {"Mesh": mesh, "Problem": problem, "History": history, "Estimate": pc.estimate(history)}
print(shown[sys.argv[1]]._repr_html_())
"""
    done = subprocess.run([sys.executable, "-c", program, kind], capture_output=True, text=True, check=True)
    assert re.match(f"<div><b>percute.{kind}</b>", done.stdout)
