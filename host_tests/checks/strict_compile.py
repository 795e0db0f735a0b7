#!/usr/bin/env python3
"""strict_compile.py LIB INCLUDE COMPILER [OPTION...]: no variable-length array, no implicit narrowing, in no C file of lib/."""
import subprocess
import sys

import c_source

STRICT = ["-std=c99", "-pedantic-errors", "-Werror", "-Wall", "-Wextra", "-Wvla", "-Wconversion", "-Wsign-conversion", "-Wshadow",
          "-Wstrict-prototypes", "-Wmissing-prototypes", "-Wundef", "-Wcast-qual", "-Wwrite-strings", "-Wswitch-enum",
          "-Wfloat-equal", "-Wdouble-promotion"]


def check(lib, include, compiler, *options):
    complaints = []
    for path in c_source.sources(lib):
        if path.suffix == ".c":
            run = subprocess.run([compiler, *STRICT, *options, f"-I{include}", f"-I{lib}", "-fsyntax-only", str(path)],
                                 capture_output=True, text=True, check=False)
            complaints += [run.stderr.strip()] if run.returncode else []
    return complaints


if __name__ == "__main__":
    found = check(*sys.argv[1:])
    print("\n".join(found) or "no complaint")
    sys.exit(1 if found else 0)
