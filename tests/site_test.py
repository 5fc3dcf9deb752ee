"""Builds the documentation site and reads it as a visitor would: no warning of MkDocs, every page in the navigation,
every link and anchor leads somewhere, every picture is there, nothing is loaded from elsewhere, and the page of options
has them all. usage: site_test.py IGSP SITE_FOLDER. Exit code 77, "skipped", where MkDocs Material is not installed.
"""
import json
import os
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parent.parent
SKIPPED = 77


class Page(HTMLParser):
    """Links, anchors and what a page loads."""

    def __init__(self, path: Path):
        super().__init__()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.anchors: set[str] = {""}
        self.feed(path.read_text())

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attributes}
        self.anchors |= {values.get("id", ""), values.get("name", "")}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        elif tag in ("img", "script", "link", "iframe") and (address := values.get("src") or values.get("href")):
            if values.get("rel") != "canonical":
                self.loaded.append(address)


def build(igsp: Path, site: Path) -> None:
    environment = dict(os.environ, IGSP=str(igsp.resolve()))
    done = subprocess.run(["/usr/bin/mkdocs", "build", "--strict", "--clean", "--config-file", ROOT / "mkdocs.yml",
                           "--site-dir", site.resolve()], capture_output=True, text=True, env=environment)
    said = done.stdout + done.stderr
    if done.returncode != 0 or "WARNING" in said or "not included in the \"nav\"" in said:
        sys.exit(said)


def faults_of(site: Path) -> list[str]:
    """What leads nowhere, as sentences."""
    pages = {path: Page(path) for path in site.rglob("*.html")}
    faults = []
    for path, page in pages.items():
        if path.name == "404.html":  # its addresses begin at the root of the server
            continue
        for address in page.links + page.loaded:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                if address in page.loaded:
                    faults.append(f"{path}: loads {address}")
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                faults.append(f"{path}: {address} leads nowhere")
            elif target in pages and parts.fragment not in pages[target].anchors:
                faults.append(f"{path}: {address}: no such place on the page")
    return faults


def main() -> None:
    if not Path("/usr/bin/mkdocs").exists() or not Path("/usr/share/mkdocs/themes/material").exists():
        print("MkDocs Material (Debian package mkdocs-material) is not installed: skipped")
        sys.exit(SKIPPED)
    igsp, site = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(site, ignore_errors=True)
    build(igsp, site)
    faults = faults_of(site.resolve())
    listed = json.loads(subprocess.run([igsp, "options", "--json"], capture_output=True, text=True, check=True).stdout)
    options = (site / "options/index.html").read_text()
    faults += [f"options: {option['flag']} is not there" for option in listed
               if f"<code>{option['flag']}</code>" not in options]
    if faults:
        sys.exit("\n".join(faults))
    print(f"{len(list(site.rglob('*.html')))} pages in {site}")


if __name__ == "__main__":
    main()
