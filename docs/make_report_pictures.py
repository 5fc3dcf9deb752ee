#!/usr/bin/env python3
"""Takes docs/images/report.png and report_plots.png, the report page of a simulated object, and network.png, that of a
survey of a simulated park.

usage: docs/make_report_pictures.py path/to/igsp     (needs chromium, chromium-driver and python3-selenium)
"""
import pathlib
import subprocess
import sys
import tempfile
import time

here = pathlib.Path(__file__).resolve().parent
sys.path.append(str(here.parent / "tests"))

from headless_chromium import headless_chromium  # noqa: E402
from selenium import webdriver  # noqa: E402


def take_network(igsp: pathlib.Path, folder: pathlib.Path, browser: webdriver.Chrome) -> None:
    subprocess.run([igsp, "simulate", "park", "--out", "park", "--stations", "8", "--points", "60000", "--seed", "3"],
                   check=True, cwd=folder, capture_output=True)
    (folder / "viewpoints.csv").write_text("scan,x,y,z\n" + "".join(f"station_{i},0,0,0\n" for i in range(8)))
    subprocess.run([igsp, "network", "park", "-o", "survey", "--viewpoints", "viewpoints.csv", "--target-points",
                    "6000"], cwd=folder, capture_output=True)
    browser.set_window_size(1180, 960)
    browser.get(f"file://{folder / 'survey/report.html'}")
    browser.execute_script("document.querySelector('[data-look=oblique]').click()")
    time.sleep(0.5)  # it draws before the next frame
    browser.save_screenshot(str(here / "images" / "network.png"))


def main() -> None:
    igsp = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([igsp, "simulate", "object", "--out", "."], check=True, cwd=folder, capture_output=True)
        subprocess.run([igsp, "align", "station_1.ply", "station_0.ply", "--html", "report.html"], check=True,
                       cwd=folder, capture_output=True)
        browser = headless_chromium(folder / "profile", 1180, 960)
        browser.get(f"file://{folder / 'report.html'}")
        browser.execute_script("document.getElementById('by-distance').click()")
        browser.save_screenshot(str(here / "images" / "report.png"))
        browser.execute_script("document.getElementById('loop').scrollIntoView()")
        browser.set_window_size(1180, 720)
        browser.save_screenshot(str(here / "images" / "report_plots.png"))
        take_network(igsp, folder, browser)
        browser.quit()


main()
