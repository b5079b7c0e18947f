"""Where a name is defined in a file of C++ or TypeScript."""

import re


def line_of(text, name):
    """The line in which a name is defined, else the first that has it; 0 if there is none."""
    name = name.removesuffix("()").rsplit("::", 1)[-1]
    lines = text.split("\n")
    word = re.compile(rf"\b{re.escape(name)}\b")
    having = [i for i, line in enumerate(lines, 1) if word.search(line) and not line.lstrip().startswith(("//", "*", "#include"))]
    # A definition: no call or declaration, so the statement that begins here does not end with a semicolon before a brace opens.
    for i in having:
        line = lines[i - 1]
        if re.search(rf"\b(struct|class|enum class|namespace|using|#define)\s+(\w+::)*{re.escape(name)}\b", line) and not line.rstrip().endswith(name + ";"):
            return i
        if re.match(r"^(template|static|inline|constexpr|export|async|function|\w[\w:<>,&* ]*\s)", line.lstrip()) and re.search(rf"\b{re.escape(name)}\s*\(", line):
            rest = " ".join(lines[i - 1:i + 6])
            begin, end = rest.find("{"), rest.find(";")
            if begin >= 0 and (end < 0 or begin < end) and not re.match(r"\s*(return|if|for|while|else|case)\b", line):
                return i
    return having[0] if having else 0
