"""Writes the options of all commands into docs/commands.md, from their `--help`: `python tools/option_tables.py` after a change of them."""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "commands.md"
PART = re.compile(r"(<!-- percute(.*?) --help -->\n).*?(<!-- end -->)", re.DOTALL)


def page() -> str:
    """Give the page with the options of the installed program."""
    return PART.sub(lambda part: f"{part[1]}\n{tables(printed(part[2].split()))}\n{part[3]}", PAGE.read_text(encoding="utf-8"))


def printed(command: list[str]) -> str:
    """Give the help of a command, in lines that are as long as they need."""
    environment = os.environ | {"COLUMNS": "1000"}
    done = subprocess.run(
        [sys.executable, "-m", "percute", *command, "--help"], cwd=ROOT, env=environment, check=True, capture_output=True, encoding="utf-8"
    )
    return done.stdout


def tables(text: str) -> str:
    """Give the usage, and a table of each list of arguments, options or commands."""
    usage = re.search(r"(?mi)^usage: (.*)", text)
    assert usage is not None, text
    found = [f"    {usage[1]}\n"]
    for title, lines in re.findall(r"(?m)^([\w ]+):\n((?: .*\n|\n(?= ))+)", text):
        rows = [f"| {cell(name)} | {meaning_of(meaning)} |\n" for name, meaning in entries(lines) if "--help" not in name and name != "help"]
        if rows:
            found.append(f"| {title.lower()} | |\n|---|---|\n" + "".join(rows))
    return "\n".join(found)


def entries(lines: str) -> list[tuple[str, str]]:
    """Give names and meanings; a meaning may go on in further lines."""
    found: list[tuple[str, str]] = []
    for line in filter(str.strip, lines.splitlines()):
        indent = len(line) - len(line.lstrip())
        name, _, meaning = re.sub(r" {2,}", "\t", line.strip()).partition("\t")
        if indent <= 6:
            found.append((name, meaning))
        else:
            found[-1] = (found[-1][0], f"{found[-1][1]} {' '.join(line.split())}".strip())
    return found


def cell(name: str) -> str:
    """Quote the names of an option; Python before 3.13 repeats its value behind each."""
    names = name.split(", ")
    value = names[-1].partition(" ")[2]
    short = [each.removesuffix(f" {value}") if value else each for each in names[:-1]]
    return ", ".join(f"`{escaped(each)}`" for each in [*short, names[-1]])


def meaning_of(text: str) -> str:
    """Give a meaning in Markdown: names of options are code, and so is what was."""
    text = re.sub(r" - (\w+): ", r"; `\1`: ", text.replace(" Possible values:", ":")).replace(":;", ":")
    pieces = text.split("`")
    pieces[::2] = [re.sub(r"(?<![\w-])(--[a-z-]+)", r"`\1`", piece) for piece in pieces[::2]]
    return escaped("`".join(pieces))


def escaped(text: str) -> str:
    """Keep a bar from ending the cell of a table."""
    return text.replace("|", r"\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
