"""A headless Chromium for tests of pages, or lack it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from office import lack

INSTALL = "install chromium and chromium-driver (Debian packages), and pip install selenium"
OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)


class Browser:
    """Chromium with one page open at a time.

    Parameters
    ----------
    driver : selenium.webdriver.Chrome
    """

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, path: Path, *, address: str = "") -> None:
        """Open a file as a page, and forget what was logged before."""
        self.driver.get("about:blank")  # so that another address of the same file is opened anew
        self.log()
        self.requests()
        self.driver.get(path.as_uri() + address)

    def run(self, script: str, *arguments: object) -> Any:
        """Run JavaScript and return its value."""
        return self.driver.execute_script(script, *arguments)

    def view(self, call: str) -> Any:
        """Return what one of the page's functions for tests says: ``card()``."""
        return self.run(f"return window.graspView.{call}")

    def command(self, name: str, **details: Any) -> Any:
        """Send a command of the browser's own protocol."""
        return self.driver.execute_cdp_cmd(name, details)

    def find(self, selector: str) -> Any:
        """Return an element of the page."""
        return self.driver.find_element("css selector", selector)

    def text(self, selector: str) -> str:
        """Return the text of an element, also of one that only a screen reader reads."""
        return str(self.find(selector).get_attribute("textContent"))

    def wait(self, script: str) -> Any:
        """Wait until a JavaScript expression is true, and return its value."""
        from selenium.webdriver.support.wait import WebDriverWait

        wait = WebDriverWait(self.driver, 20, poll_frequency=0.02)
        return wait.until(lambda _: self.run(f"return {script}"))

    def log(self) -> list[dict[str, Any]]:
        """Return what the console has said since."""
        entries: list[dict[str, Any]] = self.driver.get_log("browser")
        return entries

    def requests(self) -> list[str]:
        """Return the addresses that the open page has asked for since."""
        messages = [json.loads(e["message"])["message"] for e in self.driver.get_log("performance")]
        sent = [m["params"] for m in messages if m["method"] == "Network.requestWillBeSent"]
        page = self.driver.current_url.split("#")[0]
        return [each["request"]["url"] for each in sent if each["documentURL"] == page]


def run_browser(profile: Path) -> Iterator[Browser]:
    """Start Chromium, or lack it; end it when its user is done (a fixture's body)."""
    try:
        from selenium import webdriver
    except ImportError:
        lack(f"selenium is not here: {INSTALL}")
    programs = {name: shutil.which(name) for name in ("chromium", "chromedriver")}
    missing = [name for name, path in programs.items() if not path]
    if missing:
        lack(f"{missing[0]} is not here: {INSTALL}")
    options = webdriver.ChromeOptions()
    options.binary_location = programs["chromium"]
    for option in (*OPTIONS, f"--user-data-dir={profile}", "--window-size=1200,700"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.ChromeService(programs["chromedriver"])
    driver = webdriver.Chrome(options=options, service=service)
    yield Browser(driver)
    driver.quit()
