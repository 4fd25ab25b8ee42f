"""What stands beside the scene: keys, filters, sheets of a small screen, colours of words, files to save."""

import base64
import json
import re

import numpy
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from browser import SIZE, SOURCES, named

PHONE = (390, 844)


@pytest.fixture
def phone(browser):
    """A screen of 390 pixels."""
    metrics = {"deviceScaleFactor": 1, "mobile": False}
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride", {"width": PHONE[0], "height": PHONE[1], **metrics}
    )
    yield
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride", {"width": SIZE[0], "height": SIZE[1], **metrics}
    )


@pytest.fixture
def dark(browser):
    features = [{"name": "prefers-color-scheme", "value": "dark"}]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    yield
    browser.get("about:blank")  # the page loads itself anew where colours change
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def listed(page) -> list[int]:
    return page.script("return Array.from(caromPage.events.shown)")


def test_space_presses_what_has_the_focus(show):
    page = show("everything")
    box = page.element("contacts")
    box.send_keys(Keys.SPACE)
    assert not box.is_selected() and not page.script("return caromPage.player.isPlaying")
    page.element("next").send_keys(Keys.SPACE)
    assert page.time() == page.recording.times[1]
    assert not page.script("return caromPage.player.isPlaying")
    page.element("play").send_keys(Keys.SPACE)
    assert page.script("return caromPage.player.isPlaying")
    page.element("play").send_keys(Keys.SPACE)
    page.element("scene").send_keys(Keys.SPACE)
    assert page.script("return caromPage.player.isPlaying")
    page.element("scene").send_keys(Keys.SPACE)
    page.element("find").send_keys("a b")  # a space is a space there
    assert page.element("find").get_attribute("value") == "a b"
    assert not page.script("return caromPage.player.isPlaying")


def test_events_follow_the_time(show):
    page = show("pile")
    times = numpy.sort(page.recording.events["time"])
    for time in (0.5, 1.4, 0.2, 1.5):
        page.seek(time)
        current = page.driver.find_element(By.CSS_SELECTOR, ".event.current")
        expected = int(numpy.searchsorted(times, time, side="right")) - 1
        assert int(current.get_attribute("data-event")) == expected
        assert current.get_attribute("aria-selected") == "true"
        box, inside = page.element("events").rect, current.rect
        assert box["y"] <= inside["y"] + 1 and inside["y"] + inside["height"] <= box["y"] + box["height"] + 1


def test_events_are_filtered_by_kind_body_and_text(show):
    page = show("everything")
    events = page.recording.events[numpy.argsort(page.recording.events["time"], kind="stable")]
    names = [page.recording.names[event["name"]] for event in events]
    assert listed(page) == list(range(len(events)))
    body = page.element("of-body")
    body.send_keys("ball")
    expected = [i for i, name in enumerate(names) if "rigid body 'ball'" in name]
    assert 0 < len(expected) < len(names) and listed(page) == expected
    page.element("find").send_keys("HALF-PLANE")
    expected = [i for i in expected if "half-plane" in names[i].lower()]
    assert listed(page) == expected
    page.element("find").send_keys(" nothing has this")
    assert listed(page) == []
    assert page.element("events").text == "No event is of this kind, body and text."
    page.script("document.getElementById('find').value = ''")
    body.clear()
    body.send_keys("nobody")
    assert body.get_property("validationMessage") == "there is no body of this name"
    page.script("arguments[0].value = ''; arguments[0].dispatchEvent(new Event('input'))", body)
    assert listed(page) == list(range(len(events)))
    kinds = page.element("kind").find_elements(By.TAG_NAME, "option")
    assert [kind.text for kind in kinds] == ["all kinds", "impact"]
    kinds[1].click()
    assert listed(page) == list(range(len(events)))


def test_a_body_is_not_taken_for_one_with_a_longer_number(show):
    page = show("pile")
    names = [page.recording.names[i] for i in page.recording.events["name"]]
    assert any("rigid body #1 " in f"{name} " for name in names)
    page.element("of-body").send_keys("rigid body #1")
    page.settle()
    for i in listed(page):
        assert re.search(r"rigid body #1(?!\d)", page.script("return caromPage.recording.names[caromPage.recording.event_name[arguments[0]]]", i))


def test_a_word_has_one_colour(show):
    page = show("ball")
    words = page.script(
        "return Object.fromEntries([...document.querySelectorAll('#modes span')].map((each) => "
        "[each.textContent, getComputedStyle(each.firstChild).backgroundColor]))"
    )
    kinds = page.script("return caromPage.events.kinds")
    assert {kind.replace("_", " ") for kind in kinds} <= set(words)  # a legend of all kinds that there are
    assert len(set(words.values())) == len(words)
    rows = page.driver.find_elements(By.CSS_SELECTOR, "[data-event]")
    for row in rows:
        kind = row.find_element(By.CLASS_NAME, "kind").text
        dot = row.find_element(By.CLASS_NAME, "dot").value_of_css_property("background-color")
        assert words[kind].replace("rgb(", "").rstrip(")") in dot.replace("rgba(", ""), kind
    text = (SOURCES / "colours.js").read_text()
    colours = re.findall(r"\"(#\w{6})\"", re.search(r"WORDS = \{(.*?)\}", text, re.DOTALL).group(1))
    assert len(colours) == len(set(colours))


def test_energies_are_changes_since_the_start(show):
    page = show("ball")
    ledger = page.recording.ledger

    def values():
        page.settle()
        buttons = page.element("legend").find_elements(By.TAG_NAME, "button")
        return {row.text.split("\n")[0]: float(row.text.split("\n")[1].removesuffix(" J")) for row in buttons}

    page.seek(page.recording.times[-1])
    for term in ("total", "gravity"):
        change = ledger[term][-1] - ledger[term][0]
        assert values()[term] == pytest.approx(change, rel=1e-3, abs=1e-3)
    page.element("change").click()
    for term in ("total", "gravity"):
        assert values()[term] == pytest.approx(ledger[term][-1], rel=1e-3, abs=1e-3)


def test_arrows_are_scaled_and_switched_off(show):
    page = show("pile")
    page.seek(page.recording.times[-1])
    length = page.script("return caromPage.scene.uniforms.arrowScale.value")
    assert length > 0.0
    page.script(
        "const size = document.getElementById('arrow-size'); size.value = 0.5;"
        "size.dispatchEvent(new Event('input'))"
    )
    page.settle()
    scaled = page.script("return caromPage.scene.uniforms.arrowScale.value")
    assert scaled == pytest.approx(length * 10**0.5, rel=1e-6)
    page.element("arrows").click()
    page.settle()
    assert page.script("return caromPage.scene.uniforms.arrowScale.value") == 0
    assert not page.element("arrow").is_displayed()


def test_nothing_is_off_a_small_screen(show, phone):
    page = show("everything")
    off = page.script(
        """return [...document.querySelectorAll('button, input, select, canvas, label, output, h1, #key')]
        .filter((each) => each.checkVisibility()).map((each) => [each.id || each.textContent, each.getBoundingClientRect()])
        .filter(([, box]) => box.left < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5 || box.top < -0.5)
        .map(([name]) => name)"""
    )
    assert off == []
    assert page.script("return document.documentElement.scrollWidth") <= PHONE[0]
    assert page.element("scene").rect["height"] > 250
    sheets = page.driver.find_elements(By.CSS_SELECTOR, ".sheet")
    assert [sheet.text for sheet in sheets] == ["Events", "Energies"]
    for sheet, name in zip(sheets, ("event-sheet", "legend-sheet")):
        assert not page.element(name).is_displayed()
        page.script("arguments[0].click()", sheet)
        assert page.element(name).is_displayed() and sheet.get_attribute("aria-expanded") == "true"
        box = page.element(name).rect
        assert 0 <= box["x"] and box["x"] + box["width"] <= PHONE[0] and box["y"] + box["height"] <= PHONE[1] + 1
    assert not page.element("event-sheet").is_displayed()  # one at a time
    page.script("arguments[0].click()", sheets[1])
    assert not page.element("legend-sheet").is_displayed()


def test_two_fingers_scale_and_move(show):
    page = show("everything")
    scale, at = page.script(
        "const {camera} = caromPage; return [camera.scale, camera.sceneAt(500, 300)]"
    )
    box = page.element("scene").rect

    def touch(kind, points):
        page.driver.execute_cdp_cmd(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": [{"x": box["x"] + x, "y": box["y"] + y, "id": i} for i, (x, y) in enumerate(points)]},
        )

    page.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
    try:
        touch("touchStart", [(450, 300), (550, 300)])
        touch("touchMove", [(400, 320), (600, 320)])
        touch("touchEnd", [])
        page.settle()
    finally:
        page.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})
    now, there = page.script("const {camera} = caromPage; return [camera.scale, camera.pixelAt(...arguments[0])]", at)
    assert now == pytest.approx(2.0 * scale, rel=1e-3)
    assert there == pytest.approx([500, 320], abs=1.0)  # what was between the fingers


def test_dark_colours(show, dark):
    page = show("everything")
    picture = page.picture()
    assert picture[5, 5].max() < 80  # the header
    assert page.colour(0.0, 0.9, picture) == "#1a1e23"
    assert page.colour(0.6, -1.3, picture) == named("GROUND")


def test_names_for_readers(show):
    page = show("ball")
    nameless = page.script(
        """return [...document.querySelectorAll('button, input, select, canvas, [role]')].filter((each) =>
        !(each.getAttribute('aria-label') || each.getAttribute('aria-labelledby') || each.textContent.trim() ||
          each.closest('label')?.textContent.trim() || each.getAttribute('role') === 'status')).map((each) => each.outerHTML)"""
    )
    assert nameless == []
    assert page.element("scene").get_attribute("aria-label").startswith("ball: 1 body")
    assert page.element("events").get_attribute("role") == "listbox"
    assert all(row.get_attribute("role") == "option" for row in page.driver.find_elements(By.CSS_SELECTOR, "[data-event]"))


def saved(page, action: str) -> tuple[str, bytes]:
    """What a page offers as a file: its name and content."""
    name, data = page.driver.execute_async_script(
        """const done = arguments[0], click = HTMLAnchorElement.prototype.click;
        HTMLAnchorElement.prototype.click = function () {
          HTMLAnchorElement.prototype.click = click;
          fetch(this.href).then((answer) => answer.blob()).then((blob) => {
            const reader = new FileReader();
            reader.onload = () => done([this.download, reader.result.split(',')[1]]);
            reader.readAsDataURL(blob);
          });
        };"""
        + action
    )
    return name, base64.b64decode(data)


def test_the_view_is_saved_as_a_picture(show):
    import io

    from PIL import Image

    page = show("everything")
    name, data = saved(page, "document.getElementById('png').click()")
    assert name == "everything.png"
    image = numpy.asarray(Image.open(io.BytesIO(data)).convert("RGB"))
    box = page.element("scene").rect
    assert image.shape[:2] == (round(box["height"]), round(box["width"]))
    colours = {"#" + "".join(f"{value:02x}" for value in pixel) for pixel in numpy.unique(image.reshape(-1, 3), axis=0)}
    assert {named("GROUND"), "#fbfbf9"} <= colours


def test_the_run_is_saved_as_a_video(show):
    page = show("ball")
    page.seek(1.0)
    page.script("caromPage.player.speed = 2")
    page.driver.set_script_timeout(60)
    name, data = saved(page, "document.getElementById('video').click()")
    assert name == "ball.webm"
    assert data[:4] == b"\x1a\x45\xdf\xa3" and b"webm" in data[:64]  # EBML, as Matroska has it
    assert len(data) > 1000
    assert page.time() == page.recording.times[-1]  # from the start to the end
    assert page.element("video").get_attribute("aria-pressed") == "false"


def test_bodies_without_outline_and_pins_are_seen(browser, tmp_path):
    from carom import Recorder, Simulation, System, TimeStepping, ground, write_view
    from carom.planar import Gravity, Point, Revolute, RigidBody, rod

    system = System()
    system.add(Gravity((0.0, -9.81)))
    bar = system.add(RigidBody(mass=rod(1.0, 1.0), position=(0.5, 0.0)), "bar")
    system.add(Revolute(from_=(ground, (0.0, 0.0)), to=(bar, (-0.5, 0.0))))
    system.add(Point(body=bar, position=(0.5, 0.0)))
    simulation = Simulation(system, TimeStepping())
    with Recorder(simulation, interval=0.1) as recorder:
        simulation.run_until(0.3)
    write_view(recorder.recording(), tmp_path / "run.html")
    browser.get((tmp_path / "run.html").as_uri())
    data = json.loads(browser.execute_script("return document.getElementById('description').textContent"))
    assert sorted(data["struts"]) == [[1, -0.5, 0.0], [1, 0.5, 0.0]]
    x0, y0, x1, y1 = data["bounds"]
    assert x0 < 0.0 and y1 > 0.0 and x1 > 1.0  # the pin, and the tip at the start


def test_half_planes_are_bands(show):
    page = show("everything")
    (triangles,) = [points for pose, points in page.script("return caromPage.recording.fills") if max(points) > 50.0][:1]
    heights = numpy.reshape(triangles, (-1, 2))
    span = page.script("const b = caromPage.recording.bounds; return Math.max(b[2] - b[0], b[3] - b[1])")
    assert numpy.ptp(heights[:, 0]) > 4.0 * span
    assert numpy.ptp(heights[:, 1]) < 0.2 * span
