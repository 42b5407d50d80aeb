"""The grammar of paper.json, once: it checks a file strictly, and it is the JSON Schema (draft 7) for editors."""
import json
from dataclasses import dataclass, field

from reproducing.reading import nearest, one_of


def shown(node):
    text = json.dumps(node.plain(), ensure_ascii=False)
    return text if len(text) <= 60 else text[:57] + "..."


def wrong(errors, node, expected, names=()):
    hint = nearest(node.value, names) if isinstance(node.value, str) else ""
    errors.append(f"{node.place}: {node.pointer or '/'}: found {shown(node)}, expected {expected}.{hint}")


@dataclass
class Text:
    about: str = ""
    names: tuple = ()  # the allowed ones; none: any text that is not empty

    def check(self, node, errors):
        if not isinstance(node.value, str) or not node.value:
            wrong(errors, node, one_of(self.names) if self.names else "text")
        elif self.names and node.value not in self.names:
            wrong(errors, node, one_of(self.names), self.names)

    def schema(self):
        return {"type": "string", **({"enum": list(self.names)} if self.names else {"minLength": 1})}


@dataclass
class Number:
    about: str = ""
    low: float = None
    high: float = None
    null: bool = False

    def check(self, node, errors):
        value = node.value
        if value is None and self.null:
            return
        span = f" from {self.low:g} to {self.high:g}" if self.high is not None else ""
        span = span or (f" of at least {self.low:g}" if self.low is not None else "")
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            wrong(errors, node, "a number" + span + (" or null" if self.null else ""))
        elif (self.low is not None and value < self.low) or (self.high is not None and value > self.high):
            wrong(errors, node, "a number" + span)

    def schema(self):
        out = {"type": ["number", "null"] if self.null else "number"}
        if self.low is not None:
            out["minimum"] = self.low
        if self.high is not None:
            out["maximum"] = self.high
        return out


@dataclass
class Any:
    about: str = ""

    def check(self, node, errors):
        pass

    def schema(self):
        return {}


@dataclass
class Either:
    """Kinds that differ in their JSON type."""

    kinds: tuple
    about: str = ""

    def check(self, node, errors):
        for kind in self.kinds:
            fits = {List: list, Object: dict, Map: dict, Text: str}.get(type(kind), (int, float))
            if isinstance(node.value, fits):
                return kind.check(node, errors)
        wrong(errors, node, self.about or "another type")

    def schema(self):
        return {"anyOf": [kind.schema() for kind in self.kinds]}


@dataclass
class List:
    of: object
    about: str = ""
    least: int = 1
    most: int = None

    def check(self, node, errors):
        if not isinstance(node.value, list):
            return wrong(errors, node, "a list")
        if len(node.value) < self.least or (self.most and len(node.value) > self.most):
            wrong(errors, node, f"a list of {self.least}" + (f" to {self.most}" if self.most else " or more"))
        for child in node.value:
            self.of.check(child, errors)

    def schema(self):
        out = {"type": "array", "items": self.of.schema(), "minItems": self.least}
        return {**out, "maxItems": self.most} if self.most else out


@dataclass
class Map:
    """Keys that the file chooses."""

    of: object
    about: str = ""

    def check(self, node, errors):
        if not isinstance(node.value, dict):
            return wrong(errors, node, "an object")
        for child in node.value.values():
            self.of.check(child, errors)

    def schema(self):
        return {"type": "object", "additionalProperties": self.of.schema()}


@dataclass
class Object:
    keys: dict
    needs: tuple = ()
    about: str = ""
    title: str = field(default="an object")

    def check(self, node, errors):
        if not isinstance(node.value, dict):
            return wrong(errors, node, self.title)
        for key, child in node.value.items():
            if key in self.keys:
                self.keys[key].check(child, errors)
            else:
                hint = nearest(key, self.keys) or f" Expected {one_of(self.keys)}."
                errors.append(f"{child.place}: {child.pointer}: unknown key '{key}'.{hint}")
        for key in self.needs:
            if key not in node.value:
                errors.append(f"{node.place}: {node.pointer or '/'}: '{key}' is missing: {self.keys[key].about}")

    def schema(self):
        keys = {k: {**v.schema(), **({"description": v.about} if v.about else {})} for k, v in self.keys.items()}
        out = {"type": "object", "additionalProperties": False, "properties": keys}
        return {**out, "required": list(self.needs)} if self.needs else out
