"""Times of the programs that answer the questions of the README."""
from .words import duration


def time(tables, question):
    """Returns the processor time of the program that answers a question on the scene of the quick start."""
    return duration(tables.row("question_times", {"question": question})["processor_s"], 1)


def answer(tables, question):
    """Returns a part of a line that the program printed."""
    return f"`{tables.row('question_times', {'question': question})['answer']}`"


def all_four(tables):
    """Returns the processor time of the programs of `./tress ask`."""
    asked = ["stability_limit", "hard_cases", "effect_audit", "cost_of_accuracy"]
    return duration(tables.rows("question_times", {"question": asked})["processor_s"].sum(), 1)
