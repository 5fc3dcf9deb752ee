#!/usr/bin/env python3
"""Takes docs/images/report.png and report_plots.png: the report page of a simulated object.

usage: docs/make_report_pictures.py path/to/igsp     (needs chromium, chromium-driver and python3-selenium)
"""
import pathlib
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent
sys.path.append(str(here.parent / "tests"))

from headless_chromium import headless_chromium  # noqa: E402


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
        browser.quit()


main()
