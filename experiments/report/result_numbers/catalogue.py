"""List of the catalogue, which every experiment prints with --list, as committed."""
import re

SNAPSHOT = "docs/templates/catalogue.txt"


def _text(tables):
    return tables.text(SNAPSHOT).rstrip()


def integrators(tables):
    after = re.split(r"^INTEGRATORS.*$", _text(tables), flags=re.M)[1]
    return len(re.findall(r"^  \w", re.split(r"^[A-Z]", after, flags=re.M)[0], re.M))


def models(tables):
    """Returns the ids of all models."""
    listed = re.split(r"^[A-Z]", re.split(r"^MODELS.*$", _text(tables), flags=re.M)[1], flags=re.M)[0]
    return re.findall(r"^  (\w+)", listed, re.M)


def strand_models(tables):
    return tables["validation"]["model"].nunique()


def listing(tables):
    return f"```text\n{_text(tables)}\n```"
