"""Prints what a page of many discs costs: the size of the file, pictures a second in a browser that draws in
software, the processor time of each, which other programs on the machine change less, as it plays and where it
jumps, and how much of a picture is JavaScript, which stays where a graphics card draws.

    python viewer/tests/measure.py [number of discs] [file of a picture]
"""

import os
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "python" / "tests"))

from browser import Page, open_browser  # noqa: E402
from models import pile  # noqa: E402

from carom import Recorder, Simulation, TimeStepping, write_view  # noqa: E402

COUNT = """
const done = arguments[0], page = caromPage, player = page.player;
player.seek(player.start);
player.speed = (player.end - player.start) / 6;
player.play(true);
let first = 0, frames = 0;
requestAnimationFrame(function tick(now) {
  first ||= now;
  if (now - first >= 5000) done([page.frames - frames, now - first]);
  else requestAnimationFrame(tick);
  frames ||= page.frames;
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
    ticks, known = 0, {parent}
    stats = sorted((int(path.parent.name), path) for path in Path("/proc").glob("[0-9]*/stat"))
    for process, path in stats:
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it ended meanwhile
        if process in known or int(fields[1]) in known:
            known.add(process)
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def main() -> None:
    number = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
    rows = max(1, round((number / 2.0) ** 0.5))
    simulation = Simulation(pile(2 * rows, rows), TimeStepping(step=2e-3))
    begin = time.perf_counter()
    with Recorder(simulation, interval=0.02) as recorder:
        simulation.run_until(0.6)
    recording = recorder.recording()
    print(f"{recording!r} in {time.perf_counter() - begin:.1f} s")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pile.html"
        write_view(recording, path)
        print(f"page: {path.stat().st_size / 1e6:.1f} MB for {len(recording)} samples")
        driver = open_browser()
        try:
            driver.set_script_timeout(60)
            begin = time.perf_counter()
            Page(driver, path.as_uri(), recording)
            print(f"opened in {time.perf_counter() - begin:.1f} s")
            before = processor_time(driver.service.process.pid)
            frames, milliseconds = driver.execute_async_script(COUNT)
            spent = processor_time(driver.service.process.pid) - before
            print(f"pictures: {1000 * frames / milliseconds:.1f} a second over {milliseconds / 1000:.1f} s")
            spent *= 1000 / max(1, frames)
            print(f"playing: {spent:.1f} ms of processor time a picture, of all processes of the browser")
            before = processor_time(driver.service.process.pid)
            count = driver.execute_async_script(DRAW)
            spent = processor_time(driver.service.process.pid) - before
            print(f"by samples: {1000 * spent / count:.1f} ms of processor time a picture")
            print(f"JavaScript: {script_time(driver):.2f} ms a picture")
            if len(sys.argv) > 2:
                driver.save_screenshot(sys.argv[2])
        finally:
            driver.quit()


if __name__ == "__main__":
    main()
