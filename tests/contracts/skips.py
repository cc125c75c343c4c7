"""Compares the skipped cases of the contract suite with those that are meant to be skipped.

    skips.py [--rewrite] EXPECTED.csv SHARD.xml...

Counts skipped cases by test and reason, over all shards. A contract that a model no longer
keeps, or a new one that nobody tests, would otherwise be one more skip among hundreds.
--rewrite first writes the table. Exit codes: 0 as expected, 1 otherwise."""
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def counted(shards):
    """Returns the number of skipped cases by "test,reason", and the number of all cases."""
    skipped, cases = Counter(), 0
    for shard in shards:
        for case in ElementTree.parse(shard).iter("testcase"):
            cases += 1
            for skip in case.iter("skipped"):
                # The message is "file:line\nreason", the name Test/parameter.
                reason = " ".join(skip.get("message").split("\n")[1:]).strip()
                skipped[f"{case.get('name').split('/')[0]},{reason}"] += 1
    return skipped, cases


def expected(table):
    rows = (line.rpartition(",") for line in table.read_text(encoding="utf-8").splitlines()[1:] if line)
    return Counter({key: int(cases) for key, _, cases in rows})


def main(rewrite, table, shards):
    found, cases = counted(shards)
    if rewrite:
        rows = [f"{key},{found[key]}\n" for key in sorted(found)]
        table.write_text("test,reason,cases\n" + "".join(rows), encoding="utf-8")
    meant = expected(table)
    wrong = 0
    for key in sorted(found | meant):
        differs = "" if found[key] == meant[key] else f"  NOT AS EXPECTED: {meant[key]}"
        wrong += differs != ""
        print(f"{found[key]:5}  {key.replace(',', ': ', 1)}{differs}")
    print(f"{found.total()} of {cases} cases skipped")
    if wrong:
        print(f"look at each difference; then: python3 {sys.argv[0]} --rewrite {table} {' '.join(map(str, shards))}")
    return 1 if wrong or not cases else 0


if __name__ == "__main__":
    rewrite = sys.argv[1:2] == ["--rewrite"]
    expected_table, *reports = map(Path, sys.argv[2:] if rewrite else sys.argv[1:])
    sys.exit(main(rewrite, expected_table, reports))
