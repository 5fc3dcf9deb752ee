"""The report page in a real browser, headless Chromium. usage: report_browser_test.py IGSP [unittest arguments]"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from headless_chromium import headless_chromium

IGSP = os.path.abspath(sys.argv.pop(1))

# What the picture holds: which share of its pixels differs from the background (the top right corner, where no label or
# cloud is), how many look like the source, the target, or grey, and checksums of all colours and of what is drawn
# where. `from` and `to` are shares of the width.
PIXELS = """
const [from, to] = arguments;
const picture = document.getElementById('picture');
const copy = document.createElement('canvas');
copy.width = picture.width; copy.height = picture.height;
const context = copy.getContext('2d', {willReadFrequently: true});
context.drawImage(picture, 0, 0);
const left = Math.round(from * copy.width), width = Math.round(to * copy.width) - left;
const pixels = context.getImageData(left, 0, width, copy.height).data;
const back = context.getImageData(copy.width - 2, 2, 1, 1).data;
let drawn = 0, red = 0, blue = 0, grey = 0, sum = 0, shape = 0;
for (let i = 0; i < pixels.length; i += 4) {
  const r = pixels[i], g = pixels[i + 1], b = pixels[i + 2];
  sum = (sum * 31 + r * 65536 + g * 256 + b) % 9007199254;
  if (r === back[0] && g === back[1] && b === back[2]) continue;
  ++drawn;
  shape = (shape * 31 + i) % 9007199254;
  if (r > b + 40 && r > g + 40) ++red;
  if (b > r + 20) ++blue;
  if (Math.max(r, g, b) - Math.min(r, g, b) < 14) ++grey;
}
return {drawn: drawn / (pixels.length / 4), red, blue, grey, sum, shape};
"""

WITHOUT_WEBGL = """
const original = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function(kind, ...more) {
  return /webgl/.test(kind) ? null : original.call(this, kind, ...more);
};
"""

SCRIPT_NAME = "<img src=x onerror=\"document.title='broken'\"><script>document.title='broken'<"  # no slash in a name
INTRUDERS = """<script>window.broken = 'script'</script><img src=x onerror="window.broken = 'handler'">
<style>body {display: none}</style><a id=link href="javascript:window.broken='link'">link</a>
<base href="https://example.org/"><iframe srcdoc="<script>parent.broken = 'frame'</script>"></iframe>"""


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    PageTest.folder = Path(folder.name)
    PageTest.browser = headless_chromium(PageTest.folder / "profile")
    unittest.addModuleCleanup(PageTest.browser.quit)
    make_pages(PageTest.folder)


def make_pages(folder):
    """park.html, registered; streamed.html, of clouds too large to keep; runner_up.html, with one; line.html,
    without an estimate; far.html, of a source far away."""
    def igsp(*arguments, codes=(0,)):
        run = subprocess.run([IGSP, *arguments], cwd=folder, capture_output=True, text=True)
        if run.returncode not in codes:
            raise RuntimeError(f"igsp {arguments}: {run.stdout}{run.stderr}")

    igsp("simulate", "park", "--out", ".", "--points", "60000")
    igsp("align", "station_1.ply", "station_0.ply", "--html", "park.html", "--report", "park.json")
    igsp("align", "station_1.ply", "station_0.ply", "--html", "streamed.html", "--max-points", "20000")
    # No scene here has a rival: the park with one that lies 2 m beside it.
    run = json.loads((folder / "park.json").read_text())
    beside = np.array(run["target_from_source"])
    beside[0, 3] += 2
    run["runner_up"] = {"target_from_source": beside.tolist(), "share": 0.25}
    (folder / "runner_up.json").write_text(json.dumps(run))
    igsp("report", "runner_up.json", "-o", "runner_up.html")
    # A file's name that is a script wherever it would be taken as a part of the page.
    shutil.copy(folder / "station_1.ply", folder / SCRIPT_NAME)
    igsp("align", SCRIPT_NAME, "station_0.ply", "--html", "script.html")
    # As if something had got into the page in spite of all.
    page = (folder / "park.html").read_text()
    (folder / "changed.html").write_text(page.replace("</main>", INTRUDERS + "</main>", 1))
    np.savetxt(folder / "line.xyz", np.linspace([0, 0, 0], [10, 0, 0], 500))
    igsp("align", "line.xyz", "line.xyz", "--html", "line.html", codes=(1,))
    np.savetxt(folder / "far.xyz", np.random.default_rng(0).uniform(0, 10, (5000, 3)) + [500_000, 5_000_000, 0])
    igsp("align", "far.xyz", "station_0.ply", "--html", "far.html", codes=(0, 1))


class PageTest(unittest.TestCase):
    def open(self, name):
        self.browser.get(f"file://{self.folder / name}")
        self.addCleanup(self.check_console)

    def check_console(self):
        """Nothing but Chromium's own remarks on the speed of reading pixels back."""
        said = [entry["message"] for entry in self.browser.get_log("browser")]
        self.assertEqual([message for message in said if "GPU stall due to ReadPixels" not in message], [])

    def find(self, name):
        return self.browser.find_element(By.ID, name)

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def pixels(self, begin=0.0, end=1.0):
        self.wait_for_frames()
        return self.script(PIXELS, begin, end)

    def wait_for_frames(self):
        """Events are handled, and what changed is drawn, in the next frame or the one after it."""
        self.browser.execute_async_script(
            "const done = arguments[0], next = requestAnimationFrame; next(() => next(() => next(done)))")

    def press(self, name, *keys):
        self.script("arguments[0].focus()", self.find(name))
        self.find(name).send_keys(*keys)

    def toggle(self, name):
        self.press(name, Keys.SPACE)


class Hostile(PageTest):
    def test_a_file_name_stays_a_name(self):
        self.open("script.html")
        self.assertIn(SCRIPT_NAME, self.browser.title)
        self.assertIn("Registered", self.find("verdict-word").text)
        self.assertEqual(self.script("return document.images.length"), 0)

    def test_nothing_runs_but_the_page_itself(self):
        """Its content security policy: neither scripts, handlers, styles, frames nor requests that came in later."""
        self.browser.get(f"file://{self.folder / 'changed.html'}")
        self.script("document.getElementById('link').click()")
        self.assertIn("Registered", self.find("verdict-word").text)
        self.assertIsNone(self.script("return window.broken || null"))
        self.assertTrue(self.find("picture").is_displayed())
        self.assertTrue(self.script("return document.baseURI").startswith("file:"))
        refused = [entry["message"] for entry in self.browser.get_log("browser")]
        for directive in ("script-src", "style-src", "base-uri"):
            self.assertTrue([message for message in refused if directive in message], (directive, refused))


class Registered(PageTest):
    def setUp(self):
        self.open("park.html")
        self.toggle("compare")  # one picture, unless a test is about two

    def test_it_opens_and_asks_for_nothing_else(self):
        self.assertEqual(self.script("return performance.getEntriesByType('resource').length"), 0)
        self.assertIn("Registered: station_1.ply onto station_0.ply", self.browser.title)
        self.assertIn("Registered", self.find("verdict-word").text)
        self.assertRegex(self.find("verdict-text").text, r"confidence (9\d\.\d|above 99\.9) %\.")
        self.assertIn("mutual matches agree", self.find("reason").text)
        self.assertFalse(self.find("diagnosis").is_displayed())

    def test_the_picture_shows_both_clouds(self):
        pixels = self.pixels()
        self.assertGreater(pixels["drawn"], 0.03)
        self.assertGreater(pixels["red"], 2000)
        self.assertGreater(pixels["blue"], 2000)

    def test_the_slider_walks_with_the_keyboard_and_changes_the_picture(self):
        last = self.find("step").get_attribute("max")
        self.assertEqual(self.find("step").get_attribute("value"), last)
        self.assertIn("Final pose", self.find("step-text").text)
        final = self.pixels()
        self.press("step", Keys.ARROW_LEFT)
        self.assertEqual(int(self.find("step").get_attribute("value")), int(last) - 1)
        self.assertRegex(self.find("step-text").text, r"Iteration \d+: \d+ matched keypoints, .* Energy ")
        iteration = self.pixels()
        self.press("step", Keys.HOME)
        self.assertIn("As given", self.find("step-text").text)
        given = self.pixels()
        self.assertEqual(len({final["sum"], iteration["sum"], given["sum"]}), 3)
        self.press("step", Keys.END)
        self.assertEqual(self.pixels(), final)

    def test_the_source_moves_and_the_target_stays(self):
        self.toggle("show-matches")
        self.press("picture", Keys.ARROW_LEFT)  # from now on the camera stays where it is

        def at_both_ends():
            seen = []
            for key in (Keys.HOME, Keys.END):
                self.press("step", key)
                seen.append(self.pixels()["shape"])  # the shading turns with the source
            return seen

        self.toggle("show-target")
        given, final = at_both_ends()
        self.assertNotEqual(given, final)
        self.toggle("show-target")
        self.toggle("show-source")
        given, final = at_both_ends()
        self.assertEqual(given, final)

    def test_play_goes_from_the_start_to_the_end(self):
        self.script("window.seen = []; document.getElementById('step-text').textContent = '';"
                    "new MutationObserver(() => seen.push(document.getElementById('step').value))"
                    ".observe(document.getElementById('step-text'), {childList: true})")
        self.press("play", Keys.SPACE)
        last = int(self.find("step").get_attribute("max"))
        self.browser.set_script_timeout(120)
        self.browser.execute_async_script(
            "const done = arguments[0]; const wait = () => document.getElementById('play').textContent === 'Play' "
            "? done() : setTimeout(wait, 50); wait();")
        self.assertEqual(self.script("return [...new Set(seen.map(Number))]"), list(range(last + 1)))

    def test_clouds_and_lines_can_be_hidden(self):
        both = self.pixels()
        self.toggle("show-source")
        self.toggle("show-matches")
        self.assertEqual(self.pixels()["red"], 0)
        self.assertGreater(self.pixels()["blue"], both["blue"])
        self.toggle("show-target")
        self.assertEqual(self.pixels()["drawn"], 0)
        self.toggle("show-matches")
        lines = self.pixels()
        self.assertGreater(lines["drawn"], 0)
        self.press("step", Keys.HOME)
        self.assertGreater(self.pixels()["drawn"], 2 * lines["drawn"])  # from end to end of the scene
        for name in ["show-source", "show-target"]:
            self.toggle(name)
        self.press("step", Keys.END)
        self.assertEqual(self.pixels(), both)

    def test_distances_have_a_scale_and_what_does_not_overlap_is_grey(self):
        self.assertFalse(self.find("scale").is_displayed())
        self.toggle("show-matches")
        self.toggle("by-distance")
        self.assertTrue(self.find("scale").is_displayed())
        self.assertIn("units", self.find("scale-far").text)
        self.toggle("show-target")
        near = self.pixels()
        self.assertGreater(near["blue"], 2000)
        self.press("step", Keys.HOME)
        far = self.pixels()
        self.assertLess(near["grey"] / near["drawn"], 0.5 * far["grey"] / far["drawn"])

    def test_contradicted_points_are_marked_where_viewpoints_are_known(self):
        self.toggle("compare")
        self.toggle("show-matches")
        self.press("step", Keys.HOME)
        plain = self.pixels()
        self.toggle("show-contradicting")
        marked = self.pixels()  # magenta is neither the red of the source nor the blue of the target
        self.assertLess(marked["red"], 0.98 * plain["red"])
        self.toggle("show-contradicting")
        self.assertEqual(self.pixels()["sum"], plain["sum"])
        self.open("line.html")
        self.assertFalse(self.find("contradicting-group").is_displayed())

    def test_before_and_after_beside_each_other(self):
        self.toggle("compare")
        self.assertEqual(self.find("before-label").text, "As given")
        left, right = self.pixels(0, 0.5), self.pixels(0.5, 1)
        for half in (left, right):
            self.assertGreater(half["red"], 1000)
            self.assertGreater(half["blue"], 1000)
        self.press("step", Keys.HOME)
        given = [self.pixels(0, 0.5), self.pixels(0.5, 1)]
        for name in ("red", "blue"):  # now the same twice, up to the rounding of places to pixels
            self.assertAlmostEqual(given[0][name] / given[1][name], 1, delta=0.02)
            self.assertGreater(abs(left[name] / right[name] - 1), 0.02)

    def test_the_picture_turns_with_mouse_wheel_and_keys(self):
        seen = [self.pixels()["sum"]]

        def changes():
            seen.append(self.pixels()["sum"])
            self.assertEqual(len(set(seen)), len(seen))

        picture = self.find("picture")
        self.script("arguments[0].scrollIntoView()", picture)
        ActionChains(self.browser).click_and_hold(picture).move_by_offset(80, 20).release().perform()
        changes()
        ActionChains(self.browser).scroll_from_origin(ScrollOrigin.from_element(picture), 0, -200).perform()
        changes()
        for key in [Keys.ARROW_LEFT, Keys.ARROW_UP, "+", "-" * 4]:
            self.press("picture", key)
            changes()
        for look in ["top", "front", "side"]:
            self.script("document.querySelector(`[data-look=${arguments[0]}]`).click()", look)
            changes()
        self.script("const up = document.getElementById('up'); up.value = 'y'; up.dispatchEvent(new Event('change'))")
        changes()
        self.script("document.querySelector('[data-look=oblique]').click();"
                    "const up = document.getElementById('up'); up.value = 'z'; up.dispatchEvent(new Event('change'))")
        self.assertEqual(self.pixels()["sum"], seen[0])

    def test_plots_are_drawn_and_a_click_moves_the_slider(self):
        drawn = self.script("""
          return [...document.querySelectorAll('.chart canvas, .chart > div > canvas')].map((canvas) => {
            const copy = document.createElement('canvas');
            copy.width = canvas.width; copy.height = canvas.height;
            const context = copy.getContext('2d', {willReadFrequently: true});
            context.drawImage(canvas, 0, 0);
            const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
            return pixels.filter((value, i) => i % 4 === 3 && value > 0).length;
          });""")
        self.assertEqual(len(drawn), 7)  # the histogram and six over the iterations
        self.assertGreater(min(drawn), 1000)
        titles = [heading.text for heading in self.browser.find_elements(By.CSS_SELECTOR, "#charts h3")]
        self.assertEqual(titles, ["Weights", "Mismatch threshold T_cd", "Matches", "Energy", "Residuals", "Step sizes"])
        canvas = self.browser.find_element(By.CSS_SELECTOR, "#charts canvas")
        self.script("arguments[0].scrollIntoView({block: 'center'})", canvas)
        ActionChains(self.browser).move_to_element(canvas).click().perform()
        self.wait_for_frames()
        step, last = (int(self.find("step").get_attribute(name)) for name in ("value", "max"))
        self.assertTrue(1 < step < last - 1, step)

    def test_numbers_of_points_are_said(self):
        note = self.find("picture-note").text
        self.assertRegex(note, r"Drawn: all [\d,]+ points of the source and all [\d,]+ points of the target\.")
        self.assertIn("units (2.5 voxels)", self.find("histogram-note").text)

    def test_nothing_is_wider_than_a_small_laptop_or_a_phone(self):
        self.addCleanup(self.browser.set_window_size, 1280, 900)
        for width in (1280, 1024, 520):
            self.browser.set_window_size(width, 800)
            self.wait_for_frames()
            self.assertLessEqual(*self.script("return [document.documentElement.scrollWidth, innerWidth]"))

    def test_dark_and_light(self):
        def scheme(name):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                         {"features": [{"name": "prefers-color-scheme", "value": name}]})
            self.wait_for_frames()  # the change is an event, too
            return self.script("return getComputedStyle(document.body).backgroundColor"), self.pixels()["sum"]

        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})
        light, dark = scheme("light"), scheme("dark")
        self.assertNotEqual(light[0], dark[0])
        self.assertNotEqual(light[1], dark[1])


class Others(PageTest):
    def test_without_an_estimate_there_is_still_a_page(self):
        self.open("line.html")
        self.assertIn("Not registered", self.find("verdict-word").text)
        self.assertIn("No transformation was found", self.find("verdict-text").text)
        self.assertFalse(self.find("step").is_enabled())
        self.assertFalse(self.find("loop").is_displayed())
        self.assertGreater(self.pixels()["drawn"], 0)

    def test_it_names_the_cause_of_the_refusal(self):
        self.open("line.html")
        self.assertTrue(self.find("diagnosis").is_displayed())
        self.assertIn("All points of both clouds lie on a line", self.find("diagnosis").text)

    def test_a_source_far_away_is_seen_beside_the_target_and_said_so(self):
        self.open("far.html")
        self.press("step", Keys.HOME)
        self.assertIn("Drawn beside the target", self.find("step-text").text)
        pixels = self.pixels()
        self.assertGreater(pixels["red"], 500)
        self.assertGreater(pixels["blue"], 500)

    def test_centroids_are_not_called_points(self):
        self.open("streamed.html")
        self.assertRegex(self.find("picture-note").text, r"Drawn: [\d,]+ centroids of small voxels instead of the "
                         r"[\d,]+ points of the source and .*, thinned for display")

    def test_the_runner_up_is_a_pose_to_look_at(self):
        self.open("runner_up.html")
        final = self.pixels()
        self.press("runner-up", Keys.SPACE)
        self.assertIn("Runner-up: the best other pose", self.find("step-text").text)
        self.assertNotEqual(self.pixels()["sum"], final["sum"])
        self.press("runner-up", Keys.SPACE)
        self.assertEqual(self.pixels(), final)
        self.assertIn("25 %", self.find("evidence").text)

    def test_a_browser_without_webgl_shows_the_rest(self):
        script = self.browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": WITHOUT_WEBGL})
        self.addCleanup(self.browser.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", script)
        self.browser.get(f"file://{self.folder / 'park.html'}")
        self.assertTrue(self.find("no-picture").is_displayed())
        self.press("step", Keys.HOME)
        self.assertIn("As given", self.find("step-text").text)
        self.assertIn("mutual matches agree", self.find("reason").text)
        self.browser.get_log("browser")  # three.js says what is missing


if __name__ == "__main__":
    unittest.main()
