"""How is a mapping written as TOML?"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(mapping: Mapping[str, Any]) -> str:
    """TOML of nested mappings, lists, texts, numbers and truth values; reading it back gives an equal mapping."""
    return "\n".join(_lines(mapping, "")).strip() + "\n"


def _lines(mapping: Mapping[str, Any], path: str) -> Iterator[str]:
    for key, value in mapping.items():
        if not isinstance(value, Mapping) and not _is_table_list(value):
            yield f"{_key(key)} = {value_text(value)}"
    for key, value in mapping.items():
        full = f"{path}.{_key(key)}" if path else _key(key)
        if isinstance(value, Mapping):
            if not value or any(not isinstance(item, Mapping) and not _is_table_list(item) for item in value.values()):
                yield f"\n[{full}]"
            yield from _lines(value, full)
        elif _is_table_list(value):
            for item in value:
                yield f"\n[[{full}]]"
                yield from _lines(item, full)


def _is_table_list(value: object) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(item, Mapping) for item in value)


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _text(key)


def value_text(value: object) -> str:
    """One value as it stands after the equals sign; TypeError for what TOML cannot hold there."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(value_text(item) for item in value)}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_key(key)} = {value_text(item)}' for key, item in value.items())} }}" if value else "{}"
    raise TypeError(f"TOML cannot hold {type(value).__name__}")


def _text(text: str) -> str:
    # JSON escapes are TOML escapes; only DEL passes JSON unescaped and is forbidden in TOML.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
