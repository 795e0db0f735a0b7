#!/usr/bin/env python3
"""self_test.py GCC CLANG: determinism.py passes a program that is deterministic, and fails those that are not."""
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

import determinism

COMPILERS = ["gcc", "clang"]
SCRIPT = pathlib.Path(__file__).with_name("determinism.py")
HEAD = "#include <limits.h>\n#include <stdio.h>\nint main(int argc, char **argv) {\n    (void)argv;\n"


class Variants(unittest.TestCase):
    def test_no_build_is_forgotten(self):
        options = types.SimpleNamespace(compilers=["gcc", "clang"], folder=".")
        with mock.patch.object(determinism, "can_link", return_value=True):
            found = [f"{compiler} {words}" for compiler, words in determinism.variants(options)]
        for compiler in ["gcc", "clang"]:
            for words in ["-O0", "-O2", "-O3", "-Os", "sanitize=address,undefined"]:
                self.assertTrue(any(name.startswith(compiler) and words in name for name in found), (compiler, words))
        for words in ["-m32", "-funsigned-char", "-fshort-enums"]:
            self.assertTrue(any(words in name for name in found), words)


class Determinism(unittest.TestCase):
    def run_on(self, body):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "drive").mkdir()
            (folder / "drive" / "rig.yml").write_text("", encoding="utf-8")
            (folder / "program.c").write_text(HEAD + body + "    return 0;\n}\n", encoding="utf-8")
            command = [sys.executable, "-B", SCRIPT, "--folder", folder / "build", "--fixtures", folder, "--compilers",
                       *COMPILERS, "--sources", folder / "program.c", "--includes", folder, "--definitions", "A=1"]
            return subprocess.run(command, capture_output=True, text=True, check=False)

    def test_good_program(self):
        run = self.run_on('    printf("%d\\n", argc > 100);\n')
        self.assertEqual(0, run.returncode, run.stdout + run.stderr)

    def test_output_that_depends_on_the_compiler(self):
        run = self.run_on('#ifdef __clang__\n    puts("1.5");\n#else\n    puts("1.6");\n#endif\n')
        self.assertEqual(1, run.returncode)
        self.assertIn("line 1", run.stdout)

    def test_output_that_depends_on_the_sign_of_char(self):
        self.assertEqual(1, self.run_on('    printf("%d\\n", (char)(argc + 200) > 0);\n').returncode)

    def test_undefined_behaviour_with_the_same_output(self):
        run = self.run_on('    const int sum = INT_MAX - 100 + 200 * argc;\n    if (sum == 3) puts("?");\n')
        self.assertEqual(1, run.returncode)
        self.assertIn("runtime error", run.stderr)

    def test_reading_beyond_an_array(self):
        run = self.run_on('    static char text[4];\n    if (text[argc + 4] == 77) puts("?");\n')
        self.assertEqual(1, run.returncode)


if __name__ == "__main__":
    COMPILERS = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
