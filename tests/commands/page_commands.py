"""The command lines that the pages have their readers type.

    page_commands.py ROOT PAGE [PATTERN]   prints those of a page that match, one per line

They stand in fences without a language; text, scenes and sources in fences have one."""
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

# Folders that hold no pages: templates, and what tests read.
LEFT_OUT = re.compile(r"build|node_modules|templates|tests|\..*")
BEGINS_COMMAND = re.compile(r"\s*(\./tress|build/|experiments/\S+\.sh|cmake|mpirun|node|python3) ")


class BadPage(Exception):
    """What is wrong, and where."""


SENTENCES = "sentences"  # as a page: the commands within the sentences of all pages


@dataclass
class Command:
    page: str
    line: int
    text: str
    output: list[str] = field(default_factory=list)  # lines that the command prints
    where: str = ""  # page and line of one in a sentence

    @property
    def place(self):
        return self.where or f"{self.page}:{self.line}"


def pages(root, folder=""):
    """Returns every page of Markdown, relative to the repository."""
    found = []
    for entry in sorted((root / folder).iterdir()):
        if entry.is_dir():
            if not LEFT_OUT.fullmatch(entry.name):
                found += pages(root, f"{folder}{entry.name}/")
        elif entry.suffix == ".md":
            found.append(folder + entry.name)
    return sorted(found)


def commands_of(page, text):
    """Returns the commands of a page's text. A fence ```text output holds what the command before
    it prints. Raises BadPage on an open fence, and on an indented command, which would not be
    found."""
    found = []
    fence = None  # its language
    for number, line in enumerate(text.split("\n"), start=1):
        place = f"{page}:{number}"
        mark = re.match(r"\s*```(.*)$", line)
        if mark:
            fence = mark[1].strip() if fence is None else None
            if fence == "text output" and not found:
                raise BadPage(f"{place}: output of no command")
        elif fence == "text output":
            found[-1].output.append(line)
        elif fence == "" and line.strip():
            if not re.match(r"[\w./]", line, re.A):
                raise BadPage(f"{place}: no command; give the fence a language, as in ```text")
            found.append(Command(page, number, line))
        elif fence == "text" and BEGINS_COMMAND.match(line):
            raise BadPage(f"{place}: a command in a fence of text; give the fence no language")
        elif fence is None and line.startswith("    ") and BEGINS_COMMAND.match(line):
            raise BadPage(f"{place}: put the command into a fence, where its test finds it")
    if fence is not None:
        raise BadPage(f"{page}: a fence without an end")
    return found


def page_commands(root, page):
    return commands_of(page, (root / page).read_text(encoding="utf-8"))


def blocks_of(text, language):
    """Returns the texts in the fences of a language."""
    return re.findall(rf"(?ms)^```{language}\n(.*?)^```$", text)


def main(root, page, pattern=""):
    found = [command.text for command in page_commands(Path(root), page) if re.search(pattern, command.text)]
    if not found:
        raise BadPage(f"{page} has no command that matches '{pattern}'")
    print(*found, sep="\n")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except BadPage as problem:
        sys.exit(str(problem))
