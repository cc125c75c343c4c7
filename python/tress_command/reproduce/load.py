"""Load of the machine by other programs, before a timing begins."""

import os
import time

MOST_LOAD = 0.5  # processors that others may use; experiments/run/row_loads.h has the same
LOOK_S = 5  # duration of a measurement


def busy_s(file="/proc/stat"):
    """Returns the processor time that all programs have used (s), None where the system does
    not tell."""
    try:
        with open(file, encoding="ascii") as stat:
            ticks = [int(word) for word in stat.readline().split()[1:9]]
    except (OSError, ValueError):
        return None
    # user, nice, system, idle, iowait, irq, softirq, steal
    return sum(ticks[:3] + ticks[5:]) / os.sysconf("SC_CLK_TCK")


def load_of_others(seconds):
    """Measures for some seconds. Returns the mean number of processors that programs used,
    None where the system does not tell."""
    before, since = busy_s(), time.monotonic()
    time.sleep(seconds)
    after, passed = busy_s(), time.monotonic() - since
    return None if before is None or after is None else max(0.0, (after - before) / passed)


def wait_for_idle(limit_s, say, look=load_of_others, clock=time.monotonic):
    """Waits until other programs use at most MOST_LOAD processors, or for limit_s. Returns the
    last load and the time waited (s)."""
    since, told = clock(), False
    while True:
        load = look(min(LOOK_S, max(0.5, limit_s)))
        waited = clock() - since
        if load is None or load <= MOST_LOAD or waited >= limit_s:
            return load, waited
        if not told:
            say(f"other programs use {load:.1f} processors; waiting up to {limit_s:.0f} s for an "
                "idle machine")
            told = True


def doubt(manifest):
    """Returns why the times of a table are uncertain, "" if nothing is known against them."""
    machine = manifest.get("machine") or {}
    during = machine.get("load_of_others_during")
    if during:
        above = len(during.get("rows_above", ()))
        return f"{above} rows were timed under load" if above else ""
    loads = [machine[key][0] for key in ("load_before", "load_after") if machine.get(key)]
    if loads and max(loads) > machine.get("cpus", 1):
        return f"load average {max(loads):.1f} on {machine.get('cpus', 1)} processors"
    return ""
