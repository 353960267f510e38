"""Are the lines of keys found in any TOML a person may write?"""

from watchsim.scene.values import key_lines, tomllib

TEXT = '''\
# a comment with [brackets] and "quotes
top = 1
[scene]
title = "a # no comment" # a comment
"quoted key" = """
several [lines]
of = text
"""
[bodies.wheel]
position = [
  "1 mm",   # first
  "2 mm",
]
nested.key = 2
[[springs]]
body = 'balance'
[[springs]]
frequency = "4 Hz"
[[bodies.wheel.solids]]
layer = "A"
[[bodies.wheel.solids]]
layer = "B"
[expect]
"amplitude" = { value = "275°", tolerance = "1°" }
polygon = [["1 mm", "2 mm"],
           ["3 mm", "4 mm"]]
number = -1.5e-3
'''


def test_lines_of_all_kinds_of_keys():
    lines = key_lines(TEXT)
    expected = {
        "top": 2,
        "scene": 3,
        "scene.title": 4,
        "scene.quoted key": 5,
        "bodies.wheel": 9,
        "bodies.wheel.position": 10,
        "bodies.wheel.position.0": 11,
        "bodies.wheel.position.1": 12,
        "bodies.wheel.nested.key": 14,
        "springs": 15,
        "springs.0": 15,
        "springs.0.body": 16,
        "springs.1": 17,
        "springs.1.frequency": 18,
        "bodies.wheel.solids.0.layer": 20,
        "bodies.wheel.solids.1.layer": 22,
        "expect.amplitude": 24,
        "expect.amplitude.tolerance": 24,
        "expect.polygon.0": 25,
        "expect.polygon.1": 26,
        "expect.polygon.1.0": 26,
        "expect.number": 27,
    }
    assert {key: lines.get(key) for key in expected} == expected


def test_every_key_of_the_parsed_text_is_located():
    lines = key_lines(TEXT)

    def keys(value, path):
        if isinstance(value, dict):
            return [path, *(k for key, item in value.items() for k in keys(item, f"{path}.{key}" if path else key))]
        if isinstance(value, list):
            return [path, *(k for i, item in enumerate(value) for k in keys(item, f"{path}.{i}"))]
        return [path]

    missing = [key for key in keys(tomllib.loads(TEXT), "") if key and key not in lines]
    assert missing == ["bodies", "bodies.wheel.nested"]
