"""Worst stack of functions: the compiler's own figure for each function (-fcallgraph-info=su), followed through the calls.

Functions of the C library and of the compiler's run-time are taken from the disassembly of a linked program: every push
and every subtraction from the stack pointer in them counts, so their figure is an upper bound."""
import re
import subprocess

NODE = re.compile(r'node: { title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: { sourcename: "([^"]+)" targetname: "([^"]+)"')
SIZE = re.compile(r"(\d+) bytes \((\w+(?:,\w+)?)\)")
INDIRECT = "__indirect_call"
# In a disassembly: a call or jump to an address in a register, and a stack pointer lowered by one.
BY_REGISTER = re.compile(r"\t(?:blx\s+r\d|bx\s+(?!lr)|mov\s+pc,|ldr(?:\.w)?\s+pc,\s*\[(?!sp)|jalr\s|jr\s+(?!ra))")
LOWERED = re.compile(r"\tsub(?:\.w)?\s+sp,\s*(?:sp,\s*)?[a-z]|\tmov\s+sp,|\tmv\s+sp,")
BRANCH = re.compile(r"\t(?:bl|b[a-z]{0,2}|b[a-z]{0,2}\.[wn]|cbn?z|j|jal|call|tail)\s+(?:\w+,\s*)*[0-9a-f]+ <([^>+]+)>")


class Fault(Exception):
    pass


class Graph:
    def __init__(self):
        self.frame = {}  # function -> bytes of its own
        self.calls = {}  # function -> set of functions
        self.dynamic = set()

    def add(self, name, size):
        self.frame[name] = max(size, self.frame.get(name, 0))
        self.calls.setdefault(name, set())

    def worst(self, name, path=()):
        """Bytes of name and all that it calls."""
        if name in path:
            raise Fault(f"recursion: {' -> '.join(path + (name,))}")
        if name == INDIRECT:
            return 0  # a callback of the platform: its stack is the platform's to know (see calls_by_pointer)
        if name not in self.frame:
            raise Fault(f"the stack of {name}() is not known, called by {path[-1] if path else 'nobody'}()")
        if name in self.dynamic:
            raise Fault(f"the stack of {name}() is not bounded at compile time")
        return self.frame[name] + max((self.worst(callee, path + (name,)) for callee in self.calls[name]), default=0)

    def calls_by_pointer(self):
        """Functions that do not say whom they call."""
        return sorted(name for name, callees in self.calls.items() if INDIRECT in callees)

    def reached(self, name):
        seen, waiting = set(), [name]
        while waiting:
            current = waiting.pop()
            if current not in seen:
                seen.add(current)
                waiting += self.calls.get(current, ())
        return seen


def read_graph(files):
    """files: .ci files of the objects."""
    graph = Graph()
    for path in files:
        text = path.read_text(encoding="utf-8")
        for title, label in NODE.findall(text):
            size = SIZE.search(label)
            if size:
                graph.add(title, int(size.group(1)))
                if size.group(2) not in ("static", "dynamic,bounded"):
                    graph.dynamic.add(title)
        for source, target in EDGE.findall(text):
            graph.calls.setdefault(source, set()).add(target)
    return graph


def registers(listing):
    """Number of registers in {r4, r5-r7, lr}."""
    count = 0
    for part in listing.split(","):
        ends = re.findall(r"\d+", part)
        count += int(ends[1]) - int(ends[0]) + 1 if "-" in part else 1
    return count


def taken_by(instruction):
    """Bytes that one instruction takes from the stack, Thumb-2 and RISC-V."""
    push = re.search(r"\b(?:push|stmdb\tsp!,|stmfd\tsp!,)(?:\.w)?\s*{([^}]*)}", instruction)
    if push:
        return 4 * registers(push.group(1))
    down = re.search(r"\bsub(?:w|\.w)?\tsp, (?:sp, )?#(\d+)|\baddi\tsp,sp,-(\d+)|\[sp, #-(\d+)\]!", instruction)
    return int(next(group for group in down.groups() if group)) if down else 0


def add_disassembly(graph, objdump, program):
    """Adds the functions of program that the graph does not know yet."""
    text = subprocess.run([objdump, "-d", "--no-show-raw-insn", program], check=True, capture_output=True, text=True).stdout
    for block in re.split(r"\n\n", text):
        head = re.match(r"\s*[0-9a-f]+ <([^>]+)>:\n", block)
        if not head or head.group(1) in graph.frame:
            continue
        name = head.group(1)
        graph.add(name, sum(taken_by(line) for line in block.splitlines()))
        graph.calls[name] |= {target for target in BRANCH.findall(block) if target != name}
        if BY_REGISTER.search(block):
            graph.calls[name].add("an address in a register: ")
        if LOWERED.search(block):
            graph.dynamic.add(name)
