"""Reads the data members of structs and the values of enumerations from public headers.

The test of the bindings compares them with what the package binds, so that no list can go stale.
"""

from __future__ import annotations

import pathlib
import re
from collections.abc import Iterator

TYPE = re.compile(r"\b(?:struct|class)\s+(?:CAROM_API\s+)?(\w+(?:<\d>)?)\s*(?:final\s*)?(?::([^;{]*))?\{")
ENUM = re.compile(r"\benum\s+(?:class\s+)?(\w+)[^;{]*\{([^}]*)\}")
NO_DATA = re.compile(
    r"^(?:static|using|friend|typedef|template|enum|struct|class|explicit|virtual|public|private|\})\b|^\}"
)


def public_headers(root: pathlib.Path) -> list[pathlib.Path]:
    """The headers that cmake/CaromPublicHeaders.cmake lists."""
    listed = (root / "cmake" / "CaromPublicHeaders.cmake").read_text(encoding="utf-8")
    return [root / name for name in re.findall(r"^\s+([\w/]+\.h)$", listed, re.MULTILINE)]


def code_of(text: str) -> str:
    """The text of a header without comments, preprocessor lines and attributes."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    return re.sub(r"^\s*#[^\n]*|\[\[\w+\]\]", "", text, flags=re.MULTILINE)


def without_brackets(code: str, opening: str, closing: str) -> str:
    """The code without what stands between brackets, and without these."""
    kept, depth = [], 0
    for sign in code:
        depth += sign == opening
        if depth == 0:
            kept.append(sign)
        depth -= sign == closing and depth > 0
    return "".join(kept)


def body_of(code: str, start: int) -> str:
    """The code from behind an open brace to the one that closes it."""
    depth = 1
    for end in range(start, len(code)):
        depth += (code[end] == "{") - (code[end] == "}")
        if depth == 0:
            return code[start:end]
    raise ValueError("a brace is not closed")


def statements(body: str) -> Iterator[str]:
    """Statements at the top of the body of a type; functions with a body end where that ends."""
    outline = re.sub(r"operator\s*[<>=]+", "operator", mark_functions(body))
    outline = without_brackets(outline, "<", ">")
    outline = re.sub(r"\)[^;{]*\{\}", ");", outline)
    for statement in re.split(r"[;:](?!:)(?<!::)", outline):
        yield " ".join(statement.split())


def mark_functions(body: str) -> str:
    """Every block in braces becomes {}."""
    kept, depth = [], 0
    for sign in body:
        if sign == "}":
            depth -= 1
        if depth == 0:
            kept.append(sign)
        if sign == "{":
            depth += 1
    return "".join(kept)


def names_in(statement: str) -> list[str]:
    """Names of the data members that a statement declares: `double a = 0.0, b{};` gives a and b."""
    plain = without_brackets(statement, "{", "}")
    if not plain or NO_DATA.search(plain) or "operator" in plain:
        return []
    names = []
    for declared in plain.split(","):
        head = declared.split("=")[0].strip()
        if "(" in head:
            return []
        found = re.search(r"(\w+)\s*(?:\[\w*\])?$", head)
        if found and (names or " " in head):
            names.append(found.group(1))
    return [name for name in names if not name.endswith("_")]


class Headers:
    """Types of the public headers: own members, bases, values of enumerations.

    A type that is written apart for the plane and for space is "HalfSpace<2>" and "HalfSpace<3>".
    """

    def __init__(self, root: pathlib.Path) -> None:
        self.own: dict[str, list[str]] = {}
        self.bases: dict[str, list[str]] = {}
        self.enumerations: dict[str, list[str]] = {}
        for header in public_headers(root):
            code = code_of(header.read_text(encoding="utf-8"))
            end = 0
            for found in TYPE.finditer(code):
                if found.start() < end or code[: found.start()].rstrip().endswith("enum"):
                    continue  # inside another type, or an enumeration
                body = body_of(code, found.end())
                end = found.end() + len(body)
                own = [name for statement in statements(body) for name in names_in(statement)]
                self.own.setdefault(found.group(1), []).extend(own)
                bases = re.findall(
                    r"(\w+)\s*(?:,|$)", without_brackets(found.group(2) or "", "<", ">").strip()
                )
                self.bases.setdefault(found.group(1), []).extend(bases)
            for found in ENUM.finditer(code):
                values = [value.split("=")[0].strip() for value in found.group(2).split(",")]
                self.enumerations[found.group(1)] = [value for value in values if value]

    def members(self, name: str) -> list[str]:
        """Members of a type, with those of its bases. Raises KeyError for an unknown type."""
        inherited = [
            member for base in self.bases[name] if base in self.own for member in self.members(base)
        ]
        return list(dict.fromkeys(inherited + self.own[name]))
