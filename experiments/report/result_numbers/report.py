"""Sentences and rows that the report page computes, quoted from its program: each is computed in one
place."""
import json
import subprocess

import pandas as pd

from .tables import REPORT, InputError


def _answers(root):
    command = ["node", str(REPORT / "quoted.mjs"), str(root / "results")]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    except FileNotFoundError:
        raise InputError("node is not installed; install the package nodejs") from None
    except subprocess.CalledProcessError as error:
        if error.returncode != 2:
            raise
        raise InputError(error.stderr.strip()) from None
    return json.loads(done.stdout)


def quoted(tables, name):
    """Returns the report's answer. The tables behind it count as read."""
    answer = tables.once(_answers)[name]
    tables.read.update(answer["tables"])
    if "error" in answer:
        raise InputError(f"the report cannot compute it ({answer['error']}); make the tables with ./tress run")
    return answer["value"]


def told(tables, name):
    """Returns the report's answer; an empty one is an error."""
    found = quoted(tables, name)
    if not found:
        raise InputError("the tables of results/ hold no rows for it; make them with ./tress run")
    return found


def figure_tables(tables, name):
    """Returns the tables that a figure of results/ is drawn from; none for a picture of a scene."""
    return tables.once(_answers)["figures"]["value"].get(name, [])


def rows(tables, name):
    return pd.DataFrame(told(tables, name))
