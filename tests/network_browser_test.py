"""The page of a network in a real browser, headless Chromium. usage: network_browser_test.py IGSP [unittest arguments]"""
import base64
import csv
import json
import math
import os
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
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
let drawn = 0, sum = 0, colours = 0, blue = 0;
for (let i = 3; i < pixels.length; i += 4) {
  if (pixels[i] === 0) continue;
  ++drawn;
  sum = (sum * 31 + i) % 9007199254;
  if (pixels[i - 1] > pixels[i - 3]) ++blue;
  colours = (colours * 31 + pixels[i - 3] + 256 * pixels[i - 2]) % 9007199254;
}
return {share: 4 * drawn / pixels.length, sum, colours, blue: blue / drawn};
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


def world_points(scan):
    """What is drawn of a scan of the page's data."""
    numbers = base64.b64decode(scan["points_drawn"])
    local = struct.iter_unpack("<3f", numbers)
    moved = ([a + b for a, b in zip(scan["origin"], p, strict=True)] for p in local)
    rows = scan["world_from_scan"][:3]
    return [[row[3] + sum(a * b for a, b in zip(row[:3], p, strict=True)) for row in rows] for p in moved]


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
        return [[cell.text for cell in row.find_elements(By.TAG_NAME, "td")]
                for row in self.all(f"#{table} tr:not(.below)")[1:]]

    def titles(self, table):
        return [title.text for title in self.all(f"#{table} th")]

    def sort_by(self, table, title):
        """The cells of the column, after a click on its title."""
        column = self.titles(table).index(title)
        self.all(f"#{table} th button")[column].click()
        return [row[column] for row in self.rows(table)]

    def drawn(self):
        """What is in the canvas, once what changed is drawn."""
        self.browser.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => setTimeout(done))")
        return self.script(DRAWN)

    def choose(self, name, value):
        self.script("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('change'))",
                    self.find(name), value)

    def stations_drawn(self):
        self.drawn()
        return [[float(circle.get_attribute(name)) for name in ("cx", "cy")] for circle in self.all("#map circle")]

    def data(self):
        return json.loads(self.script("return document.getElementById('data').textContent"))


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
        drawn = self.stations_drawn()

        def apart(p, a, b):
            return ((p[a][0] - p[b][0]) ** 2 + (p[a][1] - p[b][1]) ** 2) ** 0.5

        scale = apart(drawn, 1, 0) / apart(positions, 1, 0)
        for a, b in ((2, 0), (3, 0), (3, 1)):
            self.assertAlmostEqual(apart(drawn, a, b) / scale / apart(positions, a, b), 1, delta=0.05)

    def test_points_are_drawn_and_can_be_hidden(self):
        self.assertGreater(self.drawn()["share"], 0.01)
        self.toggle("show-points")
        self.assertEqual(self.drawn()["share"], 0)
        self.toggle("show-names")
        self.assertEqual(self.all("#map text"), [])

    def test_another_direction_is_another_map(self):
        before = self.drawn()["sum"]
        self.choose("up", "y")
        self.assertNotEqual(self.drawn()["sum"], before)

    def stage(self):
        """All of it in view: places on it are told from its middle."""
        self.script("arguments[0].scrollIntoView({block: 'center'})", self.find("stage"))
        return self.find("stage")

    def drag(self, *moves, start=(-250, -60)):
        actions = ActionChains(self.browser, 50).move_to_element_with_offset(self.stage(), *start).click_and_hold()
        for move in moves:
            actions.move_by_offset(*move)
        actions.release().perform()

    def test_dragging_turns_the_map_and_a_button_turns_it_back(self):
        above, places = self.drawn(), self.stations_drawn()
        self.drag((40, -30), (40, -30))
        self.assertNotEqual(self.drawn()["sum"], above["sum"])
        self.assertNotEqual(self.stations_drawn(), places)
        self.all("[data-look=above]")[0].click()
        self.assertEqual(self.drawn(), above)
        self.assertEqual(self.stations_drawn(), places)

    def test_seen_from_the_side_a_level_park_is_flat(self):
        def height():
            heights = [y for _, y in self.stations_drawn()]
            return max(heights) - min(heights)

        above = height()
        for _ in range(12):  # of 7.5 degrees
            self.find("points").send_keys(Keys.ARROW_DOWN)
        self.assertLess(height(), above / 5)
        self.assertGreater(self.drawn()["share"], 0.002)

    def test_wheel_and_keys_zoom(self):
        def apart():
            (ax, ay), (bx, by) = self.stations_drawn()[:2]
            return ((ax - bx) ** 2 + (ay - by) ** 2) ** 0.5

        stage, before, scrolled = self.stage(), apart(), self.script("return scrollY")
        ActionChains(self.browser).scroll_from_origin(ScrollOrigin.from_element(stage), 0, -100).perform()
        self.assertAlmostEqual(apart() / before, 1.15, places=6)
        self.assertEqual(self.script("return scrollY"), scrolled)
        self.find("points").send_keys("-")
        self.assertAlmostEqual(apart() / before, 1, places=6)

    def test_dragging_from_a_link_is_no_click(self):
        self.drawn()
        middle = self.script("""
            const stage = arguments[0].getBoundingClientRect();
            const middles = [...document.querySelectorAll('#map line')].map((line) => {
              const box = line.getBoundingClientRect();
              return [line, Math.round(box.x + box.width / 2), Math.round(box.y + box.height / 2)];
            });
            const [, x, y] = middles.find(([line, x, y]) => document.elementFromPoint(x, y) === line);
            return [x - stage.x - stage.width / 2, y - stage.y - stage.height / 2];""", self.stage())
        self.drag((30, -30), (-30, 30), start=middle)  # there and back, onto the link
        self.assertEqual(self.all(".chosen"), [])
        self.all("[data-look=above]")[0].click()
        self.drawn()
        ActionChains(self.browser).move_to_element_with_offset(self.stage(), *middle).click().perform()
        self.assertEqual(len(self.all("line.chosen")), 1)

    def test_colours_by_distance(self):
        by_station = self.drawn()
        self.assertFalse(self.find("scale").is_displayed())
        self.choose("colour", "distance")
        by_distance = self.drawn()
        self.assertEqual(by_distance["sum"], by_station["sum"])
        self.assertNotEqual(by_distance["colours"], by_station["colours"])
        self.assertGreater(by_distance["blue"], 0.6)  # of near points; the others are leaves
        farthest = self.data()["farthest_coloured"]
        self.assertIn(f"{farthest:.3g} units or more", self.find("scale").text)
        self.assertIn("along the normal", self.find("map-note").text)
        self.choose("colour", "station")
        self.assertEqual(self.drawn(), by_station)

    def test_distances_are_those_to_the_other_scans(self):
        """All voxels of so small scans are drawn: a point has a distance where one of another scan of its frame is
        within reach, and along a normal that is no longer than to the point, mostly far shorter."""
        data, shares = self.data(), []
        clouds = [(scan["component"], world_points(scan), base64.b64decode(scan["distances_drawn"] or ""))
                  for scan in data["scans"]]
        for frame, points, distances in clouds:
            self.assertEqual(len(points), len(distances))
            others = [q for other in clouds if other[0] == frame and other[1] is not points for q in other[1]]
            for p, step in list(zip(points, distances, strict=True))[::40]:
                nearest = min((math.dist(p, q) for q in others), default=math.inf)
                if abs(nearest / data["neighbour_reach"] - 1) < 1e-3:
                    continue
                self.assertEqual(step == 255, nearest > data["neighbour_reach"])
                distance = step / 254 * data["farthest_coloured"]
                self.assertTrue(step == 255 or distance <= nearest + data["farthest_coloured"] / 254)
                shares += [distance / nearest] if step < 254 else []
        self.assertGreater(len(shares), 100)
        self.assertLess(statistics.median(shares), 0.5)

    def test_the_chosen_pair_alone(self):
        self.assertFalse(self.find("pair-only").is_enabled())
        self.all("#links tr.used td")[0].click()
        everything = self.drawn()
        self.toggle("pair-only")
        pair = self.drawn()
        self.assertLess(pair["share"], everything["share"])
        self.assertGreater(pair["share"], 0)
        self.assertEqual(len(self.all("#map line.chosen")), 1)

    def test_click_and_keyboard_choose_a_link(self):
        lines = self.all("#map line")
        self.script("arguments[0].dispatchEvent(new MouseEvent('click', {bubbles: true}))", lines[0])
        said = self.find("link-text").text
        self.assertRegex(said, r"station_\d – station_\d: \w+")
        self.assertRegex(said, r"igsp align \S*scans/station_\d.ply \S*scans/station_\d.ply --voxel-size 0\.\d+ --html")
        self.assertEqual(len(self.all("tr.chosen:not(.below)")), 1)
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
        for title in ("Overlap", "Median", "RMS", "Cycle error"):
            numbers = [float(text.rstrip(" %").replace("–", "0")) for text in self.sort_by("links", title)]
            self.assertGreater(len(set(numbers)), 1, title)
            self.assertEqual(numbers, sorted(numbers, reverse=True), title)
        weakest = [max(map(float, text.split(", "))) for text in self.sort_by("links", "Sigma x, y, z [1/1000]")]
        self.assertEqual(weakest, sorted(weakest, reverse=True))
        self.assertGreater(weakest[-1], 0)

    def test_links_say_how_far_the_clouds_lie_apart(self):
        median, rms, cycle = map(self.titles("links").index, ("Median", "RMS", "Cycle error"))
        of = {(link["source"], link["target"]): link for link in self.links()}
        rows = [row for row in self.rows("links") if row[2] == "used"]
        self.assertGreater(len(rows), 2)
        for row in rows:
            link = of[f"scans/{row[0]}.ply", f"scans/{row[1]}.ply"]
            for column, name in ((median, "median_distance"), (rms, "rms_distance"), (cycle, "cycle_error")):
                self.assertAlmostEqual(float(row[column]) / float(link[name]), 1, delta=0.06, msg=name)

    def test_loops_and_contradictions_are_listed(self):
        network = json.loads((self.folder / "survey/network.json").read_text())
        errors = [float(text) for text in self.sort_by("loops", "Error [sigmas]")]
        self.assertGreater(len(errors), 0)
        self.assertEqual(len(errors), len(network["cycles"]))
        self.assertAlmostEqual(errors[0] / max(cycle["error"] for cycle in network["cycles"]), 1, delta=0.06)
        opened = sum(not cycle["closes"] for cycle in network["cycles"])
        self.assertIn("not close" if opened else "close", self.find("loops-text").text)
        self.assertEqual(len(self.rows("contradictions")), len(network["contradictions"]))
        said = "^None: " if not network["contradictions"] else r"^\d+ pair"
        self.assertRegex(self.find("contradictions-text").text, said)

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
        self.assertIn("too few to stand alone", self.all("#links .below")[0].text)
        self.assertIn("No three scans", self.find("loops-text").text)
        self.assertIn("Not known", self.find("contradictions-text").text)


if __name__ == "__main__":
    unittest.main()
