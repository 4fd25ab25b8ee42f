"""What builds the package where this folder is given: the package is that of the folder above, whose sources it
is made of, so all is done there.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Optional

from scikit_build_core import build

Settings = Optional[dict[str, Any]]
_ROOT = Path(__file__).resolve().parents[2]


@contextlib.contextmanager
def _above() -> Iterator[None]:
    """In the folder above."""
    if not (_ROOT / "pyproject.toml").exists():
        raise FileNotFoundError(f"{_ROOT / 'pyproject.toml'}: the package needs the sources around its folder")
    before = os.getcwd()
    os.chdir(_ROOT)
    try:
        yield
    finally:
        os.chdir(before)


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    with _above():
        return list(build.get_requires_for_build_wheel(config_settings))


def get_requires_for_build_sdist(config_settings: Settings = None) -> list[str]:
    with _above():
        return list(build.get_requires_for_build_sdist(config_settings))


def get_requires_for_build_editable(config_settings: Settings = None) -> list[str]:
    with _above():
        return list(build.get_requires_for_build_editable(config_settings))


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Settings = None) -> str:
    folder = os.path.abspath(metadata_directory)
    with _above():
        return str(build.prepare_metadata_for_build_wheel(folder, config_settings))


def prepare_metadata_for_build_editable(metadata_directory: str, config_settings: Settings = None) -> str:
    folder = os.path.abspath(metadata_directory)
    with _above():
        return str(build.prepare_metadata_for_build_editable(folder, config_settings))


def build_wheel(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None
) -> str:
    folder = os.path.abspath(wheel_directory)
    metadata = metadata_directory and os.path.abspath(metadata_directory)
    with _above():
        return str(build.build_wheel(folder, config_settings, metadata))


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    folder = os.path.abspath(sdist_directory)
    with _above():
        return str(build.build_sdist(folder, config_settings))


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None
) -> str:
    folder = os.path.abspath(wheel_directory)
    metadata = metadata_directory and os.path.abspath(metadata_directory)
    with _above():
        return str(build.build_editable(folder, config_settings, metadata))
