"""What of an SVG drawing was left out or looks damaged, and does it matter?"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from watchsim.drawing.findings import Finding
from watchsim.drawing.svg.element_names import CONTAINERS, MOVING, SILENT, TEXT_LIKE, strange_attributes
from watchsim.drawing.svg.element_shapes import READERS
from watchsim.drawing.svg.xml_elements import Node

FOREIGN = "element of another vocabulary"
BURIED = "element inside of one that holds none"
DRAWN = frozenset((*READERS, "use"))
TEMPLATES = frozenset(("clipPath", "mask", "pattern", "marker"))  # what they hold is never drawn
DEFINED = frozenset(("defs", "symbol"))


@dataclass
class LeftOut:
    """Counts of what is not drawn as it stands in the file, by layer, kind or name; and the elements met."""

    hidden: Counter[str] = field(default_factory=Counter)
    ignored: Counter[str] = field(default_factory=Counter)
    sizeless: Counter[str] = field(default_factory=Counter)
    clipped: int = 0
    marks: int = 0
    met: set[Node] = field(default_factory=set)

    def silent(self, node: Node) -> bool:
        """Is this an element that draws nothing? It is counted if something may be missed."""
        if node.tag.startswith("*:"):
            self.ignored.update([FOREIGN] if node.tag[2:] in DRAWN | CONTAINERS or drawn_within(node) else [])
            return True
        if node.tag not in SILENT:
            return False
        if node.tag in MOVING:
            self.ignored[node.tag] += 1
        elif node.tag not in TEMPLATES and node.tag not in DEFINED and (count := drawn_within(node)):
            self.ignored[BURIED] += count
        return True

    def findings(self, root: Node) -> list[Finding]:
        """One finding for each thing, however often."""
        result = []
        for layer, count in self.hidden.items():
            message = f"hidden elements (display, visibility, conditions) left out: {count}"
            result += [Finding("hidden", "notice", message, layer=layer)] if count else []
        result += [_ignored(kind, count) for kind, count in self.ignored.items()]
        for kind, count in self.sizeless.items():
            result.append(Finding("zero-size", "notice", f"{count} × {kind} of no size, and so not drawn"))
        if self.marks:
            result.append(Finding("point", "notice", f"circles of radius 0, read as points: {self.marks}"))
        if self.clipped:
            message = f"elements clipped or masked in the picture, here read whole: {self.clipped}"
            result.append(Finding("clipped", "warning", message))
        return [*result, *self._of_the_whole(root)]

    def _of_the_whole(self, root: Node) -> list[Finding]:
        """What shows only when all elements are looked at once."""
        strange: Counter[tuple[str, str]] = Counter()
        unused = 0
        waiting = [(root, False)]
        while waiting:
            node, defined = waiting.pop()
            strange.update((node.tag, name) for name in strange_attributes(node.tag, node.attributes))
            defined = defined or node.tag in DEFINED
            unused += defined and node.tag in DRAWN and node not in self.met
            unused += node.tag == "symbol" and "id" not in node.attributes
            waiting += [(child, defined) for child in node.children if child.tag not in TEMPLATES]
        result = []
        for (tag, name), count in strange.items():
            message = f'{count} × {tag} with an attribute "{name[:40]}" that it cannot have: the file may be damaged'
            result.append(Finding("strange-attribute", "warning", message, "Check its shape."))
        if unused:
            message = f"elements defined but never used, and so not drawn: {unused}"
            result.append(Finding("unused", "notice", message))
        return result


def _ignored(kind: str, count: int) -> Finding:
    if kind in TEXT_LIKE:
        return Finding("ignored", "notice", f"{count} × {kind} not read: it is not an outline")
    why = "it moves" if kind in MOVING else "no element known here; the file may be damaged"
    return Finding("ignored", "warning", f"{count} × {kind[:40]} not read: {why}")


def drawn_within(node: Node) -> int:
    """How many elements would be drawn if this one were shown."""
    count, waiting = 0, [node]
    while waiting:
        at = waiting.pop()
        count += at.tag in DRAWN
        waiting += [child for child in at.children if child.tag not in SILENT]
    return count
