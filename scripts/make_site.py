"""The documentation as a site, in results/site/html; a warning is an error. Needs pip install '.[docs]'.

python scripts/make_site.py            the pages; the notebook runs once, and again when it changes
python scripts/make_site.py linkcheck  looks whether links to other sites lead somewhere
"""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MADE = ROOT / "results" / "site"


def main(builder: str) -> int:
    from sphinx.cmd.build import main as build

    places = ["-c", str(ROOT / "docs"), "-d", str(MADE / "kept"), str(ROOT), str(MADE / builder)]
    return build(["-b", builder, "--fail-on-warning", "--keep-going", *places])


if __name__ == "__main__":
    from usage import arguments

    raise SystemExit(main(arguments(__doc__, builder=("html", "html or linkcheck")).builder))
