"""Lays out the sources of the documentation site: the pages that pages.txt names, at their
places in the site, with links rewritten to those places."""
import os
import re
import shutil
from pathlib import Path

from generated import with_parts

# A block of code, a link (whose label may have code in it), or code in a line.
TOKEN = re.compile(
    r"^[ ]*```.*?^[ ]*```[ ]*$"
    r"|(?P<picture>!?)\[(?P<label>(?:[^\[\]]|\[[^\]]*\])*)\]\((?P<href>[^)\s]+)\)"
    r"|`[^`\n]+`",
    re.S | re.M)


class Page:
    def __init__(self, place, source, title, caption):
        self.place, self.source, self.title, self.caption = place, source, title, caption
        self.children = []


def read_pages(table):
    """Returns the pages of pages.txt, by source, and the problems of the table."""
    pages, problems, caption = {}, [], None
    for number, line in enumerate(table.read_text().splitlines(), 1):
        line = line.split("#", 1)[0].strip()
        if not line:
            continue
        if line.startswith("["):
            caption = line.strip("[]")
            continue
        words = line.split(None, 2)
        if len(words) != 3:
            problems.append(f"{table}:{number}: expected: place, source and title")
            continue
        pages[words[1]] = Page(words[0], words[1], words[2], caption)
    by_place = {page.place: page for page in pages.values()}
    for page in pages.values():
        parents = [str(folder) for folder in Path(page.place).parents if str(folder) in by_place]
        if parents:
            by_place[parents[0]].children.append(page)
    return pages, problems


def unlisted(root, pages):
    """Returns the Markdown files of the repository that are meant for readers and have no place."""
    found = {path for pattern in ("*.md", "docs/**/*.md", "experiments/**/*.md", "results/*.md", "scenes/*.md")
             for path in root.glob(pattern)}
    hidden = {"node_modules", "templates"}
    names = (path.relative_to(root) for path in found if not hidden & set(path.parts))
    return sorted(str(name) for name in names if str(name) not in pages)


def toctree(pages, caption=None):
    head = ":hidden:\n" + (f":caption: {caption}\n" if caption else "")
    return "\n```{toctree}\n" + head + "\n".join(f"{page.title} </{page.place}>" for page in pages) + "\n```\n"


def toctrees(page, pages):
    """Returns the navigation below a page: the captions on the front page, else its children."""
    if page.place != "index":
        return toctree(page.children) if page.children else ""
    children = {child.place for other in pages.values() for child in other.children}
    captions = dict.fromkeys(other.caption for other in pages.values() if other.caption)
    return "".join(
        toctree([other for other in pages.values() if other.caption == caption and other.place not in children],
                caption)
        for caption in captions)


class Stage:
    def __init__(self, root, out):
        self.root, self.out = root, out
        self.pages, self.problems = read_pages(root / "docs/site/pages.txt")
        self.problems += [f"{name}: has no place in docs/site/pages.txt" for name in unlisted(root, self.pages)]
        self.written = set()

    def put(self, name, content):
        """Writes a staged file where it is not as it should be, so that Sphinx rebuilds little."""
        target = self.out / name
        self.written.add(target)
        if target.exists() and target.read_bytes() == content:
            return
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)

    def place_of(self, path):
        """Returns where a file of the repository lies in the site; None: nowhere."""
        name = os.path.relpath(path, self.root)
        if path.is_dir() and f"{name}/README.md" in self.pages:
            name += "/README.md"
        if name in self.pages:
            return self.pages[name].place + ".md"
        if not path.is_file() or name.startswith(".."):
            return None
        self.put(f"files/{name}", path.read_bytes())
        return f"files/{name}"

    def rewritten(self, page, match):
        picture, label, href = match.group("picture", "label", "href")
        if href is None or re.match(r"[a-z]+:|#", href):
            return match.group(0)
        path, _, anchor = href.partition("#")
        target = Path(os.path.normpath(self.root / Path(page.source).parent / path))
        if not target.exists():
            self.problems.append(f"{page.source}: link to '{href}', which is no file")
            return match.group(0)
        place = self.place_of(target)
        if place is None:  # a folder without a page
            return label
        link = os.path.relpath(place, Path(page.place).parent)
        return f"{picture}[{label}]({link}{'#' + anchor if anchor else ''})"

    def text(self, page):
        text = with_parts(self.root, (self.root / page.source).read_text())
        return TOKEN.sub(lambda match: self.rewritten(page, match), text) + toctrees(page, self.pages)

    def run(self):
        """Stages every page and returns the problems found."""
        for page in self.pages.values():
            if (self.root / page.source).is_file():
                self.put(f"{page.place}.md", self.text(page).encode())
            else:
                self.problems.append(f"docs/site/pages.txt: no file {page.source}")
        if self.out.exists():
            for path in sorted(self.out.rglob("*"), reverse=True):
                if path.is_file() and path not in self.written:
                    path.unlink()
                elif path.is_dir() and not any(path.iterdir()):
                    shutil.rmtree(path)
        return self.problems
