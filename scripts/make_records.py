"""What does the program say otherwise than it did, of the drawings, scenes and runs in tests/records?

Prints what moved and rewrites the records (`--dry`: only prints). Of runs all numbers are left out that move when the scene
is changed by rounding, so that the records hold on any machine.
"""

import argparse
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), *(str(ROOT / "tests" / name) for name in ("drawing", "drawing/damaged", "scene"))]

from records.test_records import KEPT, MAKERS, TOPICS, said_of  # noqa: E402
from records.wording import moved, sections, written  # noqa: E402

ABOUT = ("Made by scripts/make_records.py: what the program said. See tests/records/test_records.py.", "")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("topics", nargs="*", metavar="TOPIC", help=f"default: {', '.join(TOPICS)}")
    parser.add_argument("--dry", action="store_true", help="write nothing")
    given = parser.parse_args()
    for topic in given.topics or TOPICS:
        path, module = KEPT / f"{topic}.txt", TOPICS[topic]
        before, now = sections(path), {}
        for name in MAKERS[topic]:
            with tempfile.TemporaryDirectory() as folder:
                text = said_of(topic, name, Path(folder))
            if name not in before or moved(before[name], text):
                print(f"{topic}: {name}", *moved(before.get(name, ""), text), sep="\n  ")
                now[name] = module.kept(name, text) if hasattr(module, "kept") else text
            else:
                now[name] = before[name]
        print(*(f"{topic}: {name} is gone" for name in before if name not in now), sep="\n")
        if not given.dry:
            path.write_text(written(now, ABOUT), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
