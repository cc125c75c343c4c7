"""How pages are laid out for the documentation site, and how its links are checked:
python3 tests/docs/test_stage.py"""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs/site"))
import links  # noqa: E402
from stage import Stage  # noqa: E402


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def write(self, **files):
        for name, text in files.items():
            path = self.root / name.replace("__", "/").replace("_dot_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)


class Layout(Folder):
    def staged(self, a, extra=""):
        pages = f"index docs/index.md Home\n[Start]\nstart/a docs/a.md A\nstart/a/b docs/b.md B\n{extra}"
        self.write(docs__site__pages_dot_txt=pages, docs__index_dot_md="# Home\n", docs__a_dot_md=a,
                   docs__b_dot_md="# B\n", scenes__one_dot_toml="x = 1\n")
        problems = Stage(self.root, self.root / "out").run()
        return (self.root / "out/start/a.md").read_text(), problems

    def test_links_follow_pages_to_their_places(self):
        text, problems = self.staged("[b](b.md#top) [`b`](b.md) [home](index.md) ![p](../scenes/one.toml)\n")
        self.assertEqual(problems, [])
        self.assertTrue(text.startswith("[b](a/b.md#top) [`b`](a/b.md) [home](../index.md) "
                                        "![p](../files/scenes/one.toml)\n"), text)
        self.assertEqual((self.root / "out/files/scenes/one.toml").read_text(), "x = 1\n")

    def test_code_and_addresses_stay(self):
        plain = "`[b](b.md)` [far](https://example.org) [near](#top)\n```text\n[b](b.md)\n```\n"
        text, problems = self.staged(plain)
        self.assertEqual(problems, [])
        self.assertTrue(text.startswith(plain), text)

    def test_a_page_has_its_children_and_the_front_page_the_captions(self):
        text, _ = self.staged("# A\n")
        self.assertIn("B </start/a/b>", text)
        front = (self.root / "out/index.md").read_text()
        self.assertIn(":caption: Start\nA </start/a>\n```", front)

    def test_links_to_nothing_and_pages_without_a_place_are_problems(self):
        self.write(docs__lost_dot_md="# Lost\n")
        _, problems = self.staged("[x](none.md)\n", "start/c docs/c.md C\n")
        self.assertEqual(problems, ["docs/lost.md: has no place in docs/site/pages.txt",
                                    "docs/a.md: link to 'none.md', which is no file",
                                    "docs/site/pages.txt: no file docs/c.md"])

    def test_a_page_that_is_gone_leaves_the_site(self):
        self.write(out__old_dot_md="# Old\n")
        self.staged("# A\n")
        self.assertFalse((self.root / "out/old.md").exists())


class Links(Folder):
    def problems(self, body):
        self.write(site__a_dot_html=f"<h1 id='top'>A</h1>{body}", site__b_dot_html="<p id='here'>B</p>")
        return links.problems(self.root / "site")[0]

    def test_files_and_anchors_must_exist(self):
        self.assertEqual(self.problems("<a href='b.html#here'></a><a href='#top'></a><a href='https://x.org'></a>"), [])
        self.assertEqual(self.problems("<a href='c.html'></a><a href='b.html#gone'></a>"),
                         ["a.html: link to 'c.html', which is no file",
                          "a.html: link to 'b.html#gone', an anchor that does not exist"])

    def test_nothing_is_loaded_from_a_network(self):
        self.assertEqual(self.problems("<script src='https://x.org/a.js'></script>"),
                         ["a.html: loads https://x.org/a.js from a network"])


if __name__ == "__main__":
    unittest.main()
