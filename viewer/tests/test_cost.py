"""The work of a picture, counted: calls, corners and bytes do not depend on how busy the machine is."""

import math

import pytest
from browser import SIZE, Page
from conftest import record

from carom import Surface, System, TimeStepping, write_view
from carom.planar import Disc, Gravity, HalfPlane, Polygon, RigidBody, Segment, box, disc, rod

COUNT = """
const done = arguments[2], page = caromPage, gl = page.scene.renderer.getContext();
const { times } = page.recording;
page.player.play(false);
document.getElementById("contacts").checked || document.getElementById("contacts").click();
page.camera.scale = arguments[0]; // pixels of a metre
const at = (part) => times[arguments[1]] + part * (times[arguments[1] + 1] - times[arguments[1]]);
for (const part of [0.2, 0.4]) { // what is used the first time is made once
  page.player.seek(at(part));
  page.draw();
}
const found = { calls: 0, draws: 0, corners: 0, bytes: 0 }, original = {};
const size = (words) => words.filter(ArrayBuffer.isView).reduce((sum, word) => sum + word.byteLength, 0);
for (const name in gl) {
  if (typeof gl[name] !== "function") continue;
  original[name] = gl[name];
  gl[name] = function (...words) {
    ++found.calls;
    if (name === "drawElements") { ++found.draws; found.corners += words[1]; }
    if (name === "drawArrays") { ++found.draws; found.corners += words[2]; }
    if (/^(tex|buffer)/.test(name)) found.bytes += name === "bufferSubData" && words.length === 5
      ? words[4] * words[2].BYTES_PER_ELEMENT : size(words);
    return original[name].apply(gl, words);
  };
}
page.player.seek(at(0.6));
page.draw();
for (const name in original) delete gl[name];
done(found);
"""
SMALL, LARGE = 30.0, 400.0  # pixels of a metre: bodies are 3 and 40 pixels wide
GRAIN = 32 * 512  # bytes of a row of places


def falling(kind: str, count: int) -> System:
    """Bodies of one kind in the air, which touch nothing."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.3, normal_restitution=0.2))
    system.add(HalfPlane(normal=(0.0, 1.0)), name="floor")
    for i in range(count):
        place = {"position": (0.2 * (i % 30), 2.0 + 0.2 * (i // 30)), "angle": 0.3 * i}
        if kind == "discs":
            body = system.add(RigidBody(mass=disc(1.0, 0.05), **place))
            system.add(Disc(body=body, radius=0.05))
        elif kind == "bars":
            body = system.add(RigidBody(mass=rod(1.0, 0.06), **place))
            system.add(Segment(body=body, from_=(-0.03, 0.0), to=(0.03, 0.0), radius=0.02))
        else:
            body = system.add(RigidBody(mass=box(1.0, 0.08, 0.06), **place))
            corners = [(-0.04, -0.03), (0.04, -0.03), (0.04, 0.03), (-0.04, 0.03)]
            system.add(Polygon(body=body, vertices=corners))
    return system


def picture(browser, folder, kind: str, count: int, scale: float) -> dict[str, int]:
    """Counts of a picture between two samples in which nothing touches."""
    recording = record(falling(kind, count), TimeStepping(step=5e-3), 0.1, 0.02)
    assert len(recording.contacts) == len(recording.events) == 0
    path = folder / f"{kind}{count}.html"
    write_view(recording, path)
    page = Page(browser, path.as_uri(), recording)
    return page.driver.execute_async_script(COUNT, scale, 2)


@pytest.mark.parametrize(
    ("kind", "scale", "corners"),
    [
        ("discs", SMALL, 1),  # a point
        ("bars", SMALL, 1),
        ("discs", LARGE, 6),  # two triangles
        ("bars", LARGE, 6),
        ("boxes", SMALL, 12),  # a triangle of each edge
        ("boxes", LARGE, 12),
    ],
)
def test_a_body_costs_few_corners_and_bytes(browser, tmp_path, kind, scale, corners):
    few, many = (picture(browser, tmp_path, kind, count, scale) for count in (10, 700))
    assert many["corners"] - few["corners"] == corners * (700 - 10)
    assert many["draws"] == few["draws"] <= 9 and many["calls"] == few["calls"] <= 200
    # A place and a rotation, in whole rows of a texture; nothing else changes between two samples.
    assert few["bytes"] <= GRAIN and many["bytes"] <= math.ceil(701 / 512) * GRAIN + GRAIN


def note(page: Page, interval: float, pictures: int) -> bool:
    """Whether a run that plays is drawn sparingly after so many pictures [ms]."""
    return page.script(
        "const pace = new caromPage.pace.constructor();"
        "for (let i = 0; i < arguments[1]; ++i) pace.note(i % 5 === 0 ? 500 : arguments[0], true);"
        "return pace.isSparing",
        interval,
        pictures,
    )


def test_slow_pictures_are_drawn_sparingly(show):
    page = show("pile")
    assert not note(page, 33.4, 60)  # now and then a picture is late
    assert note(page, 50.0, 60) and not note(page, 50.0, 14)
    assert not page.script(
        "const pace = new caromPage.pace.constructor();"
        "for (let i = 0; i < 20; ++i) pace.note(50, true);"
        "pace.note(50, false); return pace.isSparing"
    )


SPARE = """
const page = caromPage, { player } = page;
player.speed = 1e-9;
player.play(true);
for (let i = 0; i < 20; ++i) page.pace.note(50, true);
page.changePace();
page.pace.controlsAt = Infinity; // as if it had just been
player.seek(arguments[0]);
page.draw();
return [document.getElementById("now").textContent, page.scene.renderer.getPixelRatio()];
"""


def test_what_is_beside_the_scene_waits_while_pictures_are_slow(show, browser):
    metrics = {"width": SIZE[0], "height": SIZE[1], "mobile": False}
    command = "Emulation.setDeviceMetricsOverride"
    browser.execute_cdp_cmd(command, {**metrics, "deviceScaleFactor": 2})
    try:
        page = show("pile")
        assert page.script("return caromPage.scene.renderer.getPixelRatio()") == 2
        now, ratio = page.script(SPARE, 0.7)
        assert now == "0.0000 s" and ratio == 1
        assert page.script("return caromPage.scene.poses.y(1)") != page.recording.positions[0, 0, 1]
        assert page.element("pace").is_displayed()
        page.script("caromPage.player.play(false)")
        page.settle()
        assert page.element("now").text == "0.7000 s"
        assert page.script("return caromPage.scene.renderer.getPixelRatio()") == 2
        assert not page.element("pace").is_displayed()
    finally:
        browser.execute_cdp_cmd(command, {**metrics, "deviceScaleFactor": 1})
