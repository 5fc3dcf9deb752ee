"""What the documentation site (mkdocs.yml) adds to its pages: the table of options, from the igsp command itself, the
changelog, and every decision in the navigation.

IGSP in the environment is the command to ask; without it, the one in build/release.
"""
import json
import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def options_of(preset: str) -> list[dict]:
    """The option list with the values of a preset."""
    igsp = os.environ.get("IGSP", str(ROOT / "build/release/bin/igsp"))
    listed = subprocess.run([igsp, "options", "--json", "--preset", preset], capture_output=True, text=True, check=True)
    return json.loads(listed.stdout)


def cell(value: object) -> str:
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return text.replace("|", "\\|").replace("*", "\\*")


def options_table() -> str:
    """Markdown, a heading and a table per section."""
    lines: list[str] = []
    section = None
    for option, paper in zip(options_of("default"), options_of("paper"), strict=True):
        name = option["key"].rpartition(".")[0]
        if name != section:
            section = name
            lines += ["", f"### {section or 'Top level'}", "", "| option | default | paper | admissible | what it is |",
                      "|---|---|---|---|---|"]
        key = option["key"].rpartition(".")[2]
        unit = f" [{option['unit']}]" if option["unit"] else ""
        values = [cell(option["value"]), cell(paper["value"]), cell(option["admissible"]), cell(option["help"] + unit)]
        lines.append(f"| `{key}`<br>`{option['flag']}` | " + " | ".join(values) + " |")
    return "\n".join(lines)


PLACES = {"<!-- options table -->": options_table, "<!-- changelog -->": (ROOT / "CHANGELOG.md").read_text}


def on_page_markdown(markdown: str, **_: object) -> str:
    for place, text in PLACES.items():
        if place in markdown:
            markdown = markdown.replace(place, text())
    return markdown


def on_config(config, **_: object):
    """All decisions in the order of their numbers, so that a new one needs no line elsewhere."""
    for entry in config["nav"]:
        if "Decisions" in entry:
            pages = sorted((ROOT / "docs/decisions").glob("*.md"))
            entry["Decisions"] = [str(page.relative_to(ROOT / "docs")) for page in pages]
    return config


def on_files(files, **_: object):
    """Scripts beside the pages are not part of the site."""
    for file in list(files):
        if file.src_path.endswith(".py"):
            files.remove(file)
    return files
