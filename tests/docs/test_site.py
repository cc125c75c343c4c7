"""The built documentation site in headless Chromium, opened from disk:
TRESS_SITE=build/docs/html python3 tests/docs/test_site.py

TRESS_PICTURES: a folder for screenshots. TRESS_EVERY_PAGE: set, the time of every page is measured,
not of PAGES alone. Exit codes: 0 all tests pass, 1 otherwise, 77 there is
no site."""
import base64
import os
import re
import sys
import unittest
from pathlib import Path

from browser import Browser, settled

ROOT = Path(__file__).resolve().parents[2]
SITE = Path(os.environ.get("TRESS_SITE", "build/docs/html")).resolve()
AXE = ROOT / "docs/site/node_modules/axe-core/axe.min.js"
PICTURES = os.environ.get("TRESS_PICTURES")
PAGES = ("index", "start/first_strand", "start/how_to_choose", "theory/rod", "theory/models/der", "theory/integrators",
         "theory/glossary", "results/hard_cases", "reference/scene_file", "reference/cpp/system")
WIDTHS = {"phone": 390, "desktop": 1400}
THEMES = ("light", "dark")
LONGEST_S = 2
EVERY_PAGE = bool(os.environ.get("TRESS_EVERY_PAGE"))

TYPESET = """return document.readyState === 'complete' && (!window.MathJax?.startup ||
  document.querySelectorAll('.math').length === 0 || document.querySelector('mjx-container') !== null)"""
SEEN = """return {
  wide: document.documentElement.scrollWidth,
  bad: document.querySelectorAll('mjx-merror, .problematic, .system-message').length,
  ground: getComputedStyle(document.body).backgroundColor,
  lost: [...document.images].filter((image) => image.complete && image.naturalWidth === 0).map(({ src }) => src),
}"""
RESULTS = "return [...document.querySelectorAll('#search-results li a')].map(({ href }) => href)"
VIOLATIONS = """return axe.run(document, { resultTypes: ['violations'], ...arguments[0] }).then(({ violations }) =>
  violations.map(({ id, nodes }) => id + ': ' + nodes.slice(0, 3).map(({ html }) => html.slice(0, 200)).join(' ')))"""


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browsers = {}
        for theme in THEMES:
            cls.browsers[theme] = Browser(dark=theme == "dark")
            cls.addClassCleanup(cls.browsers[theme].stop)

    def visit(self, page, theme="light", width=WIDTHS["desktop"]):
        """Opens a page of the site and waits for its mathematics."""
        browser = self.browsers[theme]
        browser.open(f"{SITE.as_uri()}/{page}", width)
        self.assertTrue(settled(lambda: browser.run(TYPESET)), f"{page}: its mathematics is not set")
        return browser

    def check_look(self, page, theme, name):
        self.browsers[theme].requests()
        browser = self.visit(f"{page}.html", theme, WIDTHS[name])
        seen = browser.run(SEEN)
        self.assertLessEqual(seen["wide"], WIDTHS[name], "width of the page")
        self.assertEqual(seen["bad"], 0, "mathematics or text that could not be set")
        self.assertEqual(seen["lost"], [])
        red = int(re.search(r"\d+", seen["ground"])[0])
        self.assertEqual(red < 128, theme == "dark", seen["ground"])
        self.assertEqual([url for url in browser.requests() if not re.match("(file|data|about):", url)], [])
        if PICTURES:
            folder = Path(PICTURES)
            folder.mkdir(parents=True, exist_ok=True)
            picture = browser.devtools("Page.captureScreenshot")["data"]
            (folder / f"{page.replace('/', '_')}_{name}_{theme}.png").write_bytes(base64.b64decode(picture))

    def test_pages_fit_a_phone_and_a_desktop_in_light_and_dark_without_a_network(self):
        # Each page on a phone and on a desktop, every other one light; the first both ways.
        for i, page in enumerate(PAGES):
            for j, name in enumerate(WIDTHS):
                for k, theme in enumerate(THEMES):
                    if i == 0 or (i + j + k) % 2 == 0:
                        with self.subTest(page=page, width=name, theme=theme):
                            self.check_look(page, theme, name)

    def test_the_search_finds_words_of_the_field_ids_and_keys(self):
        for words, page in (("gravito-bending", "theory/rod.html"), ("rattle", "theory/integrators.html"),
                            ("friction_law", "reference/scene_file.html")):
            with self.subTest(words=words):
                browser = self.visit(f"search.html?q={words}")
                self.assertTrue(settled(lambda: any(page in href for href in browser.run(RESULTS))),
                                f"{page} is not among the results")

    def test_the_button_of_the_theme_changes_it(self):
        browser = self.visit("index.html")
        theme = "return document.body.dataset.theme"
        first = browser.run(theme)
        browser.run("document.querySelector('.theme-toggle').click()")
        self.assertNotEqual(browser.run(theme), first)
        browser.run("localStorage.clear()")

    def test_a_page_takes_at_most_two_seconds_of_its_thread(self):
        # Processor time of the page's main thread, mathematics included: another load of the
        # machine does not lengthen it.
        browser = self.browsers["light"]
        browser.devtools("Performance.enable", timeDomain="threadTicks")
        every = sorted(SITE.rglob("*.html"))
        pages = every if EVERY_PAGE else [SITE / f"{page}.html" for page in PAGES]
        for page in (path.relative_to(SITE) for path in pages):
            if "_static" not in page.parts:
                with self.subTest(page=str(page)):
                    browser.open("about:blank")  # so that the page gets a process of its own
                    self.visit(page)
                    metrics = browser.devtools("Performance.getMetrics")["metrics"]
                    busy_s = {metric["name"]: metric["value"] for metric in metrics}["TaskDuration"]
                    self.assertTrue(0 < busy_s < LONGEST_S, f"{busy_s} s")

    @unittest.skipUnless(AXE.is_file(), "no axe-core: npm ci --prefix docs/site")
    def test_axe_has_no_complaints(self):
        # In the dark only colours differ.
        for theme, pages, rules in (("light", (*PAGES, "search"), {}),
                                    ("dark", ("index", "reference/cpp/system"), {"runOnly": ["color-contrast"]})):
            for page in pages:
                for width in WIDTHS.values():
                    with self.subTest(page=page, theme=theme, width=width):
                        browser = self.visit(f"{page}.html", theme, width)
                        browser.devtools("Runtime.evaluate", expression=AXE.read_text(encoding="utf-8"))
                        self.assertEqual(browser.run(VIOLATIONS, rules), [])


if __name__ == "__main__":
    if not (SITE / "index.html").is_file():
        print(f"no site in {SITE}: ./tress docs builds it", file=sys.stderr)
        sys.exit(77)
    unittest.main()
