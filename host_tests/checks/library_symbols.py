#!/usr/bin/env python3
"""library_symbols.py LIBRARY.a: the library calls nothing but mem*, and has no .data and no .bss."""
import re
import subprocess
import sys

# What a compiler may call on its own in a freestanding program, and the sanitizer-free rest of <string.h> that we use.
ALLOWED = {"memcpy", "memmove", "memset", "memcmp"}


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def undefined_symbols(library):
    defined = set(re.findall(r"^(\S+) [A-Z]", output_of("nm", "-P", "-g", "--defined-only", library), re.MULTILINE))
    wanted = set(re.findall(r"^(\S+) U", output_of("nm", "-P", "-u", library), re.MULTILINE))
    return sorted(wanted - defined - ALLOWED - {"_GLOBAL_OFFSET_TABLE_"})


def bytes_in_ram(library):
    """Bytes of every writable section that is loaded."""
    rows = re.findall(r"^\s*(\.(?:data|bss|tdata|tbss)\S*)\s+(\d+)", output_of("size", "-A", library), re.MULTILINE)
    return [(name, int(size)) for name, size in rows if int(size) > 0 and not name.startswith(".data.rel.ro")]


def check(library):
    complaints = [f"{library} needs {name}" for name in undefined_symbols(library)]
    complaints += [f"{library} has {size} bytes of {name}" for name, size in bytes_in_ram(library)]
    foreign = re.findall(r"^(\S+) [TDBRC]", output_of("nm", "-P", "-g", "--defined-only", library), re.MULTILINE)
    return complaints + [f"{library} defines {name}, which does not begin with roadpose_"
                         for name in foreign if not name.startswith("roadpose_")]


if __name__ == "__main__":
    found = check(sys.argv[1])
    print("\n".join(found) or "only mem* is needed; .data + .bss is 0")
    sys.exit(1 if found else 0)
