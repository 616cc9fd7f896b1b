"""The documentation site builds without warnings, its links hold, and what its pages say of the program is true."""

import importlib.util
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import percute as pc
import pytest

ROOT = Path(__file__).parents[2]


class Page(HTMLParser):
    """The links of a page, the files that a browser loads with it, and the places in it that links can name."""

    def __init__(self, file: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.places: set[str] = set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        found = {name: value or "" for name, value in attributes}
        self.places |= {found[name] for name in ("id", "name") if name in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if "src" in found:
            self.loaded.append(found["src"])
        if tag == "link" and found.get("rel") in ("stylesheet", "icon", "preload"):
            self.loaded.append(found["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    missing = [name for name in ("sphinx", "myst_parser", "numpydoc", "furo") if importlib.util.find_spec(name) is None]
    if missing:
        pytest.skip(f"the site needs {', '.join(missing)}: pip install '.[site]'")
    made = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", "docs", ".", made], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return made


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, Page]:
    return {file: Page(file) for file in site.rglob("*.html")}


def test_all_links_of_the_site_hold(pages: dict[Path, Page]) -> None:
    """Links inside the site: to a file that is there, and to a place on the page."""
    checked = 0
    for file, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            # A theme's links to the top of a page and to nowhere.
            if parts.scheme or link == "#":
                continue
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            assert target.is_file(), f"{file.name}: {link}"
            if parts.fragment and target.suffix == ".html":
                assert unquote(parts.fragment) in pages[target].places, f"{file.name}: {link}"
            checked += 1
    assert checked > 1000


def test_a_browser_loads_nothing_from_elsewhere(pages: dict[Path, Page]) -> None:
    loaded = {(file.name, name) for file, page in pages.items() for name in page.loaded}
    assert len(loaded) > 100
    assert not [each for each in loaded if urlsplit(each[1]).netloc]


def test_all_pages_are_within_two_links_of_the_start(site: Path, pages: dict[Path, Page]) -> None:
    """Of the start page's text and menu; search and index stand apart."""
    start = site / "docs" / "index.html"
    assert 'url=docs/index.html"' in (site / "index.html").read_text()

    def linked(file: Path) -> set[Path]:
        return {(file.parent / unquote(urlsplit(link).path)).resolve() for link in pages[file].links if not urlsplit(link).scheme}

    near = linked(start)
    near |= {other for page in near if page in pages for other in linked(page)}
    left = {page.resolve() for page in pages} - near - {site / name for name in ("index.html", "genindex.html", "search.html")}
    assert not [page for page in left if page.name != "py-modindex.html"]


def test_equations_are_typeset_with_their_numbers(site: Path) -> None:
    page = (site / "docs" / "method.html").read_text()
    source = (ROOT / "docs" / "method.md").read_text()
    numbers = re.findall(r"\\tag\{(.*?)\}", source)
    assert len(numbers) > 20
    assert re.findall(r'<span class="number">\[(.*?)\]</span>', page) == numbers
    # Outside the formulas themselves, dollars and backslashes would be what was not read as one.
    assert page.count("<math") > 60
    assert "$" not in page and "\\frac" not in page


def test_the_gallery_shows_what_its_cases_give(site: Path) -> None:
    """Each case among the examples has a page with its summary, but for the time that the run took."""
    for case in (ROOT / "examples").glob("*.toml"):
        page = (site / "docs" / "gallery" / f"{case.stem}.html").read_text()
        text = re.sub(r"<[^>]+>", "", page)
        relative = 100 * pc.run(case).relative_sup
        assert re.search(r"(?m)^result    sup (\S+) % ", text)[1] == f"{relative:#.3g}", case.name  # type: ignore[index]
        assert re.search(rf"(?m)^case      examples/{case.name} \(percute [\d.]+\)$", text), "a time, or no summary"


def test_the_page_on_verdicts_quotes_the_program(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """The sentences of its example, the reasons for low trust, and its lines of Python."""
    page = (ROOT / "docs" / "verdict.md").read_text()
    monkeypatch.chdir(ROOT)
    verdict = pc.run("examples/block.toml").verdict
    assert verdict == " ".join(re.findall(r"(?m)^> (.*)$", page))
    folder = ROOT / "crates" / "workflow" / "src" / "report" / "verdict"
    code = "".join(file.read_text() for file in (folder / "rules.rs", folder / "text.rs", folder.parent / "linearity.rs"))
    # The verdict has names in quotes of code, and numbers in place of the dots.
    code, plain = code.replace("`", ""), page.replace("`", "")
    reasons = re.findall(r"(?m)^\| (.*?) \|", plain.split("### Reasons for low trust")[1].split("###")[0])[1:]
    assert len(reasons) > 9
    for part in (part.strip() for reason in reasons for part in reason.split("…")):
        assert part in code, f"no verdict says: {part}"
    for reason in re.findall(r'reason: Some\("([^";]*)', code):
        assert reason in reasons, f"docs/verdict.md leaves out: {reason}"
    example, printed = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", page, re.DOTALL)[0]
    exec(example, {})
    assert capsys.readouterr().out == printed


def test_the_python_of_the_page_on_exports_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyvista")
    monkeypatch.chdir(tmp_path)
    pc.run(ROOT / "examples" / "block.toml", store="block.vtkhdf")
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "export.md").read_text(), re.DOTALL)
    export, step_through = blocks[:2]
    names: dict[str, object] = {}
    exec(export, names)
    exec(step_through, names)
    assert names["files"] and names["grid"]["von_mises"].shape == (640,)  # type: ignore[index]


def test_tests_know_all_pages_with_code() -> None:
    """A page with blocks of Python or TOML is named by a test, which runs them."""
    tests = "".join(file.read_text() for file in (ROOT / "python" / "tests").glob("test_*.py"))
    files = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").glob("*.md")]
    with_code = [file for file in files if re.search(r"```(python|toml|c\+\+)\n", file.read_text())]
    assert len(with_code) > 8
    assert not [file.name for file in with_code if f"{file.name}\"" not in tests]


def test_the_pages_of_the_crates_have_the_method(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("docutils")
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    crate_pages = importlib.import_module("crate_pages")
    for crate in crate_pages.PAGES:
        written = (ROOT / "crates" / crate / "src" / "method.md").read_text(encoding="utf-8")
        assert written == crate_pages.page(crate), "docs/method.md has changed: run `python tools/crate_pages.py`"


def test_the_page_on_the_command_has_all_options(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    option_tables = importlib.import_module("option_tables")
    written = option_tables.PAGE.read_text(encoding="utf-8")
    assert written == option_tables.page(), "options have changed: run `python tools/option_tables.py`"
    commands = re.findall(r"(?m)^\| `(\w+)` \|", written.split("## `percute new`")[0])
    assert len(commands) > 10
    for command in commands:
        part = written.split(f"<!-- percute {command} --help -->")[1].split("<!-- end -->")[0]
        options = {name for name in re.findall(r"(?<![\w-])--[a-z-]+", option_tables.printed([command])) if name != "--help"}
        assert not [name for name in options if name not in part], command
