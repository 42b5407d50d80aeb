"""The part of JSON Schema draft 7 that Penumbra's schemas use, checked without packages."""
import json
import re

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool}
KNOWN = {"$schema", "$id", "$ref", "title", "description", "default", "definitions", "type", "enum", "const", "anyOf",
         "oneOf", "allOf", "not", "properties", "additionalProperties", "required", "minProperties", "maxProperties",
         "items", "minItems", "maxItems", "minimum", "maximum", "exclusiveMinimum", "minLength", "pattern", "if",
         "then", "else", "propertyNames"}


def strip_comments(text):
    """`//` and `/* */` outside strings become blanks."""
    pattern = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.S)
    return pattern.sub(lambda m: m.group(1) or " ", text)


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.loads(strip_comments(file.read()))


def is_type(value, name):
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if name == "number":
        return number
    if name == "integer":
        return number and float(value).is_integer()
    if name == "null":
        return value is None
    return isinstance(value, TYPES[name])


def errors(value, schema, root=None, at=""):
    """Messages about everything in `value` that the schema forbids."""
    root = schema if root is None else root
    if isinstance(schema, bool):
        return [] if schema else [f"{at}: forbidden"]
    unknown = set(schema) - KNOWN
    assert not unknown, f"schema keyword not known to this check: {unknown}"
    if "$ref" in schema:
        target = root
        for token in schema["$ref"].lstrip("#/").split("/"):
            target = target[token]
        return errors(value, target, root, at)
    out = []
    if "type" in schema:
        names = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        if not any(is_type(value, n) for n in names):
            return [f"{at}: {value!r} is no {schema['type']}"]
    if "enum" in schema and value not in schema["enum"]:
        out.append(f"{at}: {value!r} is none of {schema['enum']}")
    if "const" in schema and value != schema["const"]:
        out.append(f"{at}: {value!r} is not {schema['const']!r}")
    out += combined(value, schema, root, at)
    if isinstance(value, dict):
        out += object_errors(value, schema, root, at)
    elif isinstance(value, list):
        out += array_errors(value, schema, root, at)
    elif isinstance(value, str):
        if len(value) < schema.get("minLength", 0) or not re.search(schema.get("pattern", ""), value):
            out.append(f"{at}: {value!r} has not the form asked for")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        low, high = schema.get("minimum", value), schema.get("maximum", value)
        if not low <= value <= high or not value > schema.get("exclusiveMinimum", value - 1):
            out.append(f"{at}: {value!r} is out of range")
    return out


def combined(value, schema, root, at):
    out = []
    counts = {key: sum(not errors(value, s, root, at) for s in schema[key])
              for key in ("anyOf", "oneOf", "allOf") if key in schema}
    if counts.get("anyOf") == 0 or counts.get("oneOf", 1) != 1 or counts.get("allOf", 0) != len(schema.get("allOf", [])):
        out.append(f"{at}: {json.dumps(value)[:80]} fits not the alternatives")
    if "not" in schema and not errors(value, schema["not"], root, at):
        out.append(f"{at}: fits what it must not")
    if "if" in schema:
        branch = "else" if errors(value, schema["if"], root, at) else "then"
        out += errors(value, schema.get(branch, True), root, at)
    return out


def object_errors(value, schema, root, at):
    out = [f"{at}: no {key!r}" for key in schema.get("required", []) if key not in value]
    if not schema.get("minProperties", 0) <= len(value) <= schema.get("maxProperties", len(value)):
        out.append(f"{at}: {len(value)} members")
    for key, member in value.items():
        if "propertyNames" in schema:
            out += errors(key, schema["propertyNames"], root, f"{at}/{key}")
        rule = schema.get("properties", {}).get(key, schema.get("additionalProperties", True))
        out += errors(member, rule, root, f"{at}/{key}")
    return out


def array_errors(value, schema, root, at):
    out = []
    if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
        out.append(f"{at}: {len(value)} elements")
    rule = schema.get("items", True)
    for i, element in enumerate(value):
        out += errors(element, rule[i] if isinstance(rule, list) else rule, root, f"{at}/{i}")
    return out
