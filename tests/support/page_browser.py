# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desk's page in Debian's chromium, without a display."""

from __future__ import annotations

import shutil
import typing
from contextlib import contextmanager, suppress
from io import BytesIO

import waiting
from PIL import Image

USER, PASSWORD = "franka", "open-sesame"
LIMIT = 60.0  # [s] for what a busy machine does
PICTURE_LIMIT = 120.0  # [s] for one of the whole tab, drawn without a GPU
PAUSE = 0.03  # [s] between two looks
OPTIONS = [
    "--headless=new",
    "--no-sandbox",  # for root
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--ignore-certificate-errors",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--no-first-run",
]


def missing() -> str:
    """Why no browser can be started; empty if one can."""
    programs = [name for name in ("chromium", "chromedriver") if not shutil.which(name)]
    try:
        import selenium  # noqa: F401
    except ImportError:
        programs.append("python3-selenium")
    verb = "is" if len(programs) == 1 else "are"
    return f"{' and '.join(programs)} {verb} not installed: run ./franka install test" if programs else ""


def wait_for(condition: typing.Callable[[], typing.Any], what: str, limit: float = LIMIT) -> typing.Any:
    """The first true value of the condition. Each look takes the browser's time."""
    return waiting.wait_for(condition, what, limit, PAUSE)


class Browser:
    """A browser with one tab. Names in brackets are those that a screen reader would read."""

    def __init__(self, width: int = 900, height: int = 700):
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium") or ""
        for option in [*OPTIONS, f"--window-size={width},{height}"]:
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
        self.resize(width, height)

    def resize(self, width: int, height: int) -> None:
        """Sets the size of the page, also below that of a window."""
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)

    def prefer(self, scheme: str) -> None:
        """As if the system preferred light or dark colors."""
        feature = {"name": "prefers-color-scheme", "value": scheme}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [feature]})

    def run(self, script: str, *arguments) -> typing.Any:
        """The value of an expression of JavaScript."""
        return self.driver.execute_script(f"return {script}", *arguments)

    # ---- actions of the user -----------------------------------------------------------------------------

    def open(self, address: str) -> None:
        self.driver.get(address)

    def log_in(self, user: str = USER, password: str = PASSWORD) -> None:
        form = wait_for(lambda: self.find("form.login"), "the login")
        for field, word in zip(form.find_elements("css selector", "input"), (user, password)):
            field.clear()
            field.send_keys(word)
        form.submit()

    def wait_for_view(self) -> None:
        wait_for(
            lambda: self.run("Boolean(window.desk?.robots.every((robot) => robot.report))"), "the robots"
        )
        wait_for(lambda: self.run("[...desk.panels.values()].some((panel) => panel.ready)"), "the 3D view")

    def click(self, name: str, robot: int = 0) -> None:
        """Clicks the enabled button of that name, of one robot, of a dialog, or of the page."""
        wait_for(lambda: self._click(name, robot), f"the button '{name}' can be clicked")

    def _click(self, name: str, robot: int) -> bool:
        button = self.button(name, robot)
        if button is None or not button.is_enabled() or button.get_attribute("aria-busy") == "true":
            return False
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", button)
        button.click()
        return True

    def press(self, *keys: str) -> None:
        """Sends keys to what has the focus."""
        from selenium.webdriver import ActionChains

        ActionChains(self.driver).send_keys(*keys).perform()

    def drag(
        self, start: dict, offset: tuple[float, float], hold: typing.Callable[[], typing.Any]
    ) -> typing.Any:
        """Drags the pointer from a place by an offset [px] and holds it there during a call."""
        self._pointer("mouseMoved", start["x"], start["y"], 0)
        self._pointer("mousePressed", start["x"], start["y"], 1)
        x, y = start["x"] + offset[0], start["y"] + offset[1]
        for part in (0.5, 1.0):
            self._pointer("mouseMoved", start["x"] + part * offset[0], start["y"] + part * offset[1], 1)
        try:
            return hold()
        finally:
            self._pointer("mouseReleased", x, y, 0)

    def _pointer(self, kind: str, x: float, y: float, buttons: int) -> None:
        event = {"type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1}
        self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    # ---- what the user sees ------------------------------------------------------------------------------

    def find(self, selector: str):
        """The first element, or None."""
        found = self.driver.find_elements("css selector", selector)
        return found[0] if found else None

    def button(self, name: str, robot: int = 0):
        """A visible button or option by its name; those of an open dialog come first."""
        script = """
            const [name, robot] = arguments;
            const shown = (element) => element.checkVisibility();
            const nameOf = (element) => element.getAttribute("aria-label") ?? element.textContent;
            const named = (element) => nameOf(element).trim() === name;
            const places = ["dialog[open]", `[data-robot="${robot}"]`, "body"];
            for (const place of places) {
              const all = [...document.querySelectorAll(`${place} button, ${place} summary, ${place} label`)];
              const found = all.find((element) => shown(element) && named(element));
              if (found) return found;
            }
            return null;"""
        return self.driver.execute_script(script, name, robot)

    def text(self, selector: str = "body") -> str:
        """What is written there, visibly."""
        element = self.find(selector)
        return element.text if element else ""

    def shows(self, text: str, selector: str = "body") -> None:
        """Waits until that text can be read."""
        wait_for(lambda: text in self.text(selector), f"'{text}' is shown")

    def report(self, robot: int = 0) -> dict:
        """The newest report that the page has."""
        return self.run(f"desk.robots[{robot}].report")

    def place(self, body: str) -> dict:
        """Where a body is in the 3D view [px]."""
        return wait_for(lambda: self.run("desk.project(arguments[0])", body), f"{body} is in the view")

    def picture(self) -> Image.Image:
        """What the tab shows. chromedriver gives up after 10 s, which a busy machine may take."""
        from selenium.common.exceptions import TimeoutException

        def take():
            with suppress(TimeoutException):
                return self.driver.get_screenshot_as_png()

        data = wait_for(take, "a picture of the tab", PICTURE_LIMIT)
        return Image.open(BytesIO(data)).convert("RGB")

    def errors(self) -> list[str]:
        """Errors and violations of the policy in the console since the last call."""
        entries = self.driver.get_log("browser")
        return [each["message"] for each in entries if each["level"] in ("SEVERE", "WARNING")]

    def focused(self) -> tuple[str, bool]:
        """The name of what has the focus, and whether a ring shows it."""
        script = """
            const element = document.activeElement;
            if (element === document.body) return ["", true];
            const outline = getComputedStyle(element).outlineStyle;
            const shown = outline !== "none" || element.matches(".segments input"); // its text has it
            return [element.getAttribute("aria-label") ?? element.textContent.trim(), shown];"""
        return tuple(self.driver.execute_script(script))

    def close(self) -> None:
        self.driver.quit()


@contextmanager
def browser(**options):
    """A browser that ends with the block."""
    opened = Browser(**options)
    try:
        yield opened
    finally:
        opened.close()
