"""Meshes that Gmsh makes here and now: the same results as from arrays."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import percute as pc
import pytest

try:
    import gmsh
except (ImportError, OSError) as error:  # The wheel needs libraries of the system, of X11 among others.
    pytest.skip(f"Gmsh cannot be imported here: {error}", allow_module_level=True)

FORMATS = [("4.1", 0), ("4.1", 1), ("2.2", 0), ("2.2", 1)]


@pytest.fixture
def model() -> Iterator[None]:
    """Gmsh with nothing in it."""
    # Without its own handler of Ctrl-C, which is not for a library to take.
    gmsh.initialize(["gmsh", "-noenv"], interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def plate() -> None:
    """Make a plate of 50 × 40 mm with a hole, of two materials, and name what a user would."""
    cad = gmsh.model.occ
    plate = cad.addRectangle(0, 0, 0, 50, 40)
    hole = cad.addDisk(30, 20, 0, 8, 8)
    body, _ = cad.cut([(2, plate)], [(2, hole)])
    core = cad.addRectangle(0, 0, 0, 12, 40)
    cad.fragment(body, [(2, core)])
    cad.synchronize()
    surfaces = sorted(gmsh.model.getEntities(2), key=lambda entity: cad.getCenterOfMass(*entity)[0])
    for tag, (name, (_, surface)) in enumerate(zip(["left", "right"], surfaces, strict=True), start=11):
        gmsh.model.addPhysicalGroup(2, [surface], tag, name)
    gmsh.model.addPhysicalGroup(2, [surface for _, surface in surfaces], 20, "body")
    bottom = [curve for dim, curve in gmsh.model.getEntities(1) if abs(cad.getCenterOfMass(dim, curve)[1]) < 1e-6]
    gmsh.model.addPhysicalGroup(1, bottom, 30, "bottom")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 8)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 4)
    gmsh.model.mesh.generate(2)


def save(file: Path, version: str, binary: int) -> Path:
    gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
    gmsh.option.setNumber("Mesh.Binary", binary)
    gmsh.write(str(file))
    return file


def from_arrays(like: pc.Mesh, text: bool) -> pc.Mesh:
    """Make the mesh of Gmsh's memory by arrays, in the order of another."""
    tags, places, _ = gmsh.model.mesh.getNodes()
    # Texts have 16 digits.
    written = [[float(f"{x:.16g}") if text else x for x in place[:2]] for place in places.reshape(-1, 3).tolist()]
    assert len(tags) == len(like.points)
    exact = {point: node for node, point in enumerate(map(tuple, like.points.tolist()))}
    node = {tag: exact[point[0] * 1e-3, point[1] * 1e-3] for tag, point in zip(tags.tolist(), written, strict=True)}
    points = np.empty((len(tags), 2))
    for tag, point in zip(tags.tolist(), written, strict=True):
        points[node[tag]] = np.array(point) * 1e-3

    def members(dimension: int) -> dict[str, list[list[int]]]:
        groups = {}
        for _, group in gmsh.model.getPhysicalGroups(dimension):
            entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, group)
            found = [gmsh.model.mesh.getElements(dimension, entity)[2][0].tolist() for entity in entities]
            rows = np.array([node[tag] for each in found for tag in each]).reshape(-1, dimension + 1)
            groups[gmsh.model.getPhysicalName(dimension, group)] = rows.tolist()
        return groups

    place = {frozenset(cell): element for element, cell in enumerate(like.cells.tolist())}
    by_name = {name: [place[frozenset(cell)] for cell in cells] for name, cells in members(2).items()}
    cells = {place[frozenset(cell)]: cell for cell in members(2)["body"]}
    assert len(cells) == len(like.cells)
    return pc.Mesh(points, [cells[element] for element in range(len(cells))], members(1), by_name)


def results(mesh: pc.Mesh) -> pc.Estimate:
    steel = pc.Elastic(young=210e9, poisson=0.3, density=7800.0, plane="strain")
    aluminium = pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="strain")
    problem = pc.Problem(
        mesh,
        material={"left": steel, "right": aluminium},
        obstacles=[pc.Plane(point=(0, -1e-4), normal=(0, 1), friction=0.3, group="bottom")],
        initial_velocity=(20, -100),
    )
    return pc.estimate(pc.simulate(problem, end=4e-6, courant=0.9))


@pytest.mark.parametrize(("version", "binary"), FORMATS)
def test_a_mesh_of_gmsh_gives_what_its_arrays_give(model: None, tmp_path: Path, version: str, binary: int) -> None:
    plate()
    mesh = pc.Mesh.read(save(tmp_path / "plate.msh", version, binary), scale=1e-3)
    same = from_arrays(mesh, text=not binary)
    assert mesh.points.tobytes() == same.points.tobytes()
    for groups, others in [(mesh.edge_groups, same.edge_groups), (mesh.element_groups, same.element_groups)]:
        assert list(groups) == list(others)
        assert all(np.array_equal(groups[name], others[name]) for name in groups)
    ours, theirs = results(mesh), results(same)
    assert ours.history.displacement.tobytes() == theirs.history.displacement.tobytes()
    assert ours.history.reaction.tobytes() == theirs.history.reaction.tobytes()
    assert ours.history.touching.any()
    assert ours.by_element.tobytes() == theirs.by_element.tobytes()
    assert max(ours.residuals.values()) < 1e-10


@pytest.mark.parametrize("version", ["4.1", "2.2"])
@pytest.mark.parametrize("binary", [False, True])
def test_gmsh_reads_what_is_written(model: None, tmp_path: Path, version: str, binary: bool) -> None:
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=3, ny=2)
    mesh = pc.Mesh(mesh.points, mesh.cells, dict(mesh.edge_groups), {"odd": np.arange(1, 12, 2), "first": [0, 1]})
    mesh.write(tmp_path / "a.msh", version=version, binary=binary)
    gmsh.open(str(tmp_path / "a.msh"))
    tags, places, _ = gmsh.model.mesh.getNodes()
    assert np.array_equal(places.reshape(-1, 3)[np.argsort(tags), :2], mesh.points)
    names = {gmsh.model.getPhysicalName(*group): group for group in gmsh.model.getPhysicalGroups()}
    assert sorted(names) == ["bottom", "first", "left", "odd", "right", "top"]
    for name, count in {"bottom": 4, "left": 3, "odd": 9, "first": 4}.items():
        nodes, _ = gmsh.model.mesh.getNodesForPhysicalGroup(*names[name])
        assert len(nodes) >= count, name


def bad_quads() -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.model.mesh.generate(2)


def bad_order() -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)


def bad_bricks() -> None:
    gmsh.model.addPhysicalGroup(3, [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)], name="body")
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setTransfiniteAutomatic(recombine=True)
    gmsh.model.mesh.generate(3)


def bad_shell() -> None:
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)


def bad_partition() -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.partition(2)


def bad_groups() -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(1, [1, 2], name="bottom")
    gmsh.model.mesh.generate(2)


def bad_joint() -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.addRectangle(1, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)


def bad_truss() -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.addLine(gmsh.model.occ.addPoint(2, 0, 0), gmsh.model.occ.addPoint(3, 1, 0))
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)


@pytest.mark.parametrize(("version", "binary"), FORMATS)
@pytest.mark.parametrize(
    ("make", "phrase"),
    [
        (bad_quads, "Mesh.RecombineAll = 0"),
        (bad_order, "Mesh.ElementOrder = 1"),
        (bad_bricks, "Recombine Surface"),
        (bad_shell, "not in a plane z = const"),
        (bad_partition, "Mesh > Unpartition"),
        (bad_groups, "Physical Surface"),
        (bad_joint, "BooleanFragments"),
        (bad_truss, "not an edge of any triangle"),
    ],
)
def test_what_percute_cannot_take_is_refused(
    model: None, tmp_path: Path, make: Callable[[], None], phrase: str, version: str, binary: int
) -> None:
    make()
    with pytest.raises(pc.FileFormatError, match=phrase) as caught:
        pc.Mesh.read(save(tmp_path / "a.msh", version, binary))
    assert str(caught.value).startswith(str(tmp_path / "a.msh"))


@pytest.mark.parametrize(("version", "binary"), FORMATS)
def test_saving_all_leaves_out_what_does_not_belong(model: None, tmp_path: Path, version: str, binary: int) -> None:
    plate()
    gmsh.model.mesh.addNodes(0, gmsh.model.addDiscreteEntity(0), [9999], [25.0, 90.0, 0.0])
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    with pytest.warns(pc.MeshWarning) as caught:
        mesh = pc.Mesh.read(save(tmp_path / "a.msh", version, binary), scale=1e-3)
    told = " ".join(str(each.message) for each in caught)
    # Version 2.2 has nodes only where there are elements.
    assert ("1 node of the mesh file" in told) == (version == "4.1")
    assert all(each.filename == __file__ for each in caught)
    # In version 2.2 this setting loses the groups.
    assert ("Mesh.SaveAll = 1" in told) == (version == "2.2")
    assert (len(mesh.element_groups["left"]) == 0) == (version == "2.2")


def test_a_curve_inside_the_body_is_left_out(model: None, tmp_path: Path) -> None:
    plate()
    inside = [curve for _, curve in gmsh.model.getEntities(1) if len(gmsh.model.getAdjacencies(1, curve)[0]) == 2]
    gmsh.model.addPhysicalGroup(1, inside, name="joint")
    with pytest.warns(pc.MeshWarning, match='"joint" lie inside the body'):
        mesh = pc.Mesh.read(save(tmp_path / "a.msh", "4.1", 0), scale=1e-3)
    assert len(mesh.edge_groups["joint"]) == 0


@pytest.mark.parametrize(("version", "binary"), FORMATS)
def test_parameters_periods_and_data_do_no_harm(model: None, tmp_path: Path, version: str, binary: int) -> None:
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    # Another body, apart from the first.
    gmsh.model.occ.addDisk(3, 0, 0, 0.5, 0.5)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setPeriodic(1, [2], [4], [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    gmsh.model.mesh.generate(2)
    tags, _, _ = gmsh.model.mesh.getNodes()
    plain = pc.Mesh.read(save(tmp_path / "a.msh", version, binary))
    gmsh.option.setNumber("Mesh.SaveParametric", 1)
    parametric = pc.Mesh.read(save(tmp_path / "b.msh", version, binary))
    gmsh.option.setNumber("Mesh.SaveParametric", 0)
    view = gmsh.view.add("T")
    gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), "NodeData", tags, [[float(tag)] for tag in tags])
    gmsh.option.setNumber("PostProcessing.SaveMesh", 1)
    gmsh.view.write(view, str(tmp_path / "c.msh"))
    for mesh in (parametric, pc.Mesh.read(tmp_path / "c.msh")):
        assert len(tags) == len(plain.points) == len(mesh.points)
        assert mesh.points.tobytes() == plain.points.tobytes()
        assert np.array_equal(mesh.cells, plain.cells)


def test_the_model_of_the_page_on_meshes_becomes_a_case(model: None, tmp_path: Path) -> None:
    """Its model and its table [mesh], with the rest of the block of the examples."""
    root = Path(__file__).parents[2]
    page = (root / "docs" / "mesh.md").read_text()
    table = page.split("```toml\n")[1].split("```")[0]
    (tmp_path / "block.geo").write_text(page.split("```c++\n")[1].split("```")[0])
    gmsh.merge(str(tmp_path / "block.geo"))
    gmsh.model.mesh.generate(2)
    gmsh.write(str(tmp_path / "block.msh"))
    rest = (root / "examples" / "block.toml").read_text().split("[material]")[1]
    case = tmp_path / "block.toml"
    case.write_text(f"{table}\n[material]{rest}")
    estimate = pc.run(case)
    assert "bottom" in estimate.mesh.edge_groups
    # The regular mesh of 2.5 mm has 6.3 %; this one has 2 mm.
    assert estimate.published_relative_sup < 0.08
