#!/usr/bin/env python3
"""self_test.py C_COMPILER CXX_COMPILER: each check complains about a bad sample, and does not about a good one."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import forbidden_words
import headers_alone
import lengths
import library_symbols
import limit_errors
import recursion
import room_arrows
import strict_compile

COMPILER, CXX_COMPILER = "cc", "c++"


class CheckTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.root = pathlib.Path(self.temporary.name)

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def assert_one(self, complaints, part):
        self.assertEqual(1, len(complaints), complaints)
        self.assertIn(part, complaints[0])


class ForbiddenWords(CheckTest):
    def test_bad_samples(self):
        samples = {
            "float x;": "float", "long double x;": "double", "p = malloc(4);": "malloc", "free (p);": "free",
            "goto end;": "goto", "snprintf(t, 4, s);": "snprintf", "x = time(0);": "time", "x = rand();": "rand",
            "char *p = alloca(4);": "alloca", "x = 1.5;": "1.5", "x = 2e3;": "2e3", "x = .5f;": ".5f",
            "#include <math.h>": "<math.h>", "#  include <stdio.h>": "<stdio.h>", "x = __builtin_clz(y);": "__builtin_clz",
            "asm(\"nop\");": "asm", "setjmp(b);": "setjmp", "x = y ?: z;": "?:", "y = sqrt(x);": "sqrt",
            "x = /* a */ calloc /* b */ (1, 2);": "calloc", "x = 0x1p-3;": "0x1p-3", "x = 0X1.8P3f;": "0X1.8P3", "_Float32 x;": "_Float32",
            "__fp16 x;": "__fp16", "int x __attribute((used));": "__attribute", "__float128 x;": "__float128",
        }
        for text, part in samples.items():
            with self.subTest(text):
                self.assertIn(part, str(forbidden_words.complaints_of(text + "\n")))

    def test_good_samples(self):
        for text in ["/* a float, by malloc() */ int x;", "// goto 1.5\nint x;", 'const char *s = "printf(1.5)";',
                     "int free_map, is_free, timeout, random;", "x = roadpose_is_free(a);", "x = 0x1e5 + 0xE3u;", "x = 0xAFu + p + 1; y = 0x1 + p3;",
                     "#ifdef __cplusplus\nint _Roll;\n#endif",
                     "#include <stdint.h>\n#include <string.h>\n", "x = a ? b : c;", "y = roadpose_sqrt(x);"]:
            with self.subTest(text):
                self.assertEqual([], forbidden_words.complaints_of(text))

    def test_finds_files_in_rooms(self):
        self.write("lib/room/a.h", "\nfloat x;\n")
        self.assert_one(forbidden_words.check([self.root]), "a.h:2: forbidden word: float")


class RoomArrows(CheckTest):
    def sample(self, name, include):
        for header in ["lib/fixed_point/f.h", "lib/disparity/d.h", "lib/road/r.h", "include/roadpose/p.h", "port/x/x.h"]:
            self.write(header, "")
        self.write(name, f"#include {include}\n")
        return room_arrows.check(self.root)

    def test_against_the_arrows(self):
        self.assert_one(self.sample("lib/disparity/a.c", '"road/r.h"'), "must not see")
        self.setUp()
        self.assert_one(self.sample("lib/fixed_point/a.c", '"disparity/d.h"'), "must not see")
        self.setUp()
        self.assert_one(self.sample("lib/road/a.c", '"../port/x/x.h"'), "leaves its room")
        self.setUp()
        self.assert_one(self.sample("lib/road/a.c", '"x/x.h"'), "neither in lib/ nor")
        self.setUp()
        self.assert_one(self.sample("include/roadpose/a.h", '"fixed_point/f.h"'), "public header")
        self.setUp()
        self.assert_one(self.sample("lib/attic/a.c", '"road/r.h"'), "no entry")

    def test_along_the_arrows(self):
        for name, header in [("lib/road/a.c", '"disparity/d.h"'), ("lib/a.c", '"road/r.h"'),
                             ("lib/fixed_point/a.c", '"roadpose/p.h"'), ("include/roadpose/a.h", "<stdint.h>")]:
            self.setUp()
            self.assertEqual([], self.sample(name, header))


class Lengths(CheckTest):
    def function(self, lines):
        return "static int f(int (*g)(int), int x)\n{\n" + "    x++;\n" * (lines - 4) + "    return x;\n}\n"

    def test_limits(self):
        self.write("a.c", self.function(60) + "int y;\n" * 340)
        self.assertEqual([], lengths.check([self.root]))
        self.write("a.c", self.function(61))
        self.assert_one(lengths.check([self.root]), "f() has 61 lines")
        self.write("a.c", "int y;\n" * 401)
        self.assert_one(lengths.check([self.root]), "401 lines")

    def test_function_behind_extern_c(self):
        self.write("a.h", 'extern "C" {\n' + self.function(61) + "}\n")
        self.assert_one(lengths.check([self.root]), "f() has 61 lines")


class Recursion(CheckTest):
    def test_cycles(self):
        self.write("a.c", "int f(int x) { return x ? f(x - 1) : 0; }\n")
        self.assert_one(recursion.check([self.root]), "f() reaches itself")
        self.write("a.c", "int g(void);\nint f(void) { return g(); }\nint g(void) { return f(); }\n")
        self.assertEqual(2, len(recursion.check([self.root])))
        self.write("a.c", "int g(void) { return 1; }\nint f(void) { return g() + g(); /* f() */ }\n")
        self.assertEqual([], recursion.check([self.root]))


class LibrarySymbols(CheckTest):
    def complaints(self, text):
        source, item, library = self.write("a.c", text), self.root / "a.o", self.root / "a.a"
        subprocess.run([COMPILER, "-O1", "-c", source, "-o", item], check=True)
        subprocess.run(["ar", "rcs", library, item], check=True)
        return library_symbols.check(str(library))

    def test_samples(self):
        self.assert_one(self.complaints("int puts(const char *);\nvoid roadpose_f(char *p) { puts(p); }\n"), "needs puts")
        self.assert_one(self.complaints("static int n;\nint roadpose_f(void) { return n++; }\n"), ".bss")
        self.assert_one(self.complaints("static int n = 3;\nint roadpose_f(void) { return n++; }\n"), ".data")
        self.assert_one(self.complaints("int stray(void) { return 1; }\n"), "stray")
        self.assertEqual([], self.complaints("#include <string.h>\nvoid roadpose_f(char *p, const char *q, unsigned n)\n"
                                             "{ static const char t[] = \"abc\"; memcpy(p, q, n); p[0] = t[n & 3]; }\n"))


class Headers(CheckTest):
    def test_samples(self):
        self.write("a.h", "static inline int f(uint8_t x) { return x; }\n")
        self.assertEqual(6, len(headers_alone.check(self.root, COMPILER, CXX_COMPILER)))
        self.write("a.h", "#ifndef A_H\n#define A_H\ntypedef struct { int class; } a_t;\n#endif\n")
        self.assertEqual(3, len(headers_alone.check(self.root, COMPILER, CXX_COMPILER)))
        self.write("a.h", "#ifndef A_H\n#define A_H\n#include <stdint.h>\ntypedef uint8_t a_t;\n#endif\n")
        self.assertEqual([], headers_alone.check(self.root, COMPILER, CXX_COMPILER))
        (self.root / "a.h").unlink()
        self.assertEqual(1, len(headers_alone.check(self.root, COMPILER, CXX_COMPILER)))


class LimitErrors(CheckTest):
    def test_samples(self):
        self.write("roadpose/limits.h", '#if A > 3\n#error "set A to 3"\n#endif\n#if B\n#error "no B"\n#endif\n')
        good = [({}, None), ({"A": 4}, "set A"), ({"B": 1}, "no B")]
        self.assertEqual([], limit_errors.check(self.root, COMPILER, good))
        self.assert_one(limit_errors.check(self.root, COMPILER, good[:2]), "no case fires 'no B'")
        self.assert_one(limit_errors.check(self.root, COMPILER, [*good, ({"A": 3}, "set A")]), "must say")
        self.assert_one(limit_errors.check(self.root, COMPILER, [*good, ({"A": 5}, None)]), "must compile")


class StrictCompile(CheckTest):
    def test_samples(self):
        self.write("a.c", "int f(int n);\nint f(int n) { int a[n]; a[0] = 1; return a[0]; }\n")
        self.assert_one(strict_compile.check(self.root, self.root, COMPILER), "vla")
        self.write("a.c", "short f(int n);\nshort f(int n) { return n; }\n")
        self.assert_one(strict_compile.check(self.root, self.root, COMPILER), "onversion")
        self.write("a.c", "int f(int n);\nint f(int n) { return n; }\n")
        self.assertEqual([], strict_compile.check(self.root, self.root, COMPILER))


if __name__ == "__main__":
    COMPILER, CXX_COMPILER = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
