"""Checks a built site: every link leads to a file and to an anchor that exist, and no page
loads anything from a network."""
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

LOADED = {"script": "src", "img": "src", "iframe": "src", "link": "href"}


class Links(HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.links, self.loaded = set(), [], []

    def handle_starttag(self, tag, attributes):
        of = dict(attributes)
        self.ids.update(of[key] for key in ("id", "name") if of.get(key))
        if tag == "a" and of.get("href"):
            self.links.append(of["href"])
        source = of.get(LOADED.get(tag, ""))
        if source:
            self.loaded.append(source)


def read(path):
    links = Links()
    links.feed(path.read_text(encoding="utf-8", errors="replace"))
    return links


def is_address(href):
    return "://" in href or href.startswith(("mailto:", "//"))


def problems(site):
    """Returns a line for each broken link and each thing loaded from a network."""
    site = Path(site)
    pages = {path.resolve(): read(path) for path in sorted(site.rglob("*.html"))
             if "_static" not in path.relative_to(site).parts}
    found = []
    for path, page in pages.items():
        name = path.relative_to(site.resolve())
        found += [f"{name}: loads {source} from a network" for source in page.loaded if is_address(source)]
        for href in page.links + page.loaded:
            if is_address(href) or href.startswith(("data:", "javascript:")):
                continue
            where, _, anchor = href.partition("#")
            target = (path.parent / unquote(where.partition("?")[0])).resolve() if where else path
            if not target.is_file():
                found.append(f"{name}: link to '{href}', which is no file")
            elif anchor and target in pages and unquote(anchor) not in pages[target].ids:
                found.append(f"{name}: link to '{href}', an anchor that does not exist")
    return found, len(pages)
