#!/usr/bin/env python3
"""self_test.py COMPILER: each check of this folder complains about a bad sample, and does not about a good one."""
import pathlib
import re
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

import all_targets
import budgets
import call_stack
import figures
import symbols
import targets

COMPILER = "gcc"
ARM = "arm-none-eabi-"
CORTEX_M3 = ["-mthumb", "-mcpu=cortex-m3"]
BOARDS = pathlib.Path(__file__).resolve().parents[2] / "port/cortex_m"


class Sample(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.root = pathlib.Path(self.temporary.name)

    def compile(self, text, *options):
        (self.root / "sample.c").write_text(text, encoding="utf-8")
        command = [self.compiler, "-Os", "-fcallgraph-info=su", *options, "-c", "sample.c", "-o", "sample.o"]
        subprocess.run(command, cwd=self.root, check=True)
        return self.root / "sample.ci"

    @property
    def compiler(self):
        return COMPILER

    def library(self, text, *options):
        self.compile(text, *options)
        (self.root / "sample.a").unlink(missing_ok=True)
        subprocess.run(["ar", "rc", "sample.a", "sample.o"], cwd=self.root, check=True)
        return self.root / "sample.a"

    def graph(self, text):
        return call_stack.read_graph([self.compile(text)])


class ArmSample(Sample):
    @property
    def compiler(self):
        return f"{ARM}gcc"

    def linked(self, text, *options):
        self.compile(text, *CORTEX_M3)
        return subprocess.run([self.compiler, *CORTEX_M3, "-nostartfiles", *options, "sample.o", "-o", "sample.elf"],
                              cwd=self.root, capture_output=True, text=True, check=False)


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

    def test_refuses_alloca(self):
        graph = self.graph("void use(char *); void f(int n) { use(__builtin_alloca(n)); }")
        graph.add("use", 0)
        self.assertRaisesRegex(call_stack.Fault, "not bounded", graph.worst, "f")

    def test_tells_calls_by_pointer(self):
        graph = self.graph("int f(int (*g)(int)) { return g(3) + 1; } int h(int x) { return x + 1; }")
        self.assertEqual(["f"], graph.calls_by_pointer())
        graph = self.graph("int f(int (*g)(int)) { return g(3); }")  # as a jump
        self.assertEqual(["f"], graph.calls_by_pointer())

    def graph_of_core(self, text):
        """As figures.py reads it, of a core with no port and no run-time functions."""
        folder = self.root / "lib/CMakeFiles/roadpose.dir"
        folder.mkdir(parents=True, exist_ok=True)
        self.compile(text).rename(folder / "f.c.ci")
        machine = types.SimpleNamespace(machine=types.SimpleNamespace(tools=""))
        builds = types.SimpleNamespace(where={("x", "-O2"): self.root}, targets={("x", "-O2"): machine}, compiler=lambda _: COMPILER)
        with mock.patch.object(targets, "run"), mock.patch.object(call_stack, "add_disassembly"):
            return figures.graph_of(builds, "x", "-O2", "")

    def test_refuses_a_core_that_cannot_be_followed(self):
        self.graph_of_core("int f(int x) { return x + 1; }")
        bad = {"int f(int (*g)(int)) { return g(3) + 1; }": "by pointer", "int f(int n) { volatile int b[n]; return b[0] = n; }": "not bounded",
               "int f(int n) { return n < 2 ? n : f(n - 1) * f(n - 2) + 1; }": "recursion"}
        for text, complaint in bad.items():
            self.assertRaisesRegex(call_stack.Fault, complaint, self.graph_of_core, text)

    def test_instructions_that_take_from_the_stack(self):
        for text, taken in {"push\t{r4, r5, r6, lr}": 16, "stmdb\tsp!, {r4-r9, sl, lr}": 32, "sub\tsp, #24": 24, "sub.w\tsp, sp, #400": 400,
                            "addi\tsp,sp,-32": 32, "str.w\tlr, [sp, #-4]!": 4, "add\tsp, #24": 0, "mov\tr0, r1": 0}.items():
            self.assertEqual(taken, call_stack.taken_by(text), text)


class Disassembly(ArmSample):
    def worst(self, text, name="f"):
        run = self.linked(text, "-Wl,--entry=0")
        self.assertEqual(0, run.returncode, run.stderr)
        graph = call_stack.Graph()
        call_stack.add_disassembly(graph, f"{ARM}objdump", self.root / "sample.elf")
        return graph.worst(name)

    def test_follows_calls_and_jumps(self):
        inner = "__attribute__((noinline)) int g(int n) { volatile char b[400]; b[n] = 1; return b[n + 1]; }"
        self.assertGreaterEqual(self.worst(inner + "int f(int n) { volatile char b[100]; b[n] = 1; return g(n) + b[n]; }"), 500)
        self.assertGreaterEqual(self.worst(inner + "int f(int n) { return g(n); }"), 400)
        jump = '__attribute__((naked)) void f(void) { __asm__("cmp r0, #0\\n beq.w g\\n bx lr"); }'
        self.assertGreaterEqual(self.worst(inner + jump.replace("\\\\", "\\")), 400)

    def test_refuses_what_it_cannot_follow(self):
        self.assertRaisesRegex(call_stack.Fault, "address in a register", self.worst, "int f(int (*g)(int)) { return g(3) + 1; }")
        self.assertRaisesRegex(call_stack.Fault, "address in a register", self.worst, "int f(int (*g)(int)) { return g(3); }")
        self.assertRaisesRegex(call_stack.Fault, "not bounded", self.worst,
                               "char f(int n) { volatile char b[n]; b[0] = 1; return b[n - 1]; }")


class LibraryRam(ArmSample):
    def test_the_link_fails_when_the_library_outgrows_its_ram(self):
        for script in ["mps2.ld", "mps2_an500.ld", "mps2_an505.ld"]:
            for size, fits in {65536: True, 65537: False}.items():
                run = self.linked(f'__attribute__((section(".library_ram"))) char all[{size}]; void reset(void) {{ all[0] = 1; }}',
                                  f"-L{BOARDS}", f"-T{script}", "-Wl,--defsym=library_ram_bytes=65536")
                self.assertEqual(fits, run.returncode == 0, f"{script}, {size}: {run.stderr}")


class ArmSymbols(ArmSample):
    def test_what_a_microcontroller_would_need(self):
        samples = {"float roadpose_f(float x, float y) { return x * y; }": "needs __aeabi_fmul",
                   "int roadpose_f(int x) { return (int)(x * 1.5); }": "needs __aeabi_dmul",
                   "#include <stdlib.h>\nvoid *roadpose_f(void) { return malloc(3); }": "needs malloc",
                   "#include <stdio.h>\nint roadpose_f(void) { return getchar(); }": "needs getc",
                   "#include <string.h>\nunsigned roadpose_f(const char *p) { return strlen(p); }": "needs strlen",
                   "#include <stdlib.h>\nvoid roadpose_f(void) { abort(); }": "needs abort",
                   "static int n; int roadpose_f(void) { return n++; }": "writable data",
                   "static int n = 3; int roadpose_f(void) { return n++; }": "writable data"}
        for text, complaint in samples.items():
            found = symbols.check(ARM, self.library(text, *CORTEX_M3))
            self.assertTrue(any(complaint in line for line in found), (text, found))

    def test_integer_arithmetic(self):
        text = "#include <stdint.h>\nint64_t roadpose_f(int64_t x, int64_t y) { return x / y * y; }"
        self.assertEqual([], symbols.check(ARM, self.library(text, *CORTEX_M3)))


class Symbols(Sample):
    def test_good(self):
        library = self.library("#include <string.h>\nvoid roadpose_f(void *p, int n) { memset(p, 0, (size_t)n); }")
        self.assertEqual([], symbols.check("", library))

    def test_bad(self):
        samples = {"double roadpose_f(void *p) { double pow(double, double); return pow(*(double *)p, 2.5); }": "needs pow",
                   "#include <stdlib.h>\nvoid *roadpose_f(void) { return malloc(3); }": "needs malloc",
                   "#include <stdio.h>\nvoid roadpose_f(int n) { printf(\"%d\", n); }": "needs printf",
                   "int roadpose_n; int *roadpose_f(void) { return &roadpose_n; }": "writable data: 4 bytes of .bss",
                   "static int n __attribute__((section(\"mine\"))) = 1; int roadpose_f(void) { return n++; }": "bytes of mine",
                   "static __thread int n; int roadpose_f(void) { return n++; }": "bytes of .tbss",
                   "void other(void) { }": "defines other"}
        for text, complaint in samples.items():
            found = symbols.check("", self.library(text, "-fno-builtin"))
            self.assertTrue(any(complaint in line for line in found), (text, found))

    def test_a_variable_that_the_linker_places(self):
        library = self.library("int roadpose_n; int *roadpose_f(void) { return &roadpose_n; }", "-fcommon")
        self.assertEqual([f"{library} has writable data: the variable roadpose_n"], symbols.check("", library))

    def test_members_of_the_same_name(self):
        library = self.library("void roadpose_f(void) { }")
        (self.root / "other").mkdir()
        (self.root / "sample.o").rename(self.root / "other/sample.o")
        self.compile("void roadpose_g(void) { }")
        subprocess.run(["ar", "cq", library, "other/sample.o"], cwd=self.root, check=True)
        subprocess.run(["ar", "cq", library, "sample.o"], cwd=self.root, check=True)
        self.assertRaisesRegex(ValueError, "same name", symbols.check, "", library)


class Targets(unittest.TestCase):
    def test_no_machine_is_forgotten(self):
        machines = {"cortex-m3", "cortex-m4", "cortex-m7", "cortex-m33", "riscv32", "powerpc", "host64-gcc", "host64-clang",
                    "host32-gcc", "host32-clang"}
        levels = {"-O0", "-Os", "-O2", "-O3"}
        self.assertEqual({f"{machine} {level}" for machine in machines for level in levels},
                         {target.name for target in targets.all_targets()})
        self.assertEqual({machine for machine in machines if re.match("cortex|riscv", machine)}, set(figures.MACHINES))

    def test_each_machine_is_another(self):
        # Two machines on one emulated board, or with one compiler and toolchain file, would be one.
        self.assertEqual(len(targets.MACHINES), len({(m.toolchain, m.compiler, m.emulator) for m in targets.MACHINES}))
        self.assertEqual(["mps2-an385", "mps2-an386", "mps2-an500", "mps2-an505"],
                         [m.emulator[2] for m in targets.MACHINES if m.name.startswith("cortex")])
        for machine in targets.MACHINES:
            if not machine.name.startswith("host"):
                self.assertTrue(machine.emulator, machine.name)

    def test_failed_commands(self):
        self.assertRaisesRegex(targets.Failure, "exit status 3", targets.run, ["sh", "-c", "exit 3"])
        missing = targets.Target(targets.Machine("x", "", "no-such-compiler-gcc", (), False), "-O2")
        self.assertRaisesRegex(targets.Failure, "is missing", targets.build, missing, ".", ".", [])


class OneTarget(unittest.TestCase):
    """try_target() on a machine that is only a shell command."""
    GOOD = "0,ok,1.0\n"

    def try_with(self, emulator, output=GOOD):
        with tempfile.TemporaryDirectory() as folder:
            options = types.SimpleNamespace(source=".", folder=folder, fixtures=folder, replay="", firmware="", small="", frames=1,
                                            small_levels=[])
            player = all_targets.Player(options, folder)
            player.cases = [(pathlib.Path("level"), 1, "")]
            machine = targets.Machine("x", "", "gcc", emulator, False)
            with mock.patch.object(targets, "build", return_value=pathlib.Path(folder)), \
                 mock.patch.object(all_targets, "check_symbols", return_value=[]), mock.patch("builtins.print"):
                return all_targets.try_target(targets.Target(machine, "-O2"), options, player,
                                              {all_targets.DEFAULT: {("level", ""): (output.encode(), b"", b"")}})

    def test_same(self):
        self.assertEqual([], self.try_with(("sh", "-c", f"printf '{self.GOOD}'")))

    def test_emulator_that_says_nothing_is_missing_or_fails(self):
        self.assertIn("poses differ", self.try_with(("sh", "-c", "true"))[0])
        self.assertIn("no-such-emulator", self.try_with(("no-such-emulator",))[0])
        self.assertIn("exit status 70", self.try_with(("sh", "-c", f"printf '{self.GOOD}'; exit 70"))[0])


class Comparison(unittest.TestCase):
    def test_the_first_different_line(self):
        expected = {("level", ""): (b"head\n0,ok,1.0\n", b"can\n", b"pose 1\n")}
        self.assertEqual([], all_targets.compare(expected, expected, "target"))
        other = {("level", ""): (b"head\n0,ok,1.1\n", b"can\n", b"pose 1\n")}
        found = all_targets.compare(expected, other, "target")
        self.assertEqual(1, len(found))
        self.assertIn("target, level : poses differ\n    line 2", found[0])
        self.assertEqual(1, len(all_targets.compare(expected, {("level", ""): (b"head\n0,ok,1.0\n", b"", b"pose 1\n")}, "target")))
        found = all_targets.compare(expected, {("level", ""): (b"head\n0,ok,1.0\n", b"can\n", b"pose 2\n")}, "target")
        self.assertIn("fields differ", found[0])

    def test_output_that_proves_little(self):
        good = {("a", ""): (b"0,ok,1.0\n1,no_road,\n2,ok,1.0,,ok,2.0\n", b"can\n", b"pose 1\n")}
        self.assertEqual([], all_targets.empty(good))
        self.assertEqual(["no recording gives a yaw"], all_targets.empty(
            {("a", ""): (b"0,ok,1.0\n1,no_road,\n2,ok,1.0,,turning,\n", b"can\n", b"pose 1\n")}))
        self.assertEqual(["a : no CAN frames"], all_targets.empty({("a", ""): (good["a", ""][0], b"", b"pose 1\n")}))
        self.assertEqual(3, len(all_targets.empty({})))

    def test_frames_from_the_first_to_the_last(self):
        with tempfile.TemporaryDirectory() as folder:
            fixture = pathlib.Path(folder)
            (fixture / "disparity").mkdir()
            for number in range(9):
                (fixture / f"disparity/{number:06}.pgm").touch()
            self.assertEqual([0, 4, 8], all_targets.chosen_frames(fixture, 3))
            self.assertEqual(list(range(9)), all_targets.chosen_frames(fixture, 10))
            (fixture / "tracks").mkdir()
            self.assertEqual([0, 1, 2], all_targets.chosen_frames(fixture, 3))


class Growth(unittest.TestCase):
    def figures(self, instructions, state=100, stack=100):
        return {("Executed instructions", "cortex-m4, default: level", "worst frame"): instructions,
                ("Worst stack", "`f`", "cortex-m4"): stack, ("Memory", "cortex-m4, default", "state"): state}

    def test_growth_beyond_the_tolerance(self):
        self.assertEqual([], budgets.growth(self.figures(1000), self.figures(1020)))
        self.assertEqual([], budgets.growth(self.figures(1000), self.figures(900)))
        self.assertEqual([], budgets.growth(self.figures(1000), self.figures(1000, stack=116)))
        for worse in [self.figures(1021), self.figures(1000, state=101), self.figures(1000, stack=117)]:
            self.assertEqual(1, len(budgets.growth(self.figures(1000), worse)))

    def test_what_cannot_be_true(self):
        self.assertIn("not counted", budgets.growth(self.figures(1000), self.figures(0))[0])
        self.assertIn("not counted", budgets.growth(self.figures(1000), self.figures(700))[0])

    def test_missing_figures(self):
        self.assertEqual(3, len(budgets.growth({}, self.figures(1000))))
        self.assertEqual(3, len(budgets.growth(self.figures(1000), {})))
        self.assertEqual(1, len(budgets.growth(self.figures(1000), self.figures(None))))
        self.assertEqual(1, len(budgets.growth(self.figures(None), self.figures(1000))))


class Budgets(unittest.TestCase):
    """The documents against measurements of which one is made worse."""
    def tables(self, code=1000, state=1000, small=900, frame=3000000, stack=500):
        machine = "cortex-m4"
        return [
            figures.Table("Code and constants", "", ["`.text` -Os", "`.rodata` -Os", "sum -Os", "sum -O2"],
                          {f"{machine}, default: {part}": [code, 10, code + 10, code + 99]
                           for part in ["pose", "pose and yaw", "whole library"]}),
            figures.Table("Memory", "", list(figures.OBJECTS), {
                f"{machine}, default": [state] * 9, f"{machine}, small": [small] * 9}),
            figures.Table("Worst stack", "", [machine, "riscv32"], {"`f`": [stack, None], "`g` + callback": [12, 0]}),
            figures.Table("Executed instructions", "", ["mean a frame", "a pixel", "worst frame", "worst slice"], {
                f"{machine}, {profile}: {figures.WORST}": figures.row_of(frame, frame, 9) for profile in ["default", "small"]})]

    def complaints(self, now, edit=lambda name, text: text):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder)
            (source / "README.md").write_text(f"text\n{budgets.BEGIN}\nold\n{budgets.END}\n", encoding="utf-8")
            with mock.patch.object(budgets, "tools_of", return_value="Measured."):
                budgets.write(source, self.tables())
            for name in ["README.md", "docs/budgets.md"]:
                path = source / name
                path.write_text(edit(name, path.read_text(encoding="utf-8")), encoding="utf-8")
            return budgets.check(source, now)

    def test_what_is_written_is_read(self):
        self.assertEqual([], self.complaints(self.tables()))
        table = figures.Table("Worst stack", "", ["cortex-m4", "riscv32"], {"`f`": [1234, None], "`g` + callback": [12.34, 0]})
        read = budgets.read(budgets.render_table(table))
        self.assertEqual({1234, None, 12.34, 0}, set(read.values()))
        self.assertEqual(1234, read["Worst stack", "`f`", "cortex-m4"])

    def test_worse_figures(self):
        for worse, part in {"code": "Code", "state": "state", "small": "small", "frame": "worst frame", "stack": "`f`"}.items():
            figure = {"code": 1100, "state": 1001, "small": 901, "frame": 3100000, "stack": 540}[worse]
            self.assertIn(part, str(self.complaints(self.tables(**{worse: figure}))), worse)

    def test_limits(self):
        beyond = {"code": 24 * 1024, "state": 128 * 1024 + 1, "small": 40 * 1024 + 1, "frame": 25 * figures.PIXELS + 3000,
                  "stack": 1025}
        for worse, figure in beyond.items():
            found = budgets.over_limits(self.tables(**{worse: figure}))
            self.assertTrue(found and "exceeds" in found[0], worse)
        self.assertEqual([], budgets.over_limits(self.tables()))
        self.assertIn("RAM in all", str(budgets.over_limits(self.tables(small=14000))))

    def test_documents_that_say_something_better(self):
        def better(document):
            return lambda name, text: text.replace("9.77 | 25", "8.77 | 25") if name == document else text
        for document in ["README.md", "docs/budgets.md"]:
            self.assertIn("summary", str(self.complaints(self.tables(), better(document))), document)

    def test_documents_without_figures(self):
        gone = self.complaints(self.tables(), lambda name, text: text if name != "README.md" else "text\n")
        self.assertEqual(["README.md does not show the summary of docs/budgets.md"], gone)
        self.assertIn("not in docs/budgets.md", str(self.complaints(self.tables(), lambda name, text: "")))
        row = self.complaints(self.tables(), lambda name, text: re.sub(r"\| `f` .*\n", "", text))
        self.assertIn("`f`, cortex-m4: not in docs/budgets.md", str(row))


class Costs(unittest.TestCase):
    SAID = "pose: frames 2 instructions 100 worst_frame 60 worst_slice 9\nyaw: frames 0 instructions 0 worst_frame 0 worst_slice 0\n"

    def test_read(self):
        cost = figures.read_cost(f"{self.SAID}stack 500\n", True, "x")
        self.assertEqual((50, 500, (0, 0, 0, 0)), (cost.mean, cost.stack, cost.yaw))

    def test_a_board_that_does_not_count(self):
        for said in ["", self.SAID, f"{self.SAID}stack 0\n", f"{self.SAID}stack 500\n".replace("instructions 100", "instructions 0"),
                     f"{self.SAID}stack 500\n".replace("worst_slice 9", "worst_slice 0")]:
            self.assertRaisesRegex(targets.Failure, "does not count", figures.read_cost, said, True, "x")

    def test_stack_that_the_call_graph_does_not_explain(self):
        columns = len(figures.MACHINES)
        analysed = figures.Table("", "", figures.MACHINES, {f"`{name}` + callback": [400] * columns
                                                            for names in figures.CALLED.values() for name in names})
        seen = figures.Table("", "", figures.MACHINES, {row: [400 + figures.WRAPPERS] * columns for row in figures.CALLED})
        self.assertEqual([], figures.unexplained_stack(analysed, seen))
        seen.rows["pose and CAN"][1] += 1
        self.assertEqual(1, len(figures.unexplained_stack(analysed, seen)))


if __name__ == "__main__":
    COMPILER = sys.argv.pop()
    unittest.main()
