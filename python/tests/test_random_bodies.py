"""Random bodies: they follow from their seeds, their meshes are sound, and their table is complete."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from studies.random_bodies import __main__ as command
from studies.random_bodies import judge
from studies.random_bodies.cases import KINDS, OF_CELLS, body
from studies.random_bodies.draws import Draws
from studies.random_bodies.judge import Row, summary
from studies.random_bodies.meshes import MOST, Sizes, by_gmsh, delaunay, longest, of_cells, sized
from studies.random_bodies.shapes import SHAPES, Shape

try:
    import gmsh  # noqa: F401
except (ImportError, OSError) as error:
    pytest.skip(f"Gmsh cannot be imported here: {error}", allow_module_level=True)

QUICK = {"impact": 1, "vibration": 1, "graded": 1}
"""Seeds of bodies that take a second or two."""


@pytest.mark.parametrize(("kind", "seed"), QUICK.items())
def test_a_body_has_an_index_beside_its_range(kind: str, seed: int) -> None:
    row = judge.judged(kind, seed)
    assert row.error == "" and row.kind == kind and row.steps > 10 and row.trust in ("high", "limited", "low")
    # The estimate is between 0.8 and 1.4 times the true error in these bodies, and the verdict holds.
    assert 0.8 < row.sup < 1.4 and 0.8 < row.mean < 1.4 and row.inside == "yes"
    assert row.inside == ("yes" if row.low <= min(row.sup, row.mean) and max(row.sup, row.mean) <= row.high else "no")
    assert row.touches == "none" if kind == "vibration" else row.touches != "none"
    assert Row.of_cells(row.cells) == row


def test_the_reference_resolves_a_slow_contact() -> None:
    """With elements of a quarter everywhere, the true error of this corner would be a third smaller."""
    first, finer = (judge.judged("impact", 1, further) for further in (0, 1))
    assert first.speed_ratio < 1e-3 and first.touches == "corner"
    # The ranges of the verdict have two digits.
    assert first.sup == pytest.approx(finer.sup, rel=0.02) and first.mean == pytest.approx(finer.mean, rel=0.02)


@pytest.mark.parametrize("kind", KINDS)
def test_a_seed_determines_its_body(kind: str) -> None:
    for seed in range(3):
        first, second = body(kind, seed), body(kind, seed)
        assert first.mesh == second.mesh and first.law == second.law
        assert (first.end, first.courant, first.gap, first.speed) == (second.end, second.courant, second.gap, second.speed)
        assert np.array_equal(first.problem().initial_velocity, second.problem().initial_velocity)
    assert body(kind, 0).mesh != body(kind, 1).mesh


def test_draws_are_those_of_all_machines() -> None:
    """Numbers of PCG64 after SeedSequence, which NumPy keeps."""
    draws = Draws(0, 7, 0)
    expected = np.random.Generator(np.random.PCG64(np.random.SeedSequence([0, 7, 0]))).random(3)
    assert [draws.uniform(0.0, 1.0) for _ in range(3)] == expected.tolist()


def test_all_shapes_and_meshes_appear() -> None:
    seen: set[str] = set()
    wanted = {*SHAPES, "cells", "Delaunay", "Gmsh", "exactly flat", "exactly 45°", "graded", "friction", "along"}
    for seed in range(200):
        made = body("impact", seed)
        facts = {"exactly flat": made.tilt == 0.0, "exactly 45°": abs(made.tilt) == 45.0, "graded": made.grading > 20.0}
        facts |= {"friction": made.friction > 0.0, "along": made.along != 0.0}
        seen |= {made.shape, made.mesh_kind} | {name for name, holds in facts.items() if holds}
        if seen >= wanted:
            return
    raise AssertionError(wanted - seen)


def shape_of(name: str) -> Shape:
    return SHAPES[name](Draws(5), 0.05)


def area(mesh: pc.Mesh) -> float:
    a, b, c = (mesh.points[mesh.cells[:, k]] for k in range(3))
    areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert areas.min() > 0.0
    return float(areas.sum())


def polygon_area(shape: Shape, sizes: Sizes) -> float:
    parts = [np.array(outline) for outline in shape.outlines(sizes.parts)]
    areas = [0.5 * abs(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1))) for p in parts]
    return float(areas[0] - sum(areas[1:]))


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("grading", [1.0, 30.0])
def test_meshes_fill_the_shape_and_are_graded(name: str, grading: float) -> None:
    shape = shape_of(name)
    place = shape.lowest(0.3)
    assert np.array_equal(place[0], place[1])
    sizes = sized(shape, place, 400, grading, 0.4)
    for mesh in (delaunay(shape, sizes, Draws(6)), by_gmsh(shape, sizes, 6)):
        # Rounding of some hundred areas.
        assert area(mesh) == pytest.approx(polygon_area(shape, sizes), rel=1e-12)
        assert 100 < len(mesh.cells) < MOST
        edges = longest(mesh)
        near = np.linalg.norm(mesh.points[mesh.cells] - place[0], axis=2).min(axis=1)
        # A mesh follows the sizes to a factor of two.
        assert edges[near.argmin()] < 2.0 * sizes.smallest
        assert 0.5 * sizes.largest < edges.max() < 2.0 * sizes.largest
    assert sizes.largest / sizes.smallest == pytest.approx(grading) or grading > 1.0


def test_nodes_along_a_side_make_no_triangles() -> None:
    """With rounding, the nodes of the sides of this trapezoid are not in line, and the triangulation has triangles between them."""
    shape = SHAPES["trapezoid"](Draws(4), 0.05)
    sizes = sized(shape, shape.lowest(0.3), 300, 5.0, 0.4)
    assert area(delaunay(shape, sizes, Draws(4, 1))) == pytest.approx(polygon_area(shape, sizes), rel=1e-12)


@pytest.mark.parametrize("name", OF_CELLS)
@pytest.mark.parametrize("grading", [1.0, 64.0])
def test_cells_fill_the_shape_and_are_graded(name: str, grading: float) -> None:
    shape = shape_of(name)
    place = shape.lowest(0.3)
    first, other = (of_cells(shape, 200, place, grading, 0.4, mirrored) for mirrored in (False, True))
    for mesh in (first, other):
        # A disc in rings is a polygon.
        assert area(mesh) == pytest.approx(shape.area, rel=0.05 if name == "disc" else 1e-12)
        edges = longest(mesh)
        assert edges.max() / edges.min() >= 0.999 * grading / (2.0 if name == "disc" else np.sqrt(2.0))
        near = np.linalg.norm(mesh.points[mesh.cells] - place[0], axis=2).min(axis=1)
        assert edges[near.argmin()] <= np.sqrt(2.0) * edges.max() / grading * 1.001
    assert (first == other) == (name == "disc")


def row_of(kind: str, seed: int, further: int = 0) -> Row:
    """A row without a run."""
    known = {"kind": kind, "seed": seed, "further": further, "trust": "high", "inside": "yes", "error": ""}
    index = 1.0 + 0.01 * seed
    by_type = {"str": 'a "text", of two lines\nor more', "int": 3, "float": index}
    cells = [known.get(name, by_type[str(Row.__dataclass_fields__[name].type)]) for name in judge.COLUMNS]
    return Row.of_cells([str(cell) for cell in cells])


def test_the_table_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    run: list[int] = []

    def fake(kind: str, seed: int, further: int = 0) -> Row:
        if seed == 3 and 3 not in run:
            run.append(seed)
            raise KeyboardInterrupt
        run.append(seed)
        return row_of(kind, seed, further)

    monkeypatch.setattr(command, "judged", fake)
    file = tmp_path / "table.csv"
    assert command.main(["--seed", "1", "--count", "4", "--csv", str(file)]) == command.INTERRUPTED
    assert run == [1, 2, 3] and [row.seed for row in command.stored(file)] == [1, 2]
    assert "interrupted" in capsys.readouterr().err
    # The process ends while a line is written.
    file.write_bytes(file.read_bytes()[:-30])
    assert [row.seed for row in command.stored(file)] == [1]
    run.clear()
    run.append(3)
    assert command.main(["--seed", "1", "--count", "4", "--csv", str(file)]) == command.DONE
    assert run == [3, 2, 3, 4]
    assert command.stored(file) == [row_of("impact", seed) for seed in (1, 2, 3, 4)]
    # Other kinds and other references are other bodies; some are run again.
    run.clear()
    assert command.main(["--count", "3", "--csv", str(file), "--kind", "graded"]) == command.DONE
    assert command.main(["--count", "3", "--csv", str(file), "--further", "1"]) == command.DONE
    assert command.main(["--seed", "2", "--count", "1", "--csv", str(file), "--again"]) == command.DONE
    assert run == [0, 1, 2, 0, 1, 2, 2] and len(command.stored(file)) == 10
    file.write_text("a,b\n1,2\n")
    assert command.main(["--csv", str(file)]) == command.BAD_INPUT
    assert "not a table" in capsys.readouterr().err and file.read_text() == "a,b\n1,2\n"


def test_processes_change_no_number(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    texts = []
    for jobs in (1, 2):
        file = tmp_path / f"{jobs}.csv"
        assert command.main(["--seed", "0", "--count", "2", "--jobs", str(jobs), "--csv", str(file)]) == command.DONE
        texts.append((file.read_bytes(), capsys.readouterr().out))
    assert texts[0] == texts[1] and len(texts[0][0].splitlines()) == 3


@pytest.mark.parametrize("argument", ["--seed=-1", "--count=0", "--jobs=none", "--kind=fall"])
def test_wrong_arguments_are_named(argument: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        command.main([argument])
    assert argument.split("=")[0] in capsys.readouterr().err


def test_the_summary_counts() -> None:
    rows = [row_of("impact", seed) for seed in range(4)]
    rows[0] = replace(rows[0], sup=1.75, inside="no")
    rows[1] = replace(rows[1], mean=0.75, inside="no", trust="limited")
    rows[2] = replace(rows[2], inside="", low=float("nan"), high=float("nan"))
    text = "\n".join(summary([*rows, replace(rows[3], error="no")]))
    assert "5 cases, 1 refused, 1 without a range" in text
    assert "inside the stated range: 1 of 3 (33.3 %)" in text
    assert "trust high: 3 cases; outside the stated range: 0 (1.75, 1.00)" in text
    assert "trust limited: 1 case; outside the stated range: 1 (1.01, 0.75)" in text
    assert "1.3: 1 of 2" in "\n".join(summary([row_of("vibration", 0), replace(row_of("vibration", 1), mean=0.8)]))
    assert "trust high outside 0.8 to 1.7: 0 (1.75, 1.00)" in text
    assert "index of sup, quantiles: 0 % 1.01," in text and "100 % 1.75" in text
