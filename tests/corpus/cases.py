"""Bad inputs for every program."""
import re
from dataclasses import dataclass
from itertools import chain

from texts import (GARBAGE, GRIDS, HEAD_SCENE, ITSELF, MALFORMED_CSV, MALFORMED_TOML, SCENE, SPECIAL, WRONG_VALUES,
                   Special, is_text, random)


@dataclass(frozen=True)
class Case:
    program: str
    kind: str
    name: str
    args: list[str]
    files: dict  # of the folder where the program runs: name -> text, bytes, Special or None
    maybe: bool = False  # chance may have left the input legal
    after: str = ""  # the program that must have refused the same input


QUICK = ["--quick", "--out", "t.csv"]
# How each program is given a scene, without running it where it can.
READERS_OF_SCENES = {
    "simulate": lambda file: [file, "--out", "out"],
    "cost_of_accuracy": lambda file: ["--scene", file, "--out", "t.csv"],
    "stability_limit": lambda file: ["--scene", file, *QUICK],
    "hard_cases": lambda file: ["--scene", file, *QUICK],
    "work_precision": lambda file: ["--scene", file, *QUICK],
    "scaling": lambda file: ["--scene", file, *QUICK],
    "effect_audit": lambda file: ["--scene", file, "--out", "t.csv"],
    "head_accuracy": lambda file: ["--scene", file, *QUICK],
    "calibrate": lambda file: ["--scene", file, *QUICK],
}


def each_reader(file, dry=False):
    more = ["--dry-run"] if dry else []
    for program, args in READERS_OF_SCENES.items():
        if not dry or program != "simulate":
            yield program, [*args(file), *more]
    yield "cost_of_accuracy", ["--advise", file, "--out", "t.csv", *more]


def wrong_keys():
    lines = SCENE.split("\n")
    for i, line in enumerate(lines):
        found = re.match(r"(\w+) = ", line)
        if not found:
            continue
        key = found[1]

        def with_line(text):
            return "\n".join([*lines[:i], text, *lines[i + 1:]])

        yield f"{key} misspelt", with_line(line.replace(key, f"{key[:-1]}q_", 1))
        yield f"{key} twice", with_line(f"{line}\n{line}")
        for value in WRONG_VALUES:
            yield f"{key} = {value}", with_line(f"{key} = {value}")
    for table in re.findall(r"^\[+[\w.]+\]+$", SCENE, re.M):
        name = table.strip("[]")
        yield f"{name} misspelt", SCENE.replace(table, table.replace(name, f"{name}q_", 1), 1)
        if "." not in name:
            yield f"{name} = 3", f"{name} = 3\n{SCENE}"


MARKS = [*"\"'[]{}=,.#-\n\\\0\x01\xff 0e_", "nan", "inf"]


def spoilt(text, draw):
    """Spoils a text in one of six ways, up to three times."""

    def pick(count):
        return int(count * draw())

    def cut():
        at = pick(len(text))
        return text[:at] + text[at + 1 + pick(4):]

    def insert():
        at = pick(len(text))
        return text[:at] + MARKS[pick(len(MARKS))] + text[at:]

    def drop_line():
        lines = text.split("\n")
        del lines[pick(len(lines))]
        return "\n".join(lines)

    def repeat_line():
        lines = text.split("\n")
        at = pick(len(lines))
        lines.insert(at, lines[pick(len(lines))])
        return "\n".join(lines)

    def replace():
        at = pick(len(text))
        return text[:at] + "abcdefghijklmnopqrstuvwxyz"[pick(26)] + text[at + 1:]

    def end():
        return text[:pick(len(text))]

    ways = (cut, insert, drop_line, repeat_line, replace, end)
    for _ in range(1 + pick(3)):
        text = ways[pick(len(ways))]()
    return text


def scenes(shipped, seed, count):
    texts = chain(GARBAGE, MALFORMED_TOML, wrong_keys(), SPECIAL)
    fixed = [(name, {"scene.toml": what}) for name, what in texts]
    with_grid = f'{SCENE}[[effects.body]]\nshape = "sdf"\nsdf_file = "grid.txt"\n'
    fixed += [(f"{name} as sdf_file", {"scene.toml": with_grid, "grid.txt": what}) for name, what in (*GRIDS, *SPECIAL)]
    for name, files in fixed:
        for program, args in each_reader("scene.toml"):
            yield Case(program, "scene", name, args, files)
    draw = random(seed)
    for i in range(count):
        files = {"scene.toml": spoilt(shipped[i % len(shipped)], draw)}
        for program, args in each_reader("scene.toml", dry=True):
            yield Case(program, "spoilt scene", f"number {i}", args, files, maybe=True)
        # It has no dry run; those that effect_audit reads are left out.
        yield Case("simulate", "spoilt scene", f"number {i}", READERS_OF_SCENES["simulate"]("scene.toml"), files,
                   after="effect_audit")


WRONG_OPTIONS = (
    "title = 3", "models = 3", 'models = "none_such"', "models = [[]]", "models = {}", 'integrators = ["none_such"]',
    "elements = 0", "elements = [1, -1]", "elements = 1e308", "elements = nan", 'elements = "3:1"', "timeout = 1e10",
    "timeout = -1", "timeout = true", "timeout = inf", "repeat = 0", "repeat = 1e308", "seed = -1", "seed = nan",
    "quick = 1", 'full = "yes"', "settings = 5", "settings = []", "sede = 1", "[settings]\nstep = []",
    "[settings]\nstep = nan", "[settings]\nstep = -1", "[settings]\nnone_such = 1", "quick = true\nfull = true",
    "jobs = 3",
)


def options_files(programs):
    wrong = [*GARBAGE, *MALFORMED_TOML, *SPECIAL, *((text, f"{text}\n") for text in WRONG_OPTIONS)]
    legal = ("nothing", "blanks", "a byte order mark")
    for program in programs:
        if program == "simulate":  # has options of its own
            continue
        for name, what in wrong:
            if name not in legal:
                yield Case(program, "options file", name, ["--options", "options.toml", "--out", "t.csv"],
                           {"options.toml": what})


OF_ALL = (
    "--elments 3", "--set", "--set x", "--set =1", "--set none_such=1", "--set step=nan", "--set step=-1",
    "--set rtol=1e308", "--models none_such", "--models ,", "--integrators none_such", "--elements 0", "--elements -1",
    "--elements 1e308", "--elements nan", "--elements 3:1", "--elements 1:99999999", "--elements 1:2:0", "--jobs 0",
    "--jobs -1", "--jobs 99999999999999999999", "--jobs nan", "--repeat 0", "--repeat 1e308", "--repeat -3",
    "--shard 0/1", "--shard 2/1", "--shard 1", "--shard 1/99999999999", "--run-id", "--run-id none",
    "--seed -1", "--seed 1e308", "--seed nan",
    "--seed 18446744073709551616", "--timeout 0", "--timeout -1", "--timeout nan", "--timeout inf", "--timeout 1e308",
    "--timeout 1e10", "--timeout 1e-300", "--progress loud", "--quick --full", "--retry-failed", "stray", "--out .",
    "--out none/t.csv", "--out /proc/t.csv", "--out /dev/full", "--out /dev/null", "--out loop", "--out loop/t.csv",
    "--out pipe", "--out file/t.csv", f"--out {'n' * 300}", "--out - --resume", "--merge a.csv", "--merge --out t.csv",
    "--options", "-x", "--", "-", "--plugin", "--plugin none.so", "--plugin .", "--plugin file", "--plugin pipe",
    "--plugin loop", "--plugin /dev/zero",
)
OF_SIMULATE = (
    "--threads 0", "--threads -1", "--threads 1e9", "--threads nan", "--hairs -1", "--hairs 1e308", "--hairs nan",
    "--progress loud", "--elments 3", "-x", "--out", "--as none", "--as", "--device none", "--device", "--precision 16",
    "--precision nan", "--precision 1e308", "--simd-width 0", "--simd-width -8", "--simd-width 3", "--simd-width 16", "--precision 32 --simd-width 4",
    "--frames 16", "--frames", "--frames nan", "scene.toml --as batch --out o", "head.toml --as batch --out o --hairs 3",
    "head.toml --as batch --out o --error-bars", "head.toml --as batch --out file", "none.toml", "scene.toml none.toml",
    "scene.toml --out file", "scene.toml --out loop", "scene.toml --out loop/o", "scene.toml --out /proc/o",
    "scene.toml --out /dev/null/o", "scene.toml --plugin none.so", "scene.toml --plugin file",
    "scene.toml --plugin pipe", "--plugin", "scene.toml --out file/o", "scene.toml --out pipe",
    f"scene.toml --out {'n' * 300}", "",
)


def command_lines(programs):
    files = {"loop": ITSELF, "pipe": Special("pipe"), "file": "text\n", "scene.toml": SCENE, "head.toml": HEAD_SCENE}
    for program in programs:
        for text in OF_SIMULATE if program == "simulate" else OF_ALL:
            more = ["stray"] if text == "--" else []  # '--' alone asks for all there is
            yield Case(program, "command line", text[:40], [*text.split(), *more], files)


WRONG_MANIFESTS = (
    "null", "[]", '""', "3", "{}", '{"settings": 5}', '{"settings": null}', '{"settings": ["seed=1 quick"]}',
    '{"settings": "seed=2"}', '{"settings": "seed=1 quick"', "[" * 200_000, '{"a":' * 200_000,
)


def tables(headers):
    """Tables, their manifests and journals. `headers`: program -> header of its table."""
    nowhere = ["--quick", "--shard", "9999/9999", "--out", "t.csv", "--resume"]
    part = "t.9999-of-9999"  # the table of a part has a name of its own
    meta = '{"settings": "seed=1 quick"}'
    manifests = [*GARBAGE, *((text[:40], text) for text in WRONG_MANIFESTS), *SPECIAL]
    for program, header in headers.items():
        texts = [*GARBAGE, *MALFORMED_CSV, *SPECIAL, ("one column less", re.sub("^[^,]*,", "", header)),
                 ("one cell less", f"{header}1\n")]
        for name, what in texts:
            # What is not there is not resumed; nor is a table without a line, which has no rows.
            if what is not None:
                yield Case(program, "table to resume", name, nowhere, {f"{part}.csv": what})
            yield Case(program, "table to merge", name, ["--merge", "b.csv", "a.csv", "--out", "t.csv"],
                       {"a.csv": what, "b.csv": header})
        for name, what in manifests:
            if what not in (None, ITSELF):  # those are no manifest
                yield Case(program, "manifest", name, nowhere, {f"{part}.csv": header, f"{part}.meta.json": what})
        for name, what in (*GARBAGE, *SPECIAL):
            # A last line without an end is what a crash leaves, and dropped.
            if what is None or is_text(what) and (b"\n" if isinstance(what, bytes) else "\n") not in what:
                continue
            yield Case(program, "journal", name, nowhere, {f"{part}.csv": header, f"{part}.meta.json": meta,
                                                           f"{part}.csv.journal": what})


def records():
    """Measured records that calibrate reads."""
    head = "t_s,amplitude_m\n"
    good = "".join(f"{i / 100},{0.01 * i}\n" for i in range(1, 7))

    def further(column, value):
        return f"t_s,amplitude_m,{column}\n" + good.replace("\n", f",{value}\n")

    wrong = [
        *GARBAGE, *MALFORMED_CSV, *SPECIAL, ("a header alone", head),
        ("four points", head + "\n".join(good.split("\n")[:4])), ("another header", f"a,b\n{good}"),
        ("an unknown parameter", further("none_such", 1)),
        *((f"t_s = {t}", f"{head}{good}{t},0.01\n") for t in ("nan", "inf", "1e999", "", "x", "-1", "0", "0x1")),
        *((f"amplitude_m = {x}", f"{head}{good}0.07,{x}\n") for x in ("nan", "inf", "-inf", "1e999", "", "x")),
        *((f"sigma_m = {sigma}", further("sigma_m", sigma)) for sigma in ("0", "-1", "nan", "")),
        *((f"length_m = {length}", further("length_m", length)) for length in ("0", "-1", "nan", "1e308", "x")),
    ]
    for name, what in wrong:
        yield Case("calibrate", "record", name, ["--set", "data=data.csv", "--out", "t.csv"], {"data.csv": what})


def states():
    """What an interrupted run of simulate may have left."""
    for name, what in (*GARBAGE, *SPECIAL):
        if what is None:
            continue
        maybe = what == ITSELF
        for ending in ("state", "frames"):
            if ending == "frames" and what == "":  # goes with what made it: a lock
                continue
            yield Case("simulate", f".{ending}", name, ["scene.toml", "--out", "out", "--resume"],
                       {"scene.toml": SCENE, "out/scene.state": "x", f"out/scene.{ending}": what}, maybe)
        for ending in ("state", "h5", "csv"):
            # A table or frames to be written again are not read.
            read = ending == "state"
            if read or not is_text(what):
                resume = ["--resume"] if read else []
                yield Case("simulate", f"head's .{ending}", name,
                           ["scene.toml", "--as", "batch", "--out", "out", *resume],
                           {"scene.toml": HEAD_SCENE, f"out/scene.{ending}": what}, maybe)


def corpus(programs, shipped, headers, seed, count):
    """Yields all of them, in an order that depends on nothing but the seed."""
    yield from scenes(shipped, seed, count)
    yield from options_files(programs)
    yield from command_lines(programs)
    yield from tables(headers)
    yield from records()
    yield from states()
