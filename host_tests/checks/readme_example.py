"""readme_example.py README INCLUDE COMPILER: every C block of the README compiles as it stands, without a warning."""
import pathlib
import re
import subprocess
import sys
import tempfile


def blocks(text):
    return re.findall(r"^```c\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def compiles(source, include, compiler):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "example.c")
        path.write_text(source)
        command = [compiler, "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-Wno-unused-function",
                   f"-I{include}", "-c", str(path), "-o", str(pathlib.Path(folder, "example.o"))]
        return subprocess.run(command).returncode == 0


def main(readme, include, compiler):
    found = blocks(pathlib.Path(readme).read_text())
    failed = [number for number, source in enumerate(found, 1) if not compiles(source, include, compiler)]
    for number in failed:
        print(f"{readme}: C block {number} does not compile")
    if not found:
        print(f"{readme}: no C block found")
    return 1 if failed or not found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
