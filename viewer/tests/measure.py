"""Prints what a page of many bodies costs, discs and mixed shapes: the size of the file; how long a run that
plays waits from picture to picture, in a browser that draws in software, and the processor time of each, which
other programs on the machine change less, as it plays and where it jumps; and how much of a picture is
JavaScript, which stays where a graphics card draws.

    python viewer/tests/measure.py [number of bodies] [file of a picture]
"""

import math
import os
import sys
import tempfile
import time
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).parents[2] / "python" / "tests"))

from browser import Page, open_browser  # noqa: E402
from models import pile  # noqa: E402

from carom import Recorder, Simulation, Surface, System, TimeStepping, write_view  # noqa: E402
from carom.planar import BoxInside, Disc, Gravity, Polygon, RigidBody, Segment, box, disc, rod  # noqa: E402

SIZE = (1280, 720)
ROUNDS = 5  # of which the one with the least processor time counts
PLAY = """
const done = arguments[0], page = caromPage, player = page.player;
player.seek(player.start + 0.3 * (player.end - player.start)); // where bodies touch
player.speed = (player.end - player.start) / 9;
player.play(true);
const times = [];
requestAnimationFrame(function tick(now) {
  times.push(now);
  if (now - times[0] < 5000) requestAnimationFrame(tick);
  else { player.play(false); done(times); }
});
"""
DRAW = """
const done = arguments[0], page = caromPage, player = page.player, count = 40;
const gl = page.scene.renderer.getContext(), pixel = new Uint8Array(4);
player.play(false);
let drawn = 0;
requestAnimationFrame(function tick() {
  player.seek(player.start + (drawn + 0.5) / count * (player.end - player.start));
  page.draw();
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until all is drawn
  if (++drawn === count) done(count);
  else requestAnimationFrame(tick);
});
"""


def script_time(driver) -> float:
    """Milliseconds of JavaScript a picture, without waiting for what is drawn, from samples of a profiler."""
    driver.execute_cdp_cmd("Profiler.enable", {})
    driver.execute_cdp_cmd("Profiler.setSamplingInterval", {"interval": 200})
    driver.execute_cdp_cmd("Profiler.start", {})
    count = driver.execute_async_script(DRAW)
    profile = driver.execute_cdp_cmd("Profiler.stop", {})["profile"]
    names = {node["id"]: node["callFrame"]["functionName"] for node in profile["nodes"]}
    others = ("readPixels", "(idle)", "(program)", "(root)")
    spans = zip(profile["samples"], profile["timeDeltas"])
    return sum(span for node, span in spans if names[node] not in others) / (1000.0 * count)


def processor_time(parent: int) -> float:
    """Seconds that a process and all that it started have computed."""
    children: dict[int, list[int]] = {}
    spent = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it ended meanwhile
        process = int(path.parent.name)
        children.setdefault(int(fields[1]), []).append(process)
        spent[process] = int(fields[11]) + int(fields[12])
    ticks, waiting = 0, [parent]
    while waiting:
        process = waiting.pop()
        ticks += spent.get(process, 0)
        waiting += children.get(process, [])
    return ticks / os.sysconf("SC_CLK_TCK")


def mixed(columns: int, rows: int) -> System:
    """Discs, bars and boxes as pile() has discs."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.3, normal_restitution=0.2))
    system.add(BoxInside(lower=(0.0, 0.0), upper=(0.11 * columns, 0.3 * rows)), name="box")
    corners = [(-0.035, -0.03), (0.035, -0.03), (0.035, 0.03), (-0.035, 0.03)]
    masses = (disc(1.0, 0.05), rod(1.0, 0.06), box(1.0, 0.07, 0.06))
    for row in range(rows):
        for column in range(columns):
            shift, kind = 0.005 * math.sin(7.0 * row + 3.0 * column), (row + column) % 3
            place = ((column + 0.6) * 0.11 + shift, (row + 0.6) * 0.11)
            body = system.add(RigidBody(mass=masses[kind], position=place, angle=0.1 * column + 0.3 * row))
            if kind == 0:
                system.add(Disc(body=body, radius=0.05))
            elif kind == 1:
                system.add(Segment(body=body, from_=(-0.03, 0.0), to=(0.03, 0.0), radius=0.02))
            else:
                system.add(Polygon(body=body, vertices=corners))
    return system


def measure_play(driver) -> None:
    """Intervals between pictures of a run that plays, and their processor time: rounds, and the best."""
    best = (math.inf, "")
    for _ in range(ROUNDS):
        load, before = os.getloadavg()[0], processor_time(driver.service.process.pid)
        intervals = numpy.diff(driver.execute_async_script(PLAY))
        spent = 1000.0 * (processor_time(driver.service.process.pid) - before) / len(intervals)
        median, late = numpy.percentile(intervals, [50, 95])
        rate = 1000.0 * len(intervals) / intervals.sum()
        text = (
            f"{spent:.1f} ms of processor time a picture; from picture to picture {median:.1f} ms in the "
            f"median, {late:.1f} ms at 95 %, {rate:.1f} a second (load {load:.1f})"
        )
        print(f"  round: {text}", flush=True)
        best = min(best, (spent, text))
    print(f"playing: {best[1]}")


def measure(name: str, model: System, picture: str) -> None:
    simulation = Simulation(model, TimeStepping(step=2e-3))
    begin = time.perf_counter()
    with Recorder(simulation, interval=0.02) as recorder:
        simulation.run_until(0.6)
    recording = recorder.recording()
    print(f"{name}: {recording!r} in {time.perf_counter() - begin:.1f} s", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.html"
        write_view(recording, path)
        print(f"page: {path.stat().st_size / 1e6:.1f} MB for {len(recording)} samples")
        driver = open_browser()
        try:
            driver.set_script_timeout(60)
            screen = {"width": SIZE[0], "height": SIZE[1], "deviceScaleFactor": 1, "mobile": False}
            driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
            begin = time.perf_counter()
            Page(driver, path.as_uri(), recording)
            print(f"opened in {time.perf_counter() - begin:.1f} s")
            measure_play(driver)
            before = processor_time(driver.service.process.pid)
            count = driver.execute_async_script(DRAW)
            spent = processor_time(driver.service.process.pid) - before
            print(f"by samples: {1000 * spent / count:.1f} ms of processor time a picture")
            print(f"JavaScript: {script_time(driver):.2f} ms a picture")
            if picture:
                driver.save_screenshot(picture)
        finally:
            driver.quit()


def main() -> None:
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
    rows = max(1, round((number / 2.0) ** 0.5))
    measure("discs", pile(2 * rows, rows), sys.argv[2] if len(sys.argv) > 2 else "")
    measure("mixed shapes", mixed(2 * rows, rows), "")


if __name__ == "__main__":
    main()
