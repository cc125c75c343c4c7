"""Commands within the sentences of pages, such as `./tress run --full`: the spelling of each, and
which of them a test runs."""
import re
import subprocess

from page_commands import SENTENCES, Command, page_commands

SPAN = re.compile(r"`([^`]+)`")
TRESS = re.compile(r"\./tress (?:--no-install )?([a-z_]+)(.*)")
PROGRAM = re.compile(r"build/release/experiments/([a-z_]+)( .*)")
SCRIPT = re.compile(r"(?:node|(?:/usr/bin/)?python3) ([\w./]+\.(?:mjs|py))(.*)")
# A record of versions names commands of its time.
LEFT_OUT = "CHANGELOG.md"


# Has the options that every experiment has.
ANY_EXPERIMENT = "damping"


def printed(root, *command):
    """Returns what a command prints, or None where it fails."""
    done = subprocess.run(command, cwd=root, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


def helps_of_tress(root, build):
    """Returns the help text of each command of ./tress, with that of the programs that it passes
    its words to."""
    texts = {"help": "all"}
    for text in printed(root, "./tress", "help", "all").split("\nusage: ./tress ")[1:]:
        usage = text.partition("\n")[0]
        if re.search(r"(?<!-- )ARGUMENTS\]", usage):
            text += printed(root, build / "experiments" / ANY_EXPERIMENT, "--help")
        texts[usage.split()[0]] = text
    return texts


def sentences(text):
    """Yields numbers and lines of what is not in a fence."""
    inside = False
    for number, line in enumerate(text.split("\n"), start=1):
        if line.lstrip().startswith("```"):
            inside = not inside
        elif not inside:
            yield number, line


def inline_commands(root, page):
    """Yields place and text of each command, its kind, its name and the words after it."""
    for number, line in sentences((root / page).read_text(encoding="utf-8")):
        for text in SPAN.findall(line):
            for kind in (TRESS, PROGRAM, SCRIPT):
                if found := kind.match(text):
                    yield f"{page}:{number}: {text}", kind, found[1], found[2]


# Words that stand for a reader's own: the sentence gives the form of a command.
FORM = re.compile(r"(?<!\S)(?:[A-Z_]*[A-Z]{2,}\S*|\S*/[A-Z]{2,}\S*|\.\.\.)(?!\S)")


def sentence_commands(root, pages):
    """Returns each command of a sentence once. Forms, names of commands such as `./tress run`, and
    what begins a command in a fence, which has its own test, are left out."""
    fenced = [command.text for page in pages for command in page_commands(root, page)]
    found = {}
    for page in pages:
        for place, kind, _, words in () if page == LEFT_OUT else inline_commands(root, page):
            where, _, text = place.partition(": ")
            if FORM.search(text) or (kind is TRESS and not words.strip()):
                continue
            if not any(line == text or line.startswith(f"{text} ") for line in fenced):
                found.setdefault(text, Command(SENTENCES, 0, text, where=where))
    return list(found.values())


def misspelt(root, build, pages):
    """Returns complaints about commands, scripts and options that do not exist; prints a count."""
    helps = {(TRESS, name): text for name, text in helps_of_tress(root, build).items()}
    complaints, count = [], 0
    for page in pages:
        for place, kind, name, words in () if page == LEFT_OUT else inline_commands(root, page):
            count += 1
            if kind is SCRIPT:
                complaints += [] if (root / name).is_file() else [f"{place}: no file {name}"]
                continue
            if kind is PROGRAM and (kind, name) not in helps:
                program = build / "experiments" / name
                helps[kind, name] = printed(root, program, "--help") if program.is_file() else None
            text = helps.get((kind, name))
            if text is None:
                complaints.append(f"{place}: no such command")
                continue
            # After -- are options of another program; every command has --help.
            options = re.findall(r"(?<!\S)--[a-z][a-z-]*", words.partition(" -- ")[0])
            complaints += [f"{place}: no option {option}" for option in options
                           if option != "--help" and not re.search(rf"{option}(?![a-z-])", text)]
    print(f"{count} commands in sentences, all of verified spelling")
    return complaints
