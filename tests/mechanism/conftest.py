"""A desk with a good scene and its drawings, for each test of the mechanism."""

import pytest
from made_scenes import GOOD, Desk


@pytest.fixture
def desk(tmp_path, monkeypatch):
    return Desk(tmp_path, monkeypatch)


@pytest.fixture
def good():
    return GOOD
