"""Small slips in C++ sources, one at a time: where each could be made, and the line that it makes.

Works on lines as clang-format leaves them: binary operators stand between spaces, template brackets do not.
"""

import re
from typing import NamedTuple

IDENTIFIER = r"[A-Za-z_]\w*"


class Mutant(NamedTuple):
    path: str
    line: int  # from 1
    kind: str
    before: str  # the whole line, as it stands
    after: str


class CodeLine(NamedTuple):
    number: int  # from 1
    text: str  # as it stands
    code: str  # with comments, strings and characters blanked, of the same length
    returns: str  # return type of the function around it, "" if its head does not show it


def blanked(text):
    """The text with everything in comments and literals of characters replaced by blanks, line ends kept."""
    out = []
    at = 0
    pattern = re.compile(r"//[^\n]*|/\*.*?\*/|R\"(?P<tag>[^(\s]*)\(.*?\)(?P=tag)\"|\"(?:\\.|[^\"\\\n])*\""
                         r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])'", re.S)
    for match in pattern.finditer(text):
        out.append(text[at:match.start()])
        out.append(re.sub(r"[^\n]", " ", match.group()))
        at = match.end()
    return "".join(out) + text[at:]


def returned_by(head):
    """The type before the name in a function's head, or "" if it has none."""
    head = " ".join(head.split())
    if re.match(r"(if|for|while|switch|do|else|try|catch|return)\b", head) or "[" in head.split("(")[0]:
        return ""
    match = re.match(r"(?:(?:inline|static|constexpr|\[\[\w+\]\]) )*([\w:]+) [\w:~]+\(", head)
    return match.group(1) if match else ""


def code_lines(text):
    """The lines within bodies of functions, without directives, assertions and mere declarations."""
    raw = text.split("\n")
    code = blanked(text).split("\n")
    scopes = []  # (is the brace a function's or within one, what that function returns)
    head = ""
    statement = ""  # since the last ; { }
    out = []
    for number, (line, bare) in enumerate(zip(raw, code), start=1):
        if bare.lstrip().startswith("#"):
            continue
        inside = bool(scopes) and scopes[-1][0]
        statement_here = (statement + " " + bare).strip()
        is_assert = re.match(r"(static_)?assert\s*\(", statement_here) is not None
        is_alias = re.match(r"(using|typedef|namespace|template|constexpr\s+const\s+char|friend)\b", statement_here)
        if inside and bare.strip() and not is_assert and not is_alias:
            out.append(CodeLine(number, line, bare, scopes[-1][1]))
        body_from = None  # set while inside a function that stands on one line
        for at, char in enumerate(bare + "\n"):
            if char == "{":
                head = statement.strip()
                is_named = re.match(r"(inline )?(namespace|struct|class|enum|union|extern)\b", head) is not None
                within = bool(scopes) and scopes[-1][0]
                # A body follows a parameter list; braces after = or a type are a list of values at
                # file scope.
                is_body = not is_named and ("(" in head and "= " not in head.split("(")[0])
                returns = scopes[-1][1] if within else returned_by(head)
                scopes.append((within or is_body, returns if (within or is_body) else ""))
                if is_body and not inside and body_from is None:
                    body_from = at + 1
                if within and re.search(r"\[[^\[\]]*\]\s*(\([^{}]*\))?[^(){}]*$", head):
                    scopes[-1] = (True, "")  # a lambda: its own return
                statement = ""
            elif char == "}":
                if scopes:
                    scopes.pop()
                statement = ""
            elif char == ";":
                statement = ""
            else:
                statement += char
        if body_from is not None and bare[body_from:].strip(" }"):
            out.append(CodeLine(number, line, " " * body_from + bare[body_from:], ""))
    return out


def closing(code, opening):
    """Where the bracket at `opening` closes on the same line, None if it does not."""
    depth = 0
    for at in range(opening, len(code)):
        depth += {"(": 1, ")": -1}.get(code[at], 0)
        if depth == 0:
            return at
    return None


def replaced(line, start, end, new):
    return line.text[:start] + new + line.text[end:]


def swaps(line, kind, pairs, around=" "):
    for old, new in pairs:
        for match in re.finditer(re.escape(around + old + around), line.code):
            start = match.start() + len(around)
            yield kind, replaced(line, start, start + len(old), new)


def comparisons(line):
    yield from swaps(line, "comparison", [("<", ">="), ("<=", ">"), (">", "<="), (">=", "<"), ("==", "!="), ("!=", "==")])


def off_by_one(line):
    if not re.match(r"\s*(for|while) \(", line.code):
        return
    yield from swaps(line, "off by one", [("<", "<="), ("<=", "<"), (">", ">="), (">=", ">")])


def arithmetic(line):
    pairs = [("+", "-"), ("-", "+"), ("*", "/"), ("/", "*"), ("%", "*"), ("+=", "-="), ("-=", "+="), ("*=", "/="), ("/=", "*=")]
    yield from swaps(line, "arithmetic", pairs)
    for match in re.finditer(r"(?<=[(,=?:] )-(?=[A-Za-z_(])|(?<=\()-(?=[A-Za-z_(])|(?<=return )-(?=[A-Za-z_(])", line.code):
        yield "sign", replaced(line, match.start(), match.end(), "")


def logic(line):
    yield from swaps(line, "logic", [("&&", "||"), ("||", "&&"), ("&", "|"), ("|", "&")])
    for match in re.finditer(r"(?<=[( ])!(?=[A-Za-z_(])", line.code):
        yield "negation", replaced(line, match.start(), match.end(), "")


def conditions(line):
    for match in re.finditer(r"\b(if|while) \(", line.code):
        opening = match.end() - 1
        end = closing(line.code, opening)
        inner = line.code[opening + 1:end] if end else ""
        if end is None or ";" in inner or re.match(r"(const )?[\w:<>]+[*&]? [*&]?\w+ = ", inner):
            continue
        yield "condition", replaced(line, opening + 1, end, "!(" + line.text[opening + 1:end] + ")")


def constants(line):
    for match in re.finditer(r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+|\d+)(?![\w.'])", line.code):
        text = match.group()
        if "." in text or "e" in text:
            new = "1.0" if float(text) == 0.0 else "0.0" if float(text) == 1.0 else "(2.0 * " + text + ")"
        else:
            new = str(int(text) + 1)
        yield "constant", replaced(line, match.start(), match.end(), new)
    for match in re.finditer(r"\b(true|false)\b", line.code):
        yield "constant", replaced(line, match.start(), match.end(), "false" if match.group() == "true" else "true")


def functions(line):
    for one, other in [("min", "max"), ("floor", "ceil"), ("sin", "cos"), ("min_element", "max_element"), ("all_of", "any_of"),
                       ("lower_bound", "upper_bound")]:
        for old, new in [(one, other), (other, one)]:
            for match in re.finditer(r"(?<=\bstd::)" + old + r"(?=\()", line.code):
                yield "function", replaced(line, match.start(), match.end(), new)


def steps(line):
    for match in re.finditer(r"\+\+|--", line.code):
        if re.match(r"\s*for \(", line.code):
            continue  # such a mutant would only hang or change nothing
        yield "step", replaced(line, match.start(), match.end(), "--" if match.group() == "++" else "++")


def is_statement(code):
    """A whole line that does something and declares nothing."""
    text = code.strip()
    if not text.endswith(";") or text.count("(") != text.count(")") or text.count("{") != text.count("}"):
        return False
    if re.match(r"(continue|break);", text):
        return True
    if re.match(r"(return|case|default|goto|throw|using|const|auto|static|constexpr|delete)\b", text):
        return False
    target = r"(\+\+|--|\*)?" + IDENTIFIER + r"(?:::" + IDENTIFIER + r"|\.|->|" + IDENTIFIER + r"|\[[^\]]*\]|\([^()]*\))*"
    return re.match(r"(\(void\))?" + target + r"( [-+*/%|&^]?= .*|\+\+|--|\(.*\))?;$", text) is not None


def statements(line):
    if is_statement(line.code) and not line.code.strip().startswith("}"):
        indent = len(line.code) - len(line.code.lstrip())
        yield "removed statement", line.text[:indent] + "{}"
        if line.returns == "void":
            yield "returned early", line.text[:indent] + "return;"
        elif re.match(r"(bool|double|int|Vec3|std::size_t|std::uint\d+_t)$", line.returns):
            yield "returned early", line.text[:indent] + "return {};"
    match = re.match(r"(\s*)return (.+);$", line.code)
    if match and match.group(2).strip() not in ("{}", "false", "0", "nullptr") and line.returns:
        yield "returned nothing", line.text[:len(match.group(1))] + "return {};"


OPERATORS = [comparisons, off_by_one, arithmetic, logic, conditions, constants, functions, steps, statements]


def mutants_of(path, text):
    """Every mutant of a source, by line."""
    out = []
    for line in code_lines(text):
        for operator in OPERATORS:
            for kind, after in operator(line):
                if after != line.text:
                    out.append(Mutant(path, line.number, kind, line.text, after))
    return out


def applied(mutant, text):
    lines = text.split("\n")
    assert lines[mutant.line - 1] == mutant.before
    lines[mutant.line - 1] = mutant.after
    return "\n".join(lines)
