"""The programs of pages, each page in one session, print what the page says."""

import pages
import pytest


@pytest.mark.parametrize(("page", "least"), [("python.md", 4), ("ensembles.md", 3)])
def test_programs_of_the_page(page: str, least: int) -> None:
    if page == "ensembles.md":
        pytest.importorskip("scipy")
    names: dict[str, object] = {}
    printed, compared = "", 0
    for language, text in pages.blocks(page):
        if language == "python":
            printed = pages.run(text, names)
        elif language == "text":
            assert pages.same(text, printed), printed
            compared += 1
    assert compared >= least
