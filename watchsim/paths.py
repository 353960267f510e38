"""Where are the profiles, the scenes that come with the package?"""

from __future__ import annotations

from pathlib import Path


def profiles_dir() -> Path:
    """The folder with one folder per scene: inside the installed package, or beside it in a checkout.

    Raises FileNotFoundError where there is neither.
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "profiles", package.parent / "profiles"):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"the profiles that belong to watchsim are missing: there is no folder {package / 'profiles'}")
