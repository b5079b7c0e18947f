"""Reads Gyre's public headers into plain data: enums, structs, classes, functions, constants, with their comments.

The headers are declarations in one style (clang-format keeps it), so this is a small scanner for that style and not a
parser of C++. What it does not understand is an error with the text in question, never silence.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Field:
    name: str
    type: str  # as in C++, without const and references; arrays as T[N]
    doc: str = ""


@dataclass
class Enum:
    name: str
    values: list  # (name, number, doc)
    doc: str = ""


@dataclass
class Struct:
    name: str
    fields: list
    doc: str = ""
    cpp: str = ""  # its name in C++, where that differs (a struct inside another)


@dataclass
class Parameter:
    name: str
    type: str
    by_pointer: bool = False
    by_mutable_reference: bool = False
    writable: bool = False  # a span that the function fills
    default: str = ""


@dataclass
class Function:
    name: str
    result: str
    parameters: list
    doc: str = ""
    static: bool = False
    const: bool = False
    nullable: bool = False  # the result is a pointer
    owner: str = ""         # the class it is a member of
    line: str = ""          # the declaration's text


@dataclass
class Class:
    name: str
    functions: list
    constructors: list
    doc: str = ""


@dataclass
class Api:
    enums: dict = field(default_factory=dict)
    structs: dict = field(default_factory=dict)
    classes: dict = field(default_factory=dict)
    functions: list = field(default_factory=list)
    constants: dict = field(default_factory=dict)  # name -> (literal, doc)
    aliases: dict = field(default_factory=dict)
    alias_docs: dict = field(default_factory=dict)


class HeaderError(Exception):
    pass


def clean_comment(lines):
    kept = [re.sub(r"^//\s?", "", line) for line in lines]
    return "\n".join(line for line in kept if not re.fullmatch(r"-{10,}.*", line)).strip()


def declarations(text):
    """Yields (comment, declaration, trailing comment) of one scope, comments inside the declaration included."""
    out = []
    comment = []
    at = 0
    size = len(text)
    while at < size:
        if text[at] == "\n":
            # A blank line parts a comment from what follows.
            if re.match(r"\n[ \t]*\n", text[at:at + 80]):
                comment = []
            at += 1
        elif text[at].isspace():
            at += 1
        elif text.startswith("//", at):
            end = text.find("\n", at)
            end = size if end < 0 else end
            line = text[at:end]
            begin = text.rfind("\n", 0, at) + 1
            if text[begin:at].strip() and out:
                out[-1][2] = (out[-1][2] + "\n" + clean_comment([line])).strip()
                comment = []
            elif out and not comment and out[-1][2] and out[-1][3] == text.count("\n", 0, at) - 1 and at - begin > 20:
                # A trailing comment that goes on in the next line, indented below its beginning.
                out[-1][2] += "\n" + clean_comment([line])
                out[-1][3] += 1
            else:
                comment.append(line)
            at = end
        elif text[at] == "#":
            end = text.find("\n", at)
            while end > 0 and text[end - 1] == "\\":
                end = text.find("\n", end + 1)
            at = size if end < 0 else end
            comment = []
        elif match := re.match(r"namespace\s+[\w:]*\s*\{", text[at:]):
            at += match.end()
            comment = []
        elif text[at] == "}":
            at += 1
        elif match := re.match(r"(public|private|protected)\s*:(?!:)", text[at:]):
            out.append(["", match.group(1) + ":", "", 0])
            at += match.end()
            comment = []
        else:
            end = declaration_end(text, at)
            out.append([clean_comment(comment), text[at:end].strip(), "", text.count("\n", 0, end)])
            comment = []
            at = end
    return [(doc, body, after) for doc, body, after, _ in out]


def declaration_end(text, at):
    depth = 0
    i = at
    while i < len(text):
        c = text[i]
        if text.startswith("//", i):
            i = text.find("\n", i)
            continue
        if c == '"':
            i = text.find('"', i + 1)
        elif c in "{([":
            depth += 1
        elif c in "})]":
            depth -= 1
            if depth == 0 and c == "}":
                following = re.match(r"\s*(.)", text[i + 1:], re.S)
                if following and following.group(1) not in ";,=":
                    return i + 1
        elif c == ";" and depth == 0:
            return i + 1
        i += 1
    raise HeaderError("no end of: " + text[at:at + 80])


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def split_commas(text):
    parts, depth, begin = [], 0, 0
    for i, c in enumerate(text):
        if c in "<({[":
            depth += 1
        elif c in ">)}]":
            depth -= 1
        elif c == "," and depth == 0:
            parts.append(text[begin:i])
            begin = i + 1
    parts.append(text[begin:])
    return [part.strip() for part in parts if part.strip()]


def plain_type(text):
    text = re.sub(r"\b(const|struct|class)\b", " ", text)
    text = text.replace("&", " ").replace("std::", "")
    text = re.sub(r"\s+", " ", text).strip()
    text = re.sub(r"\s*([<>,*])\s*", r"\1", text)
    return re.sub(r"\barray<(\w+),(\w+)>", r"\1[\2]", text)


def parse_enum(doc, body):
    match = re.match(r"enum class (\w+)\s*:\s*[\w:]+\s*\{(.*)\}\s*;", body, re.S)
    if not match:
        raise HeaderError("an enum without a type: " + body)
    values, number = [], 0
    pending = ""
    for line in match.group(2).split("\n"):
        code, _, after = line.partition("//")
        after = after.strip()
        if not code.strip():
            pending = (pending + " " + after).strip()
            continue
        entries = split_commas(code)
        for i, entry in enumerate(entries):
            name, _, value = (part.strip() for part in entry.partition("="))
            if value:
                number = int(value, 0)
            values.append((name, number, after if len(entries) == 1 else ""))
            number += 1
    return Enum(match.group(1), values, doc)


def parse_fields(text, where, inner_structs=None):
    """The fields of a struct; structs inside it go to `inner_structs` by name."""
    fields = []
    for doc, body, after in declarations(text):
        if body.endswith(":"):
            if body != "public:":
                break
            continue
        code = without_comments(body)
        if match := re.match(r"struct (\w+)\s*\{", code):
            inner_structs[match.group(1)] = Struct(where + match.group(1), parse_fields(inner_text(body), where), doc,
                                                   f"{where}::{match.group(1)}")
            continue
        if re.search(r"\boperator\b|^\s*(constexpr|static|using|friend|explicit|template)\b", code) or is_function(code):
            continue
        parts = [re.split(r"[={]", part, maxsplit=1)[0].strip() for part in split_commas(code.rstrip(";").strip())]
        match = re.match(r"(.*[\s>&*])(\w+)\s*((?:\[[^\]]*\])?)$", parts[0], re.S)
        if not match:
            raise HeaderError(f"{where}: not understood: {body}")
        base = plain_type(match.group(1))
        for i, part in enumerate(parts):
            name, array = match.group(2, 3) if i == 0 else re.match(r"(\w+)\s*((?:\[[^\]]*\])?)", part).groups()
            words = " ".join(t for t in (doc if i == 0 else "", after) if t)
            fields.append(Field(name, base + array.replace(" ", ""), words))
    return fields


def is_function(code):
    """A declaration whose first bracket outside <> is round, after a name."""
    depth = 0
    for i, c in enumerate(code):
        if c == "<":
            depth += 1
        elif c == ">":
            depth -= 1
        elif depth == 0 and c in "({=;":
            return c == "("
    return False


def parse_parameter(text):
    text, _, default = (part.strip() for part in text.partition("="))
    match = re.match(r"(.*[\s>&*])(\w+)$", text, re.S)
    if not match:
        raise HeaderError("a parameter without a name: " + text)
    kind = match.group(1).strip()
    constant = bool(re.search(r"\bconst\b", re.sub(r"<.*>", "", kind)))
    return Parameter(match.group(2), plain_type(kind).rstrip("*"), by_pointer=kind.endswith("*"),
                     by_mutable_reference=kind.endswith("&") and not kind.endswith("&&") and not constant,
                     writable=bool(re.match(r"std::span<(?!const\b)", kind)), default=default)


def parse_function(doc, body, owner=""):
    code = " ".join(without_comments(body).split())
    code = re.sub(r"\[\[[^\]]*\]\]|__attribute__\(\(.*?\)\)\)", "", code).strip()
    match = re.match(r"(static )?(.*?)\b(\w+)\((.*)\)\s*(const)?\s*(noexcept)?\s*(override)?\s*(=\s*\w+)?\s*;$", code)
    if not match:
        raise HeaderError("not understood: " + body)
    result = match.group(2).strip()
    return Function(match.group(3), plain_type(result).rstrip("*") if plain_type(result) != "char*" else "char*",
                    [parse_parameter(part) for part in split_commas(match.group(4))], doc, static=bool(match.group(1)),
                    const=bool(match.group(5)), nullable=result.endswith("*") and plain_type(result) != "char*", owner=owner,
                    line=code)


def inner_text(body):
    return body[body.index("{") + 1:body.rindex("}")]


def parse_class(doc, name, body):
    functions, constructors = [], []
    public = not body.startswith("class")
    for text, declaration, after in declarations(inner_text(body)):
        if declaration.endswith(":"):
            public = declaration == "public:"
            continue
        code = without_comments(declaration)
        if not public or not is_function(code) or "operator" in code or "~" in code:
            continue
        if code.rstrip().endswith("}"):
            code = code[:code.index("{")].strip() + ";"
            code = re.sub(r"\s*:\s*\w+_?\(.*\)\s*;$", ";", code)
        words = "\n".join(t for t in (text, after) if t)
        if re.match(rf"(explicit\s+)?{name}\s*\(", code):
            if not re.search(rf"\(\s*(const\s+)?{name}\s*&|=\s*delete|\(\s*std::unique_ptr|\(\s*\)\s*= default", code):
                parts = code[code.index("(") + 1:code.rindex(")")]
                constructors.append(Function(name, name, [parse_parameter(p) for p in split_commas(parts)], words, owner=name,
                                             line=" ".join(code.split())))
            continue
        functions.append(parse_function(words, code, name))
    return Class(name, functions, constructors, doc)


def read_headers(paths):
    api = Api()
    for path in paths:
        text = Path(path).read_text(encoding="utf-8")
        for doc, body, after in declarations(text):
            code = without_comments(body).strip()
            try:
                read_declaration(api, doc, body, after, code)
            except (HeaderError, AttributeError, ValueError) as error:
                raise HeaderError(f"{path}: {error}: {' '.join(code.split())[:120]}") from error
    return api


def read_declaration(api, doc, body, after, code):
    if code.startswith("enum class"):
        enum = parse_enum(doc, body)
        api.enums[enum.name] = enum
    elif match := re.match(r"(struct|class)\s+(?:\[\[\w+\]\]\s*)?(\w+)\s*(?::[^{]*)?\{", code):
        name = match.group(2)
        if match.group(1) == "struct":
            inner = {}
            fields = parse_fields(inner_text(body), name, inner)
            for part in inner.values():
                api.structs[part.name] = part
            for part in fields:
                kind = re.match(r"\w*", part.type).group(0)
                if kind in inner:
                    part.type = part.type.replace(kind, inner[kind].name, 1)
            api.structs[name] = Struct(name, fields, doc, name)
        else:
            api.classes[name] = parse_class(doc, name, body)
    elif match := re.match(r"(?:inline )?constexpr [\w:]+ k(\w+) = ([^;]+);$", code):
        api.constants[match.group(1)] = (match.group(2).strip(), " ".join(t for t in (doc, after) if t))
    elif match := re.match(r"using (\w+) = (.*);$", code, re.S):
        api.aliases[match.group(1)] = plain_type(match.group(2))
        api.alias_docs[match.group(1)] = " ".join(t for t in (doc, after) if t)
    elif re.match(r"(template|struct \w+;|class \w+;|extern|static_assert|constexpr|inline)", code) or code.endswith("}"):
        return  # forward declarations, and what is computed in the header itself
    elif is_function(code):
        if "operator" not in code and "..." not in code:
            api.functions.append(parse_function("\n".join(t for t in (doc, after) if t), body))
    else:
        raise HeaderError("not understood")
