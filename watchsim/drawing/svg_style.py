"""Which CSS declarations hold for an SVG element?

Only properties that decide whether and where something is drawn are kept. Selectors: type, *, #id, .class, [attribute],
compounds of them, descendants and children. Cascade after CSS 2.1 §6.4: importance, style attribute, specificity, order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from watchsim.drawing.findings import Finding
from watchsim.drawing.svg_elements import Node

SEEN = ("display", "visibility", "clip-path", "mask")
PLACED = ("transform", "transform-origin", "transform-box", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "d")
RELEVANT = frozenset((*SEEN, *PLACED))
_DECLARED = re.compile(rf"(?<![\w-])(?:{'|'.join(map(re.escape, sorted(RELEVANT)))})\s*:")
MOST_RULES = 500
MOST_COMPOUNDS = 16
_COMMENT = re.compile(r"/\*.*?\*/|<!--|-->", re.DOTALL)
_RULE = re.compile(r"([^{};]*)([{};])")
_PART = re.compile(r"([#.])([\w-]+)|\[\s*([\w:-]+)\s*(?:=\s*[\"']?([^\"'\]]*)[\"']?\s*)?\]")
_TYPE = re.compile(r"\*|[A-Za-z][\w-]*")


class Compound(NamedTuple):
    """One step of a selector; `child` says that it must be the parent of the next step, not any ancestor."""

    tag: str
    identity: str
    classes: frozenset[str]
    attributes: tuple[tuple[str, str | None], ...]
    child: bool

    def matches(self, node: Node) -> bool:
        if self.tag not in ("*", node.tag) or (self.identity and node.attributes.get("id") != self.identity):
            return False
        if self.classes and not self.classes <= set(node.attributes.get("class", "").split()):
            return False
        return all(key in node.attributes and value in (None, node.attributes[key]) for key, value in self.attributes)


class Rule(NamedTuple):
    """Declarations for what `selector` (outermost step first) matches; `weight` is the specificity."""

    selector: tuple[Compound, ...]
    weight: tuple[int, int, int]
    declarations: dict[str, tuple[str, bool]]  # value, important


@dataclass
class Styles:
    """All rules of the file that matter here."""

    rules: list[Rule] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)

    def of(self, node: Node) -> dict[str, str]:
        """The attributes of an element with the declarations that overrule them."""
        inline = node.attributes.get("style")
        if not inline and not self.rules:
            return node.attributes
        best: dict[str, tuple[tuple[bool, bool, tuple[int, int, int]], str]] = {}
        for rule in self.rules:
            if _matches(rule.selector, len(rule.selector) - 1, node):
                _offer(best, rule.declarations, False, rule.weight)
        _offer(best, declarations(inline or ""), True, (0, 0, 0))
        if not best:
            return node.attributes
        found = {name: value for name, (_, value) in best.items()}
        if node.parent is None:  # web pages stretch the root; its attributes tell its size
            return {**found, **node.attributes}
        return {**node.attributes, **found}


def _offer(
    best: dict[str, tuple[tuple[bool, bool, tuple[int, int, int]], str]],
    offered: dict[str, tuple[str, bool]],
    inline: bool,
    weight: tuple[int, int, int],
) -> None:
    for name, (value, important) in offered.items():
        rank = (important, inline, weight)
        if name not in best or rank >= best[name][0]:
            best[name] = (rank, value)


def declarations(text: str) -> dict[str, tuple[str, bool]]:
    """The relevant declarations of a block or a style attribute: value and whether it is important."""
    result: dict[str, tuple[str, bool]] = {}
    for part in _COMMENT.sub(" ", text).split(";"):
        name, colon, value = part.partition(":")
        name = name.strip().lower()
        if colon and name in RELEVANT:
            plain, bang, word = value.partition("!")
            important = bool(bang) and word.strip().lower() == "important"
            if important or name not in result or not result[name][1]:
                result[name] = (plain.strip(), important)
    return result


def read_styles(sheets: tuple[str, ...]) -> Styles:
    styles = Styles()
    for sheet in sheets:
        for prelude, body in _blocks(_COMMENT.sub(" ", sheet), styles):
            found = declarations(body)
            for selector in prelude.split(",") if found else ():
                _add(styles, selector.strip(), found)
    if len(styles.rules) > MOST_RULES:
        message = f"its style sheet has more than {MOST_RULES} rules that hide or move; the rest was not read"
        styles.findings.append(Finding("css", "error", message, "Write display and transform into the elements."))
        del styles.rules[MOST_RULES:]
    return styles


def _blocks(text: str, styles: Styles) -> Iterator[tuple[str, str]]:
    """Selector and declarations of each rule outside @-rules."""
    at = 0
    while (match := _RULE.match(text, at)) is not None:
        prelude, at = match[1].strip(), match.end()
        if prelude.startswith("@import"):
            message = f"{prelude[:60]}: a style sheet outside the file was not read"
            styles.findings.append(Finding("external", "warning", message, "What it hides is shown here."))
        if match[2] != "{":
            continue
        end = _closing(text, at)
        body, at = text[at:end], end + 1
        if not prelude.startswith("@"):
            yield prelude, body
        elif prelude.startswith(("@media", "@supports", "@layer")) and _DECLARED.search(body):
            styles.findings.append(Finding("css", "warning", f"{prelude[:60]}: rules under a condition were not read"))


def _closing(text: str, at: int) -> int:
    """Where the block that was opened before `at` ends."""
    depth = 1
    for match in re.compile(r"[{}]").finditer(text, at):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return match.start()
    return len(text)


def _add(styles: Styles, text: str, found: dict[str, tuple[str, bool]]) -> None:
    selector = parse_selector(text)
    if selector is None:
        names = ", ".join(found)
        message = f'the style rule "{text[:60]}" sets {names}; this kind of selector is not read'
        styles.findings.append(Finding("css", "error", message, "Select by type, class or id."))
        return
    weight = (
        sum(bool(step.identity) for step in selector),
        sum(len(step.classes) + len(step.attributes) for step in selector),
        sum(step.tag != "*" for step in selector),
    )
    styles.rules.append(Rule(selector, weight, found))


def parse_selector(text: str) -> tuple[Compound, ...] | None:
    """The steps of a selector, None where it is of a kind that is not read."""
    words = re.sub(r"\s*>\s*", " > ", text).split()
    steps: list[Compound] = []
    for word in words:
        if word == ">":
            if not steps or steps[-1].child:
                return None
            steps[-1] = steps[-1]._replace(child=True)
            continue
        step = _compound(word)
        if step is None:
            return None
        steps.append(step)
    if not steps or steps[-1].child or len(steps) > MOST_COMPOUNDS:
        return None
    return tuple(steps)


def _compound(word: str) -> Compound | None:
    word = word.replace(":root", "svg" if word.startswith(":root") else "")
    kind = _TYPE.match(word)
    at = kind.end() if kind else 0
    identity, classes, attributes = "", set(), []
    while at < len(word):
        part = _PART.match(word, at)
        if part is None:
            return None
        at = part.end()
        if part[1] == "#":
            identity = part[2]
        elif part[1] == ".":
            classes.add(part[2])
        else:
            attributes.append((part[3], part[4]))
    return Compound(kind[0] if kind else "*", identity, frozenset(classes), tuple(attributes), False)


def _matches(selector: tuple[Compound, ...], last: int, node: Node) -> bool:
    """Does the selector up to step `last` match this element?"""
    if not selector[last].matches(node):
        return False
    if last == 0:
        return True
    above = node.parent
    if selector[last - 1].child:
        return above is not None and _matches(selector, last - 1, above)
    while above is not None:
        if _matches(selector, last - 1, above):
            return True
        above = above.parent
    return False
