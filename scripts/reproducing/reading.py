"""JSON with comments, read so that every value knows its place; and the messages of bad input."""
import difflib
import json
import re
from json.decoder import scanstring

COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.S)
SPACE = re.compile(r"[ \t\r\n]*")
NUMBER = re.compile(r"-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORDS = {"true": True, "false": False, "null": None}


class BadInput(Exception):
    """One line for each thing that is wrong; exit code 2."""


class Node:
    """A value (a dict or list of Nodes, or a scalar), where it stands, and its JSON pointer."""

    def __init__(self, value, place, pointer):
        self.value, self.place, self.pointer = value, place, pointer

    def plain(self):
        if isinstance(self.value, dict):
            return {key: child.plain() for key, child in self.value.items()}
        if isinstance(self.value, list):
            return [child.plain() for child in self.value]
        return self.value


class Reader:
    def __init__(self, path, text):
        self.path, self.original = path, text
        # Comments become blanks, so that places stay what they were.
        self.text = COMMENT.sub(lambda m: m.group(1) or re.sub(r"[^\n]", " ", m.group(0)), text)

    def place(self, at):
        return f"{self.path}:{self.text.count(chr(10), 0, at) + 1}:{at - self.text.rfind(chr(10), 0, at)}"

    def fail(self, at, pointer, message):
        raise BadInput(f"{self.place(at)}: {pointer or '/'}: {message}")

    def skip(self, at):
        return SPACE.match(self.text, at).end()

    def string(self, at, pointer):
        try:
            return scanstring(self.text, at + 1, True)
        except ValueError as error:
            self.fail(at, pointer, f"not a JSON string: {error}")

    def value(self, at, pointer):
        at = self.skip(at)
        first = self.text[at : at + 1]
        if first == "{":
            return self.members(at, pointer)
        if first == "[":
            return self.elements(at, pointer)
        if first == '"':
            text, end = self.string(at, pointer)
            return Node(text, self.place(at), pointer), end
        for word, meaning in WORDS.items():
            if self.text.startswith(word, at):
                return Node(meaning, self.place(at), pointer), at + len(word)
        if number := NUMBER.match(self.text, at):
            return Node(json.loads(number.group(0)), self.place(at), pointer), number.end()
        found = self.text[at : at + 12].split("\n")[0] or "the end of the file"
        self.fail(at, pointer, f"found {found!r}, expected a JSON value")

    def members(self, at, pointer):
        start, members = at, {}
        at = self.skip(at + 1)
        while self.text[at : at + 1] != "}":
            if self.text[at : at + 1] != '"':
                self.fail(at, pointer, f"found {self.text[at:at + 1]!r}, expected a key in quotes or '}}'")
            key, end = self.string(at, pointer)
            if key in members:
                self.fail(at, f"{pointer}/{key}", "this key stands here twice")
            end = self.skip(end)
            if self.text[end : end + 1] != ":":
                self.fail(end, f"{pointer}/{key}", "expected ':' after the key")
            members[key], at = self.value(end + 1, f"{pointer}/{key}")
            at = self.next_or_close(at, "}", pointer)
        return Node(members, self.place(start), pointer), at + 1

    def elements(self, at, pointer):
        start, elements = at, []
        at = self.skip(at + 1)
        while self.text[at : at + 1] != "]":
            element, at = self.value(at, f"{pointer}/{len(elements)}")
            elements.append(element)
            at = self.next_or_close(at, "]", pointer)
        return Node(elements, self.place(start), pointer), at + 1

    def next_or_close(self, at, close, pointer):
        at = self.skip(at)
        if self.text[at : at + 1] == ",":
            after = self.skip(at + 1)
            if self.text[after : after + 1] == close:
                self.fail(at, pointer, "a comma before the end")
            return after
        if self.text[at : at + 1] != close:
            self.fail(at, pointer, f"expected ',' or '{close}'")
        return at

    def document(self):
        node, end = self.value(0, "")
        if self.skip(end) != len(self.text):
            self.fail(self.skip(end), "", "more text after the end of the value")
        return node


def read_nodes(path):
    """The file's root Node."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    return Reader(path, text).document()


def read_plain(path):
    return read_nodes(path).plain()


def nearest(name, names):
    """' Did you mean ...?' or nothing."""
    close = difflib.get_close_matches(str(name), [str(n) for n in names], 1, 0.5)
    return f" Did you mean '{close[0]}'?" if close else ""


def one_of(names):
    return "one of " + ", ".join(f"'{n}'" for n in names)
