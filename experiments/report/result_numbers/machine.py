"""Machine, date and commit of every table."""
import math
from collections import Counter
from datetime import datetime

from .words import must, number, table


def _quick(tables):
    """Returns the manifests of `./tress run`."""
    return [manifest for manifest in tables.manifests.values() if manifest.get("quick")]


def _commit(manifest):
    git = manifest.get("git") or {}
    if not git.get("commit"):
        return "unknown"
    return git["commit"][:7] + (" with uncommitted changes" if git.get("dirty") else "")


def _machine(manifest):
    return manifest.get("machine") or {}


def _loads(manifest):
    """Returns the load before and after the run, if it was recorded."""
    loads = (_machine(manifest).get(key) for key in ("load_before", "load_after"))
    return [load[0] for load in loads if isinstance(load, list)]


def _times_uncertain(manifest):
    """Returns whether there were more runnable processes than processors: a timed thread had to share one."""
    return bool(manifest.get("timings")) and any(load > _machine(manifest)["cpus"] for load in _loads(manifest))


def processors(tables):
    names = (f"{_machine(one).get('cpu')} ({_machine(one).get('cpus')} processors)" for one in _quick(tables))
    return "; ".join(dict.fromkeys(names))


def one_run(tables):
    """Returns whether the tables of `./tress run` come from one run."""
    commits = Counter(map(_commit, _quick(tables)))
    must(commits, "some table is made by ./tress run")
    made = f"The {commits.total()} tables of `./tress run` come from"
    if len(commits) == 1:
        return f"{made} commit {next(iter(commits))}"
    each = ", ".join(f"{count} from {commit}" for commit, count in commits.items())
    return f"{made} {len(commits)} commits, not from one run ({each})"


def made_table(tables):
    """Returns, for every table, commit, date, processor, load, and whether its times can be trusted."""
    return table(
        ["table", "commit", "date", "processor", "load before, after", "SUNDIALS check", "times"],
        [[f"`{name}`", _commit(one), str(one.get("start") or "")[:10],
          f"{_machine(one).get('cpu')}, {_machine(one).get('cpus')} processors", ", ".join(f"{load:.2f}" for load in _loads(one)),
          number(one.get("sundials_speed_ratio")),
          "" if not one.get("timings") else "uncertain" if _times_uncertain(one) else "load within limit"]
         for name, one in tables.manifests.items()])


def sundials_scatter(tables):
    """Returns the scatter of the speed check between tables."""
    found = [one.get("sundials_speed_ratio") or 0 for one in tables.manifests.values()]
    ratios = [ratio for ratio in found if ratio > 0]
    return f"{number(min(ratios))} to {number(max(ratios))} over {len(ratios)} tables"


def minutes_of(manifests):
    """Returns the wall time of all together, rounded up to whole minutes."""
    spent = (datetime.fromisoformat(one["end"]) - datetime.fromisoformat(one["start"]) for one in manifests)
    return math.ceil(sum(time.total_seconds() for time in spent) / 60)


def run_minutes(tables):
    return minutes_of(_quick(tables))


def provenance(tables, names):
    """Returns the commits of the tables of a page; "": no table has a manifest."""
    all_of = {name: one for name, one in tables.manifests.items() if name in names}
    commits = {}
    for name, one in all_of.items():
        commits.setdefault(_commit(one), []).append(f"`{name}`")
    if not commits:
        return ""
    each = "; ".join(f"{commit}: {', '.join(of)}" for commit, of in commits.items())
    loaded = [f"`{name}`" for name, one in all_of.items() if _times_uncertain(one)]
    uncertain = f" Times of {', '.join(loaded)} are uncertain: other programs ran." if loaded else ""
    return f"Tables of this page by commit: {each}.{uncertain}"
