#!/usr/bin/env python3
"""headers_alone.py INCLUDE C_COMPILER CXX_COMPILER: every public header compiles alone, as C99, C11, C17 and C++."""
import pathlib
import subprocess
import sys

WARNINGS = ["-Wall", "-Wextra", "-Wshadow", "-pedantic", "-Werror"]
C_MODES = ["c99", "c11", "c17"]
CXX_MODES = ["c++11", "c++17", "c++20"]


def compiles(command, header):
    run = subprocess.run([*command, *WARNINGS, "-fsyntax-only", "-"], input=f'#include "{header}"\n#include "{header}"\n'
                         "int main(void) { return 0; }\n", capture_output=True, text=True, check=False)
    return None if run.returncode == 0 else run.stderr.strip()


def check(include, c_compiler, cxx_compiler):
    folder = pathlib.Path(include)
    commands = [[c_compiler, "-x", "c", f"-std={mode}", f"-I{folder}"] for mode in C_MODES]
    commands += [[cxx_compiler, "-x", "c++", f"-std={mode}", f"-I{folder}"] for mode in CXX_MODES]
    headers = [path.relative_to(folder).as_posix() for path in sorted(folder.rglob("*.h"))]
    failures = [(header, command[3], compiles(command, header)) for header in headers for command in commands]
    complaints = [f"{header} as {mode}:\n{problem}" for header, mode, problem in failures if problem]
    return complaints or ([] if headers else [f"no header in {folder}"])


if __name__ == "__main__":
    found = check(*sys.argv[1:4])
    print("\n".join(found) or "every public header compiles alone")
    sys.exit(1 if found else 0)
