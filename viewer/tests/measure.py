"""Prints what a page of many discs costs: the size of the file, and pictures a second in a browser that draws in
software.

    python viewer/tests/measure.py [number of discs] [file of a picture]
"""

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
BUSY = """
const page = caromPage, player = page.player, count = 20;
const begin = performance.now();
for (let i = 0; i < count; ++i) { player.seek(player.start + (i + 0.5) / count * (player.end - player.start)); page.draw(); }
return (performance.now() - begin) / count;
"""


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
            page = Page(driver, path.as_uri(), recording)
            print(f"opened in {time.perf_counter() - begin:.1f} s")
            frames, milliseconds = driver.execute_async_script(COUNT)
            print(f"pictures: {1000 * frames / milliseconds:.1f} a second over {milliseconds / 1000:.1f} s")
            print(f"script of one picture: {page.script(BUSY):.1f} ms")
            if len(sys.argv) > 2:
                driver.save_screenshot(sys.argv[2])
        finally:
            driver.quit()


if __name__ == "__main__":
    main()
