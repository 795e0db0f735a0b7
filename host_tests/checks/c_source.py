"""What the checks need to know about C text. No parser: comments and literals are blanked, braces are counted."""
import pathlib
import re
from dataclasses import dataclass

COMMENT_OR_LITERAL = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"][^>"\n]+[>"])', re.MULTILINE)
NOT_A_FUNCTION = {"if", "for", "while", "switch", "return", "sizeof", "defined"}


@dataclass
class Function:
    name: str
    line: int
    lines: int
    body: str


def blank(match):
    """Spaces for the text, so that places and line numbers stay."""
    return re.sub(r"[^\n]", " ", match.group(0))


def without_comments_and_literals(text):
    return COMMENT_OR_LITERAL.sub(blank, text)


def includes(text):
    """(line, '<name>' or '"name"') of every #include outside comments."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*", blank, text, flags=re.DOTALL)
    return [(line_of(code, found.start(1)), found.group(1)) for found in INCLUDE.finditer(code)]


def line_of(text, place):
    return text.count("\n", 0, place) + 1


def sources(*folders, suffixes=(".c", ".h")):
    return sorted(path for folder in folders for path in pathlib.Path(folder).rglob("*") if path.suffix in suffixes)


def matching_brace(code, start):
    depth = 0
    for place in range(start, len(code)):
        depth += {"{": 1, "}": -1}.get(code[place], 0)
        if depth == 0:
            return place
    return len(code) - 1


def functions(text):
    """Functions defined in a C file."""
    code = DIRECTIVE.sub(blank, without_comments_and_literals(text))
    code = re.sub(r'extern\s+\{', blank, code)  # extern "C" {
    found, place = [], 0
    while (start := code.find("{", place)) >= 0:
        end = matching_brace(code, start)
        head = re.search(r"(\w+)\s*\([^;{}]*\)\s*$", code[place:start])
        if head and head.group(1) not in NOT_A_FUNCTION:
            first = line_of(code, place + head.start())
            found.append(Function(head.group(1), first, line_of(code, end) - first + 1, code[start:end + 1]))
        place = end + 1
    return found
