#!/usr/bin/env python3
"""Builds the documentation site.

    build.py [--check] [--out FOLDER]

Writes FOLDER/html/index.html (default: build/docs). --check: warnings are errors, every link
of the built pages must lead somewhere, and every public name of the C++ API must have a
description (api_check.py). Exit codes: 0 done, 3 a check fails, 77 something that the build needs is not installed."""
import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import api_check  # noqa: E402
import links  # noqa: E402
from stage import Stage  # noqa: E402

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
NODE = HERE / "node_modules"


def missing():
    """Returns what the build needs and does not find."""
    programs = [name for name in ("doxygen", "node") if not shutil.which(name)]
    modules = [f"Python module {name}" for name in ("sphinx", "myst_parser", "furo", "breathe", "sphinx_copybutton")
               if not importlib.util.find_spec(name)]
    packages = [f"npm package {name}" for name in ("sass", "esbuild", "mathjax", "normalize.css")
                if not (NODE / name).is_dir()]
    return programs + modules + packages


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, **options)
    if done.returncode:
        sys.exit(f"docs: {command[0]} failed:\n{done.stdout}{done.stderr}")


def older(target, *sources):
    times = [path.stat().st_mtime for source in sources
             for path in (source.rglob("*") if source.is_dir() else [source]) if path.is_file()]
    return not target.exists() or target.stat().st_mtime < max(times)


def assets(static):
    """Writes Furo's style sheets and script, and MathJax. Debian's own files of Furo lack the
    dark theme and load as a classic script what is a module."""
    furo = Path(importlib.util.find_spec("furo").origin).parent / "assets"
    for name in ("furo", "furo-extensions"):
        target = static / f"styles/{name}.css"
        if older(target, furo, NODE / ".package-lock.json"):
            plain = static.parent / f"{name}.css"
            run(NODE / ".bin/sass", "--no-source-map", "--style=compressed", furo / f"styles/{name}.sass", plain)
            run(NODE / ".bin/esbuild", plain, "--bundle", "--minify", "--log-level=error",
                f"--alias:~normalize.css={NODE / 'normalize.css/normalize.css'}", f"--outfile={target}")
    script = static / "scripts/furo.js"
    if older(script, furo, NODE / ".package-lock.json"):
        run(NODE / ".bin/esbuild", furo / "scripts/furo.js", "--bundle", "--minify", "--log-level=error",
            f"--outfile={script}")
    mathjax = static / "mathjax/tex-svg.js"
    if older(mathjax, NODE / ".package-lock.json"):
        mathjax.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(NODE / "mathjax/es5/tex-svg.js", mathjax)


def doxygen(out):
    """Writes Doxygen's XML of the public headers."""
    folders = [ROOT / name for name in ("contract", "integrators", "linear", "math", "models", "simulation")]
    xml = out / "doxygen/xml/index.xml"
    if not older(xml, HERE / "Doxyfile", HERE / "trailing_comments.sed", *folders):
        return
    settings = (HERE / "Doxyfile").read_text()
    settings += f"OUTPUT_DIRECTORY = {out / 'doxygen'}\nSTRIP_FROM_PATH = {ROOT}\n"
    shutil.rmtree(out / "doxygen", ignore_errors=True)  # names of headers that have gone
    (out / "doxygen").mkdir(parents=True)
    run("doxygen", "-", input=settings, cwd=ROOT)


def sphinx(out, check):
    environment = dict(os.environ, TRESS_DOXYGEN=str(out / "doxygen/xml"), TRESS_STATIC=str(out / "static"),
                       PYTHONHASHSEED="0")
    command = [sys.executable, "-m", "sphinx", "-q", "-n", "-b", "html", "-c", HERE, "-d", out / "doctrees"]
    if check:
        command += ["-W", "--keep-going", "-E"]  # warnings of all pages, not of those that changed
    done = subprocess.run([str(word) for word in (*command, out / "source", out / "html")], env=environment)
    return done.returncode == 0


# What a screen reader or a keyboard misses in Furo's pages, and in code wider than its place.
ACCESSIBLE = (
    ('role="heading"><span class="caption-text"', 'role="heading" aria-level="2"><span class="caption-text"'),
    ('<aside class="sidebar-drawer"', '<aside aria-label="Pages" class="sidebar-drawer"'),
    ('<aside class="toc-drawer', '<aside aria-label="On this page" class="toc-drawer'),
    ('<label class="overlay', '<label aria-hidden="true" class="overlay'),
    ("<pre>", '<pre tabindex="0">'),
    ('<table class="docutils', '<table tabindex="0" class="docutils'),
    ('<th class="head"><p></p></th>', '<td class="head"></td>'),
    ('\n<div id="search-results">', '\n<h1>Search</h1><div id="search-results">'),
)


def make_accessible(html):
    for path in html.rglob("*.html"):
        before = text = path.read_text(encoding="utf-8")
        for one, better in ACCESSIBLE:
            text = text.replace(one, better)
        if text != before:
            path.write_text(text, encoding="utf-8")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--check", action="store_true", help="warnings, broken links and undescribed names of the C++ API are errors")
    options.add_argument("--out", type=Path, default=ROOT / "build/docs", help="folder of the site")
    options = options.parse_args()
    absent = missing()
    if absent:
        print(f"docs: not installed: {', '.join(absent)}; install what cmake/docs_packages.txt and "
              "docs/site/package.json name, or run ./tress docs on Debian", file=sys.stderr)
        return 77
    out = options.out.resolve()
    found = Stage(ROOT, out / "source").run()
    assets(out / "static")
    doxygen(out)
    good = sphinx(out, options.check)
    make_accessible(out / "html")
    broken, count = links.problems(out / "html")
    for line in found + broken:
        print(f"docs: {line}", file=sys.stderr)
    print(f"docs: {count} pages, {len(found) + len(broken)} broken links: {out / 'html/index.html'}", file=sys.stderr)
    good = good and not (options.check and found + broken)
    if options.check:
        good = api_check.report(out / "doxygen/xml") and good
    return 0 if good else 3


if __name__ == "__main__":
    sys.exit(main())
