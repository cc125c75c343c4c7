"""What notebooks show: strands as drawings, tables as tables, runs with a progress bar."""

import html
import sys
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

_SIZE, _MARGIN, _ROWS = 360, 12, 12


def drawing(poses: Iterable[tuple[float, list[np.ndarray]]], title: str) -> str:
    """Returns an SVG of strands in the plane of x and z. A pose is its place in time, from 0
    to 1, and the points of each strand (points, 3)."""
    poses = list(poses)
    points = np.concatenate([x for _, strands in poses for x in strands])[:, [0, 2]]
    points = points[np.isfinite(points).all(axis=1)]
    low, high = points.min(axis=0), points.max(axis=0)
    scale = (_SIZE - 2 * _MARGIN) / max(*(high - low), 1e-12)
    lines = []
    for place, strands in poses:
        for x in strands:
            across = _MARGIN + (x[:, 0] - low[0]) * scale
            down = _MARGIN + (high[1] - x[:, 2]) * scale
            path = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, down))
            lines.append(f'<polyline points="{path}" fill="none" stroke="#2a5d8f" '
                         f'stroke-opacity="{0.15 + 0.85 * place:.2f}"/>')  # fmt: skip
    height = int(2 * _MARGIN + (high[1] - low[1]) * scale) + 1
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{_SIZE}" height="{height}">'
            f"<title>{html.escape(title)}</title>{''.join(lines)}</svg>")  # fmt: skip


def table_html(columns: dict[str, np.ndarray], rows: int) -> str:
    """Returns the first rows of a table as HTML."""
    heads = "".join(f"<th>{html.escape(name)}</th>" for name in columns)
    lines = []
    for k in range(min(rows, _ROWS)):
        cells = "".join(f"<td>{html.escape(str(c[k]))}</td>" for c in columns.values())
        lines.append(f"<tr>{cells}</tr>")
    more = f"<p>{rows} rows, {len(columns)} columns</p>"
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(lines)}</tbody></table>{more}"


def _notebook() -> Any:
    """Returns the module IPython.display in a notebook, else None."""
    shell = sys.modules.get("IPython")
    if shell is None or type(shell.get_ipython()).__name__ != "ZMQInteractiveShell":
        return None
    from IPython import display

    return display


def progress_line() -> Callable[[float, float], None]:
    """Returns a function of (time, duration) that shows the progress of a run: a bar in a
    notebook, otherwise a line on standard error."""
    notebook = _notebook()
    if notebook is not None:
        bar = notebook.ProgressBar(1000)
        bar.display()

        def move(t: float, duration: float) -> None:
            bar.progress = round(1000 * t / duration)

        return move

    def line(t: float, duration: float) -> None:
        end = "\n" if t >= duration else ""
        print(f"\r{t:.3f} of {duration:g} s", end=end, file=sys.stderr, flush=True)

    return line
