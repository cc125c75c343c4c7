"""Sources that headers, catalogues, tests, scenes and pages of theory cite."""
import re
import unicodedata

from .tables import InputError, read_table
from .words import table

_FOLDERS = ["math", "contract", "linear", "models", "integrators", "simulation", "experiments"]
_PUBLISHED = "results/other_simulators_published.csv"  # its column cited_as
_BIBLIOGRAPHY = "docs/templates/references.txt"
_YEAR = r"(?:1[6-9]|20)[0-9][0-9]"
_LETTER = r"[^\W\d_]"
_NAME = r"(?:(?:van der|von|de|den) )?[A-Z]"  # the start of an author's surname


def _files(root):
    """Yields headers, sources, scenes, the report's programs and pages of theory, relative to the repository."""
    def listing(folder, endings):
        for path in sorted((root / folder).iterdir()):
            if path.is_dir():
                if path.name != "report":
                    yield from listing(path, endings)
            elif path.suffix in endings:
                yield path.relative_to(root).as_posix()

    for folder in _FOLDERS:
        yield from listing(folder, (".h", ".cpp"))
    yield from listing("scenes", (".toml",))
    yield from listing("experiments/report/src", (".mjs",))
    yield from listing("docs/theory", (".md",))


def _cited(path, text):
    """Returns the citations of one file: in brackets in comments and pages, as the source of a published test or
    scene, and in lines of a catalogue."""
    joined = re.sub(r'"\s*\n\s*"', "", re.sub(r"\n\s*///? ?", " ", text))
    if path.endswith(".md"):
        joined = text.replace("\n", " ")
    patterns = [] if path.endswith(".toml") else [rf"\[({_NAME}[^\[\]]{{3,150}}{_YEAR}[^\[\]]{{0,80}})\](?!\()"]
    patterns.append(r'\bsource = "([^"]+)"')
    if path.endswith("catalogue.cpp"):
        patterns.append(rf'"([A-Z][^"]*\b{_YEAR}\b[^"]*)"')
    return [one for pattern in patterns for all_of in re.findall(pattern, joined) for one in all_of.split(";")]


def citations(text):
    """Returns [(authors, year, place)]: two for "Bergou et al. 2008, 2010, eq. 3", none without author and
    year."""
    authors = rf"{_NAME}(?:{_LETTER}|[.&,' -])*?"
    found = re.search(rf"({authors}),? ({_YEAR}(?:, {_YEAR})*)(.*)$", re.sub(r"\s+", " ", text).strip())
    if found is None:
        return []
    place = re.sub(r"^[,:]? *", "", found[3]).strip()
    return [(found[1].strip(), year, place) for year in found[2].split(", ")]


def _surname(authors):
    """Returns the name by which a publication is known: catalogues write Chung-Hulbert."""
    for word in re.findall(rf"{_LETTER}+", authors):
        capital = next((k for k, letter in enumerate(word[:-1]) if letter.isupper()), None)
        if capital is not None:
            return word[capital:]
    return authors


def works(text):
    """Returns the publications by surname and year."""
    found = {}
    for number, line in enumerate(text.split("\n"), 1):
        if line == "" or line.startswith("#"):
            continue
        if line.count("\t") != 1:
            raise InputError(f'{_BIBLIOGRAPHY}:{number}: expected "Surname year<tab>publication"')
        key, work = line.split("\t")
        found[key] = work
    return found


def match(cited, known):
    """Refuses citations without a publication, and publications that nothing cites."""
    missing = [key for key in cited if key not in known]
    unused = [key for key in known if key not in cited]
    if missing:
        raise InputError(f"{_BIBLIOGRAPHY}: nothing stands there for {', '.join(missing)}: add a line")
    if unused:
        raise InputError(f"{_BIBLIOGRAPHY}: nothing cites {', '.join(unused)}: remove the line")


def _alphabetical(key):
    """Returns a sort key: letters without accents and case first."""
    plain = unicodedata.normalize("NFD", key)
    return "".join(letter for letter in plain if not unicodedata.combining(letter)).casefold(), plain


def listing(tables):
    places = [(path, _cited(path, tables.text(path))) for path in _files(tables.root)]
    published = read_table(tables.root / _PUBLISHED, _PUBLISHED)
    places.append((_PUBLISHED, published["cited_as"]))
    found = {}
    for path, texts in places:
        for text in texts:
            for authors, year, _ in citations(text):
                entry = found.setdefault(f"{_surname(authors)} {year}", {"authors": authors, "year": year, "where": {}})
                entry["authors"] = max(entry["authors"], authors, key=len)
                entry["where"][f"`{path}`"] = None
    known = works(tables.text(_BIBLIOGRAPHY))
    match(found, known)
    return table(["cited as", "publication", "cited in"],
                 [[f"{found[key]['authors']} {found[key]['year']}", known[key], ", ".join(found[key]["where"])]
                  for key in sorted(found, key=_alphabetical)])
