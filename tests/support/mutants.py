"""Small faults that can be put into the sources: every place, and what it is changed to."""

import ast
import re
from pathlib import Path
from typing import NamedTuple

COMPARED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
JOINED = {"+": "-", "-": "+", "*": "/", "/": "*"}


class Mutant(NamedTuple):
    """A change of one place."""

    path: str  # from the root of the repository
    line: int
    begin: int  # of what is replaced, in characters
    end: int
    new: str

    def apply(self, text):
        return text[: self.begin] + self.new + text[self.end :]

    def shown(self, text):
        """The line before and after."""
        return line_at(text, self.begin), line_at(self.apply(text), self.begin)


def line_at(text, place):
    begin = text.rfind("\n", 0, place) + 1
    return text[begin : text.find("\n", place)].strip()


def off(number):
    """Another number, as text: integers one more, others times 1.1."""
    if re.fullmatch(r"\d+", number):
        return str(int(number) + 1)
    return repr(1.1 * float(number)) if float(number) else "1.0"


# --- Python, by its syntax tree -------------------------------------------------------------------

WORDS = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Pow: ("**", "*"),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
}
"""Operators and what takes their place."""
UNSEEN = (ast.JoinedStr, ast.Import, ast.ImportFrom)
"""What is not entered: words of messages, and names."""
EITHER_WAY = re.compile(r"at|\w*(?:_mul|_add|max|min|maximum|minimum|hypot)")
"""Functions of two arguments that may be swapped."""
DELETED = (ast.AugAssign, ast.Raise, ast.Continue, ast.Break)


class Python(ast.NodeVisitor):
    """Every mutant of a module."""

    def __init__(self, path, text):
        self.path, self.text = path, text
        self.starts = [0, *(m.end() for m in re.finditer("\n", text))]
        self.found = []
        self.visit(ast.parse(text))

    def at(self, line, column):
        start = self.starts[line - 1]
        row = self.text[start:].split("\n", 1)[0].encode()[:column]
        return start + len(row.decode())

    def span(self, node):
        begin = self.at(node.lineno, node.col_offset)
        return begin, self.at(node.end_lineno, node.end_col_offset)

    def add(self, line, begin, end, new):
        self.found.append(Mutant(self.path, line, begin, end, new))

    def visit(self, node):
        if isinstance(node, UNSEEN):
            return
        self.mutate(node)
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns"):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    self.visit(child)

    def mutate(self, node):
        name = type(node).__name__
        getattr(self, f"mutate_{name}", lambda _: None)(node)
        place = isinstance(node, ast.Assign) and not isinstance(node.targets[0], ast.Name)
        called = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        if isinstance(node, DELETED) or called or place:
            self.add(node.lineno, *self.span(node), "pass")

    def between(self, left, operator, right):
        """Replace the operator between two nodes."""
        begin, end = self.span(left)[1], self.span(right)[0]
        old, new = WORDS.get(type(operator), (None, None))
        found = old and re.search(rf"(?<![\w=<>!*/]){re.escape(old)}", self.text[begin:end])
        if found:
            line = left.end_lineno + self.text.count("\n", begin, begin + found.start())
            self.add(line, begin + found.start(), begin + found.end(), new)

    def mutate_Compare(self, node):
        for left, operator, right in zip(
            [node.left, *node.comparators], node.ops, node.comparators, strict=False
        ):
            self.between(left, operator, right)

    def mutate_BinOp(self, node):
        if not any(isinstance(n, (ast.JoinedStr, ast.List)) for n in (node.left, node.right)):
            self.between(node.left, node.op, node.right)

    def mutate_BoolOp(self, node):
        for left, right in zip(node.values, node.values[1:], strict=False):
            self.between(left, node.op, right)

    def mutate_UnaryOp(self, node):
        if isinstance(node.op, (ast.Not, ast.USub)):
            begin, end = self.span(node)
            self.add(node.lineno, begin, end, self.text[self.span(node.operand)[0] : end])

    def mutate_Constant(self, node):
        begin, end = self.span(node)
        if isinstance(node.value, bool):
            self.add(node.lineno, begin, end, repr(not node.value))
        elif isinstance(node.value, (int, float)):
            self.add(node.lineno, begin, end, off(repr(node.value)))

    def mutate_Call(self, node):
        if len(node.args) >= 2 and not any(isinstance(a, ast.Starred) for a in node.args[:2]):
            (a, b), (c, d) = (self.span(argument) for argument in node.args[:2])
            text = self.text
            called = text[slice(*self.span(node.func))].split(".")[-1]
            if text[a:b] != text[c:d] and not EITHER_WAY.fullmatch(called):
                self.add(node.lineno, a, d, text[c:d] + text[b:c] + text[a:b])

    def mutate_FunctionDef(self, node):
        if any(isinstance(d, ast.Name) and d.id == "overload" for d in node.decorator_list):
            node.body, node.args = [], ast.arguments([], [], None, [], [], None, [])


# --- C, by its tokens: clang-format puts spaces around what joins two values ----------------------

HIDDEN = re.compile(
    r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])+'"
    r"|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*|\bassert\([^;]*;",
    re.S | re.M,
)
NUMBER = r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+)(?:[eE][-+]?\d+)?(?![\w.])"
STATEMENT = r"(?<=\n)[ \t]+(?!return|break|goto|else|case)[\w.>\[\]()*-]+(?: [-+*/]?= |\()[^;{}]*;"
ARGUMENTS = r"(?<=\()([^(),;]+), ([^(),;]+)(?=[,)])"


def c_mutants(path, text):
    """Every mutant of a C file."""
    bare = HIDDEN.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    found = []

    def add(match, new, group=0):
        line = text.count("\n", 0, match.start(group)) + 1
        found.append(Mutant(path, line, match.start(group), match.end(group), new))

    for match in re.finditer(r"(?<= )([<>]=?|[=!]=)(?=\s)", bare):
        add(match, COMPARED[match[0]])
    for match in re.finditer(r"(?<= )([-+*/])(?=\s)", bare):
        add(match, JOINED[match[0]])
    for match in re.finditer(r"(?<= )([-+*/])=(?=\s)", bare):
        add(match, JOINED[match[1]] + "=")
    for match in re.finditer(r"(?<= )(&&|\|\|)(?=\s)", bare):
        add(match, "||" if match[0] == "&&" else "&&")
    for match in re.finditer(r"(?<=[(,=] )-(?=\w)|(?<=\()-(?=\w)|(?<=return )-(?=\w)", bare):
        add(match, "")
    for match in re.finditer(NUMBER, bare):
        add(match, off(match[0]))
    for match in re.finditer(STATEMENT, bare):
        add(match, ";")
    for match in re.finditer(ARGUMENTS, bare):
        called = re.search(r"\w*$", bare[: match.start() - 1])[0]
        declared = re.search(r"\b(?:const|double|size_t|int|struct|cv|enum|char)\b", match[0])
        if not declared and not EITHER_WAY.fullmatch(called) and match[1] != match[2]:
            add(match, f"{match[2]}, {match[1]}")
    return found


def every_mutant(root):
    """Every mutant of the package and of the core, in a fixed order."""
    found = []
    for path in sorted(Path(root, "ropedyn").rglob("*.py")):
        found += Python(path.relative_to(root).as_posix(), path.read_text()).found
    for path in sorted(Path(root, "csrc").rglob("*.[ch]")):
        found += c_mutants(path.relative_to(root).as_posix(), path.read_text())
    return found
