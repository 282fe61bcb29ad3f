#!/usr/bin/python3
"""Reads the project's IDL files and writes one C++ source with the schema of every message.

    idl_to_schema.py OUTPUT.cpp FILE.idl ...

Understands the subset that idl/ uses: modules, structs, sequence<T>, arrays, strings, primitives,
@extensibility(FINAL), constants. Anything else stops it with file and line, so that no field is ever missing
from what the tools show. The comment behind a field (and the lines that go on below it) is kept.
"""

import re
import sys

# IDL name: (Kind in C++, bytes on the wire at least)
PRIMITIVES = {
    "boolean": ("boolean", 1), "octet": ("uint8", 1), "uint8": ("uint8", 1), "int8": ("int8", 1),
    "short": ("int16", 2), "unsigned short": ("uint16", 2), "int16": ("int16", 2),
    "uint16": ("uint16", 2), "long": ("int32", 4), "unsigned long": ("uint32", 4),
    "int32": ("int32", 4), "uint32": ("uint32", 4), "long long": ("int64", 8),
    "unsigned long long": ("uint64", 8), "int64": ("int64", 8), "uint64": ("uint64", 8),
    "float": ("float32", 4), "double": ("float64", 8), "string": ("string", 4),
}
FIELD = re.compile(
    r"^(?:sequence<\s*(?P<element>[\w: ]+?)\s*>|(?P<plain>[\w: ]+?))\s+(?P<name>\w+)\s*"
    r"(?:\[\s*(?P<size>\d+)\s*\])?\s*;$")
STRUCT = re.compile(r"^struct\s+(\w+)\s*\{$")
MODULE = re.compile(r"^module\s+(\w+)\s*\{$")
CONSTANT = re.compile(r"^const\s+octet\s+\w+\s*=\s*\d+\s*;$")  # nothing on the wire


class IdlError(Exception):
    pass


class Field:
    def __init__(self, name, idl_type, arity, size, comment):
        self.name, self.idl_type, self.arity, self.size = name, idl_type, arity, size
        self.comment = comment


class Struct:
    def __init__(self, name, comment):
        self.name, self.comment, self.fields = name, comment, []


def parse_field(code, comment):
    match = FIELD.match(code)
    if not match:
        raise IdlError("is no field that this reader knows: " + code)
    idl_type = match["element"] or match["plain"]
    if match["element"] and match["size"]:
        raise IdlError("arrays of sequences are not supported: " + code)
    if match["size"] == "0":
        raise IdlError("an array needs at least one element: " + code)
    arity = "sequence" if match["element"] else "array" if match["size"] else "single"
    return Field(match["name"], idl_type, arity, int(match["size"] or 1), comment)


def parse_line(code, comment, scopes, structs, pending):
    """One line without its comment. scopes: open modules and structs, innermost last."""
    if match := MODULE.match(code):
        scopes.append(match[1])
    elif match := STRUCT.match(code):
        structs.append(Struct("/".join([s for s in scopes if s] + [match[1]]), " ".join(pending)))
        scopes.append(None)  # a struct adds nothing to the names inside
    elif code in ("};", "}"):
        if not scopes:
            raise IdlError("closes what was never opened")
        scopes.pop()
    elif code == "@extensibility(FINAL)" or code.startswith("#") or CONSTANT.match(code):
        return
    elif scopes and scopes[-1] is None:
        structs[-1].fields.append(parse_field(code, comment))
    else:
        raise IdlError("is not understood: " + code)


def parse_file(path):
    structs, scopes, pending = [], [], []
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            code, _, comment = line.strip().partition("//")
            code, comment = code.strip(), comment.strip()
            if not code:
                # A comment alone belongs to the struct that follows it.
                pending = pending + [comment] if comment else []
                continue
            try:
                parse_line(code, comment, scopes, structs, pending)
            except IdlError as error:
                sys.exit(f"{path}:{number}: {error}")
            if not code.startswith("@"):
                pending = []
    if scopes:
        sys.exit(f"{path}: a module or struct is not closed")
    return structs


def ros_name(idl_type, struct):
    """'std_msgs::msg::Header' to 'std_msgs/msg/Header'; a bare name is of the same package."""
    if "::" in idl_type:
        return idl_type.strip(":").replace("::", "/")
    return struct.name.rsplit("/", 1)[0] + "/" + idl_type


def order(structs):
    """Structs after those that they hold, with their least size on the wire."""
    by_name = {s.name: s for s in structs}
    if len(by_name) != len(structs):
        sys.exit("a struct is defined twice")
    sizes, ordered = {}, []

    def visit(struct, open_names):
        if struct.name in sizes:
            return
        if struct.name in open_names:
            sys.exit(struct.name + " holds itself")
        size = 0
        for field in struct.fields:
            if field.idl_type in PRIMITIVES:
                least = PRIMITIVES[field.idl_type][1]
            else:
                inner = ros_name(field.idl_type, struct)
                if inner not in by_name:
                    sys.exit(f"{struct.name}: {field.name} is of the unknown type {inner}")
                visit(by_name[inner], open_names | {struct.name})
                least = sizes[inner]
            size += 4 if field.arity == "sequence" else least * field.size
        if not struct.fields:
            sys.exit(struct.name + " has no fields")
        sizes[struct.name] = size
        ordered.append(struct)

    for struct in structs:
        visit(struct, set())
    return ordered, sizes


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def emit(structs, sizes):
    out = ["// Made from idl/ by idl_to_schema.py; edits are lost.",
           '#include "goshawk/runtime/schema.hpp"', "",
           "namespace goshawk::runtime::schema {", "namespace {", ""]
    for index, struct in enumerate(structs):
        out.append(f"constexpr Field kFields{index}[] = {{")
        for field in struct.fields:
            primitive = PRIMITIVES.get(field.idl_type)
            kind = primitive[0] if primitive else "structure"
            inner = -1 if primitive else next(
                i for i, s in enumerate(structs) if s.name == ros_name(field.idl_type, struct))
            out.append(f"    {{{quoted(field.name)}, Kind::{kind}, Arity::{field.arity}, "
                       f"{field.size}, {inner}, {quoted(field.comment)}}},")
        out.append("};")
    out.append("constexpr Type kTypes[] = {")
    for index, struct in enumerate(structs):
        out.append(f"    {{{quoted(struct.name)}, {quoted(struct.comment)}, kFields{index}, "
                   f"{sizes[struct.name]}}},")
    out += ["};", "", "}  // namespace", "",
            "std::span<const Type> types() { return kTypes; }", "",
            "}  // namespace goshawk::runtime::schema", ""]
    return "\n".join(out)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    structs = [s for path in sys.argv[2:] for s in parse_file(path)]
    text = emit(*order(structs))
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
