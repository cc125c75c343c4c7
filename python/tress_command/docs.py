"""./tress docs: the documentation site. It needs no compiler."""

import shutil

from .command import Command, read_words
from .messages import BAD_INPUT, refuse
from .packages import npm_packages
from .processes import run
from .scripts import SITE

NOT_INSTALLED = 77  # of the site's builder, for tests


def _run(words, machine):
    options = read_words("docs", words, flags=("--check",), hint="; the only one is --check")
    # Without Debian's packages the site's own check names what is missing.
    if shutil.which("dpkg-query"):
        if packages := machine.missing_of("cmake/docs_packages.txt"):
            machine.install(packages)
    if not npm_packages("docs/site"):
        refuse("docs: npm packages are missing; with a network run: npm ci --prefix docs/site")
    code = run(*SITE, *options.options)
    return BAD_INPUT if code == NOT_INSTALLED else code


COMMAND = Command(
    "docs", "[--check]",
    "builds the documentation site, build/docs/html/index.html. Installs "
    "cmake/docs_packages.txt and the npm packages of docs/site; needs no network afterwards.",
    _run,
    example="./tress docs --check",
    time="less than a minute once its packages are there.",
    options=(("--check", "warnings, broken links and undescribed names of the C++ API are errors"),))
