"""Parts of pages that are made when the site is built, of sources that need no compiler."""
import subprocess
import tomllib


def scenes(root):
    """Returns a table of the shipped scenes, and their pictures where there are any."""
    rows, pictures = ["| Scene | Shows | Model | Source |", "|---|---|---|---|"], []
    for path in sorted(root.glob("scenes/*.toml")):
        scene = tomllib.loads(path.read_text())
        file = f"[`{path.name}`](../../scenes/{path.name})"
        rows.append(f"| {file} | {scene['title']} | `{scene['model']['id']}` | {scene['source']} |")
        if (root / f"results/{path.stem}.png").exists():
            pictures.append(f"![{scene['title']}](../../results/{path.stem}.png)\n\n*{scene['title']}*")
    return "\n".join(rows) + "\n\n## Pictures\n\n" + "\n\n".join(pictures)


def tress_help(root):
    done = subprocess.run([root / "tress", "help", "all"], text=True, capture_output=True, check=True)
    return f"```text\n{done.stdout.rstrip()}\n```"


PARTS = {"<!-- made here: scenes -->": scenes, "<!-- made here: tress help -->": tress_help}


def with_parts(root, text):
    for mark, made in PARTS.items():
        if mark in text:
            text = text.replace(mark, made(root))
    return text
