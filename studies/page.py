"""Sections of text, tables and figures, and the folder they are written to."""

from __future__ import annotations

import base64
import csv
import html
import io
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from percute import __version__

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

Cell = str | float | int | None
TITLE = "Accuracy of the estimate"
INTRODUCTION = (
    "percute estimates the error of impact simulations by the constitutive relation error of Louf, Gallimard and Pelle. "
    "This page shows how close the estimate is to the true error, and where it is not. All numbers and figures come from the "
    "program that wrote the page; published values are given with them and are marked. Numbers in brackets, like [15], are "
    "equations of the paper. Units are SI. Energies of plane bodies are those of 1 m of thickness, so that errors are "
    "in J^½. Long tables are in CSV files, which `python -m studies` writes beside the page."
)
MOST_ROWS = 1000
"""Longer tables are in their files only."""
NOTHING = "–"
NOT_DRAWN = "(not drawn)"
"""Where the figures of a study are still to be drawn."""


def short(value: float, digits: int) -> str:
    """Give a number with so many significant digits, in the exponential form where that is shorter."""
    if value == 0.0 or not math.isfinite(value):
        return "0" if value == 0.0 else str(value)
    mantissa, exponent = f"{value:.{max(digits - 1, 0)}e}".split("e")
    power = int(exponent)
    if -3 <= power < digits + 2:
        return f"{value:.{max(digits - 1 - power, 0)}f}"
    return f"{mantissa}e{power}"


def interval(low: float, high: float) -> str:
    """Give a range of numbers with three significant digits."""
    return "–".join(dict.fromkeys(short(end, 3) for end in (low, high)))


def percent(fraction: float) -> str:
    """Give a fraction in per cent."""
    return f"{short(100.0 * fraction, 3)} %"


@dataclass(frozen=True)
class Column:
    """A column of a table."""

    name: str
    unit: str = ""
    equation: str = ""
    """Its equation in the paper, such as ``[15]``."""
    digits: int = 4
    """Significant digits on the page; files hold all."""

    @property
    def heading(self) -> str:
        """Name and unit."""
        return f"{self.name} ({self.unit})" if self.unit else self.name


@dataclass
class Table:
    """A table. Its files hold all digits, the page as many as its columns state."""

    key: str
    """The name of its file without folder and ending."""
    caption: str
    columns: Sequence[Column]
    rows: list[list[Cell]] = field(default_factory=list)
    on_page: bool | dict[str, Cell] = True
    """Whether its rows are on the page, or which ones: those with these cells. For the others the page names the CSV file."""

    def add(self, *cells: Cell) -> None:
        """Add a row; missing cells at its end are empty, as are numbers that are not finite."""
        row = [None if isinstance(cell, float) and not math.isfinite(cell) else cell for cell in cells]
        row = [cell if cell is None or isinstance(cell, str | int) else float(cell) for cell in row]
        self.rows.append(row + [None] * (len(self.columns) - len(row)))

    def where(self, column: str, equal: Mapping[str, Cell] | None = None) -> list[Any]:
        """Give the cells of a column in the rows whose other columns have these values; NaN where a cell is empty."""
        at = {each.name: i for i, each in enumerate(self.columns)}
        wanted = [(at[name], cell) for name, cell in (equal or {}).items()]
        cells = [row[at[column]] for row in self.rows if all(row[i] == cell for i, cell in wanted)]
        return [math.nan if cell is None else cell for cell in cells]

    def shown(self) -> Iterator[list[str]]:
        """Give the rows as the page shows them."""
        for row in self.rows:
            yield [_shown(cell, column) for cell, column in zip(row, self.columns, strict=True)]

    def csv(self) -> str:
        """Give the table as CSV; the first line has names and units."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow([column.heading for column in self.columns])
        writer.writerows(["" if cell is None else cell for cell in row] for row in self.rows)
        return text.getvalue()

    def json(self) -> dict[str, Any]:
        """Give the table as a JSON object."""
        columns = [{"name": c.name, "unit": c.unit, "equation": c.equation} for c in self.columns]
        return {"caption": self.caption, "columns": columns, "rows": self.rows}


@dataclass
class Figure:
    """A figure of matplotlib with its caption."""

    key: str
    """The name of its files without folder and ending."""
    caption: str
    drawing: Drawing


@dataclass
class Section:
    """What a study shows, in the order in which it is read. Text that starts with ``###`` is a heading."""

    key: str
    title: str
    items: list[str | Table | Figure] = field(default_factory=list)

    def add(self, *items: str | Table | Figure) -> None:
        """Add text, tables and figures."""
        self.items += items

    @property
    def tables(self) -> list[Table]:
        """Its tables."""
        return [item for item in self.items if isinstance(item, Table)]

    @property
    def figures(self) -> list[Figure]:
        """Its figures."""
        return [item for item in self.items if isinstance(item, Figure)]


def _shown(cell: Cell, column: Column) -> str:
    if cell is None:
        return NOTHING
    return short(cell, column.digits).replace("-", "−") if isinstance(cell, float) else str(cell)


def _rich(text: str) -> str:
    """Give text as HTML, with what stands between backticks as code."""
    pieces = [html.escape(piece) for piece in text.split("`")]
    return "".join(f"<code>{piece}</code>" if i % 2 else piece for i, piece in enumerate(pieces))


class _Html:
    """Items as HTML."""

    def text(self, text: str) -> str:
        return f"<h3>{_rich(text[4:])}</h3>" if text.startswith("### ") else f"<p>{_rich(text)}</p>"

    def figure(self, figure: Figure, number: int, svg: str | None) -> str:
        data = base64.b64encode((svg or "").encode()).decode()
        image = f'<img alt="{html.escape(figure.caption)}" src="data:image/svg+xml;base64,{data}">' if svg else NOT_DRAWN
        return (
            f'<figure id="{figure.key}">\n{image}\n<figcaption><b>Figure {number}.</b> {_rich(figure.caption)} '
            f'<span class="file">figures/{figure.key}.svg, .png</span></figcaption>\n</figure>'
        )

    def table(self, table: Table, number: int) -> str:
        name, rows = f"tables/{table.key}.csv", len(table.rows)
        link = f'<a class="file" href="{name}">{name}</a>'
        caption = f"<b>Table {number}.</b> {_rich(table.caption)} {link}"
        if not table.on_page and rows > MOST_ROWS:
            return f"<p>{caption} ({rows} rows)</p>"
        head = "".join(
            f"<th>{html.escape(c.name)}<small>{html.escape(' '.join(filter(None, (c.unit, c.equation))))}</small></th>" for c in table.columns
        )
        body = "\n".join(
            "<tr>" + "".join(f'<td{"" if isinstance(cell, str) else " class=n"}>{_rich(text)}</td>' for cell, text in zip(row, shown, strict=True)) + "</tr>"
            for row, shown in zip(table.rows, table.shown(), strict=True)
        )
        whole = f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"
        if not table.on_page:
            return f"<details><summary>{caption} ({rows} rows)</summary>\n{whole}\n</details>"
        return f'<figure class="table">\n<figcaption>{caption}</figcaption>\n<div class="wide">{whole}</div>\n</figure>'


class _Markdown:
    """Items as Markdown, for ``docs/verification.md``."""

    def text(self, text: str) -> str:
        return text

    def figure(self, figure: Figure, number: int, svg: str | None) -> str:
        image = f"![Figure {number}](figures/{figure.key}.png)" if svg else NOT_DRAWN
        return f"{image}\n**Figure {number}.** {figure.caption}"

    def table(self, table: Table, number: int) -> str:
        if not table.on_page:
            return f"**Table {number}.** {table.caption} (`tables/{table.key}.csv`, {len(table.rows)} rows)"
        head = [" ".join(filter(None, (column.heading, column.equation))) for column in table.columns]
        names = [column.name for column in table.columns]
        picked = [(names.index(name), cell) for name, cell in table.on_page.items()] if isinstance(table.on_page, dict) else []
        shown = [text for row, text in zip(table.rows, table.shown(), strict=True) if all(row[i] == cell for i, cell in picked)]
        rows = [head, ["---"] * len(head), *([text.replace("|", "\\|") for text in row] for row in shown)]
        lines = (f"| {' | '.join(row)} |" for row in rows)
        others = f" ({len(table.rows)} rows in `tables/{table.key}.csv`)" if picked else ""
        return f"**Table {number}.** {table.caption}{others}\n\n" + "\n".join(lines)


def _items(sections: Iterable[Section], form: _Html | _Markdown, svg: dict[str, str]) -> Iterator[tuple[Section, list[str], list[str]]]:
    """Give each section with its items as text, and its tables that are left to files; figures and tables are numbered."""
    tables = drawings = 0
    for section in sections:
        pieces: list[str] = []
        left: list[str] = []
        for item in section.items:
            if isinstance(item, Table):
                tables += 1
                (pieces if item.on_page else left).append(form.table(item, tables))
            elif isinstance(item, Figure):
                drawings += 1
                pieces.append(form.figure(item, drawings, svg.get(item.key)))
            else:
                pieces.append(form.text(item))
        yield section, pieces, left


def _html(sections: Sequence[Section], origin: str, svg: dict[str, str]) -> str:
    style = Path(__file__).with_name("style.css").read_text(encoding="utf-8")
    contents = "\n".join(f'<li><a href="#study-{section.key}">{html.escape(section.title)}</a></li>' for section in sections)
    body = "\n".join(
        f'<section id="study-{section.key}">\n<h2>{html.escape(section.title)}</h2>\n' + "\n".join(pieces + left) + "\n</section>"
        for section, pieces, left in _items(sections, _Html(), svg)
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width, '
        f'initial-scale=1">\n<meta name="color-scheme" content="light dark">\n<title>{TITLE}</title>\n<style>\n{style}</style>\n</head>\n'
        f'<body>\n<header>\n<h1>{TITLE}</h1>\n<p>{_rich(INTRODUCTION)}</p>\n<p class="origin">{_rich(origin)}</p>\n</header>\n'
        f"<nav>\n<h2>Contents</h2>\n<ol>\n{contents}\n</ol>\n</nav>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _markdown(sections: Sequence[Section], origin: str, svg: dict[str, str]) -> str:
    pieces = [f"# {TITLE}", INTRODUCTION, origin]
    for section, own, left in _items(sections, _Markdown(), svg):
        pieces += [f"## {section.title}", *own, *([" ".join(left)] if left else [])]
    return "\n\n".join(pieces) + "\n"


def _replace(file: Path, text: str) -> None:
    """Write a file under another name first, so that an interrupt leaves the old one whole."""
    part = file.with_name(file.name + ".part")
    try:
        part.write_text(text, encoding="utf-8")
        part.replace(file)
    finally:
        part.unlink(missing_ok=True)


def write(folder: Path, sections: Sequence[Section], resolution: str, missing: Sequence[str], svg: dict[str, str]) -> None:
    """Write the tables of the last section and the pages of all; ``svg`` has the drawn figures by their keys."""
    origin = f"Written by `python -m studies{' --small' if resolution == 'small' else ''}` of percute {__version__}."
    if missing:
        origin += f" Not on this page: {', '.join(missing)}."
    if sections[-1].tables:
        (folder / "tables").mkdir(exist_ok=True)
    for table in sections[-1].tables:
        _replace(folder / "tables" / f"{table.key}.csv", table.csv())
    studies = {s.key: {"title": s.title, "tables": {table.key: table.json() for table in s.tables}} for s in sections}
    numbers = {"percute": __version__, "resolution": resolution, "studies": studies}
    _replace(folder / "numbers.json", json.dumps(numbers, ensure_ascii=False, indent=1) + "\n")
    _replace(folder / "verification.md", _markdown(sections, origin, svg))
    _replace(folder / "index.html", _html(sections, origin, svg))
