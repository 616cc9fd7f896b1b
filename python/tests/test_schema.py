"""The schema that ``percute schema`` prints, against all cases, the mistakes of users and the page on case files."""

import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from datetime import date
from pathlib import Path
from typing import Any

import percute as pc
import pytest
from jsonschema import Draft202012Validator
from percute._percute import CaseData
from test_mistakes import MISTAKES, case_of

ROOT = Path(__file__).parents[2]
FOLDERS = [ROOT / "examples", ROOT / "tests" / "bases", ROOT / "studies" / "benchmarks" / "cases"]
CASES = [file for folder in FOLDERS for file in sorted(folder.glob("*.toml"))]

MORE = """
[[body_force]]
value = [0.0, -26487.0]

[output]
history = "a.vtkhdf"
estimate = "b.vtkhdf"
instants = [0.0, 1e-6]
fields = ["velocity", "admissible"]
every = 2
"""
"""Tables that the block does not have."""

ODD = [-1, 0, 1, 0.25, 1e300, True, "x", "x.vtkhdf", [], [1], [1.0, 0.0], [[1.0, 0.0]], [1, 2, 3], {}, {"x": 1}, date(1979, 5, 27)]
"""Values of all kinds."""

BEYOND = {
    "different friction of a surface against two bodies": "two tables together",
    "pairs of nodes on a surface against two bodies": "two tables together",
    "contact of bodies in a case of one": "the number of bodies",
    "a body beyond all numbers": "the rounding of coordinates",
    "instants in a case without an estimate file": "two keys together",
    "admissible fields without an estimate file": "two keys together",
    "fields of a history that is not kept": "two keys together",
    "steps of a history that is not kept": "two keys together",
    "times of a history that is not kept": "two keys together",
    "a density that is NaN": "JSON has no NaN",
    "a tangent that is not a number": "JSON has no NaN",
    "a number beyond the range of numbers": "JSON has no infinity",
    "a nodal field of the wrong length": "the number of nodes",
    "waves faster than light": "the ratio of two numbers",
    "a law for large strains with small kinematics": "two keys together",
    "hardening without a yield stress": "two keys together",
    "a tangent without a yield stress": "two keys together",
    "a tangent above Young's modulus": "two keys together",
    "a tangent and a hardening modulus": "two keys together",
    "a kinematic share of no hardening": "two keys together",
    "plasticity with finite kinematics": "two keys together",
    "a bar that hardens without a yield stress": "two keys together",
    "a neo-Hookean sheet with negative Poisson's ratio": "two keys together",
    "a reconstruction that does not balance where bodies turn": "two tables together",
    "finite kinematics on two planes": "two tables together",
    "a group of a plane for a body that turns": "two tables together",
    "two bodies that turn": "the number of bodies",
    "nodes counted from 1": "the number of nodes",
    "a node that no element uses": "nodes and elements together",
    "an element without area": "the geometry of the mesh",
    "two nodes at one place": "the geometry of the mesh",
    "an edge inside the body in a group": "nodes and elements together",
    "an element that is not there in a group": "the number of elements",
    "a mesh file that is not there": "other files",
    "a file that is no mesh": "other files",
    "a mesh of quadrangles": "other files",
    "a mesh file cut off": "other files",
    "a mesh that leaves the plane": "other files",
    "a group that the mesh file does not have": "other files",
    "a group that the mesh does not have": "the groups of the mesh",
    "a misspelt group": "the groups of the mesh",
    "a body of a group that is not in its mesh": "the groups of the mesh",
    "a group of the wrong case": "the groups of the mesh",
    "a group of elements where edges belong": "the groups of the mesh",
    "an empty group": "the groups of the mesh",
    "two materials on an element": "the groups of the mesh",
    "a table in time of unequal lengths": "the lengths of two lists",
    "a table in time that runs backwards": "the order of numbers",
    "a start that disagrees with a support": "values of two tables",
    "bodies that overlap": "the geometry of the bodies",
    "bodies that touch at the start": "the geometry of the bodies",
    "bodies in plane stress and plane strain": "values of two tables",
    "two bodies of one name": "values of two tables",
    "a body that jams in a corner": "values of two tables",
    "a contact with a body that is not there": "the groups of the mesh",
    "a contact of a body with itself": "the groups of the mesh",
    "a contact of a body that is not there": "the names of the bodies",
    "a contact of a body with itself by its name": "the names of the bodies",
    "two contacts of the same bodies": "values of two tables",
    "two contacts of all bodies": "values of two tables",
    "bodies without a contact": "the geometry of the bodies",
    "a contact of bodies that is held apart by a load": "the geometry of the bodies",
    "a contact without friction": "the kind of the bodies",
    "a contact of surfaces that are meshed differently": "the geometry of the bodies",
    "a contact of surfaces that are aside of each other": "the geometry of the bodies",
    "a contact of surfaces that look the same way": "the geometry of the bodies",
    "a contact of surfaces of bodies that are beside each other": "the geometry of the bodies",
    "a contact of the sides that look away from each other": "the geometry of the bodies",
    "slopes at a line of symmetry": "the geometry of the bodies",
    "a contact stated twice": "values of two tables",
    "a contact stated twice in the same order": "values of two tables",
    "a contact stated by groups and by bodies": "values of two tables",
    "a contact of a surface that is held": "two groups of the mesh",
    "a contact of a surface that is loaded": "two groups of the mesh",
    "two supports with two motions": "values of two tables",
    "an edge that is loaded and supported": "two groups of the mesh",
    "supports that leave no freedom": "the groups of the mesh",
    "a normal that points away from the body": "the geometry of the mesh",
    "a plane that cuts through the body": "the geometry of the mesh",
    "a group that does not face its plane": "the geometry of the mesh",
    "a group that is loaded and may touch": "two groups of the mesh",
    "a plane that only supported edges face": "two groups of the mesh",
    "a start too near to come to rest": "the critical step",
    "a body in mm above a plane in m": "the critical step",
    "a body of some metres that starts too near to its plane, or whose lengths are in another unit": "the critical step",
    "a speed in mm/s just above a plane": "the critical step",
    "a run of a second, in which the unit of time is wrong": "the critical step",
    "an end with the rebound but without a plane": "values of two tables",
    "a step above the critical one": "the critical step",
    "one of many steps above the critical one": "the critical step",
    "an end that the steps do not reach": "a sum",
    "more steps than any run can have": "the ratio of two numbers",
    "an instant after the end": "values of two tables",
    "a time that a history cannot keep": "values of two tables",
}
"""Mistakes that no schema finds, and what one would have to know. All other mistakes in the structure of a case are found."""



@pytest.fixture(scope="module")
def schema() -> Draft202012Validator:
    printed = subprocess.run([sys.executable, "-m", "percute", "schema"], capture_output=True, check=True).stdout
    schema = json.loads(printed)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


@pytest.mark.parametrize("case", CASES, ids=[case.stem for case in CASES])
def test_cases_are_accepted(case: Path, schema: Draft202012Validator) -> None:
    schema.validate(tomllib.loads(case.read_text(encoding="utf-8")))


def test_there_are_cases_in_each_folder() -> None:
    assert {case.parent for case in CASES} == set(FOLDERS)


def test_parts_of_cases_in_the_pages_are_accepted(schema: Draft202012Validator) -> None:
    parts = schema.evolve(schema={key: value for key, value in schema.schema.items() if key not in ("required", "oneOf", "else")})
    found = 0
    for page in ROOT.glob("docs/*.md"):
        # The file of a sweep is another language.
        for text in re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL) if page.stem != "sweep" else ():
            parts.validate(tomllib.loads(text))
            found += 1
    assert found


def test_mistakes_are_refused(schema: Draft202012Validator) -> None:
    """All of the table but those beyond a schema; what is only warned of is accepted."""
    judged, wrong = set(), []
    for mistake in MISTAKES:
        try:
            case = tomllib.loads(case_of(mistake) or "?")
        except tomllib.TOMLDecodeError:
            continue
        judged.add(mistake["name"])
        accepted = "warning" in mistake or mistake["name"] in BEYOND
        if schema.is_valid(case) != accepted:
            wrong.append(mistake["name"])
    assert judged > BEYOND.keys() and wrong == []


def written(value: Any) -> str:
    """Give a value in TOML."""
    match value:
        case dict():
            return "{ " + ", ".join(f"{json.dumps(key)} = {written(entry)}" for key, entry in value.items()) + " }"
        case list():
            return "[" + ", ".join(map(written, value)) + "]"
        case str() | bool():
            return json.dumps(value)
        case _:
            return str(value)


def changed(case: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Give the case with each of its values, tables included, left out and replaced by each odd one."""

    def places(value: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
        for key, entry in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
            yield (*path, key)
            yield from places(entry, (*path, key))

    for *path, last in places(case, ()):
        for odd in (None, *ODD):
            new = deepcopy(case)
            inner: Any = new
            for key in path:
                inner = inner[key]
            if odd is None:
                del inner[last]
            else:
                inner[last] = odd
            yield new


@pytest.mark.parametrize("base", ["arrays", "bar", "block"])
def test_what_percute_reads_is_accepted(base: str, schema: Draft202012Validator) -> None:
    """No editor may complain of a case that runs; most of what is refused is refused by the schema, too."""
    text = (ROOT / "tests" / "bases" / f"{base}.toml").read_text(encoding="utf-8") + (MORE if base == "block" else "")
    read = refused = found = 0
    for case in changed(tomllib.loads(text)):
        if any(case.get(key) == [] for key in ("initial", "estimate", "output")):
            continue  # A list of none is accepted and nobody writes it.
        new = "\n".join(f"{key} = {written(value)}" for key, value in case.items())
        try:
            CaseData("case.toml", new, ROOT)
        except pc.InputError:
            refused += 1
            found += not schema.is_valid(case)
        else:
            read += 1
            assert schema.is_valid(case), new
    # Left are numbers that do not fit together, such as nodes that are not there.
    assert read > 10 and found > 0.85 * refused, (read, refused, found)


def test_the_page_on_case_files_has_the_same_keys(schema: Draft202012Validator) -> None:
    """Each key of a table is in the section on it, and the first columns there have no other keys."""
    sections = re.split(r"(?m)^## ", (ROOT / "docs" / "case.md").read_text(encoding="utf-8"))[1:]
    told: dict[str, tuple[set[str], set[str]]] = {}
    for section in sections:
        heading, text = section.split("\n", 1)
        code = " ".join(re.findall(r"`([^`]+)`", text))
        first = " ".join(re.findall(r"(?m)^\| (`.*?) \|", text))
        begins = re.findall(r"`([a-z_]+)(?: = [^`]*)?`", first)
        for table in re.findall(r"`\[+(\w+)\]+`", heading):
            told[table] = (set(re.findall(r"[a-z_]+", code)), set(begins))
    defined = schema.schema["$defs"]
    # `gravity` is no table, but a key.
    tables = {name: defined[name] for name in schema.schema["properties"] if name != "gravity"}
    assert told.keys() == tables.keys()
    for name, (words, begins) in told.items():
        keys = set(tables[name]["properties"])
        inner = {key for value in tables[name]["properties"].values() for key in value.get("properties", {})}
        assert keys | inner <= words, f"[{name}]: {(keys | inner) - words} is not on the page"
        # Tractions and body forces share a section.
        shared = keys | set(tables["traction"]["properties"]) if name == "body_force" else keys
        assert begins <= shared, f"[{name}]: {begins - shared} is not in the schema"
