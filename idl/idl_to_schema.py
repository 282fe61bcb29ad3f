#!/usr/bin/python3
"""Reads the project's IDL files and writes one C++ source with the schema of every message.

    idl_to_schema.py OUTPUT.cpp FILE.idl ...

Understands the subset that idl/ uses: modules, structs, sequence<T>, arrays, strings, primitives,
constants, @extensibility(FINAL). Anything else stops it with file and line, so that the tools never
miss a field. The comment behind a field or constant is kept.

Constants follow ROS 2's IDL: `const uint8 STATE_IDLE = 0;` in a module `<Struct>_Constants` before
the struct. A constant belongs to the field that its name begins with: `state`.
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
CONSTANT = re.compile(r"^const\s+(?P<type>[\w ]+?)\s+(?P<name>[A-Z][A-Z0-9_]*)\s*=\s*(?P<value>\d+)\s*;$")
CONSTANTS = "_Constants"  # end of the name of a module that holds a struct's constants
STRUCT = re.compile(r"^struct\s+(\w+)\s*\{$")
MODULE = re.compile(r"^module\s+(\w+)\s*\{$")


class IdlError(Exception):
    pass


class Constant:
    def __init__(self, name, idl_type, value, comment):
        self.name, self.idl_type, self.value, self.comment = name, idl_type, value, comment


class Field:
    def __init__(self, name, idl_type, arity, size, comment):
        self.name, self.idl_type, self.arity, self.size = name, idl_type, arity, size
        self.comment = comment
        self.constants = []


class Struct:
    def __init__(self, name, comment):
        self.name, self.comment, self.fields = name, comment, []


def parse_constant(code, comment):
    match = CONSTANT.match(code)
    if not match:
        raise IdlError("is not a constant like `const uint8 STATE_IDLE = 0;`: " + code)
    return Constant(match["name"], match["type"], int(match["value"]), comment)


def give_constants(struct, constants):
    """Each constant to the field that its name begins with; the longest such name wins."""
    for constant in constants:
        fields = [f for f in struct.fields if constant.name.startswith(f.name.upper() + "_")]
        if not fields:
            raise IdlError(f"{constant.name} begins with the name of no field of {struct.name}")
        field = max(fields, key=lambda f: len(f.name))
        if field.idl_type != constant.idl_type or field.arity != "single":
            raise IdlError(f"{constant.name} is {constant.idl_type}, its field {field.name} is not")
        if constant.value in [c.value for c in field.constants]:
            raise IdlError(f"{constant.name} repeats the value {constant.value}")
        field.constants.append(constant)


def parse_field(code, comment):
    match = FIELD.match(code)
    if not match:
        raise IdlError("is not a field that this reader knows: " + code)
    idl_type = match["element"] or match["plain"]
    if match["element"] and match["size"]:
        raise IdlError("arrays of sequences are not supported: " + code)
    if match["size"] == "0":
        raise IdlError("an array needs at least one element: " + code)
    arity = "sequence" if match["element"] else "array" if match["size"] else "single"
    return Field(match["name"], idl_type, arity, int(match["size"] or 1), comment)


class FileReader:
    """The structs of one file, line by line."""

    def __init__(self):
        self.structs = []
        self.scopes = []     # open modules and structs, innermost last; a struct is None
        self.pending = []    # comment lines that belong to the struct that follows
        self.constants = {}  # by the struct's full name, until the struct is closed

    def full_name(self, name):
        return "/".join([s for s in self.scopes if s] + [name])

    def line(self, code, comment):
        """One line without its comment."""
        innermost = self.scopes[-1] if self.scopes else ""
        if match := MODULE.match(code):
            self.scopes.append(match[1])
        elif match := STRUCT.match(code):
            self.structs.append(Struct(self.full_name(match[1]), " ".join(self.pending)))
            self.scopes.append(None)  # a struct adds nothing to the names inside
        elif code in ("};", "}"):
            self.close()
        elif code == "@extensibility(FINAL)" or code.startswith("#"):
            return
        elif innermost is None:
            self.structs[-1].fields.append(parse_field(code, comment))
        elif innermost.endswith(CONSTANTS):
            struct = self.full_name("").rstrip("/").removesuffix(CONSTANTS)
            self.constants.setdefault(struct, []).append(parse_constant(code, comment))
        else:
            raise IdlError("is not understood: " + code)

    def close(self):
        if not self.scopes:
            raise IdlError("closes what was never opened")
        if self.scopes.pop() is None:
            give_constants(self.structs[-1], self.constants.pop(self.structs[-1].name, []))

    def end(self):
        if self.scopes:
            raise IdlError("a module or struct is not closed")
        if self.constants:
            raise IdlError("there are constants but no struct " + ", ".join(self.constants))


def parse_file(path):
    reader, number = FileReader(), 0
    try:
        with open(path, encoding="utf-8") as file:
            for number, line in enumerate(file, 1):
                code, _, comment = line.strip().partition("//")
                code, comment = code.strip(), comment.strip()
                if not code:
                    # A comment on its own line belongs to the struct that follows it.
                    reader.pending = reader.pending + [comment] if comment else []
                    continue
                reader.line(code, comment)
                if not code.startswith("@"):
                    reader.pending = []
        reader.end()
    except IdlError as error:
        sys.exit(f"{path}:{number}: {error}")
    return reader.structs


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
        for place, field in enumerate(struct.fields):
            if field.constants:
                values = ", ".join(f"{{{quoted(c.name)}, {c.value}}}" for c in field.constants)
                out.append(f"constexpr Constant kConstants{index}_{place}[] = {{{values}}};")
        out.append(f"constexpr Field kFields{index}[] = {{")
        for place, field in enumerate(struct.fields):
            primitive = PRIMITIVES.get(field.idl_type)
            kind = primitive[0] if primitive else "structure"
            inner = -1 if primitive else next(
                i for i, s in enumerate(structs) if s.name == ros_name(field.idl_type, struct))
            out.append(f"    {{{quoted(field.name)}, Kind::{kind}, Arity::{field.arity}, "
                       f"{field.size}, {inner}, {quoted(field.comment)}, "
                       + (f"kConstants{index}_{place}" if field.constants else "{}") + "},")
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
