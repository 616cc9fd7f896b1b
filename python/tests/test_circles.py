"""No circle of imports in the package and in the studies. Imports inside functions and those for types alone count."""

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


@pytest.mark.parametrize("folder", ["python/percute", "studies"])
def test_modules_do_not_import_each_other_in_circles(folder: str) -> None:
    known = modules(ROOT / folder)
    assert len(known) > 30
    uses = {name: used(file.read_text(encoding="utf-8"), known) for name, file in known.items()}
    try:
        TopologicalSorter(uses).prepare()
    except CycleError as error:
        pytest.fail(" ← ".join(error.args[1]))


@pytest.mark.parametrize("text", ["import a.b", "from a import b", "from a.b import c", "def f():\n    from a.b import c", "if T:\n    import a.b"])
def test_imports_in_all_places_count(text: str) -> None:
    assert used(text, ["a", "a.b", "a.d"]) == {"a.b"}
