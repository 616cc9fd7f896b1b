"""The page and the picture of an estimate."""

from __future__ import annotations

import json
import pickle
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import percute as pc

EMPTY = {"meta", "line", "polyline", "polygon", "rect", "circle", "image", "br"}
"""Elements without an end tag, or closed in themselves in SVG."""


class Page(HTMLParser):
    """Elements that open and close in order, and the references of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.count: dict[str, int] = {}
        self.references: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.count[tag] = self.count.get(tag, 0) + 1
        self.references += [value or "" for name, value in attrs if name in ("src", "href", "xlink:href", "srcset", "action")]
        assert not any(name.startswith("on") for name, _ in attrs), attrs
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert tag in EMPTY, tag
        self.handle_starttag(tag, attrs)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture(scope="module")
def estimate() -> pc.Estimate:
    """A block that strikes a plane."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=6, ny=5)
    aluminium = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plane = pc.Plane(point=(0, -2e-4), normal=(0, 1), friction=0.2)
    problem = pc.Problem(mesh, material=aluminium, obstacles=[plane], initial_velocity=(400, -400))
    return pc.estimate(pc.simulate(problem, end=5e-6, courant=0.9))


def test_the_lines_of_the_error_are_its_parts(estimate: pc.Estimate, tmp_path: Path) -> None:
    estimate.report(tmp_path / "page.html")
    chart = (tmp_path / "page.html").read_text("utf-8").split("<h2>Error over time")[1].split("</svg>")[0]
    lines = [[float(each) for each in points.replace(",", " ").split()] for points in re.findall(r'<polyline class="s\d" points="([^"]*)"', chart)]
    parts = estimate.over_time
    assert len(lines) == 4
    # The kinetic part begins at zero.
    heights = [lines[1][1] - line[-1] for line in lines]
    expected = [np.sqrt(part[-1] / parts.total[-1]) for part in (parts.total, parts.kinetic, parts.elastic, parts.contact)]
    assert parts.kinetic[0] == 0.0
    # Coordinates have a tenth of a pixel, of some 200.
    assert np.array(heights) / heights[0] == pytest.approx(expected, abs=2e-3)
    assert len({round(each, 2) for each in expected}) == 4


def test_each_plane_has_the_pressure_along_its_own_surface(estimate: pc.Estimate, tmp_path: Path) -> None:
    """Between the edges at a floor and at a wall, nothing has a pressure."""
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=6, ny=5)
    aluminium = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    planes = [pc.Plane(point=(0, -2e-5), normal=(0, 1), friction=0.2), pc.Plane(point=(-4e-5, 0), normal=(1, 0), friction=0.2)]
    problem = pc.Problem(mesh, material=aluminium, obstacles=planes, initial_velocity=(-20, -20))
    pc.estimate(pc.simulate(problem, end=8e-6, courant=0.9)).report(tmp_path / "corner.html")
    told = re.findall(r"Pressure over time(.*?) along the part .*?, from \((.*?)\) m \(below\) to \((.*?)\) m", (tmp_path / "corner.html").read_text("utf-8"))
    assert [(at, {first, last}) for at, first, last in told] == [(" at plane 0", {"0, 0", "0.05, 0"}), (" at plane 1", {"0, 0", "0, 0.04"})]
    # A single one needs no name.
    estimate.report(tmp_path / "floor.html")
    assert "Pressure over time along the part" in (tmp_path / "floor.html").read_text("utf-8")


def test_the_page_is_well_formed_and_stands_alone(estimate: pc.Estimate, tmp_path: Path) -> None:
    estimate.report(tmp_path / "page.html")
    page = Page((tmp_path / "page.html").read_text(encoding="utf-8"))
    assert page.open == []
    assert page.count["figure"] == 6 and page.count["table"] >= 10
    # The only reference is the picture of the pressure, which is inside the page.
    assert [reference.split(",")[0] for reference in page.references] == ["data:image/png;base64"]
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]


def test_the_page_has_a_style_for_the_dark_small_screens_and_paper(estimate: pc.Estimate, tmp_path: Path) -> None:
    """What browsers make of it is looked at; without these rules it cannot be right."""
    estimate.report(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    style = text.partition("<style>")[2].partition("</style>")[0]
    for rule in ("@media screen and (prefers-color-scheme:dark)", "@media screen and (max-width:", "@media print", ".scroll{overflow-x:auto;max-width:100%"):
        assert rule in style, rule
    # Tables and pictures that are wider than the screen scroll inside their frames.
    for tag in ("table", "svg"):
        framed = len(re.findall(rf'<div class="scroll"><{tag}[ >]', text))
        assert framed == len(re.findall(rf"<{tag}[ >]", text)) > 5, tag


def test_an_estimate_has_the_same_page_from_a_file(estimate: pc.Estimate, tmp_path: Path) -> None:
    estimate.report(tmp_path / "now.html")
    estimate.save(tmp_path / "e.vtkhdf")
    pc.open(tmp_path / "e.vtkhdf").report(tmp_path / "later.html")  # type: ignore[union-attr]
    now, later = ((tmp_path / name).read_text(encoding="utf-8") for name in ("now.html", "later.html"))
    assert now == later
    # Without its history an estimate has no pressure along the surface, and says so.
    pickle.loads(pickle.dumps(estimate)).report(tmp_path / "unpickled.html")
    page = (tmp_path / "unpickled.html").read_text(encoding="utf-8")
    assert "The pressure along the surface is not drawn" in page and "is not drawn" not in now


def test_nodes_that_face_nothing_are_in_the_page_from_a_file(tmp_path: Path) -> None:
    """A block on a wider plate: nodes of the plate beside it have no gap."""
    aluminium = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    plate = pc.Body(name="plate", mesh=pc.Mesh.rectangle(0.04, 0.01, nx=8, ny=2), material=aluminium)
    block = pc.Body(
        name="block", mesh=pc.Mesh.rectangle(0.01, 0.01, nx=3, ny=2), material=aluminium, origin=(0.013, 0.01001), velocity=(0, -20)
    )
    problem = pc.Problem(bodies=[plate, block], contacts=[pc.Interface(groups=("block.bottom", "plate.top"), friction=0.2, matching=False)])
    pc.estimate(pc.simulate(problem, end=4e-6, courant=0.9)).save(tmp_path / "e.vtkhdf")
    loaded = pc.open(tmp_path / "e.vtkhdf")
    assert isinstance(loaded, pc.Estimate) and loaded.contact is not None
    assert np.isinf(loaded.contact.gap).any() and loaded.contact.normal_force.max() > 0.0
    loaded.report(tmp_path / "e.html")
    assert "block" in (tmp_path / "e.html").read_text(encoding="utf-8")


def test_the_outline_has_the_last_displacements(estimate: pc.Estimate) -> None:
    """Also where the nodes are solved in an order of their own."""
    order = np.random.default_rng(1).permutation(len(estimate.mesh.points))
    points, cells = np.empty_like(estimate.mesh.points), order[estimate.mesh.cells]
    points[order] = estimate.mesh.points
    assert estimate.problem is not None
    law = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress")
    problem = pc.Problem(pc.Mesh(points, cells), material=law, obstacles=estimate.problem.obstacles, initial_velocity=(400, -400))
    for each in (estimate, pc.estimate(pc.simulate(problem, end=5e-6, courant=0.9))):
        outline, history, mesh = json.loads(each.to_json())["outline"], each.history, each.mesh
        assert history is not None and outline["time"] == history.time[-1]
        on_the_boundary = ((mesh.points == mesh.points.min(axis=0)) | (mesh.points == mesh.points.max(axis=0))).any(axis=1)
        assert outline["node"] == np.flatnonzero(on_the_boundary).tolist()
        assert np.array_equal(outline["displacement"], history.displacement[-1][outline["node"]])


def test_a_page_says_how_a_history_in_memory_was_made(estimate: pc.Estimate, tmp_path: Path) -> None:
    estimate.report(tmp_path / "simulated.html")
    page = (tmp_path / "simulated.html").read_text(encoding="utf-8")
    assert "simulated in Python and is in no file" in page and "estimate.history.save(&quot;history.vtkhdf&quot;)" in page
    history = estimate.history
    assert history is not None and estimate.problem is not None
    arrays = pc.History.from_arrays(estimate.problem, history.time, history.displacement, history.reaction)
    pc.estimate(arrays).report(tmp_path / "arrays.html")
    page = (tmp_path / "arrays.html").read_text(encoding="utf-8")
    assert "made from arrays of another program in Python" in page and "estimate.history.save(&quot;history.vtkhdf&quot;)" in page
    # An estimate of a case has its text, from a file and from Python alike.
    case = (Path(__file__).parents[2] / "tests/bases/block.toml").read_text(encoding="utf-8")
    (tmp_path / "block.toml").write_text(case, encoding="utf-8")
    pc.run(tmp_path / "block.toml").report(tmp_path / "case.html")
    page = (tmp_path / "case.html").read_text(encoding="utf-8")
    assert "percute run block.toml --report report.html" in page and "<h3>Case file block.toml</h3>" in page


def test_the_head_is_that_of_the_command(estimate: pc.Estimate, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    history = estimate.history
    assert history is not None
    arrays = pc.History.from_arrays(history.problem, history.time, history.displacement, history.reaction, program="One")
    graded = pc.estimate(arrays)
    arrays.save("a.vtkhdf")
    graded.report(tmp_path / "ours.html", title="A <title>", author="A. & B.", program="Two")
    head = ["--title", "A <title>", "--author", "A. & B.", "--program", "Two"]
    for file in ("a.vtkhdf", "e.vtkhdf"):
        if file == "e.vtkhdf":
            graded.save(tmp_path / file)
        arguments = [sys.executable, "-m", "percute", "report", file, "theirs.html", "--force", "--quiet", *head]
        subprocess.run(arguments, cwd=tmp_path, check=True, capture_output=True)
        ours, page = ((tmp_path / name).read_text(encoding="utf-8") for name in ("ours.html", "theirs.html"))
        assert ours == page and "<h1>A &lt;title&gt;</h1>\n<p>A. &amp; B.</p>" in page and "simulated by Two, estimated by" in page
    # percute's own simulation has no other program.
    with pytest.raises(pc.InputError, match="percute simulated this"):
        estimate.report(tmp_path / "none.html", program="Two")
    for argument in ("title", "author", "program"):
        with pytest.raises(pc.InputError, match=f"`{argument}` is ' '; it must be a text"):
            graded.report(tmp_path / "none.html", **{argument: " "})
    assert not (tmp_path / "none.html").exists()


def test_pictures_are_those_of_the_command(tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text((Path(__file__).parents[2] / "tests/bases/block.toml").read_text(encoding="utf-8"), encoding="utf-8")
    estimate = pc.run(case)
    estimate.picture(tmp_path / "ours.svg")
    estimate.picture(tmp_path / "ours.PNG")
    names = ["theirs.svg", "theirs.png"]
    for name in names:
        arguments = [sys.executable, "-m", "percute", "run", "case.toml", "--quiet", "--picture", name]
        subprocess.run(arguments, cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "ours.svg").read_bytes() == (tmp_path / "theirs.svg").read_bytes()
    assert (tmp_path / "ours.PNG").read_bytes() == (tmp_path / "theirs.png").read_bytes()
    assert (tmp_path / "ours.PNG").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(("method", "name", "wrong"), [("report", "a.html", "a.txt"), ("picture", "a.png", "a.jpg")])
def test_files_are_checked_first(estimate: pc.Estimate, tmp_path: Path, method: str, name: str, wrong: str) -> None:
    write = getattr(estimate, method)
    (tmp_path / name).write_text("old")
    with pytest.raises(pc.ExistingFileError, match="overwrite=True"):
        write(tmp_path / name)
    assert (tmp_path / name).read_text() == "old"
    write(tmp_path / name, overwrite=True)
    assert (tmp_path / name).stat().st_size > 1000
    with pytest.raises(pc.InputError, match="ends in"):
        write(tmp_path / wrong)
    with pytest.raises(pc.MissingFileError, match="there is no folder"):
        write(tmp_path / "none" / name)
    estimate.save(tmp_path / "e.vtkhdf")
    with pytest.raises(pc.InputError, match="the estimate itself"):
        getattr(pc.open(tmp_path / "e.vtkhdf"), method)(tmp_path / "e.vtkhdf", overwrite=True)
