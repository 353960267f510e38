"""What is said of an option that a command does not have?"""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Iterable, Sequence
from typing import Any


class CommandParser(argparse.ArgumentParser):
    """The parser of one command. What it does not know is refused with its own usage, not with that of `watchsim`."""

    def parse_known_args(self, args: Sequence[str] | None = None, namespace: Any = None) -> tuple[Any, list[str]]:  # type: ignore[override]
        """Unknown options come first: that something is missing may only follow from them."""
        words = _joined(args or ())
        takes_all = any(action.nargs == argparse.REMAINDER for action in self._actions)
        for word in () if takes_all else words:
            self._check(word)
        found, unknown = super().parse_known_args(words, namespace)
        for word in unknown:
            self._check(word)
            self.error(f'"{word}" is one word too many. A text with blanks stands in quotes.')
        return found, []

    def _check(self, word: str) -> None:
        """Ends the program where the word is an option, but none of this command; options may be shortened."""
        name = word.partition("=")[0]
        begun = name if name.startswith("--") else name[:2]
        if word[:1] != "-" or " " in word or not begun.strip("-")[:1].isalpha():
            return
        if not any(option.startswith(begun) for option in self._option_string_actions):
            self.error(f"there is no option {name}.{meant(name, self._option_string_actions)}")


def _joined(words: Sequence[str]) -> list[str]:
    """The words, a negative quantity such as "-5 µm" or "-30°" as the value of the option before it."""
    found: list[str] = []
    for word in words:
        if re.match(r"[-−][.\d]", word) and found and found[-1].startswith("--") and "=" not in found[-1]:
            found[-1] += f"={word}"
        else:
            found.append(word)
    return found


def meant(word: str, known: Iterable[str]) -> str:
    """' Did you mean --force?' where one is near."""
    plain = {one.lstrip("-"): one for one in known}
    near = difflib.get_close_matches(word.lstrip("-").lower(), plain, n=1)
    return f" Did you mean {plain[near[0]]}?" if near else ""
