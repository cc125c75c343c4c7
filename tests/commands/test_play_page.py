"""The page of ./tress play in headless Chromium. TRESS_PICTURES: a folder for screenshots."""

import base64
import os
import sys
import tempfile
import unittest
from pathlib import Path

from test_play import PROGRAM, ROOT, SCENE, Play, series_of

sys.path.insert(0, str(ROOT / "tests/docs"))
from browser import Browser, settled  # noqa: E402

PICTURES = os.environ.get("TRESS_PICTURES")
WIDTHS = {"phone": 390, "desktop": 1400}
READY = "return document.documentElement.dataset.ready === 'yes'"
STATUS = "return document.getElementById('live-status').textContent"
# A place of the page on the strand: the darkest of a column of the picture.
ON_STRAND = """const canvas = document.getElementById('scene-canvas');
  const box = canvas.getBoundingClientRect();
  const x = Math.round(0.65 * canvas.width);
  const { data } = canvas.getContext('2d').getImageData(x, 5, 1, canvas.height - 60);
  let best = 0;
  for (let y = 0; y < data.length / 4; ++y) if (data[4 * y + 3] > data[4 * best + 3]) best = y;
  return [box.left + x, box.top + 5 + best, data[4 * best + 3]];"""


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        scene = Path(folder.name) / "live.toml"
        scene.write_text(SCENE.replace("gravity_m_s2 = [0, 0, 0]", "gravity_m_s2 = [0, 0, -9.81]"))
        cls.play = Play(scene)
        cls.addClassCleanup(cls.play.end)
        cls.browsers = {}
        for theme in ("light", "dark"):
            cls.browsers[theme] = Browser(dark=theme == "dark")
            cls.addClassCleanup(cls.browsers[theme].stop)

    def visit(self, theme="light", width=WIDTHS["desktop"]):
        self.play.do(do="restart")
        browser = self.browsers[theme]
        browser.open(f"http://127.0.0.1:{self.play.port}/{self.play.token}/", width)
        self.assertTrue(settled(lambda: browser.run(READY)), "no picture came")
        return browser

    def press(self, browser, key):
        browser.command("/actions", actions=[{"type": "key", "id": "keyboard", "actions": [
            {"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]}])

    def steps(self):
        return self.play.state()["steps"]

    def test_keys_run_pause_step_and_restart(self):
        browser = self.visit()
        self.press(browser, ".")
        self.assertTrue(settled(lambda: self.steps() == 1))
        self.press(browser, " ")
        self.assertTrue(settled(lambda: self.steps() > 10))
        self.press(browser, " ")
        self.assertTrue(settled(lambda: browser.run(STATUS) == "paused"))
        self.press(browser, "r")
        self.assertTrue(settled(lambda: self.steps() == 0))

    def test_the_mouse_pulls_the_strand(self):
        browser = self.visit()
        browser.run("document.querySelector('[data-view=front]').click()")
        self.assertTrue(settled(lambda: browser.run(ON_STRAND)[2] > 0))
        *middle, _ = browser.run(ON_STRAND)

        def pointer(*actions):
            browser.command("/actions", actions=[
                {"type": "pointer", "id": "mouse", "actions": list(actions)}])

        def move(x, y):
            return {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 50}

        pointer(move(*middle), {"type": "pointerDown", "button": 0},
                move(middle[0], middle[1] - 80))
        self.assertTrue(settled(lambda: self.play.state()["pulled"]))
        height_before = series_of(self.play.state())["tip_z_m"]
        self.picture(browser, "pull")
        self.press(browser, " ")
        self.assertTrue(settled(
            lambda: series_of(self.play.state())["tip_z_m"] > height_before + 1e-3))
        self.picture(browser, "pulled")
        pointer({"type": "pointerUp", "button": 0})
        self.assertTrue(settled(lambda: not self.play.state()["pulled"]))
        self.press(browser, " ")

    def test_a_parameter_is_set_and_a_refusal_is_shown(self):
        browser = self.visit()
        fill = """for (const [id, text] of [['key', arguments[0]], ['value', arguments[1]]])
          document.getElementById('live-' + id).value = text;
          document.querySelector('#live-change button').click();"""
        browser.run(fill, "material.youngs_modulus_pa", "1e9")
        self.assertTrue(settled(
            lambda: self.play.state()["keys"]["material.youngs_modulus_pa"] == 1e9))
        browser.run(fill, "strand.length_m", "-1")
        self.assertTrue(settled(lambda: browser.run(STATUS).startswith("refused: ")))

    def test_it_fits_phone_and_desktop_in_both_themes(self):
        for theme in self.browsers:
            for name, width in WIDTHS.items():
                browser = self.visit(theme, width)
                wide = browser.run("return document.documentElement.scrollWidth")
                self.assertLessEqual(wide, width, f"{theme} {name}")
                own = f"http://127.0.0.1:{self.play.port}/"
                asked = [url for url in browser.requests() if url.startswith("http")]
                self.assertEqual([url for url in asked if not url.startswith(own)], [])
                self.picture(browser, f"{theme}_{name}")
                browser.command("/url", url="about:blank")

    def picture(self, browser, name):
        if PICTURES:
            data = browser.devtools("Page.captureScreenshot")["data"]
            Path(PICTURES, f"play_{name}.png").write_bytes(base64.b64decode(data))


if __name__ == "__main__":
    if not PROGRAM.exists():
        sys.exit(77)
    unittest.main()
