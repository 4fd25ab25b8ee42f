"""Contacts in a browser: their marks and arrows, and what a picture of many costs."""

import numpy
from browser import Page, named
from conftest import record
from models import pile

from carom import TimeStepping, write_view


def test_contacts_are_drawn_by_their_modes(show):
    page = show("pile")
    recording = page.recording
    sample = len(recording) - 1
    page.seek(recording.times[sample])
    contacts = recording.contacts_at(sample)
    assert len(contacts) > 20
    picture = page.picture()
    modes = page.script("return caromPage.recording.modes")
    seen = 0
    for contact in contacts:
        colour = named("IMPACT") if contact["impact"] else named(modes[contact["mode"]])
        seen += colour in page.near(*contact["point"], 3, picture)
    assert seen >= 0.9 * len(contacts)  # arrows of others lie over some
    strongest = contacts[numpy.argmax(contacts["impulse"][:, 0])]
    page.point_at(*strongest["point"])
    assert recording.names[strongest["name"]] in page.element("label").text
    page.element("contacts").click()
    picture = page.picture()
    assert not any(named("stick") in page.near(*contact["point"], 3, picture) for contact in contacts)


def test_arrows_are_as_long_as_impulses(show):
    page = show("pile")
    recording = page.recording
    sample = len(recording) - 1
    page.seek(recording.times[sample])
    page.picture()
    of_arrow = page.script("return caromPage.scene.impulseOfArrow()")
    sizes = numpy.hypot(*recording.contacts["impulse"].T)
    assert numpy.count_nonzero(sizes > of_arrow) <= 0.06 * numpy.count_nonzero(sizes)
    contacts = recording.contacts_at(sample)
    normal, impulse = contacts["normal"], contacts["impulse"]
    tangent = numpy.stack([normal[:, 1], -normal[:, 0]], axis=1)
    arrow = (impulse[:, :1] * normal + impulse[:, 1:2] * tangent) * page.script(
        "return caromPage.scene.uniforms.arrowScale.value"
    )
    pixels = numpy.hypot(*arrow.T) * page.script("return caromPage.camera.scale")
    picture, modes = page.picture(), page.script("return caromPage.recording.modes")
    seen, beyond = [], []
    for i in numpy.argsort(-pixels)[
        :12
    ]:  # the longest: at two thirds of the way, and a little beyond the tip
        colour = named("IMPACT") if contacts["impact"][i] else named(modes[contacts["mode"][i]])
        seen.append(colour in page.near(*(contacts["point"][i] + 0.66 * arrow[i]), 1, picture))
        tip = contacts["point"][i] + (1.0 + 4.0 / pixels[i]) * arrow[i]
        beyond.append(colour in page.near(*tip, 1, picture))
    assert pixels.max() > 12.0 and sum(seen) >= 10 and sum(beyond) <= 4  # others may lie there


def test_contacts_of_a_sample_are_those_that_are_drawn(show):
    page = show("pile")
    recording = page.recording
    for sample in (len(recording) - 1, 40, 90):
        page.seek(recording.times[sample])
        page.picture()
        contacts = recording.contacts_at(sample)
        drawn = numpy.array(page.script("return Array.from(caromPage.scene.contacts.numbers)")).reshape(-1, 8)
        drawn, expected = drawn[: len(contacts)], contacts["point"].astype("f4")
        numpy.testing.assert_array_equal(drawn[:, :2], expected)  # rounded to 24 bits
        modes = page.script("return caromPage.recording.modes")
        colours = numpy.where(contacts["impact"], len(modes), contacts["mode"])
        numpy.testing.assert_array_equal(drawn[:, 3], colours)
        normal, impulse = contacts["normal"], contacts["impulse"]
        tangent = numpy.stack([normal[:, 1], -normal[:, 0]], axis=1)
        vectors = impulse[:, :1] * normal + impulse[:, 1:2] * tangent
        # Normal and impulse are rounded to 24 bits, and so is what comes of them.
        assert numpy.abs(drawn[:, 4:6] - vectors).max() <= 4 * 2.0**-24 * numpy.abs(impulse).max()
        assert not drawn[:, [2, 6, 7]].any()


CALLS = """
const done = arguments[0], page = caromPage, gl = page.scene.renderer.getContext(), player = page.player;
player.play(false);
const events = page.recording.event_time, last = events[events.length - 1];
const moves = [0.5 * last, last];
for (const time of [...moves, moves[0]]) { // what is used the first time is made once
  player.seek(time);
  page.draw();
}
let calls = 0;
const original = {};
for (const name in gl) {
  if (typeof gl[name] !== "function") continue;
  original[name] = gl[name];
  gl[name] = function (...words) { ++calls; return original[name].apply(gl, words); };
}
player.seek(moves[1]); // with the mark of an event
page.draw();
for (const name in original) delete gl[name];
const { render, memory } = page.scene.renderer.info;
done([calls, render.calls, memory.geometries, memory.textures, render.triangles]);
"""


def test_calls_of_a_picture_do_not_depend_on_the_number_of_bodies(browser, tmp_path):
    found = []
    for number, (columns, rows) in enumerate([(4, 4), (16, 12), (40, 30)]):
        recording = record(pile(columns, rows), TimeStepping(step=2e-3), 0.4, 0.02)
        assert len(recording.contacts_at(18)) > columns  # so that marks and arrows are drawn
        path = tmp_path / f"{number}.html"
        write_view(recording, path)
        page = Page(browser, path.as_uri(), recording)
        found.append(page.driver.execute_async_script(CALLS))
    calls, drawn, geometries, textures, triangles = zip(*found)
    assert len(set(drawn)) == len(set(geometries)) == len(set(textures)) == 1
    assert drawn[0] <= 12 and max(calls) <= 250
    assert max(calls) - min(calls) <= 4
    assert triangles[-1] > 20 * triangles[0]
