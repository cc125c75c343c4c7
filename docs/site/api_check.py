#!/usr/bin/env python3
"""Counts the public names of the C++ API that have a description.

    api_check.py XML [--list [FOLDER]]

XML: folder of Doxygen's XML. Counted: classes, enumerations, enumerators, functions, variables
and aliases of the headers. A function that implements a described one needs no description of
its own, nor does an enumerator that the description of its enumeration names. Left out:
destructors, deleted and defaulted functions, friend classes and friend operators.

Prints described / all for each folder. Exit code 1 if a name has no description."""
import argparse
import re
import sys
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

COMPOUNDS = ("class", "struct", "union")


def description(element):
    return " ".join("".join(found.itertext()) for tag in ("briefdescription", "detaileddescription")
                    if (found := element.find(tag)) is not None).strip()


def is_counted(member):
    name, arguments = member.findtext("name"), member.findtext("argsstring") or ""
    if member.get("prot") != "public" or name.startswith("~"):
        return False
    if re.search(r"= ?(default|delete)$", arguments):
        return False
    if member.get("kind") == "friend":  # a function only, and no operator
        return "(" in arguments and not name.startswith("operator")
    return True


class Names:
    """The public names in a folder of XML: name, file and line, and whether it is described."""

    def __init__(self, xml):
        self.members, self.found = {}, []
        compounds = [compound for path in sorted(Path(xml).glob("*.xml"))
                     for compound in ET.parse(path).getroot().findall("compounddef")]
        hidden = {inner.get("refid") for compound in compounds for inner in compound.iter("innerclass")
                  if inner.get("prot") == "private"}
        for compound in compounds:
            if compound.get("kind") in COMPOUNDS and compound.get("id") not in hidden:
                self.add(compound, compound.findtext("compoundname"), description(compound))
        for compound in compounds:
            if compound.get("kind") in (*COMPOUNDS, "namespace") and compound.get("id") not in hidden:
                scope = compound.findtext("compoundname")
                for member in compound.iter("memberdef"):
                    self.members.setdefault(member.get("id"), (scope, member))
        self.virtual = {member.findtext("name") for _, member in self.members.values()
                        if member.get("virt") == "pure-virtual" and description(member)}
        for scope, member in self.members.values():
            if is_counted(member):
                self.add_member(scope, member)

    def add(self, element, name, good):
        location = element.find("location")
        self.found.append((location.get("file"), int(location.get("line")), name, bool(good)))

    def add_member(self, scope, member):
        name = f"{scope}::{member.findtext('name')}"
        self.add(member, name, self.is_described(member))
        for value in member.findall("enumvalue"):
            word = value.findtext("name")
            named = re.search(rf"\b{word}\b", description(member))
            self.add(member, f"{name}::{word}", description(value) or named)

    def is_described(self, member):
        if description(member):
            return True
        bases = [self.members.get(base.get("refid")) for base in member.findall("reimplements")]
        if not bases and " override" in (member.findtext("argsstring") or ""):  # of a dependent base class
            return member.findtext("name") in self.virtual
        return any(self.is_described(base) for _, base in filter(None, bases))


def folder_of(file):
    return Path(file).parts[0]


def counts(names):
    """Returns the number of names by folder, and of those without a description."""
    every = Counter(folder_of(file) for file, *_ in names.found)
    without = Counter(folder_of(file) for file, *_, good in names.found if not good)
    return every, without


def report(xml, listed=None):
    """Prints the counts. Returns false if a name has no description."""
    names = Names(xml)
    for file, line, name, good in sorted(names.found):
        if listed is not None and not good and file.startswith(listed):
            print(f"{file}:{line}: {name}")
    every, without = counts(names)
    for folder in sorted(every):
        print(f"docs: {folder}: {every[folder] - without[folder]} of {every[folder]} public names described")
    for folder in sorted(without):
        print(f"docs: {folder}: {without[folder]} public names without a description; "
              f"list: api_check.py {xml} --list {folder}", file=sys.stderr)
    return not without


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("xml", type=Path, help="folder of Doxygen's XML")
    options.add_argument("--list", nargs="?", const="", help="print the names without a description")
    options = options.parse_args()
    return 0 if report(options.xml, options.list) else 1


if __name__ == "__main__":
    sys.exit(main())
