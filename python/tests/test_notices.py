"""The wheel carries the licences of all that is linked into it."""

import importlib.util
import re
import shutil
from importlib.metadata import distribution
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def notices() -> ModuleType:
    script = ROOT / "tools" / "notices.py"
    if not script.exists() or shutil.which("cargo") is None:
        pytest.skip("a source distribution has no tools")
    spec = importlib.util.spec_from_file_location("notices", script)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_crate_has_a_licence_in_the_file(notices: ModuleType) -> None:
    """The list of all crates at the head of the file, and each crate above a text of its own."""
    text = (ROOT / "NOTICES.txt").read_text(encoding="utf-8")
    linked = {f"{package['name']} {package['version']}" for package in notices.linked()}
    assert len(linked) > 100 and {name.split()[0] for name in linked} > {"hdf5-metno-src", "libz-sys", "resvg", "pyo3", "numpy", "rayon"}
    head, *texts = re.split(r"(?m)^={80}\n(.+)\n={80}\n", text)
    assert set(re.findall(r"(?m)^(\S+ \d\S*)  \(", head)) == linked
    above = [name for names, licence in zip(texts[::2], texts[1::2], strict=True) if len(licence.strip()) > 200 for name in names.split(", ")]
    assert set(above) == linked
    assert text == notices.notices(), "Cargo.lock has changed: run python tools/notices.py"


def test_what_crates_bring_along_is_in_the_file() -> None:
    text = (ROOT / "NOTICES.txt").read_text(encoding="utf-8")
    for words in ("HDF5 (Hierarchical Data Format 5)", "Jean-loup Gailly and Mark Adler", "UBUNTU FONT LICENCE Version 1.0"):
        assert words in text


def test_the_installed_package_has_the_file() -> None:
    files = {file.name: file for file in distribution("percute").files or []}
    assert {"LICENSE-MIT", "LICENSE-APACHE", "NOTICES.txt"} <= files.keys()
    assert files["NOTICES.txt"].read_text(encoding="utf-8") == (ROOT / "NOTICES.txt").read_text(encoding="utf-8")
