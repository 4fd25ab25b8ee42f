"""docs/gallery.md: all examples, with their pictures, programs in both languages, and views that the script makes."""

import importlib.util
import re
from importlib import resources

import pytest
from conftest import PYTHON

ROOT = PYTHON.parent
SECTIONS = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8").split("\n## ")[1:]
SCENES = {path.stem for path in (PYTHON / "scenes").glob("*.json")}


def test_every_example_is_shown():
    names = [path.stem for path in sorted((ROOT / "examples").glob("*.cpp"))]
    assert len(names) == len(SECTIONS) == 12
    for name, section in zip(names, SECTIONS):
        (picture,) = re.findall(r"^!\[[^\]]{20,}\]\((figures/\w+\.png)\)$", section, re.MULTILINE)
        assert (ROOT / "docs" / picture).is_file()
        assert f"[C++](../examples/{name}.cpp) · [Python](../python/examples/{name}.py) ·" in section
        assert (PYTHON / "examples" / f"{name}.py").is_file()


def test_every_view_is_of_a_scene():
    views = [view for section in SECTIONS for view in re.findall(r"\(\.\./build/gallery/(\w+)\.html\)", section)]
    assert sorted(views) == sorted(SCENES - {"bouncing_ball"})  # that is of the tutorial


def test_the_script_makes_a_view(tmp_path, capsys):
    viewer = pytest.importorskip("carom.viewer")
    if not (resources.files("carom") / viewer.PAGE).is_file():
        pytest.skip("the page of the viewer was not built (scripts/viewer.sh --build)")
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "scripts" / "gallery.py")
    gallery = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(gallery)
    gallery.main(tmp_path / "views", ["pendulum_and_wall"])
    assert "pendulum_and_wall.html: 0." in capsys.readouterr().out
    text = (tmp_path / "views" / "pendulum_and_wall.html").read_text(encoding="utf-8")
    assert '"title":"pendulum and wall"' in text
