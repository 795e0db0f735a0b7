#!/usr/bin/env python3
"""test_documentation.py COMPILER: every C example of docs/can.md compiles as it stands, without a warning."""
import pathlib
import re
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-pedantic", "-Werror", "-fsyntax-only",
           f"-I{PROJECT / 'include'}", "-x", "c", "-"]


def main(compiler):
    text = (PROJECT / "docs" / "can.md").read_text(encoding="utf-8")
    examples = re.findall(r"^```c\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    runs = [subprocess.run([compiler, *COMMAND], input=example, capture_output=True, text=True, check=False)
            for example in examples]
    print("".join(run.stderr for run in runs) + f"{len(examples)} examples")
    return 0 if len(examples) >= 2 and all(run.returncode == 0 for run in runs) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
