"""Collects the documentation of public headers: one source for C++ and Python.

Usage: docstrings.py <root> <output> <header>...

Writes lines {"RigidBody.angle", "at the start, counter-clockwise [rad]"}, sorted by key, which src/docs.cpp
includes. A key is the name of a type, of a member with its type before it, or of a function.
"""

import pathlib
import re
import sys

SCOPE = re.compile(r"(?:class|struct|enum class)\s+(?:CAROM_API\s+)?(\w+)\s*(?:<[^{;]*>)?\s*(?:final\s*)?(?::[^:].*)?$")
NAME = re.compile(r"(\w+)\s*(?:=|\{|$)")
CALL = re.compile(r"([\w~]+)\s*\(")


def plain(lines):
    """Text of a comment: one paragraph a line, marks of Doxygen in words."""
    text = " ".join(line.strip() for line in lines).strip()
    text = re.sub(r"\\param\s+([\w,]+)", r"\1:", text)
    text = re.sub(r"\\return\b", "Returns", text)
    return re.sub(r"\s+", " ", text)


class Reader:
    """Reads one header line by line."""

    def __init__(self, table):
        self.table = table
        self.scopes = []  # (name or None) of every open brace
        self.pending = []
        self.statement = ""
        self.last = None

    def put(self, name, text):
        inner = [scope for scope in self.scopes if scope]
        key = ".".join([*inner[-1:], name])
        if text and not self.table.get(key):
            self.table[key] = text
        self.last = key

    def line(self, raw):
        stripped = raw.strip()
        if stripped.startswith("///<"):
            if self.last in self.table:
                self.table[self.last] += " " + plain([stripped[4:]])
            return
        if stripped.startswith("///"):
            self.pending.append(stripped[3:])
            return
        if stripped.startswith(("//", "#")):
            return
        code, _, trailing = raw.partition("///<")
        code = code.split("//")[0].strip()
        if not code:
            if not trailing:
                self.pending = [] if not self.statement else self.pending
            return
        self.code(code, trailing)

    def code(self, code, trailing):
        self.statement += " " + code
        inside = bool(self.scopes) and self.scopes[-1] == ""  # body of a function
        opened = self.statement.count("{") - self.statement.count("}")
        if inside:
            self.braces(code)
            self.statement = ""
            return
        if opened == 0 and not re.search(r"[;},]\s*$", self.statement):
            if not (trailing and not self.statement.strip().endswith(("=", "("))):
                return
        statement = self.statement.strip()
        self.statement = ""
        doc = plain(self.pending) or plain([trailing])
        if trailing and self.pending:
            doc = plain([*self.pending, trailing])
        head = statement.split("{")[0].strip()
        scope = SCOPE.search(head)
        if opened > 0 and scope and "(" not in head:
            self.put_type(scope.group(1), doc)
            self.braces(statement, scope.group(1))
        elif statement.startswith("namespace") or "namespace" in head.split():
            self.braces(statement, None)
        else:
            self.member(statement, head, doc)
            self.braces(statement)
        self.pending = []

    def put_type(self, name, doc):
        if doc and not self.table.get(name):
            self.table[name] = doc

    def member(self, statement, head, doc):
        if statement.startswith(("public", "private", "protected", "using", "friend", "extern", "}")):
            return
        before = re.sub(r"^template\s*<[^>]*>\s*", "", head.split("=")[0])
        before = re.sub(r"<[^<>]*(?:<[^<>]*>)?[^<>]*>", "", before)
        call = CALL.search(before)
        if call:
            self.put(call.group(1), doc)
            return
        name = NAME.search(re.sub(r"[;,].*$", "", before).strip())
        if name:
            self.put(name.group(1), doc)

    def braces(self, code, name=""):
        for sign in code:
            if sign == "{":
                self.scopes.append(name)
                name = ""
            elif sign == "}" and self.scopes:
                self.scopes.pop()


def main():
    root, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    table = {}
    for header in sys.argv[3:]:
        reader = Reader(table)
        for line in (root / header).read_text(encoding="utf-8").splitlines():
            reader.line(line)
    quoted = lambda text: '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
    text = "".join(f"{{{quoted(key)}, {quoted(table[key])}}},\n" for key in sorted(table))
    if not output.exists() or output.read_text(encoding="utf-8") != text:
        output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
