#!/usr/bin/env python3
"""symbols.py TOOLS LIBRARY...: on any machine the libraries need nothing but mem* and the compiler's integer arithmetic,
no float helper, no heap, no stdio, and have no writable data. TOOLS: how the names of nm and size begin."""
import re
import sys

import archive

# Integer division, multiplication and shift of 64 bits, and saving of registers, by their names in gcc's run-time.
INTEGER_HELPERS = [
    r"__aeabi_u?[il]div(mod)?", r"__aeabi_(lmul|llsl|llsr|lasr|u?lcmp)", r"__aeabi_mem(cpy|move|set|clr)[48]?",
    r"__u?(div|mod|divmod)[sd]i[34]", r"__mul[sd]i3", r"__(ash[lr]|lshr)di3", r"__u?cmpdi2",
    r"__(clz|ctz|ffs|popcount|bswap)[sd]i2", r"__riscv_(save|restore)_\d+", r"_(save|rest)gpr_\d+(_x)?",
    r"__gnu_thumb1_case_[su](qi|hi|si)",
]
THUNK = re.compile(r"__x86\.get_pc_thunk\.\w+")  # position-independent code of 32-bit x86
ALLOWED = re.compile("|".join([r"mem(cpy|move|set|cmp)", "_GLOBAL_OFFSET_TABLE_", *INTEGER_HELPERS]))


def check(tools, library, others=()):
    """others: libraries that are linked with it."""
    read = archive.Archive(library, tools)
    elsewhere = set().union(*(archive.Archive(other, tools).home() for other in others)) if others else set()
    needs = sorted(name for name in read.undefined() - elsewhere if not ALLOWED.fullmatch(name))
    complaints = [f"{library} needs {name}" for name in needs]
    complaints += [f"{library} has writable data: {what}" for what in read.writable()]
    foreign = [name for name in read.home() if not name.startswith("roadpose_") and not THUNK.fullmatch(name)]
    return complaints + [f"{library} defines {name}" for name in sorted(foreign)]


if __name__ == "__main__":
    libraries = sys.argv[2:]
    found = [line for path in libraries for line in check(sys.argv[1], path, [other for other in libraries if other != path])]
    print("\n".join(found) or f"{len(libraries)} libraries need only mem* and integer arithmetic, and have no writable data")
    sys.exit(1 if found or not libraries else 0)
