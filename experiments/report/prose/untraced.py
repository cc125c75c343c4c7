"""Numbers and number words in prose that no query computed: results belong into tables."""
import re

from .allowed import ALLOWED

# {{ study.query }}, or with names of a family, of a column or the like: {{ study.query('rods') }}.
SLOT = re.compile(r"\{\{\s*\w+\.\w+(?:\([^(){}]*\))?\s*\}\}")

_COUNT = (
    "two|three|four|five|six|seven|eight|nine|ten|eleven|twelve|thirteen|fourteen|fifteen|sixteen|seventeen|eighteen|nineteen|"
    "twenty|thirty|forty|fifty|sixty|hundreds?|thousands?|millions?|billions?|dozens?")
_PART = "third|quarter|fifth|sixth|eighth|tenth|hundredth|thousandth|millionth|hundred-thousandth"
_POPULATION = (
    "of|cases|runs|rows|hairs|strands|models|methods|integrators|scenes|steps|winners|tests|pairs|answers|problems")

# Words that state an amount: like a number they need a query, or a reason to stand.
_NUMBER_WORDS = re.compile("|".join([
    rf"\b(?:{_COUNT})\b",
    rf"\b(?:an?|one|two|three) (?:{_PART})s?\b|\bquarters\b|\bthirds\b",
    r"\bhal(?:f|ves)\b",
    r"\btwice\b|\bdoubl(?:e|es|ed)\b|\btripl(?:e|es|ed)\b|\bmany times\b",
    # An amount that somebody estimated; "about the axis" is none.
    r"\b(?:about|some|roughly|approximately|nearly|almost)\s+"
    rf"(?=\d|\{{\{{|(?:{_COUNT}|an? (?:{_PART}|hundred|thousand|million)|half|twice|all|none|every)\b)",
    rf"(?<!\bat )(?<!\bthe )\b(?:most|few|hardly any|the majority|several) (?:of the |of these )?(?:{_POPULATION})\b",
    r"\bmostly\b|\bmajority\b|\borders? of magnitude\b",
]), re.ASCII | re.IGNORECASE)
_NUMBER = re.compile(r"\S*\d\S*", re.ASCII)

_COMMENT = re.compile(r"<!--.*?-->", re.S)
_CODE = re.compile(r"`[^`\n]*`")
# A region of definitions and settings, which names its reason.
_INPUTS = re.compile(r"<!-- inputs: \S[^>]*-->.*?<!-- end of inputs -->", re.S)
# Not prose: inputs, code, comments, targets of links.
_SET_APART = [_INPUTS, re.compile(r"^```.*?^```", re.M | re.S), _COMMENT, _CODE, re.compile(r"\]\([^)\n]*\)")]


def _blank(match):
    return re.sub(r"[^\n]", " ", match[0])


def _without(patterns, text):
    for pattern in patterns:
        text = pattern.sub(_blank, text)
    return text


def _prose(template):
    # A slot stays as braces: "about {{ }}" is an estimate of what a query computed.
    return _without(_SET_APART, SLOT.sub(lambda match: "{{" + " " * (len(match[0]) - 4) + "}}", template))


def _amounts(text):
    return sorted([*_NUMBER.finditer(text), *_NUMBER_WORDS.finditer(text)], key=lambda match: match.start())


def untraced_numbers(template):
    """Where prose has a number or a number word that nobody computed and nothing allows: [(line, text)]."""
    prose = _without(ALLOWED, _prose(template))
    return [(prose.count("\n", 0, match.start()) + 1, match[0].strip()) for match in _amounts(prose)]


def counted(template):
    """How many slots a text has, and how many amounts stand in regions of inputs and are allowed."""
    return {
        "slots": len(SLOT.findall(template)),
        "inputs": sum(len(_amounts(_without([_COMMENT, _CODE], region))) for region in _INPUTS.findall(template)),
        "allowed": len(_amounts(_prose(template))) - len(untraced_numbers(template)),
    }


def without_marks(text):
    """A page without the marks of its regions of inputs. Marks in code stay."""
    mark = r"(?<!`)<!-- (?:inputs: [^>]*|end of inputs) -->"
    return re.sub(rf" ?{mark}", "", re.sub(rf"^{mark}\n", "", text, flags=re.M))
