"""No circle of imports in the package and in the studies, of files or of folders.

Imports inside functions and those for types alone count.
"""

import ast
from collections.abc import Collection
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def modules(folder: Path) -> dict[str, Path]:
    """The files of a package by the names of their modules."""
    files = {file.relative_to(folder.parent).with_suffix(""): file for file in folder.rglob("*.py*") if file.suffix in (".py", ".pyi")}
    return {".".join(part for part in path.parts if part != "__init__"): file for path, file in files.items()}


def used(text: str, known: Collection[str]) -> set[str]:
    """The modules that a module imports anywhere."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.module and node.level == 0, "imports have whole names"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            found |= {name if name in known else node.module for name in names}
    return found.intersection(known)


def imports(folder: str) -> dict[str, set[str]]:
    """The modules that each module of a package imports."""
    known = modules(ROOT / folder)
    assert len(known) > 30
    return {name: used(file.read_text(encoding="utf-8"), known) for name, file in known.items()}


def check(uses: dict[str, set[str]]) -> None:
    """Fail with the first circle."""
    try:
        TopologicalSorter(uses).prepare()
    except CycleError as error:
        pytest.fail(" ← ".join(error.args[1]))


@pytest.mark.parametrize("folder", ["python/percute", "studies"])
def test_modules_do_not_import_each_other_in_circles(folder: str) -> None:
    check(imports(folder))


@pytest.mark.parametrize("folder", ["python/percute", "studies"])
def test_folders_do_not_import_each_other_in_circles(folder: str) -> None:
    package = Path(folder).name
    assert any(any(path.glob("*.py")) for path in (ROOT / folder).iterdir())
    whole: dict[str, set[str]] = {}
    for name, found in imports(folder).items():
        # A module or a folder right below the package; the package itself joins all of them.
        parts = {of.split(".")[1] for of in found if of != package}
        whole.setdefault(name.removeprefix(f"{package}.").split(".")[0], set()).update(parts)
    check({name: found - {name} for name, found in whole.items() if name != package})


@pytest.mark.parametrize("text", ["import a.b", "from a import b", "from a.b import c", "def f():\n    from a.b import c", "if T:\n    import a.b"])
def test_imports_in_all_places_count(text: str) -> None:
    assert used(text, ["a", "a.b", "a.d"]) == {"a.b"}
