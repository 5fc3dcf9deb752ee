"""Debian's Chromium without a window, for pages in files."""
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.remote.remote_connection import RemoteConnection

FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL without a graphics card
         "--hide-scrollbars"]
ANSWER_S = 180  # a browser that answers no more fails its test, in place of keeping all others waiting


def headless_chromium(profile: Path, width: int = 1280, height: int = 900) -> webdriver.Chrome:
    """A browser with a profile of its own that keeps what pages say on the console."""
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for flag in [*FLAGS, f"--user-data-dir={profile}", f"--window-size={width},{height}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    RemoteConnection.set_timeout(ANSWER_S)
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
