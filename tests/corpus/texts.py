"""Bad texts, each (name, text), and special files: what programs are given to read."""
from dataclasses import dataclass


def random(seed):
    """Returns a function that draws numbers in [0, 1) by Marsaglia's xorshift, in 32 bits."""
    x = (seed * 2654435761 + 1) % 2**32 or 1

    def draw():
        nonlocal x
        x ^= x << 13 & 0xFFFFFFFF
        x ^= x >> 17
        x ^= x << 5 & 0xFFFFFFFF
        return x / 2**32

    return draw


def noise(count, seed):
    draw = random(seed)
    return bytes(int(256 * draw()) for _ in range(count))


@dataclass(frozen=True)
class Special:
    """A file that is not to be read: a folder, a pipe, or a link."""
    kind: str
    to: str = ""


ITSELF = Special("link", "itself")


def is_text(what):
    return isinstance(what, (str, bytes))


LEVELS = 31_000

# No text of any kind that a program of tress reads.
GARBAGE = (
    ("nothing", ""),
    ("blanks", " \t\n\n"),
    ("a NUL byte", "a\0b = 1\n"),
    ("a byte order mark", "\ufeff"),
    ("noise", noise(4096, 1)),
    ("more noise", noise(70_000, 2)),
    ("the head of a picture", b"\x89PNG\r\n\x1a\n"),
    ("half a character", b'title = "\xe2\x82'),
    ("half a character in a comment", b"# \xf0\x9f"),
    ("a surrogate", b'a = "\xed\xa0\x80"'),
    ("an overlong slash", b'a = "\xc0\xaf"'),
    ("Latin 1", 'titel = "Stra\xdfe"\n'.encode("latin-1")),
    ("UTF-16", 'title = "a"\n'.encode("utf-16-le")),
    ("JSON", '{"title": "a", "strand": {"elements": 3}}\n'),
    ("YAML", "title: a\nstrand:\n  - elements: 3\n"),
    ("XML", '<?xml version="1.0"?>\n<scene title="a"/>\n'),
    ("a table", "t_s,x_m\n0,1\n1,2\n"),
    ("one long line", "x" * 1_000_000),
    ("one long quoted line", '"' + "x" * 1_000_000),
    ("carriage returns", 'title = "a"\relements = 3\r'),
    ("an escape sequence", 'title = "a"\n\x1b[31m = 1\n'),
)

# No TOML, or TOML that nothing asks for.
MALFORMED_TOML = (
    ("a string without end", 'title = "a\n'),
    ("a long string without end", 'title = """a\n'),
    ("a list without end", "elements = [1, 2\n"),
    ("a table without end", "settings = {a = 1\n"),
    ("a header without end", "[settings\n"),
    ("a key without value", "title =\n"),
    ("a value without key", "= 1\n"),
    ("a key twice", 'title = "a"\ntitle = "a"\n'),
    ("a table twice", 'title = "a"\n[settings]\n[settings]\n'),
    ("a table that was a value", 'title = "a"\n[title.b]\n'),
    ("a number of 400 digits", f"seed = {'9' * 400}\n"),
    ("a hexadecimal number too large", "seed = 0xffffffffffffffffffffff\n"),
    ("an impossible date", "title = 2026-02-31\n"),
    ("a wrong escape", 'title = "\\q"\n'),
    ("a surrogate by its number", 'title = "\\ud800"\n'),
    ("a long key", f"{'k' * 1_000_000} = 1\n"),
    ("a long number", f"seed = 1{'0' * 1_000_000}\n"),
    ("many keys", "".join(f"k{i} = 1\n" for i in range(50_000))),
    ("many tables", "".join(f"[t{i}]\n" for i in range(20_000))),
    ("many of one table", 'title = "a"\n' + "[[nothing]]\n" * 20_000),
    ("a deep key", f"{'a.' * LEVELS}a = 1\n"),
    ("a deep key of quoted parts", f"""{'"a".' * LEVELS}a = 1\n"""),
    ("a deep key with blanks", f"{'a . ' * LEVELS}a = 1\n"),
    ("a deep header", f"[{'a.' * LEVELS}a]\n"),
    ("a deep header of many", f"[[{'a.' * LEVELS}a]]\n"),
    ("a deep key in a table", f"a = {{{'a.' * LEVELS}a = 1}}\n"),
    ("a deep key behind a string", f'a = [""""b""""", {{{"a." * LEVELS}a = 1}}]\n'),
    ("a deep key behind a comment", f"""# "\n{'a.' * LEVELS}a = 1\n"""),
    ("a deep list", f"a = {'[' * LEVELS}\n"),
    ("a deep list that ends", f"a = {'[' * LEVELS}{']' * LEVELS}\n"),
    ("deep tables", f"a = {'{a=' * LEVELS}\n"),
    ("deep tables of deep keys", f"b = {'{a.a.a.a.a.a.a.a.a.a=[' * 200}\n"),
    ("more than 4 MiB", f"""title = "a"\n{'#' * (4 << 20)}"""),
)

# No table, whatever its columns should be.
MALFORMED_CSV = (
    ("a quote without end", 'a,b\n1,"2\n'),
    ("a stray quote", 'a,b\n1,2"3\n'),
    ("a character after a quote", 'a,b\n"1"2,3\n'),
    ("too few cells", "a,b\n1\n"),
    ("too many cells", "a,b\n1,2,3\n"),
    ("a column twice", "a,a\n1,2\n"),
    ("many columns", ",".join(f"c{i}" for i in range(5000)) + "\n"),
    ("many lines", "a\n" + "1\n" * 4_000_000),
    ("more than 16 MiB", "a\n" + "1" * (17 << 20)),
)

# Not to be read at all; None is no file.
SPECIAL = (
    ("no file", None),
    ("a folder", Special("folder")),
    ("a pipe", Special("pipe")),
    ("/dev/zero", Special("link", "/dev/zero")),
    ("/dev/urandom", Special("link", "/dev/urandom")),
    ("a terminal", Special("link", "/dev/tty")),
    ("a link to itself", ITSELF),
)

# Values that fit no key of a scene: numbers out of all ranges, and other types.
WRONG_VALUES = ("nan", "inf", "-inf", "1e999", "-1e308", "1979-05-27", "{}", "[[]]", '""', "[nan, 0, 0]")

GRIDS = (
    ("an empty grid", ""),
    ("words for a grid", "signed distances\n"),
    ("half a grid", "4 4 4\n0 0 0\n0.1\n1 2 3\n"),
    ("more than a grid", f"4 4 4\n0 0 0\n0.1\n{'1 ' * 65}\n"),
    ("a small grid", f"3 3 3\n0 0 0\n0.1\n{'1 ' * 27}\n"),
    ("a grid of 1e18", "1000000 1000000 1000000\n0 0 0\n0.1\n"),
    ("a grid beyond all numbers", "99999999999999999999 4 4\n"),
    ("a negative grid", "-4 -4 -4\n0 0 0\n0.1\n"),
    ("a grid that is not finite", f"4 4 4\n0 0 0\n0.1\nnan {'1 ' * 63}\n"),
    ("a grid without spacing", f"4 4 4\n0 0 0\n0\n{'1 ' * 64}\n"),
    ("a grid of one word", "4" * 5_000_000),
    ("a grid of comments", "#\n" * 2_000_000),
    ("noise for a grid", noise(100_000, 3)),
    ("NUL bytes for a grid", bytes(5_000_000)),
)

# A scene that runs as a head.
HEAD_SCENE = """\
title = "a head"
duration_s = 0.05
frames_per_s = 30
checkpoint_s = 0.02
[model]
jacobian = "elastic"
[integrator]
id = "linearly_implicit_euler"
dt_s = 0.01
[groom]
count = 3
length_m = 0.1
elements = 2
[root]
motion = "fixed"
[effects.gravity]
"""

# A scene with all tables, every value on a line of its own.
SCENE = """\
title = "a strand"
duration_s = 0.05
frames_per_s = 30
checkpoint_s = 0.02
seed = 1
[model]
id = "super_helix"
[integrator]
id = "linearly_implicit_euler"
dt_s = 0.001
newton_iterations = 20
[material]
name = "hair.asian"
internal_friction_kg_m3_s = 1e-10
radius_m = 40e-6
density_kg_m3 = 1300
youngs_modulus_pa = 2e9
[strand]
shape = "straight"
length_m = 0.1
elements = 3
position_m = [0, 0, 0]
root_tangent = [1, 0, 0]
[groom]
count = 3
length_m = 0.1
elements = 2
[root]
motion = "shake"
amplitude_m = 0.02
frequency_hz = 2
[effects.gravity]
gravity_m_s2 = [0, 0, -9.81]
[effects.linear_drag]
[[effects.body]]
shape = "sphere"
radius_m = 0.05
"""
