"""Pages of recordings in Chromium, as its driver sees them."""

import io
import re
from pathlib import Path

import numpy
from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.chrome.service import Service

SIZE = (1280, 800)
SOURCES = Path(__file__).parents[1] / "src"
COLOURS = (SOURCES / "colours.js").read_text()


def named(name: str) -> str:
    """A colour of colours.js."""
    return re.search(rf"\b{name}(?: =|:) \"(#\w{{6}})\"", COLOURS).group(1)


def open_browser() -> webdriver.Chrome:
    """Chromium without a window, which draws in software."""
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for argument in (
        "--headless=new",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--hide-scrollbars",
        "--force-device-scale-factor=1",
        f"--window-size={SIZE[0]},{SIZE[1]}",
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
    # The window's size counts its frame too.
    driver.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": SIZE[0], "height": SIZE[1], "deviceScaleFactor": 1, "mobile": False},
    )
    return driver


class Page:
    """One page."""

    def __init__(self, driver: webdriver.Chrome, address: str, recording) -> None:
        self.driver = driver
        self.recording = recording
        driver.get(address)
        self.settle()

    def settle(self) -> None:
        """Waits until what changed is drawn."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))"
        )

    def script(self, text: str, *arguments):
        return self.driver.execute_script(text, *arguments)

    def element(self, name: str):
        return self.driver.find_element(By.ID, name)

    def picture(self) -> numpy.ndarray:
        """The window as an array (height, width, 3)."""
        self.settle()
        image = Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")
        return numpy.asarray(image).astype(int)

    def time(self) -> float:
        return self.script("return caromPage.player.time")

    def seek(self, time: float) -> None:
        self.script("caromPage.player.seek(arguments[0])", time)
        self.settle()

    def pixel(self, x: float, y: float, z: float = 0.0) -> tuple[int, int]:
        """Column and row in the window of a point of the scene."""
        across, down, left, top = self.script(
            "const box = document.getElementById('scene').getBoundingClientRect();"
            "return [...caromPage.camera.pixelAt(...arguments), box.left, box.top]",
            float(x),
            float(y),
            float(z),
        )
        return round(across + left), round(down + top)

    def colour(self, x: float, y: float, picture=None) -> str:
        """The colour that fills a point of the scene: the most frequent of 5 x 5 pixels."""
        column, row = self.pixel(x, y)
        picture = self.picture() if picture is None else picture
        patch = picture[row - 2 : row + 3, column - 2 : column + 3].reshape(-1, 3)
        values, counts = numpy.unique(patch, axis=0, return_counts=True)
        return "#" + "".join(f"{value:02x}" for value in values[counts.argmax()])

    def near(self, x: float, y: float, reach: int, picture=None, z: float = 0.0) -> set[str]:
        """All colours within some pixels of a point of the scene."""
        column, row = self.pixel(x, y, z)
        picture = self.picture() if picture is None else picture
        patch = picture[row - reach : row + reach + 1, column - reach : column + reach + 1].reshape(-1, 3)
        return {"#" + "".join(f"{value:02x}" for value in pixel) for pixel in numpy.unique(patch, axis=0)}

    def point_at(self, x: float, y: float, z: float = 0.0) -> None:
        """Moves the pointer to a point of the scene."""
        canvas = self.element("scene")
        column, row = self.pixel(x, y, z)
        box = canvas.rect
        ActionChains(self.driver, duration=0).move_to_element_with_offset(
            canvas, round(column - box["x"] - box["width"] / 2), round(row - box["y"] - box["height"] / 2)
        ).perform()
        self.settle()
