"""Meshes in files: those of Gmsh that are in the repository, and other formats through meshlane."""

import sys
from pathlib import Path

import numpy as np
import percute as pc
import pytest
from conftest import block_case

FILES = Path(__file__).parents[2] / "crates/io/tests/gmsh/files"
LEFT_OUT = "ignore::percute.MeshWarning"


@pytest.mark.parametrize("name", ["block-4.1", "block-4.1-binary", "block-2.2", "block-2.2-binary"])
def test_a_file_of_gmsh_is_read(name: str) -> None:
    with pytest.warns(pc.MeshWarning) as caught:
        mesh = pc.Mesh.read(FILES / f"{name}.msh", scale=1e-3)
    assert [each.filename for each in caught] == [__file__] * 3
    assert mesh.points.max(axis=0).tolist() == [0.05, 0.04]
    assert list(mesh.edge_groups) == ["Dach, außen", "bottom", "interface", "right side"]
    assert list(mesh.element_groups) == ["30", "aluminium", "steel"]


def block(mesh: str) -> str:
    """At 20 m/s strains are small."""
    return block_case(f'file = "{mesh}"\nscale = 1e-3', speed=20.0, end=5e-6, plane='group = "bottom"')


@pytest.mark.filterwarnings(LEFT_OUT)
@pytest.mark.filterwarnings("ignore::percute.InputWarning")
def test_a_case_names_its_mesh_relative_to_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cases").mkdir()
    (tmp_path / "cases/a.msh").write_bytes((FILES / "block-4.1-binary.msh").read_bytes())
    (tmp_path / "cases/a.toml").write_text(block("a.msh"))
    monkeypatch.chdir(tmp_path)
    of_file = pc.run("cases/a.toml")
    # A text is nowhere but in the working directory.
    of_text = pc.run(block("cases/a.msh"))
    assert of_file.by_element.tobytes() == of_text.by_element.tobytes()
    with pytest.raises(pc.InputError, match=r"there is no such file; names are relative"):
        pc.run(block("a.msh"))


def test_a_case_warns_of_what_its_mesh_left_out(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text(block(str(FILES / "block-2.2.msh")))
    with pytest.warns((pc.MeshWarning, pc.InputWarning)) as caught:
        estimate = pc.run(tmp_path / "a.toml")
    # The result has a warning of reoriented elements.
    assert [each.category for each in caught] == [pc.MeshWarning] * 3 + [pc.InputWarning]
    assert [each.filename for each in caught] == [__file__] * 4
    assert '"dropped_nodes"' in estimate.to_json()


def meshes() -> list[pc.Mesh]:
    plate = pc.Mesh.rectangle(0.05, 0.04, nx=4, ny=3)
    parts = {"odd": np.arange(1, 24, 2), "few": [0, 1, 5]}
    return [
        pc.Mesh(plate.points / 3, plate.cells, {**plate.edge_groups, "ends": plate.edge_groups["left"]}, parts),
        pc.Mesh(pc.Mesh.bar(0.1, elements=9).points + 0.3, pc.Mesh.bar(0.1, elements=9).cells, {"end": [9]}, {"b": [0, 1]}),
    ]


def assert_same(a: pc.Mesh, b: pc.Mesh) -> None:
    assert a.points.tobytes() == b.points.tobytes()
    assert np.array_equal(a.cells, b.cells)
    for groups, others in [(a.edge_groups, b.edge_groups), (a.element_groups, b.element_groups)]:
        assert list(groups) == list(others)
        assert all(np.array_equal(groups[name], others[name]) for name in groups)


@pytest.mark.parametrize("version", ["4.1", "2.2"])
@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("mesh", meshes(), ids=["plate", "bar"])
def test_a_mesh_comes_back_bit_by_bit(tmp_path: Path, mesh: pc.Mesh, version: str, binary: bool) -> None:
    file = tmp_path / "a.MSH"
    mesh.write(file, version=version, binary=binary)
    assert_same(pc.Mesh.read(file), mesh)
    with pytest.raises(pc.ExistingFileError, match="overwrite=True"):
        mesh.write(file)
    mesh.write(file, overwrite=True)


def test_arguments_are_checked(tmp_path: Path) -> None:
    mesh = pc.Mesh.rectangle(1, 1, nx=1, ny=1)
    with pytest.raises(pc.InputError, match=r'`version` is 4.1; it must be "4.1" or "2.2"'):
        mesh.write(tmp_path / "a.msh", version=4.1)  # type: ignore[arg-type]
    with pytest.raises(pc.InputError, match="`version` is "):
        mesh.write(tmp_path / "a.msh", version=np.array([]))  # type: ignore[arg-type]
    with pytest.raises(pc.InputError, match=r"`binary` is 1; it must be True or False"):
        mesh.write(tmp_path / "a.msh", binary=1)  # type: ignore[arg-type]
    with pytest.raises(pc.InputError, match=r"those of .msh files"):
        mesh.write(tmp_path / "a.vtu", binary=True)
    for scale in (0, -1, float("nan"), "mm"):
        for name in ("block-4.1.msh", "block.geo"):
            with pytest.raises(pc.InputError, match="`scale`"):
                pc.Mesh.read(FILES / name, scale=scale)  # type: ignore[arg-type]
    for name in ("a.msh", "a.vtu"):
        with pytest.raises(pc.MissingFileError, match="there is no such file"):
            pc.Mesh.read(tmp_path / name)
    with pytest.raises(pc.InputError, match="no quotes"):
        pc.Mesh([0, 1], [[0, 1]], {'a "b"': [0]}).write(tmp_path / "a.msh")
    assert not list(tmp_path.iterdir())


def test_without_meshlane_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "meshlane", None)
    (tmp_path / "a.vtu").write_text("")
    with pytest.raises(pc.InputError, match=r"pip install 'percute\[mesh\]'"):
        pc.Mesh.read(tmp_path / "a.vtu")
    with pytest.raises(pc.InputError, match=r"pip install 'percute\[mesh\]'"):
        meshes()[0].write(tmp_path / "b.vtu")


def test_abaqus_and_med_keep_the_groups(tmp_path: Path) -> None:
    pytest.importorskip("meshlane")
    for ending in ("inp", "med"):
        mesh = meshes()[0]
        mesh.write(tmp_path / f"a.{ending}")
        read = pc.Mesh.read(tmp_path / f"a.{ending}", scale=2.0)
        # Abaqus's is a text.
        np.testing.assert_allclose(read.points, 2 * mesh.points, rtol=1e-14)
        assert np.array_equal(read.cells, mesh.cells)
        assert set(read.edge_groups) == set(mesh.edge_groups)
        for name, edges in mesh.edge_groups.items():
            assert sorted(map(sorted, read.edge_groups[name].tolist())) == sorted(map(sorted, edges.tolist()))
        assert {name: sorted(all_) for name, all_ in read.element_groups.items()} == {
            name: sorted(all_) for name, all_ in mesh.element_groups.items()
        }
        with pytest.raises(pc.ExistingFileError):
            mesh.write(tmp_path / f"a.{ending}")
        mesh.write(tmp_path / f"a.{ending}", overwrite=True)


def test_a_format_without_groups_says_so(tmp_path: Path) -> None:
    pytest.importorskip("meshlane")
    mesh = meshes()[0]
    with pytest.warns(pc.MeshWarning, match="does not keep the groups 'bottom', 'ends', 'few'") as caught:
        mesh.write(tmp_path / "a.vtu")
    assert caught[0].filename == __file__
    read = pc.Mesh.read(tmp_path / "a.vtu")
    assert read.points.tobytes() == mesh.points.tobytes()
    assert not read.edge_groups and not read.element_groups


def test_a_format_of_two_files_is_whole(tmp_path: Path) -> None:
    pytest.importorskip("meshlane")
    mesh = pc.Mesh(meshes()[0].points, meshes()[0].cells)
    mesh.write(tmp_path / "a.xdmf")
    assert_same(pc.Mesh.read(tmp_path / "a.xdmf"), mesh)


def test_what_meshlane_finds_is_checked(tmp_path: Path) -> None:
    meshlane = pytest.importorskip("meshlane")
    places = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [9, 9, 0]], dtype=float)
    triangles = np.array([[0, 1, 2], [0, 3, 2]])

    def read(points: np.ndarray, cells: list[tuple[str, np.ndarray]], **more: object) -> pc.Mesh:
        meshlane.write(tmp_path / "a.vtu", meshlane.Mesh(points, cells, **more))
        return pc.Mesh.read(tmp_path / "a.vtu")

    numbers = {"cell_data": {"CellEntityIds": [np.array([5, 6]), np.array([2, 0, 3])]}}
    with pytest.warns(pc.MeshWarning) as caught:
        mesh = read(places, [("triangle", triangles), ("line", np.array([[0, 1], [1, 2], [0, 2]]))], **numbers)
    assert [each.filename for each in caught] == [__file__] * 2
    told = [str(each.message) for each in caught]
    assert "1 node of the mesh file left out" in told[0] and "group '3': 1 edge lies inside" in told[1]
    assert {name: all_.tolist() for name, all_ in mesh.element_groups.items()} == {"5": [0], "6": [1]}
    assert {name: all_.tolist() for name, all_ in mesh.edge_groups.items()} == {"2": [[0, 1]], "3": []}
    assert mesh.reoriented_elements == 1
    for points, cells, phrase in [
        (places[:4], [("quad", np.array([[0, 1, 2, 3]]))], "'quad'; percute takes 3-node triangles"),
        (places[:4], [("vertex", np.array([[0]]))], "neither tetrahedra nor triangles nor lines"),
        (places[:4] + np.eye(4, 3, -1), [("triangle", triangles)], "in a plane z = const"),
        (places[:4], [("triangle", np.array([[0, 1, 7]]))], "a node that is not there"),
        (places[:4], [("triangle", np.array([[0, 1, 1]]))], "degenerate"),
    ]:
        with pytest.raises(pc.FileFormatError, match=phrase):
            read(points, cells)


FOUR = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n"
NODES = f"{FOUR}5,2,0\n6,2,1\n"
GRID = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nCTRIA3,1,1,1,2,3\n"
ZONE = "ZONE N=3, E=1, F=FEPOINT, ET=TRIANGLE\n0 0\n1 0\n0 1\n1 2 3\n"
PIECE = """<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 0 2 3</DataArray><DataArray type="Int64" Name="offsets" format="ascii">3 6
</DataArray><DataArray type="UInt8" Name="types" format="ascii">5 63</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"""


@pytest.mark.parametrize(
    ("name", "content", "phrase"),
    [
        ("a.inp", f"{NODES}*ELEMENT, TYPE=CPS3\n1,1,2,3\n*Element, type=CPS6\n2,1,2,3,\n4,5,6\n3,2,1,3,4,5,6\n", "2 elements are of the kind 'CPS6'; percute takes"),
        ("a.inp", f"{NODES}*ELEMENT, TYPE=CPS3\n1,1,2,3\n*ELEMENT, TYPE=CAX3\n2,1,3,4\n", "1 element is of the kind 'CAX3'; percute has no axisymmetric"),
        ("a.inp", "*INCLUDE, INPUT=a.inp\n", "includes itself"),
        ("a.inp", "*INCLUDE, INPUT=b.inp\n", "includes 'b.inp', which is not beside it"),
        ("a.bdf", f"{GRID}CPLSTN3,2,1,1,3,4\nENDDATA\n", "1 element is of the kind 'CPLSTN3'; percute takes"),
        ("a.nas", f"{GRID}ctria3,2,1,1,3,4\nENDDATA\n", "'ctria3'; meshlane reads these in capitals"),
        ("a.bdf", f"{GRID}INCLUDE 'b.bdf'\nENDDATA\n", "includes another file"),
        ("a.dat", f'VARIABLES = "X", "Y"\n{ZONE}{ZONE}{ZONE}', "has 3 zones, of which meshlane reads the first: 2 elements would be lost"),
        ("a.vtu", PIECE, r"meshlane loses elements: File contains cells that meshlane cannot handle \(type 63\)"),
    ],
)
def test_elements_that_meshlane_would_lose_are_refused(name: str, content: str, phrase: str, tmp_path: Path) -> None:
    pytest.importorskip("meshlane")
    (tmp_path / name).write_text(content)
    with pytest.raises(pc.FileFormatError, match=phrase):
        pc.Mesh.read(tmp_path / name)


def test_triangles_of_abaqus_have_several_names(tmp_path: Path) -> None:
    """Plane strain and thermal ones are triangles, too; those of an included file are in its sets."""
    pytest.importorskip("meshlane")
    (tmp_path / "more.txt").write_text("*ELEMENT, TYPE=CPE3, ELSET=more\n2, 1, 3,\n4\n")
    (tmp_path / "a.inp").write_text(f"{FOUR}*Element, type=cps3t\n1,1,2,3\n*INCLUDE, INPUT=more.txt\n")
    mesh = pc.Mesh.read(tmp_path / "a.inp")
    assert mesh.cells.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert {name: each.tolist() for name, each in mesh.element_groups.items()} == {"more": [1]}


def test_what_is_no_part_of_a_mesh_is_told(tmp_path: Path) -> None:
    pytest.importorskip("meshlane")
    more = "*ELEMENT, TYPE=SPRINGA\n7,1,3\n*NSET,NSET=low\n1,2\n*SURFACE,NAME=side\nb,S1\n"
    files = {
        "a.inp": (f"{FOUR}*ELEMENT, TYPE=S3\n1,1,2,3\n2,1,3,4\n{more}", ["group of points 'low' left out", "1 element of the kind 'SPRINGA' left out", "surface 'side' left out"]),
        "a.bdf": (f"{GRID}CTRIA3,2,1,1,3,4\nCONM2,9,1,,3.\nENDDATA\n", ["1 element of the kind 'CONM2' left out"]),
        "a.su2": (
            "NDIME= 2\nNELEM= 2\n5 0 1 2\n5 0 2 3\nNPOIN= 4\n0 0\n1 0\n1 1\n0 1\nNMARK= 1\nMARKER_TAG= low\nMARKER_ELEMS= 1\n3 0 1\n",
            ["the reader says: meshlane does not support tags of string type. Surface tag low will be replaced by 1"],
        ),
    }
    for name, (content, told) in files.items():
        (tmp_path / name).write_text(content)
        with pytest.warns(pc.MeshWarning) as caught:
            mesh = pc.Mesh.read(tmp_path / name)
        assert len(mesh.cells) == 2 and len(caught) == len(told)
        assert all(str(each.message).startswith(start) for each, start in zip(caught, told, strict=True))


def test_sets_of_points_are_ends_of_bars(tmp_path: Path) -> None:
    pytest.importorskip("meshlane")
    (tmp_path / "a.inp").write_text("*NODE\n1,0\n2,1\n3,2\n*ELEMENT, TYPE=T2D2\n1,1,2\n2,2,3\n*NSET,NSET=right\n3\n")
    mesh = pc.Mesh.read(tmp_path / "a.inp")
    assert {name: ends.tolist() for name, ends in mesh.edge_groups.items()} == {"right": [[2]]}


def test_what_meshlane_cannot_read_is_an_exception(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("meshlane")
    for name, content in [("a.vtu", "<VTKFile>"), ("a.inp", "*NODE\n1, x"), ("a.foo", ""), ("a.xdmf", "no")]:
        (tmp_path / name).write_text(content)
        with pytest.raises(pc.FileFormatError, match=r"meshlane cannot read .*/a\.") as caught:
            pc.Mesh.read(tmp_path / name)
        assert "\n" not in str(caught.value)
        assert str(caught.value).endswith("choose .msh, .vtu, .inp or .med")
        assert ("the ending of the name selects the format" in str(caught.value)) == (name == "a.foo")
    with pytest.raises(pc.InputError, match=r"meshlane cannot write .*b\.foo: Could not deduce file format from path '[^.]*/b\.foo'"):
        meshes()[0].write(tmp_path / "b.foo")
    assert capfd.readouterr() == ("", "")
