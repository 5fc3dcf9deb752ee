"""The page of a network in a real browser, headless Chromium. usage: network_browser_test.py IGSP [unittest arguments]"""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from headless_chromium import headless_chromium

IGSP = os.path.abspath(sys.argv.pop(1))

DRAWN = """
const picture = document.getElementById('points');
const canvas = document.createElement('canvas');
canvas.width = picture.width; canvas.height = picture.height;
const context = canvas.getContext('2d', {willReadFrequently: true});
context.drawImage(picture, 0, 0);
const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
let drawn = 0, sum = 0;
for (let i = 3; i < pixels.length; i += 4) if (pixels[i] > 0) { ++drawn; sum = (sum * 31 + i) % 9007199254; }
return {share: 4 * drawn / pixels.length, sum};
"""


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    Page.folder = Path(folder.name)
    make_pages(Page.folder)
    Page.browser = headless_chromium(Page.folder / "profile")
    unittest.addModuleCleanup(Page.browser.quit)


def make_pages(folder):
    """survey: a park of four stations, one of another park, a file that is none. doubted: the same scans, where a link
    in no loop may not join."""
    def igsp(*arguments, code=0):
        run = subprocess.run([IGSP, *arguments], cwd=folder, capture_output=True, text=True)
        if run.returncode != code:
            raise RuntimeError(f"igsp {arguments}: {run.stdout}{run.stderr}")

    park = ["--points", "30000", "--station-distance", "8"]
    igsp("simulate", "park", "--out", "scans", "--stations", "4", "--seed", "3", *park)
    igsp("simulate", "park", "--out", "other", "--stations", "2", "--seed", "11", *park)
    shutil.copy(folder / "other/station_0.ply", folder / "scans/<b>other.ply")
    (folder / "scans/torn.ply").write_bytes(b"ply\n")
    (folder / "viewpoints.csv").write_text("scan,x,y,z\n" + "".join(f"station_{i},0,0,0\n" for i in range(4)))
    igsp("network", "scans", "-o", "survey", "--viewpoints", "viewpoints.csv", "--target-points", "3000", code=3)
    igsp("network", "scans/station_0.ply", "scans/station_1.ply", "-o", "doubted", "--target-points", "3000",
         "--min-unconfirmed-matches", "100000", code=1)


class Page(unittest.TestCase):
    def open(self, name):
        self.browser.get(f"file://{self.folder / name / 'report.html'}")
        self.addCleanup(lambda: self.assertEqual([e["message"] for e in self.browser.get_log("browser")], []))

    def find(self, name):
        return self.browser.find_element(By.ID, name)

    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def toggle(self, name):
        self.script("arguments[0].focus()", self.find(name))
        self.find(name).send_keys(Keys.SPACE)

    def links(self, name="survey"):
        with open(self.folder / name / "links.csv", newline="") as file:
            return list(csv.DictReader(file))

    def rows(self, table):
        return [[cell.text for cell in row.find_elements(By.TAG_NAME, "td")] for row in self.all(f"#{table} tr")[1:]]


class Survey(Page):
    def setUp(self):
        self.open("survey")

    def test_opens_and_asks_for_nothing_else(self):
        self.assertEqual(self.script("return performance.getEntriesByType('resource').length"), 0)
        self.assertEqual(self.find("verdict-word").text, "Not all scans in one frame")
        self.assertIn("registered 4 of 6 scans: 4 in one frame; 2 alone", self.find("verdict-title").text)
        self.assertIn("torn: ", self.find("warnings").text)

    def test_nothing_runs_but_the_page_itself(self):
        """Its content security policy: a script that came in later, by a name for example, is refused."""
        self.script("const late = document.createElement('script'); late.textContent = 'window.broken = true';"
                    "document.body.append(late)")
        self.assertIsNone(self.script("return window.broken || null"))
        refused = [entry["message"] for entry in self.browser.get_log("browser")]
        self.assertEqual(["script-src" in message for message in refused], [True], refused)

    def test_map_shows_stations_and_the_links_between_them(self):
        self.assertEqual(len(self.all("#map circle")), 4)
        self.assertEqual(sorted(text.text for text in self.all("#map text")), [f"station_{i}" for i in range(4)])
        states = [link["state"] for link in self.links()]
        for state in ("used", "unconfirmed"):
            self.assertEqual(len(self.all(f"#map line.{state}")), states.count(state))
        self.assertGreater(states.count("used"), 2)

    def test_stations_lie_on_the_map_as_they_stood(self):
        """Ratios of distances on the screen are those of the table's positions, seen from above: the park is level."""
        positions = [[float(x) for x in row[2].split(", ")] for row in self.rows("stations")
                     if row[0].startswith("station_")]
        drawn = [[float(circle.get_attribute(name)) for name in ("cx", "cy")] for circle in self.all("#map circle")]

        def apart(p, a, b):
            return ((p[a][0] - p[b][0]) ** 2 + (p[a][1] - p[b][1]) ** 2) ** 0.5

        scale = apart(drawn, 1, 0) / apart(positions, 1, 0)
        for a, b in ((2, 0), (3, 0), (3, 1)):
            self.assertAlmostEqual(apart(drawn, a, b) / scale / apart(positions, a, b), 1, delta=0.05)

    def test_points_are_drawn_and_can_be_hidden(self):
        self.assertGreater(self.script(DRAWN)["share"], 0.01)
        self.toggle("show-points")
        self.assertEqual(self.script(DRAWN)["share"], 0)
        self.toggle("show-names")
        self.assertEqual(self.all("#map text"), [])

    def test_another_direction_is_another_map(self):
        before = self.script(DRAWN)["sum"]
        self.script("const up = document.getElementById('up'); up.value = 'y'; up.dispatchEvent(new Event('change'))")
        self.assertNotEqual(self.script(DRAWN)["sum"], before)

    def test_click_and_keyboard_choose_a_link(self):
        lines = self.all("#map line")
        self.script("arguments[0].dispatchEvent(new MouseEvent('click', {bubbles: true}))", lines[0])
        said = self.find("link-text").text
        self.assertRegex(said, r"station_\d – station_\d: \w+")
        self.assertRegex(said, r"igsp align \S*scans/station_\d.ply \S*scans/station_\d.ply --voxel-size 0\.\d+ --html")
        self.assertEqual(len(self.all("tr.chosen")), 1)
        lines[1].send_keys(Keys.ENTER)
        self.assertNotEqual(self.find("link-text").text, said)
        self.assertEqual(len(self.all("line.chosen")), 1)

    def test_tables_hold_every_link_and_station(self):
        links = self.links()
        shown = [link for link in links if link["state"] != "not_registered"]
        self.assertEqual(len(self.rows("links")), len(shown))
        self.toggle("show-not_registered-rows")
        rows = self.rows("links")
        self.assertEqual(len(rows), len(links))
        confidences = sorted(f"{float(link['confidence']):.3f}" for link in links)
        self.assertEqual(sorted(row[3] for row in rows), confidences)
        stations = {row[0]: row for row in self.rows("stations")}
        self.assertEqual(set(stations), {"station_0", "station_1", "station_2", "station_3", "<b>other", "torn"})
        self.assertEqual(stations["station_0"][3], "0")
        self.assertGreater(float(stations["station_1"][3]), 0)
        self.assertNotEqual(stations["torn"][8], "")

    def test_a_title_sorts_its_column(self):
        self.script("document.querySelectorAll('#links th button')[4].click()")
        overlaps = [float(row[4].rstrip(" %")) for row in self.rows("links")]
        self.assertEqual(overlaps, sorted(overlaps, reverse=True))

    def test_nothing_is_wider_than_a_small_laptop_or_a_phone(self):
        self.addCleanup(self.browser.set_window_size, 1280, 900)
        for width in (1024, 520):
            self.browser.set_window_size(width, 800)
            self.assertLessEqual(*self.script("return [document.documentElement.scrollWidth, innerWidth]"))

    def test_dark_and_light(self):
        def back(name):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                         {"features": [{"name": "prefers-color-scheme", "value": name}]})
            return self.script("return getComputedStyle(document.body).backgroundColor")

        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})
        self.assertNotEqual(back("light"), back("dark"))


class Doubted(Page):
    def test_says_why_scans_stay_apart(self):
        self.open("doubted")
        self.assertEqual(self.find("verdict-word").text, "No scans in one frame")
        rows = self.rows("links")
        self.assertEqual(len(rows), 1)
        self.assertEqual(rows[0][2], "rejected")
        self.assertIn("too few to stand alone", rows[0][10])


if __name__ == "__main__":
    unittest.main()
