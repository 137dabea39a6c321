"""slender/scene_types.py from the JSON Schema of scenes, which comes from the field tables of the program.

    build/slender schema | python3 python/make_scene_types.py > python/slender/scene_types.py

tests/test_package.py says so where it is no longer what the schema gives."""
import json
import re
import sys
from typing import Any, Match

HEAD = '''"""What a scene may say, for type checkers: `scene: slender.scene_types.Scene = {..}`. docs/scene.md says what it means.

Made by python/make_scene_types.py from `slender schema`; do not edit. Which keys are needed, and which go together, is
for slender.Scene to say."""
from __future__ import annotations

from typing import Any, Literal, Mapping, Sequence as Rows, TypedDict, Union

from numpy.typing import NDArray

Number = Union[float, str]  # or text with a unit, "1 mm"
Numbers = Union[Rows[Number], NDArray[Any]]
Table = Union[Rows[Numbers], NDArray[Any]]
'''
SIMPLE = {"number": "float", "string": "str", "integer": "int", "boolean": "bool"}
ROWS_OF = {"Number": "Numbers", "float": "Numbers", "int": "Numbers", "Numbers": "Table"}
COLUMNS = 118


def name_of(definition: str) -> str:
    return "".join(word[0].upper() + word[1:] for word in re.split("[ _]", definition))


def union(parts: list[str]) -> str:
    """Without repetitions; a text that may be a number is a Number."""
    parts = ["Number" if {"float", "str"} <= set(parts) and part in ("float", "str") else part for part in parts]
    if "Number" in parts:
        parts = [part for part in parts if part not in ("float", "str", "int")]
    unique = list(dict.fromkeys(parts))
    return unique[0] if len(unique) == 1 else f"Union[{', '.join(unique)}]"


def packed(words: list[str]) -> str:
    """In lines."""
    lines = [""]
    for word in words:
        if len(lines[-1]) + len(word) + 2 > COLUMNS:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "    ") + word + ","
    return "\n".join(lines)


class Types:
    def __init__(self) -> None:
        self.texts: list[str] = []

    def kind(self, node: dict[str, Any], name: str) -> str:
        """The type of a node of the schema; objects are added as TypedDicts under the name."""
        return union(self.options(node, name))

    def options(self, node: dict[str, Any], name: str) -> list[str]:
        if "$ref" in node:
            return [name_of(node["$ref"].rsplit("/", 1)[1])]
        if "allOf" in node or "anyOf" in node:
            return [kind for option in node.get("allOf", node.get("anyOf")) for kind in self.options(option, name)]
        if "const" in node or "enum" in node:
            return [f"Literal[{', '.join(map(repr, node.get('enum', [node.get('const')])))}]"]
        if node.get("type") == "object":
            return [self.mapping(node, name)]
        if node.get("type") == "array":
            item = self.kind(node["items"], name + "Item")
            return [ROWS_OF.get(item, f"Rows[{item}]")]
        types = node["type"]
        return [SIMPLE[t] for t in ([types] if isinstance(types, str) else types)]

    def mapping(self, node: dict[str, Any], name: str) -> str:
        properties, others = node.get("properties", {}), node.get("additionalProperties")
        if others:
            return f"Mapping[str, {self.kind(others, name + 'Value')}]" if isinstance(others, dict) else "Mapping[str, Any]"
        rows = [f'"{key}": "{self.kind(value, name + name_of(key))}"' for key, value in properties.items()]
        name += "Dict" if any(text.startswith(f"{name} =") for text in self.texts) else ""
        self.texts.append(f'{name} = TypedDict("{name}", {{\n{packed(rows)}\n}}, total=False)')
        return name


def module(schema: dict[str, Any]) -> str:
    types, aliases = Types(), []
    for definition, node in schema["definitions"].items():
        name = name_of(definition)
        is_object = node.get("type") == "object" and not isinstance(node.get("additionalProperties"), dict)
        kind = types.kind(node, name if is_object else name + "Keys")
        if kind != name:
            aliases.append(f'{name} = {requote(kind)}')
    types.kind(schema["allOf"][0], "Scene")
    return "\n\n".join([HEAD, *types.texts]) + "\n\n" + "\n".join(aliases) + "\n"


def requote(kind: str) -> str:
    """An alias is evaluated where it stands: what it names may come later."""
    words = {"Union", "Rows", "Mapping", "Number", "Numbers", "Table", "Any", "float", "int", "str", "bool"}
    parts = re.split(r"(Literal\[[^\]]*\])", kind)

    def quote(word: Match[str]) -> str:
        return str(word[0]) if word[0] in words else f'"{word[0]}"'
    return "".join(part if part.startswith("Literal") else re.sub(r"\w+", quote, part) for part in parts)


if __name__ == "__main__":
    sys.stdout.write(module(json.load(sys.stdin)))
