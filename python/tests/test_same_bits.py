"""The same bits in both languages: examples and reference problems from Python against their C++ programs.

Wants the build directory of the library in CAROM_BUILD (scripts/python.sh gives it).
"""

import os
import pathlib
import subprocess
import sys

import pytest

import reference_runs

EXAMPLES = pathlib.Path(__file__).parents[1] / "examples"
IN_BOTH = sorted(path.stem for path in (EXAMPLES.parents[1] / "examples").glob("[0-9]*.cpp"))
BUILD = os.environ.get("CAROM_BUILD")

pytestmark = pytest.mark.skipif(
    not BUILD, reason="CAROM_BUILD does not name a build directory of the library"
)


def program(name: str) -> str:
    assert BUILD is not None
    return str(pathlib.Path(BUILD) / name)


@pytest.mark.parametrize("example", IN_BOTH)
def test_example_writes_the_same_files(example: str, tmp_path: pathlib.Path) -> None:
    folders = [tmp_path / language for language in ("cpp", "python")]
    commands = [[program(f"examples/{example}")], [sys.executable, str(EXAMPLES / f"{example}.py")]]
    for command, folder in zip(commands, folders):
        folder.mkdir()
        subprocess.run([*command, str(folder)], check=True, stdout=subprocess.DEVNULL, timeout=300)
    files = [sorted(path.name for path in folder.iterdir()) for folder in folders]
    assert files[0] and files[1] == files[0]
    for name in files[0]:
        first, second = ((folder / name).read_text(encoding="utf-8").splitlines() for folder in folders)
        assert len(first) > 1 and first == second, name


def test_every_cpp_example_is_there() -> None:
    assert len(IN_BOTH) >= 12
    assert set(IN_BOTH) <= {path.stem for path in EXAMPLES.glob("[0-9]*.py")}


def test_reference_problems_have_the_same_bits() -> None:
    ran = subprocess.run(
        [program("tests/reference_runs")], check=True, capture_output=True, text=True, timeout=300
    )
    expected = {}
    for line in ran.stdout.splitlines():
        name, *words = line.split()
        expected[name] = [float.fromhex(word).hex() for word in words]
    found = {name: [number.hex() for number in numbers] for name, numbers in reference_runs.all_runs()}
    assert list(found) == list(expected) and len(found) > 100
    assert {name for name in found if found[name] != expected[name]} == set()
