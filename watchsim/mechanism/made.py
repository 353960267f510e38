"""Where do drawings come from that a design makes, without a file?"""

from __future__ import annotations

from collections.abc import Mapping

from watchsim.drawing.sheet import Sheet

Made = Mapping[str, Sheet]  # name of a drawing in the scene -> the sheet
