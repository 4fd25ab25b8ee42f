"""The programs of docs/python.md, in one session, print what the page says."""

import pages


def test_programs_of_the_page() -> None:
    names: dict[str, object] = {}
    printed, compared = "", 0
    for language, text in pages.blocks("python.md"):
        if language == "python":
            printed = pages.run(text, names)
        elif language == "text":
            assert pages.same(text, printed), printed
            compared += 1
    assert compared >= 4
