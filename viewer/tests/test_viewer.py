"""The page in a browser: what it draws, and what its controls do."""

import re
import time

import numpy
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from browser import SOURCES, named
from conftest import COLOURS_OF_BODIES as BODIES

AIR = "#fbfbf9"


def place(recording, name: str, sample: int) -> numpy.ndarray:
    """Position of a body, off the line that shows how it turns."""
    names = recording.body_names()
    i = next(k for k, full in enumerate(names) if f"'{name}'" in full)
    x, y, angle = recording.positions[sample, i]
    return numpy.array([x - 0.03 * numpy.cos(angle), y - 0.03 * numpy.sin(angle)])


def body_colour(recording, name: str) -> str:
    names = recording.body_names()
    return BODIES[next(k for k, full in enumerate(names) if f"'{name}'" in full) % len(BODIES)]


# Off the middle of the dumbbell there is a disc.
OFFSETS = {"dumbbell": 0.2}


def test_bodies_are_where_the_recording_has_them(show):
    page = show("everything")
    recording = page.recording
    for sample in (0, 40, 100):
        page.seek(recording.times[sample])
        picture = page.picture()
        for name in ("ball", "bar", "brick", "tumbler"):
            assert page.colour(*place(recording, name, sample), picture) == body_colour(recording, name), (
                name,
                sample,
            )
        names = recording.body_names()
        x, y, angle = recording.positions[sample, names.index("rigid body 'dumbbell'")]
        for side in (-0.2, 0.2):
            disc = (
                x + side * numpy.cos(angle) - 0.05 * numpy.cos(angle),
                y + side * numpy.sin(angle) - 0.05 * numpy.sin(angle),
            )
            assert page.colour(*disc, picture) == body_colour(recording, "dumbbell")
        assert page.colour(x, y, picture) == AIR  # between its discs


GROUND_SPOTS = {
    "half-plane": (0.6, -1.3),
    "terrain": (-2.6, -0.7),
    "wall": (2.2, -0.7),
    "block": (0.0, -1.1),
    "drum": (-2.3 + 0.51 * numpy.cos(0.2), 0.9 + 0.51 * numpy.sin(0.2)),
}


@pytest.mark.parametrize("shape", GROUND_SPOTS)
def test_ground_is_drawn(show, shape):
    assert show("everything").colour(*GROUND_SPOTS[shape]) == named("GROUND")


def test_air_is_empty(show):
    page = show("everything")
    picture = page.picture()
    for spot in ((-2.3, 1.1), (0.0, 0.9), (0.6, -1.0), (-2.9, -0.2)):
        assert page.colour(*spot, picture) == AIR


def test_moved_ground_moves(show):
    page = show("everything")
    recording = page.recording
    sample = int(numpy.argmax(recording.ground[:, 0, 0]))
    shift = recording.ground[sample, 0, 0]
    assert shift > 0.14
    page.seek(0.0)
    assert page.colour(0.93, -0.55) == named("GROUND")
    page.seek(recording.times[sample])
    assert page.colour(0.93, -0.55) == AIR
    assert page.colour(1.5 + shift - 0.03, -0.55) == named("GROUND")


def test_springs_and_rods_join_their_ends(show):
    page = show("everything")
    recording = page.recording
    names = recording.body_names()
    for sample in (0, 60):
        page.seek(recording.times[sample])
        picture = page.picture()
        bob = recording.positions[sample, names.index("particle 'bob'"), :2]
        fixed = numpy.array([0.5, 1.8])
        for part in (0.08, 0.5, 0.92):
            assert named("LINK") in page.near(*(fixed + part * (bob - fixed)), 8, picture), (sample, part)
        slider = recording.positions[sample, names.index("rigid body 'slider'"), :2]
        end = recording.positions[sample, names.index("particle 'link'"), :2]
        for part in (0.5, 0.8):
            assert named("ROD") in page.near(*(slider + part * (end - slider)), 2, picture)


def test_the_slider_moves_the_bodies(show):
    page = show("everything")
    recording = page.recording
    first, last = place(recording, "ball", 0), place(recording, "ball", -1)
    colour = body_colour(recording, "ball")
    assert page.colour(*first) == colour
    page.element("time").send_keys(Keys.END)
    assert page.time() == recording.times[-1]
    picture = page.picture()
    assert page.colour(*first, picture) != colour
    assert page.colour(*last, picture) == colour
    page.element("time").send_keys(Keys.HOME)
    assert page.time() == 0.0
    assert page.colour(*first) == colour


def test_places_between_samples_are_on_the_way(show):
    page = show("ball")
    page.seek(0.29)
    (_, before), (_, after) = page.recording.positions[14, 0, :2], page.recording.positions[15, 0, :2]
    shown = page.script("return caromPage.scene.poses.y(1)")
    # Rounded to 24 bits, and times to 53.
    assert shown == pytest.approx(0.5 * (before + after), abs=1e-6)


def test_events_are_listed_and_jumped_to(show):
    page = show("ball")
    events = page.recording.events
    rows = page.driver.find_elements(By.CSS_SELECTOR, "[data-event]")
    for number in (0, 4):
        row = next(row for row in rows if row.get_attribute("data-event") == str(number))
        assert row.text.startswith(f"{events['time'][number]:.5f} s\nimpact")
        assert "particle 'ball' on half-plane 'floor'" in row.text
        row.click()
        page.settle()
        assert page.time() == events["time"][number]
        marked = page.driver.find_elements(By.CSS_SELECTOR, ".event.current")
        assert [each.get_attribute("data-event") for each in marked] == [str(number)]
    # The ball is on the floor at an impact, as far as between samples straight lines say.
    assert page.script("return caromPage.scene.poses.y(1)") < 0.05
    page.element("events").send_keys(Keys.ARROW_DOWN)
    assert page.time() == events["time"][5]


def test_a_long_list_has_few_rows(show):
    page = show("pile")
    count = len(page.recording.events)
    assert count > 60
    assert len(page.driver.find_elements(By.CSS_SELECTOR, "[data-event]")) < 40
    page.script("caromPage.events.go(arguments[0])", count - 1)
    page.settle()
    last = page.driver.find_element(By.CSS_SELECTOR, ".event.current")
    assert last.get_attribute("data-event") == str(count - 1) and last.is_displayed()
    assert page.time() == max(page.recording.events["time"])


def test_play_and_pause(show):
    page = show("everything")
    speed = float(page.script("return caromPage.player.speed"))
    begin = time.monotonic()
    page.element("play").click()
    while page.time() < 0.3 * speed and time.monotonic() < begin + 30.0:
        page.settle()
    page.element("play").click()
    stopped = page.time()
    # No faster than the clock, but for the picture in which it began, of which 0.25 s count at most.
    assert 0.3 * speed <= stopped <= speed * (time.monotonic() - begin + 0.25)
    page.driver.execute_async_script("setTimeout(arguments[0], 200)")
    assert page.time() == stopped


def test_steps_go_from_sample_to_sample(show):
    page = show("everything")
    times = page.recording.times
    page.element("next").click()
    page.element("next").click()
    assert page.time() == times[2]
    page.element("back").click()
    assert page.time() == times[1]
    page.seek(0.5 * (times[3] + times[4]))
    page.element("back").click()
    assert page.time() == times[3]


def test_a_followed_body_stays_in_the_middle(show):
    page = show("everything")
    field = page.element("followed")
    field.send_keys("rigid body 'ball'", Keys.ENTER)
    for sample in (0, 50, 150):
        page.seek(page.recording.times[sample])
        column, row = page.pixel(*page.recording.positions[sample, 0, :2])
        box = page.element("scene").rect
        assert abs(column - box["x"] - box["width"] / 2) <= 1 and abs(row - box["y"] - box["height"] / 2) <= 1
    page.element("fit").click()
    assert field.get_attribute("value") == ""


def test_a_body_is_followed_by_its_own_name(show):
    page = show("everything")
    field = page.element("followed")
    field.send_keys("ball", Keys.ENTER)
    assert field.get_attribute("value") == "rigid body 'ball'"
    assert page.script("return caromPage.camera.follows()[0]") == pytest.approx(1.2, abs=1e-6)
    field.clear()
    field.send_keys("bal", Keys.ENTER)
    assert field.get_attribute("value") == "bal"  # and not without a word
    assert field.get_property("validationMessage") == "there is no body of this name"
    assert page.script("return caromPage.camera.follows()") is None
    page.element("fit").click()
    assert field.get_property("validationMessage") == ""


def test_the_pointer_shows_names(show):
    page = show("everything")
    page.point_at(*place(page.recording, "brick", 0))
    label = page.element("label")
    assert label.text.startswith("rigid body 'brick'\nat 0 m, 0 m, 0.2 rad")
    assert page.colour(*place(page.recording, "brick", 0) + [0.0, 0.05]) == named("PICKED")
    page.point_at(0.0, -1.1)
    assert label.text == "block"
    page.point_at(0.0, 0.9)
    assert not label.is_displayed()


def test_the_ledger_moves_with_time(show):
    page = show("ball")
    recording = page.recording
    canvas = page.element("ledger")
    ActionChains(page.driver).move_to_element(canvas).click().perform()
    width = canvas.rect["width"]
    expected = 2.0 * (0.5 * width - 62.0) / (width - 76.0)
    assert page.time() == pytest.approx(expected, abs=2.0 * 2.0 / width)  # of two pixels
    sample = int(numpy.searchsorted(recording.times, page.time(), side="right")) - 1
    page.element("change").click()  # energies themselves
    page.settle()
    values = dict(row.text.split("\n") for row in page.element("legend").find_elements(By.TAG_NAME, "button"))
    for term in ("total", "kinetic", "gravity"):
        value = float(values[term].removesuffix(" J"))
        assert value == pytest.approx(recording.ledger[term][sample], rel=1e-3, abs=1e-3), term
    row, column = round(canvas.rect["y"] + 0.5 * canvas.rect["height"]), round(canvas.rect["x"] + 0.5 * width)
    line = page.picture()[row - 30 : row + 30, column - 3 : column + 4]
    assert (line.sum(axis=2) < 200).any(axis=1).mean() > 0.9  # the line of the present, from top to bottom


def test_nothing_is_loaded_from_elsewhere(show, tmp_path):
    page = show("ball")
    assert page.script("return performance.getEntriesByType('resource').length") == 0
    text = page.driver.page_source
    assert not re.search(r"<(?:script|img|iframe)[^>]* src=|<link|@import|url\(", text)


def test_a_notebook_shows_it_inline(browser, recordings, tmp_path):
    view = recordings["ball"].view()
    path = tmp_path / "notebook.html"
    path.write_text(
        f"<!doctype html><title>notebook</title><body>{view._repr_html_()}</body>", encoding="utf-8"
    )
    browser.get(path.as_uri())
    browser.switch_to.frame(browser.find_element(By.TAG_NAME, "iframe"))
    try:
        assert browser.execute_script("return caromPage.recording.times.length") == len(recordings["ball"])
        assert browser.find_element(By.ID, "title").text == "Recording"
    finally:
        browser.switch_to.default_content()


def test_names_cannot_end_the_page(browser, tmp_path):
    from carom import Recorder, Simulation, System, TimeStepping, write_view
    from carom.planar import Particle

    system = System()
    system.add(Particle(mass=1.0), name="</script><script>window.broken = 1</script>")
    simulation = Simulation(system, TimeStepping())
    with Recorder(simulation) as recorder:
        simulation.run_until(0.1)
    write_view(recorder.recording(), tmp_path / "run.html", title="<b>bold</b> /*ARRAYS*/")
    browser.get((tmp_path / "run.html").as_uri())
    assert browser.execute_script("return window.broken") is None
    assert browser.find_element(By.ID, "title").text == "<b>bold</b> /*ARRAYS*/"
    assert "</script>" in browser.execute_script("return caromPage.recording.bodies[0]")


def test_the_program_of_the_page_runs(browser, tmp_path, monkeypatch):
    text = (SOURCES.parents[1] / "docs" / "viewer.md").read_text()
    program = re.search(r"```python\n(.*?)```", text, re.DOTALL).group(1)
    monkeypatch.chdir(tmp_path)
    exec(compile(program, "viewer.md", "exec"), {})
    browser.get((tmp_path / "run.html").as_uri())
    assert browser.execute_script("return caromPage.recording.bodies") == ["rigid body 'ball'"]


def test_lines_around_long_polygons_are_as_wide_at_their_ends(show):
    page = show("everything")
    page.seek(0.0)
    picture = page.picture()
    # Along the lower edge of the block that shakes, from 0.9 m to 1.5 m, which is six times as long as high.
    columns = [page.pixel(x, -0.6) for x in (0.925, 1.0, 1.2, 1.475)]
    lines = [picture[row - 4 : row + 5, column].tolist() for column, row in columns]
    assert all(line == lines[2] for line in lines)
    assert min(min(pixel) for pixel in lines[2]) < 140  # there is one
