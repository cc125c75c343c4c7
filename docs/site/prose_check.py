"""Checks the texts that a reader of tress meets: pages, help of options and columns, error
messages and header comments.

    python3 docs/site/prose_check.py [ROOT] [--list [KIND]]

Kinds of faults:
    ban            a phrase of BANNED, on any surface
    page_long      a sentence, or a cell of a table, of a page with more than PAGE_WORDS words
    page_mean      a page whose mean sentence has more than PAGE_MEAN words
    help_long      a help text or error message with a sentence of more than HELP_WORDS words
    help_start     a help or column text that starts with neither noun nor verb
    long           a sentence of a header comment with more than COMMENT_WORDS words
    comment_start  a header comment whose first sentence has no verb or no object
    thin           a function whose whole description is a unit or a formula

Pages are checked as readers see them: those made from templates after their slots are filled.
Prints the counts. Exit code 1 if a count is above its limit. Limits are those reached: lower
them with the counts, never raise them. A line with `prose: ok` in a comment is not checked."""
import argparse
import re
import sys
from collections import Counter, defaultdict, namedtuple
from pathlib import Path

LIMITS = {"ban": 0, "page_long": 0, "page_mean": 0, "help_long": 0, "help_start": 0,
          "long": 0, "comment_start": 0, "thin": 0}
PAGE_MEAN, PAGE_WORDS, HELP_WORDS, COMMENT_WORDS = 20, 35, 25, 30
FEWEST = 5  # sentences of a page that has a mean

SOURCES = "contract linear math models integrators simulation experiments python".split()
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "docs/about/*.md",
         "docs/reference/*.md", "docs/start/*.md", "docs/theory/**/*.md",
         "experiments/**/README.md", "results/README.md", "scenes/README.md")

# A phrase and its replacement. Code spans of a sentence are `code` here.
BANNED = [(re.compile(phrase, re.I), instead) for phrase, instead in [
    (r"\banew\b", "again, rebuilt"),
    (r"\balike\b", "identical, in the same way"),
    (r"\bbeside\b", "next to, compared with, in addition to"),
    (r"\bdearer\b", "more expensive"),
    (r"\bso[- ]many(?:eth)?\b", "a given number of, every n-th"),
    (r"\bas many\b(?! as (?:\d|`))", "the same number of"),
    (r"\bwanted (?:error|accuracy|errors)\b", "target error"),
    (r"\b(?:that|which|all|what) there (?:is|are|was|were)\b", "name the thing"),
    (r"\bwhat is asked for\b|\b(?:is|are) asked for\b", "requested"),
    (r"\basked (?:error|accuracy|tolerance)\b|\bover asked\b|\bnot asked\b", "target, unset"),
    (r"(?<!because )(?<!instead )(?<!most )(?<!part )(?<!out )(?<!top )(?<!all )(?<!none )"
     r"(?<!each )(?<!end )\bof it(?=[.,;:)]|$)", "repeat the noun"),
    (r"\bbuys?\b", "improves, yields"),
    (r"\bpays?\b(?! off| attention| for)", "is worthwhile"),
    (r"\b(?:is|are|be) worth\b(?! (?:it|reading|noting|while))", "costs, gains"),
    (r"\bunless told\b", "by default"),
    (r"\bsays (?:how|what|which|whether|where|so|who|that)\b|\bsays it\b",
     "describes, records, prints"),
    (r"\b(?:is|are) said\b", "is stated, is printed"),
    (r"\b(?:count|list|keep|kept|stand|stood|set)\w* apart\b", "separately"),
    (r"\bby (?:a )?tolerance\b", "adaptive, with error control"),
    (r"\b(?:32|64) bits\b|\b(?:short|shorter|long|longer) numbers\b",
     "single precision, double precision"),
    (r"\blooked at\b", "examined, sampled"),
    (r"\bsome (?:two|three|four|five|six|seven|eight|nine|ten|\d+)(?: |$)(?!of)", "about N"),
    (r"\bas ever\b", "as before"),
    (r"\bfor nothing\b", "unnecessarily"),
    (r"\bwhich see\b", "see X"),
    (r"\bway to an? (?:wanted|given)\b", "how to reach"),
    (r"\btells? (?:best|how|what|which|whether)\b", "shows, predicts"),
    (r"\b(?:to|can|could|cannot) be had\b|\bnot at hand\b", "is available"),
    (r"\bspoil(?:t|s)\b", "mutated, changed"),
    (r"\bquiet machine\b", "idle machine"),
    (r"\bis nobody'?s\b|\bthe \w+'s affair\b|\bis the machine's\b", "name the cause"),
    (r"\bhas (?:it|them)(?=[.,;:)]|$)", "name the thing"),
    (r"\bthat of which\b|\bthose of which\b|\bthat which\b", "repeat the noun"),
    (r"\bmeets? (?:all|each|it|them) (?:alike|too)\b", "affects"),
    (r"\bnext to no\b", "almost no"),
    (r"\b(?:nor|neither) do(?:es)? it\b", "split the sentence"),
]]

FUNCTION_WORDS = set("""of that these those as by with in per from what how which where whose
so again also for its their it such than or and but to at on into over under upon them they he
if unless until because though not only otherwise likewise later earlier none""".split())
MAY_START = re.compile(r"(?:to (?:be )?[a-z]+|in which|per [a-z]+ ?:|at (?:most|least)"
                       r"|not (?:a|supported|yet|finished)|as in \S+$|for (?:each|every|all))", re.I)
# A condition of a few words before the subject: "At the end of a step, writes ...".
CONDITION = re.compile(r"(?:in|for|at|on|with|if|under|to) \w+(?: \w+){0,6}, ", re.I)
SAME = re.compile(r"^(?:the same\b|as (?:above|before|those|that)\b|this too\b|like the\b)",
                  re.I)

Fault = namedtuple("Fault", "kind place text advice")


class Report:
    def __init__(self):
        self.faults, self.lengths = [], defaultdict(list)

    def add(self, kind, place, text, advice):
        self.faults.append(Fault(kind, place, " ".join(text.split()), advice))

    def counts(self):
        return Counter(fault.kind for fault in self.faults)

    def mean(self, surface):
        lengths = self.lengths[surface]
        return sum(lengths) / max(1, len(lengths))

    def excesses(self):
        """Returns a line for each count above its limit."""
        counts = self.counts()
        return [f"{kind}: {counts[kind]} faults, at most {most} are allowed"
                for kind, most in LIMITS.items() if counts[kind] > most]


def plain(text):
    """Returns Markdown as words: code spans as `code`, links as their labels; citations with
    a year are left out."""
    text = re.sub(r"\{\{.*?\}\}", "slot", text)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", " ", text)
    text = re.sub(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"`[^`]*`", "`code`", text)
    text = re.sub(r"\$[^$]+\$", "formula", text)
    text = re.sub(r"\s\[[^\[\]]*\b(?:1[89]|20)\d\d\b[^\[\]]*\]", "", text)
    return re.sub(r"(?<!\w)([*_]{1,3})(\S[^*_]*\S|\S)\1(?!\w)", r"\2", text)


def sentences(text):
    text = re.sub(r"\b(e\.g|i\.e|cf|vs|etc|Fig|eq|Eq|no|al|approx|resp)\.", r"\1", text)
    for part in re.split(r"(?<=\S[.!?])[\"')\]]*\s+(?=[\w`\"'(\[{|-])|\n\s*\n", text):
        sentence = " ".join(part.split())
        if sentence:
            yield sentence


def words(sentence):
    return [w for w in re.findall(r"[^\s()\[\],;:\"]+", sentence) if re.search(r"\w", w)]


def judge(report, surface, place, text, kind, longest):
    for sentence in sentences(plain(text)):
        count = len(words(sentence))
        if count >= 3:
            report.lengths[surface].append(count)
        if count > longest:
            report.add(kind, place, sentence, f"{count} words: split the sentence")
        for phrase, instead in BANNED:
            for found in phrase.finditer(sentence):
                around = sentence[max(0, found.start() - 45):found.end() + 45]
                report.add("ban", place, around, f"{found.group(0).lower()}: {instead}")


def cells(line):
    """Returns the texts of a row of a table; a line break in a cell separates two texts."""
    if not line.lstrip().startswith("|"):
        return []
    return [part for cell in re.split(r"(?<!\\)\|", line) for part in cell.split("<br>")]


def page(report, root, name):
    block, start, fenced = [], 1, False
    before = len(report.lengths["pages"])

    def flush():
        judge(report, "pages", f"{name}:{start}", "\n".join(block), "page_long", PAGE_WORDS)
        block.clear()

    for number, line in enumerate((root / name).read_text(encoding="utf-8").split("\n"), 1):
        fence = line.lstrip().startswith("```")
        fenced ^= fence
        single = re.match(r"^\s*(?:#.*|\{\{[^}]*\}\}|!\[.*\)|---+|\|.*|<!--.*|\d+\.)?\s*$", line)
        item = re.match(r"^\s*(?:[-*]|\d+\.)\s+", line)
        if fence or fenced or single or item:
            flush()
        if not fenced and "prose: ok" not in line:
            for text in cells(line):
                judge(report, "cells", f"{name}:{number}", text, "page_long", PAGE_WORDS)
        if fence or fenced or single or "prose: ok" in line:
            continue
        if not block:
            start = number
        block.append(line[item.end():] if item else line)
    flush()
    lengths = report.lengths["pages"][before:]
    mean = sum(lengths) / max(1, len(lengths))
    if len(lengths) >= FEWEST and mean > PAGE_MEAN:
        report.add("page_mean", name, f"mean sentence of {mean:.1f} words", "split sentences")


STRING = r'"(?:[^"\\]|\\.)*"'
STRINGS = rf"{STRING}(?:\s*{STRING})*"
NAME = r'"[a-z][a-z0-9_]*"'
HELP = [re.compile(pattern) for pattern in (
    rf"\.(?:help|text|about|describe|summary)\s*=\s*({STRINGS})",
    rf"add_(?:option|flag)\(\s*\"--[^\"]*\"(?:\s*\+[^,]*)?,[^,\"]*,\s*({STRINGS})",
    rf"\{{{NAME},\s*(?:{NAME},\s*)?({STRINGS})")]
ERROR = re.compile(rf"(?:InputError|refuse_if|refuse|fail)\(\s*(?:[^\";]{{0,80}}?,\s*)?"
                   rf"(?:fmt::format\(\s*)?({STRINGS})")
COMMENT = re.compile(r"\s*///(?!/)")
FUNCTION = re.compile(r"(?!class|struct|enum|namespace|using|template)"
                      r"[\w:<>,&*\[\]~ ]+\([^)]*\)?")
THIN = re.compile(r"\s*(?:virtual |static |constexpr )*[\w:]+(?:<[^()]*>)?[&*]* \w+"
                  r"\((?!\d)[^();{]+\)[^;{/()]*;\s*//(?![/<])\s*(.*)$")


def literal(strings):
    joined = "".join(text[1:-1] for text in re.findall(STRING, strings))
    return joined.replace('\\"', '"').replace("\\n", " ")


def first_word(text):
    return re.sub(r"\W", "", next(iter(words(text)), "")).lower()


def help_text(report, place, text):
    judge(report, "help", place, text, "help_long", HELP_WORDS)
    start = text.strip()
    if SAME.match(start):
        report.add("help_start", place, start, "repeat the noun instead of 'the same'")
    elif first_word(plain(start)) in FUNCTION_WORDS and not MAY_START.match(start):
        report.add("help_start", place, start, "start with the noun or with a verb")


def strings_of(report, name, text):
    for pattern in HELP:
        for found in pattern.finditer(text):
            help_of = literal(found.group(1))
            if " " in help_of.strip():
                help_text(report, f"{name}:{text.count(chr(10), 0, found.start()) + 1}", help_of)
    for found in ERROR.finditer(text):
        message = re.sub(r"\{[^}]*\}", "X", literal(found.group(1)))
        if " " in message:
            place = f"{name}:{text.count(chr(10), 0, found.start()) + 1}"
            judge(report, "errors", place, message, "help_long", HELP_WORDS)


def comment(report, place, block, code, header):
    """Checks a block of /// lines; `code`: the lines after it."""
    # An indented line is a formula, and a list item is a text of its own.
    prose = [re.sub(r"^\s*(?:-|\d+\.) +", "\n\n", "" if re.match(r"\s{3,}\S", line) else line)
             for line in block]
    body = "\n".join(prose).strip()
    if "prose: ok" in body:
        return
    judge(report, "comments", place, body, "long", COMMENT_WORDS)
    if not header:
        return
    first = next(iter(sentences(plain(body))), "")
    if SAME.match(first):
        report.add("comment_start", place, first, "describe it instead of 'the same'")
    elif (first_word(first) in FUNCTION_WORDS and not CONDITION.match(first)
          and not MAY_START.match(first)):
        report.add("comment_start", place, first, "start with a verb or the noun described")
    elif FUNCTION.match(code) and 0 < len(words(first)) < 3:
        report.add("comment_start", place, first, "state verb, object and unit")


def source(report, root, name):
    text = (root / name).read_text(encoding="utf-8")
    strings_of(report, name, text)
    lines, at, header = text.split("\n"), 0, name.endswith(".h")
    while at < len(lines):
        start = at
        while at < len(lines) and COMMENT.match(lines[at]):
            at += 1
        if at > start:
            block = [re.sub(r"^\s*///<?\s?", "", line) for line in lines[start:at]]
            code = " ".join(line.strip() for line in lines[at:at + 3])
            comment(report, f"{name}:{start + 1}", block, code, header)
        thin = THIN.match(lines[at]) if header and at < len(lines) else None
        if thin and len(words(thin.group(1))) <= 3:
            report.add("thin", f"{name}:{at + 1}", lines[at], "state what it returns or changes")
        at += 1


def check(root):
    root, report = Path(root), Report()
    for name in sorted({str(path.relative_to(root)) for glob in PAGES
                        for path in root.glob(glob)
                        if "node_modules" not in path.parts}):
        page(report, root, name)
    for folder in SOURCES:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                source(report, root, str(path.relative_to(root)))
    return report


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", default=Path(__file__).resolve().parents[2])
    parser.add_argument("--list", nargs="?", const="all", help="print the faults of this kind")
    options = parser.parse_args()
    report = check(options.root)
    for fault in report.faults:
        if options.list in ("all", fault.kind):
            print(f"{fault.place}: {fault.kind}: {fault.text[:170]} [{fault.advice}]")
    for surface, lengths in report.lengths.items():
        print(f"{surface:14} {len(lengths):5} sentences of {report.mean(surface):.1f} words")
    for kind, most in LIMITS.items():
        print(f"{kind:14} {report.counts()[kind]:5} of at most {most}")
    excesses = report.excesses()
    print("\n".join(excesses), file=sys.stderr, end="\n" if excesses else "")
    return 1 if excesses else 0


if __name__ == "__main__":
    sys.exit(main())
