#!/usr/bin/env python3
"""self_test.py COMPILER: each check of this folder complains about a bad sample, and does not about a good one."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import all_targets
import budgets
import call_stack
import figures
import symbols

COMPILER = "gcc"


class Sample(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.root = pathlib.Path(self.temporary.name)

    def compile(self, text, *options):
        (self.root / "sample.c").write_text(text, encoding="utf-8")
        subprocess.run([COMPILER, "-Os", "-fcallgraph-info=su", *options, "-c", "sample.c", "-o", "sample.o"], cwd=self.root, check=True)
        return self.root / "sample.ci"

    def library(self, text, *options):
        self.compile(text, *options)
        subprocess.run(["ar", "rc", "sample.a", "sample.o"], cwd=self.root, check=True)
        return self.root / "sample.a"

    def graph(self, text):
        return call_stack.read_graph([self.compile(text)])


class CallStack(Sample):
    def test_adds_up_the_deepest_path(self):
        graph = self.graph("void use(char *); __attribute__((noinline)) static void inner(void) { char b[400]; use(b); }"
                           "void outer(void) { char b[100]; use(b); inner(); }")
        graph.add("use", 32)
        self.assertGreaterEqual(graph.worst("outer"), 400 + 100 + 32)
        self.assertLess(graph.worst("outer"), 700)

    def test_refuses_recursion(self):
        graph = self.graph("int f(int *p); __attribute__((noinline)) int g(int *p) { return f(p) + 1; }"
                           "__attribute__((noinline)) int f(int *p) { return *p ? g(p + 1) + 1 : 0; }")
        self.assertRaisesRegex(call_stack.Fault, "recursion: f -> g -> f", graph.worst, "f")

    def test_refuses_stack_of_unknown_size(self):
        graph = self.graph("void use(char *); void f(int n) { char b[n]; use(b); }")
        graph.add("use", 0)
        self.assertRaisesRegex(call_stack.Fault, "not bounded", graph.worst, "f")

    def test_refuses_a_function_that_it_does_not_know(self):
        graph = self.graph("void elsewhere(void); void f(void) { elsewhere(); elsewhere(); }")
        self.assertRaisesRegex(call_stack.Fault, r"elsewhere\(\) is not known, called by f", graph.worst, "f")

    def test_instructions_that_take_from_the_stack(self):
        for text, taken in {"push\t{r4, r5, r6, lr}": 16, "stmdb\tsp!, {r4-r9, sl, lr}": 32, "sub\tsp, #24": 24, "sub.w\tsp, sp, #400": 400,
                            "addi\tsp,sp,-32": 32, "str.w\tlr, [sp, #-4]!": 4, "add\tsp, #24": 0, "mov\tr0, r1": 0}.items():
            self.assertEqual(taken, call_stack.taken_by(text), text)


class Symbols(Sample):
    def test_good(self):
        library = self.library("#include <string.h>\nvoid roadpose_f(void *p, int n) { memset(p, 0, (size_t)n); }")
        self.assertEqual([], symbols.check("", library))

    def test_bad(self):
        samples = {"double roadpose_f(void *p) { double pow(double, double); return pow(*(double *)p, 2.5); }": "needs pow",
                   "#include <stdlib.h>\nvoid *roadpose_f(void) { return malloc(3); }": "needs malloc",
                   "#include <stdio.h>\nvoid roadpose_f(int n) { printf(\"%d\", n); }": "needs printf",
                   "int roadpose_n; int *roadpose_f(void) { return &roadpose_n; }": "4 bytes of writable data",
                   "void other(void) { }": "defines other"}
        for text, complaint in samples.items():
            found = symbols.check("", self.library(text, "-fno-builtin"))
            self.assertTrue(any(complaint in line for line in found), (text, found))


class Comparison(unittest.TestCase):
    def test_the_first_different_line(self):
        expected = {("level", ""): (b"head\n0,ok,1.0\n", b"can\n")}
        self.assertEqual([], all_targets.compare(expected, expected, "target"))
        other = {("level", ""): (b"head\n0,ok,1.1\n", b"can\n")}
        found = all_targets.compare(expected, other, "target")
        self.assertEqual(1, len(found))
        self.assertIn("target, level : poses differ\n    line 2", found[0])
        self.assertEqual(1, len(all_targets.compare(expected, {("level", ""): (b"head\n0,ok,1.0\n", b"")}, "target")))


class Budgets(unittest.TestCase):
    def tables(self, instructions, state=100):
        return {("Executed instructions", "cortex-m4, default: level", "worst frame"): instructions,
                ("Memory", "cortex-m4, default", "state"): state}

    def test_growth_beyond_the_tolerance(self):
        self.assertEqual([], budgets.growth(self.tables(1000), self.tables(1020)))
        self.assertEqual([], budgets.growth(self.tables(1000), self.tables(500)))
        self.assertEqual(1, len(budgets.growth(self.tables(1000), self.tables(1021))))
        self.assertEqual(1, len(budgets.growth(self.tables(1000), self.tables(1000, state=101))))

    def test_missing_figures(self):
        self.assertEqual(2, len(budgets.growth({}, self.tables(1000))))
        self.assertEqual(2, len(budgets.growth(self.tables(1000), {})))

    def test_what_is_written_is_read(self):
        table = figures.Table("Worst stack", "", ["cortex-m4", "riscv32"], {"`f`": [1234, None], "`g` + callback": [12.34, 0]})
        read = budgets.read(budgets.render_table(table))
        self.assertEqual({1234, None, 12.34, 0}, set(read.values()))
        self.assertEqual(1234, read["Worst stack", "`f`", "cortex-m4"])


if __name__ == "__main__":
    COMPILER = sys.argv.pop()
    unittest.main()
