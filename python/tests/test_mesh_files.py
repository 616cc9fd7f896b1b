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
        (places[:4], [("vertex", np.array([[0]]))], "neither triangles nor lines"),
        (places[:4] + np.eye(4, 3, -1), [("triangle", triangles)], "in a plane z = const"),
        (places[:4], [("triangle", np.array([[0, 1, 7]]))], "a node that is not there"),
        (places[:4], [("triangle", np.array([[0, 1, 1]]))], "degenerate"),
    ]:
        with pytest.raises(pc.FileFormatError, match=phrase):
            read(points, cells)


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
