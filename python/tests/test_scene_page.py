"""docs/scenes.md: its files are scenes, its commands print what it shows, its program runs.

REWRITE_PAGE=1 in the environment writes into the page what the commands print.
"""

import math
import os
import re
import shlex

import pytest

import carom
from carom import scene
from carom.command import main
from conftest import PYTHON

PAGE = PYTHON.parent / "docs" / "scenes.md"
BLOCK = re.compile(r"```(json|console|python)\n(.*?)```", re.DOTALL)


def blocks(language):
    return [match.group(2) for match in BLOCK.finditer(PAGE.read_text()) if match.group(1) == language]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the files of the page, each named by the text before it."""
    names = re.findall(r"`(\w+\.json)`[^`]*```json", PAGE.read_text())
    assert len(names) == len(blocks("json")) == 2
    for name, text in zip(names, blocks("json")):
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def alike(said, shown):
    """True of the same words, and of numbers that differ by 1e-6 of them, or by less than the tolerance of the
    event-driven run, 1e-10, leaves of energies of 10 J.
    """
    words, others = said.split(), shown.split()
    if len(words) != len(others):
        return False
    for one, other in zip(words, others):
        try:
            close = math.isclose(float(one), float(other), rel_tol=1e-6, abs_tol=1e-9)
        except ValueError:
            close = one == other
        if not close:
            return False
    return True


def played(block, capsys):
    """A block of commands with what they print."""
    made = ""
    for line in block.splitlines():
        if line.startswith("$ carom "):
            main(shlex.split(line)[2:])
            output = capsys.readouterr()
            made += f"{line}\n{output.out}{output.err}"
    return made


def test_commands_print_what_the_page_shows(folder, capsys):
    found = [(block, played(block, capsys)) for block in blocks("console")]
    if os.environ.get("REWRITE_PAGE"):
        text = PAGE.read_text()
        for block, now in found:
            text = text.replace(block, now)
        PAGE.write_text(text)
        pytest.fail("the page was written; read it")
    for block, now in found:
        assert alike(now, block), now


def test_program_of_the_page_runs(folder):
    (program,) = blocks("python")
    names = {}
    exec(compile(program, "docs/scenes.md", "exec"), names)
    assert names["simulation"].time() == 2.0
    copy = carom.load_scene("copy.json")
    assert scene.to_text(copy) == scene.to_text(names["scene"])


def test_keys_of_the_form_are_in_the_page():
    table = PAGE.read_text().split("## The form")[1].split("## In Python")[0]
    for key in scene.schema()["properties"]:
        assert f"`{key}`" in table
