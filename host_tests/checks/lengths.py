#!/usr/bin/env python3
"""lengths.py FOLDER...: no C file over 400 lines, no function over 60."""
import sys

import c_source

FILE_LINES = 400
FUNCTION_LINES = 60


def check(folders):
    complaints = []
    for path in c_source.sources(*folders, suffixes=(".c", ".h", ".cpp", ".hpp")):
        text = path.read_text(encoding="utf-8")
        if (lines := text.count("\n")) > FILE_LINES:
            complaints.append(f"{path}: {lines} lines, at most {FILE_LINES}")
        complaints += [f"{path}:{function.line}: {function.name}() has {function.lines} lines, at most {FUNCTION_LINES}"
                       for function in c_source.functions(text) if function.lines > FUNCTION_LINES]
    return complaints


if __name__ == "__main__":
    found = check(sys.argv[1:])
    print("\n".join(found) or f"no file over {FILE_LINES} lines, no function over {FUNCTION_LINES}")
    sys.exit(1 if found else 0)
