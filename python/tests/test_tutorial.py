"""docs/tutorial.md: each program in C++ has its twin in Python, which prints what the page says."""

import re

import pages
import pytest

BLOCKS = pages.blocks("tutorial.md")


def texts(language: str) -> list[str]:
    return [text for kind, text in BLOCKS if kind == language]


def test_each_program_has_its_twin_below() -> None:
    assert [kind for kind, _ in BLOCKS[:1]] == ["python"]  # what all begin with
    pairs = [kind for kind, _ in BLOCKS[1:] if kind != "text"]
    assert pairs == ["cpp", "python"] * 8
    for cpp, twin in zip(texts("cpp"), texts("python")[1:]):
        functions = re.findall(r"^[A-Za-z]\w* (\w+)\(.*\) \{$", cpp, re.MULTILINE)
        assert functions and functions == re.findall(r"^def (\w+)\(", twin, re.MULTILINE)


def test_twins_print_what_the_page_says(tmp_path) -> None:
    names: dict[str, object] = {}
    printed, compared = "", 0
    for language, text in BLOCKS:
        if language == "python":
            printed = pages.run(text, names).replace("slip_negative", "slip-")
        elif language == "text":
            assert pages.prints(text, printed.rstrip("\n")), printed
            compared += 1
    assert compared == 7
    assert names["record_and_go_on"](str(tmp_path)) is True
    assert (tmp_path / "run.csv").read_text().startswith("time [s],")


@pytest.mark.parametrize("printed", ["a 1.5\nc 2", "a 1.23\nb\nd", "a 1.23\nb\nc 2\nd"])
def test_a_page_that_says_something_else_is_found(printed: str) -> None:
    assert pages.prints("a 1.23\n...\nc 2", "a 1.23\nb\nc 2")
    assert not pages.prints("a 1.23\n...\nc 2", printed)
