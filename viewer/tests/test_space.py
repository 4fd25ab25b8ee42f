"""The page in space: a recording in space with a closed form, and planar runs as thick bodies."""

import numpy
import pytest
import spatial_run as spatial
from browser import Page, named
from conftest import COLOURS_OF_BODIES
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

AIR = "#fbfbf9"


def hue(pixels: numpy.ndarray) -> numpy.ndarray:
    """Colours without how light they are."""
    return pixels / numpy.maximum(pixels.sum(axis=-1, keepdims=True), 1)


def covered(page: Page, body: int, picture: numpy.ndarray) -> numpy.ndarray:
    """Columns and rows (n, 2) of pixels of the scene that have the hue of a body of the light's shades."""
    colour = COLOURS_OF_BODIES[body % len(COLOURS_OF_BODIES)]
    rgb = numpy.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)])
    box = page.element("scene").rect
    left, top, width, height = (round(box[key]) for key in ("x", "y", "width", "height"))
    scene = picture[top : top + height, left : left + width]
    near = numpy.abs(hue(scene) - hue(rgb)).max(axis=2) < 0.006  # of shades that are rounded to 8 bits
    rows, columns = numpy.nonzero(near & (scene.sum(axis=2) > 250))
    return numpy.stack([columns + left, rows + top], axis=1)


def is_body(page: Page, body: int, point, picture: numpy.ndarray, reach: int = 3) -> bool:
    """Whether most pixels around a point of the scene are of a body."""
    column, row = page.pixel(*point)
    found = covered(page, body, picture)
    inside = numpy.abs(found.reshape(-1, 2) - [column, row]).max(axis=1) <= reach
    return int(numpy.count_nonzero(inside)) > 0.6 * (2 * reach + 1) ** 2


@pytest.fixture
def page(show) -> Page:
    page = show("space")
    page.element("contacts").click()  # marks lie over all
    return page


def middles(time: float) -> numpy.ndarray:
    return spatial.states(numpy.array([time]))[0][0]


def drag(page: Page, across: int, down: int, *, shift: bool = False) -> None:
    """Drags from the middle of the scene."""
    actions = ActionChains(page.driver, duration=50)
    if shift:
        actions.key_down(Keys.SHIFT)
    actions.move_to_element(page.element("scene")).click_and_hold().move_by_offset(across, down).release()
    actions.key_up(Keys.SHIFT).perform()
    page.settle()


def test_solids_are_where_the_recording_has_them(page):
    for time in (0.1, 0.2, 0.3):
        page.seek(time)
        picture = page.picture()
        for body, middle in enumerate(middles(time)):
            if body == 0 or body > 2:  # the others may be hidden
                assert is_body(page, body, middle, picture), (time, body)


def test_a_sphere_is_as_wide_as_its_diameter(page):
    page.seek(0.1)
    found = covered(page, 2, page.picture())
    scale = page.script("return caromPage.camera.scale")
    width = numpy.ptp(found, axis=0) + 1
    # Pixels at the border are in or out.
    assert numpy.abs(width - 2.0 * spatial.RADIUS * scale).max() <= 2.5
    assert numpy.abs(found.mean(axis=0) - page.pixel(*middles(0.1)[2])).max() <= 2.0


def test_the_corners_of_a_tumbling_box_are_its_outline(page):
    signs = numpy.stack(numpy.meshgrid(*[[-0.5, 0.5]] * 3), axis=-1).reshape(-1, 3)
    for sample in (5, 17, 29):
        time = page.recording.times[sample]
        page.seek(time)
        found = covered(page, 3, page.picture())
        position, turn = (array[0, 3] for array in spatial.states(numpy.array([time])))
        w, axis = turn[0], turn[1:]
        local = signs * spatial.BOX["sides"]
        turned = local + 2.0 * numpy.cross(axis, numpy.cross(axis, local) + w * local)
        corners = numpy.array([page.pixel(*(position + corner)) for corner in turned])
        low, high = corners.min(axis=0), corners.max(axis=0)
        assert numpy.abs(found.min(axis=0) - low).max() <= 2, sample  # rounded to pixels
        assert numpy.abs(found.max(axis=0) - high).max() <= 2, sample


def test_what_lies_before_hides_what_is_behind(page):
    """Seen along the line from one ball to another, the nearer one is seen."""
    for time, front in ((0.0, 2), (0.6, 0)):  # from above: the floor hides nothing
        page.seek(time)
        near, far = middles(time)[[front, 2 - front]]
        x, y, z = (near - far) / numpy.linalg.norm(near - far)
        page.script(
            "const camera = caromPage.camera; camera.azimuth = arguments[0]; camera.elevation = arguments[1];"
            "camera.orbit(0, 0)",
            float(numpy.arctan2(x, -y)),
            float(numpy.arcsin(z)),
        )
        picture = page.picture()
        (a, b), (c, d) = page.pixel(*near), page.pixel(*far)
        assert abs(a - c) <= 1 and abs(b - d) <= 1
        assert is_body(page, front, near, picture) and not is_body(page, 2 - front, near, picture)


def test_shadows_are_below_what_casts_them(page):
    page.seek(0.0)
    x, y, height = middles(0.0)[0]
    towards = numpy.array(page.script("return caromPage.scene.uniforms.light.value.toArray()"))
    spot = numpy.array([x, y, height]) - towards * height / towards[2]
    beside = spot + [0.0, -2.5 * spatial.RADIUS, 0.0]
    picture = page.picture()
    dark, light = (picture[row, column].sum() for column, row in (page.pixel(*spot), page.pixel(*beside)))
    assert dark < 0.85 * light


def test_dragging_turns_the_view(page):
    page.seek(0.1)
    before = page.picture()
    azimuth, elevation = page.script("return [caromPage.camera.azimuth, caromPage.camera.elevation]")
    drag(page, 120, -40)
    after = page.picture()
    turned = page.script("return [caromPage.camera.azimuth, caromPage.camera.elevation]")
    assert turned[0] < azimuth - 0.5 and turned[1] < elevation - 0.1
    assert (before != after).any(axis=2).mean() > 0.2
    for body in (0, 3):
        assert is_body(page, body, middles(0.1)[body], after)
    middle = page.script("return caromPage.camera.middle")
    drag(page, 30, 10, shift=True)
    assert page.script("return caromPage.camera.middle") != middle
    assert page.script("return [caromPage.camera.azimuth, caromPage.camera.elevation]") == turned


def test_the_slider_moves_solids(page):
    page.seek(0.0)
    assert is_body(page, 0, middles(0.0)[0], page.picture())
    page.element("time").send_keys(Keys.END)
    assert page.time() == spatial.UNTIL
    picture = page.picture()
    assert not is_body(page, 0, middles(0.0)[0], picture)
    assert is_body(page, 0, middles(spatial.UNTIL)[0], picture)


def test_orientations_between_samples_are_on_the_way(page):
    times = page.recording.times
    time = 0.5 * (times[10] + times[11])
    page.seek(time)
    numbers = page.script("return Array.from(caromPage.scene.poses.numbers.subarray(8 * 4, 8 * 5))")
    (turn,) = spatial.turn(numpy.array(spatial.BOX["spin"]), numpy.array([time]))
    # Halfway on a great circle is exact; numbers have 24 bits.
    numpy.testing.assert_allclose(numbers[4:], [*turn[1:], turn[0]], atol=1e-6)
    before, after = (spatial.states(times[[i]])[0][0, 3] for i in (10, 11))
    numpy.testing.assert_allclose(numbers[:3], 0.5 * (before + after), atol=1e-6)


def test_events_are_jumped_to(page):
    events = page.recording.events
    row = page.driver.find_element(By.CSS_SELECTOR, "[data-event='1']")
    assert row.text.startswith(f"{events['time'][1]:.5f} s\nimpact")
    row.click()
    assert page.time() == events["time"][1]
    ball = int(events["name"][1])
    assert named("IMPACT") in page.near(*spatial.BALLS[ball], 12)  # a ring around the point


def test_arrows_are_impulses_in_space(show):
    page = show("space")
    page.seek(0.0)
    contacts = page.recording.contacts_at(0)
    scale = page.script("return caromPage.scene.uniforms.arrowScale.value")
    assert scale > 0.0
    picture = page.picture()
    for contact in contacts[:2]:
        # On the floor the normal is z, t1 along x, the axis that is least aligned with it, and t2 along y.
        n, t1, t2 = contact["impulse"]
        for part, is_there in ((0.5, True), (0.9, True), (1.15, False)):
            tip = contact["point"] + part * scale * numpy.array([t1, t2, n])
            assert (named("stick") in page.near(*tip[:2], 1, picture, z=tip[2])) == is_there, part


def test_the_pointer_names_what_it_meets_first(page):
    page.seek(0.1)
    for body in (0, 3, 5, 6):
        page.point_at(*middles(0.1)[body])
        name = page.recording.body_names()[body]
        assert page.element("label").text.startswith(f"{name}\nat ")
    page.point_at(-0.2, -2.0, 0.0)
    assert page.element("label").text == "floor"


def test_a_followed_solid_stays_in_the_middle(page):
    page.element("followed").send_keys("box", Keys.ENTER)
    box = page.element("scene").rect
    for time in (0.0, 0.5):
        page.seek(time)
        column, row = page.pixel(*middles(time)[3])
        # Places between samples are on straight ways.
        assert abs(column - box["x"] - box["width"] / 2) <= 1 and abs(row - box["y"] - box["height"] / 2) <= 1


def test_a_planar_run_may_be_seen_as_thick_bodies(show):
    page = show("everything")
    page.element("contacts").click()
    flat = page.picture()
    page.element("space").click()
    thick = page.picture()
    assert (flat != thick).any(axis=2).mean() > 0.1  # of the window
    names = page.recording.body_names()
    half = 0.5 * page.script("return caromPage.scene.bodySize")
    body = names.index("rigid body 'brick'")
    x, y, _ = page.recording.positions[0, body]
    assert is_body(page, body, (x, y, half), thick)
    page.point_at(x, y, half)
    assert page.element("label").text.startswith("rigid body 'brick'\nat 0 m, 0 m, 0.2 rad")
    page.point_at(0.0, -1.05, half)
    assert page.element("label").text == "block"
    drag(page, -150, 30)
    turned = page.picture()
    assert any(is_body(page, body, (x, y, z), turned) for z in (half, -half))
    page.script("document.activeElement.blur(); caromPage.pick(-1)")
    page.element("space").click()
    page.driver.execute_script("caromPage.pick(-1)")
    ActionChains(page.driver).move_to_element(page.element("title")).perform()
    assert (page.picture() == flat).all()  # the plane as it was


def test_calls_of_a_picture_in_space_do_not_depend_on_the_number_of_bodies(show):
    counts = []
    for name in ("everything", "pile"):
        page = show(name)
        page.element("space").click()
        page.seek(0.3)
        counts.append(page.script("return caromPage.scene.renderer.info.render.calls"))
    assert max(counts) <= 12
