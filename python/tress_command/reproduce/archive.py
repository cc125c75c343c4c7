"""./tress archive: the results of a release in one file, with checksums."""

import gzip
import hashlib
import io
import json
import os
import re
import tarfile
from pathlib import Path, PurePosixPath

from .. import place
from ..command import Command, read_words
from ..compare.tables import manifest_of
from ..files import MEBIBYTE, read_text
from ..messages import refuse, say
from ..processes import read
from ..version import commit_of
from .recipes import tables_of

SUMS, CONTENTS = "SHA256SUMS", "MANIFEST.json"
LIMIT = 1024 * MEBIBYTE  # of an unpacked archive
# Of a folder that git does not track, as .gitignore leaves them out of results/.
LEFT_OUT = re.compile(r".*\.(journal|part|lock|h5|xdmf)|report\.html|.*\.reference/.*"
                      r"|scenes/(?!.*\.meta\.json).*\.json|(ask|cluster|compare|simulate)/.*")
REMEDY = "fetch or write the archive again"


def _files(folder):
    """Returns the files of a folder of results: those that git has, where it has some."""
    listed = read("git", "ls-files", "-z", "--", str(folder)).stdout.split("\0")
    tracked = [Path(name) for name in listed if name]
    paths = tracked or [path for path in folder.rglob("*") if not LEFT_OUT.fullmatch(
        path.relative_to(folder).as_posix())]
    return sorted((path for path in paths if path.is_file() and not path.is_symlink()
                   and path.name not in (SUMS, CONTENTS)), key=lambda path: path.as_posix())


def _table_facts(folder):
    facts = {}
    for table in tables_of(folder):
        manifest = manifest_of(folder, table)
        git = manifest.get("git") or {}
        if git.get("commit"):
            facts[table] = {"commit": git["commit"], "dirty": bool(git.get("dirty")),
                            "rows": (manifest.get("rows") or {}).get("total")}
    return facts


def commits_of(facts):
    """Returns the commits of tables, with their number of tables, the most frequent first."""
    numbers = {}
    for one in facts.values():
        numbers[one["commit"]] = numbers.get(one["commit"], 0) + 1
    return sorted(numbers.items(), key=lambda pair: (-pair[1], pair[0]))


def _member(name, data):
    """Returns the header of a file: the same for everybody who packs it."""
    member = tarfile.TarInfo(name)
    member.size, member.mode, member.mtime = len(data), 0o644, 0
    return member


def write_archive(folder, out, version, commit):
    """Writes the archive of a folder. The same files give the same bytes. Returns the facts of
    its tables and the SHA-256 of the archive."""
    files = {path.relative_to(folder).as_posix(): path.read_bytes() for path in _files(folder)}
    if not any(name.endswith(".csv") for name in files):
        refuse(f"archive: {folder}: has no tables; give a folder of results")
    facts = _table_facts(folder)
    commits = commits_of(facts)
    contents = {"version": version, "commit": commits[0][0] if len(commits) == 1 else commit,
                "tables": facts}
    files[CONTENTS] = (json.dumps(contents, indent=2, sort_keys=True) + "\n").encode()
    sums = "".join(f"{hashlib.sha256(files[name]).hexdigest()}  {name}\n"
                   for name in sorted(files))
    files[SUMS] = sums.encode()
    packed = io.BytesIO()
    with gzip.GzipFile("", "wb", 9, packed, mtime=0) as zipped, \
            tarfile.open(fileobj=zipped, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for name in sorted(files):
            tar.addfile(_member(f"tress-{version}-results/{name}", files[name]),
                        io.BytesIO(files[name]))
    part = Path(f"{out}.part")
    part.write_bytes(packed.getvalue())
    os.replace(part, out)
    return facts, hashlib.sha256(packed.getvalue()).hexdigest()


def _members(path):
    """Returns the files of an archive, by their name below its folder."""
    files, total = {}, 0
    with tarfile.open(path, "r:gz") as tar:
        for member in tar:
            if member.isdir():
                continue
            parts = PurePosixPath(member.name).parts
            total += member.size
            if not member.isreg() or len(parts) < 2 or parts[0] == "/" or ".." in parts:
                refuse(f"{path}: {member.name}: no file of results; {REMEDY}")
            if total > LIMIT:
                refuse(f"{path}: more than {LIMIT // MEBIBYTE} MiB; {REMEDY}")
            files["/".join(parts[1:])] = tar.extractfile(member).read()
    return files


def check_sums(name, text, digests):
    """Refuses files that are not those of a list of checksums. digests: by name."""
    listed = {}
    for number, line in enumerate(text.splitlines(), 1):
        found = re.fullmatch(r"([0-9a-f]{64})  (.+)", line)
        if not found:
            refuse(f"{name}: {SUMS}:{number}: no checksum; {REMEDY}")
        listed[found[2]] = found[1]
    for file in sorted(listed.keys() | digests.keys()):
        if listed.get(file) != digests.get(file):
            why = ("is missing" if file not in digests else
                   f"is not in {SUMS}" if file not in listed else "has another checksum")
            refuse(f"{name}: {file}: {why}; {REMEDY}")


def unpack(path, folder):
    """Checks an archive and writes its files into a folder. Refuses one that was changed."""
    try:
        files = _members(path)
    except (tarfile.TarError, EOFError, gzip.BadGzipFile) as error:
        refuse(f"{path}: no archive of results ({error}); {REMEDY}")
    if SUMS not in files:
        refuse(f"{path}: has no {SUMS}; {REMEDY}")
    sums = files.pop(SUMS).decode(errors="replace")
    check_sums(path, sums, {name: hashlib.sha256(data).hexdigest() for name, data in files.items()})
    for name, data in files.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)
    return folder


def check_folder(folder):
    """Checks a folder that has checksums, such as an unpacked archive. Returns true if it has."""
    if not (folder / SUMS).is_file():
        return False
    digests = {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
               for path in folder.rglob("*") if path.is_file() and path.name != SUMS}
    check_sums(folder, read_text(folder / SUMS), digests)
    return True


def _run(words, _):
    given = read_words("archive", words, valued=("--out",), names=True)
    if len(given.names) > 1:
        refuse("archive: give one folder of results")
    folder = Path(given.names[0] if given.names else "results")
    if not folder.is_dir():
        refuse(f"archive: no folder '{folder}'; paths are relative to {os.getcwd()}")
    version, root = place.version()
    out = given.options.get("--out", f"tress-{version}-results.tar.gz")
    facts, digest = write_archive(folder, out, version, commit_of(root))
    commits = commits_of(facts)
    if len(commits) > 1:
        say("archive: the tables come from "
            + ", ".join(f"{commit[:8]} ({number})" for commit, number in commits)
            + "; ./tress reproduce makes them of one commit")
    if dirty := [table for table, one in facts.items() if one["dirty"]]:
        say(f"archive: made with uncommitted changes: {' '.join(dirty)}")
    print(f"{digest}  {out}")


ARCHIVE = Command(
    "archive", "[--out FILE] [FOLDER]",
    "packs a folder of results (default: results) into one file with checksums, for a release. "
    "The same files give the same bytes. Prints the SHA-256 of the file. Files of results/ that "
    "git does not track are left out.",
    _run,
    example="./tress archive --out tress-results.tar.gz",
    time="seconds.",
    options=(("--out FILE", "the archive (default: tress-VERSION-results.tar.gz)"),))
