"""What is in a static library of any machine, and what of it a program takes in that calls some functions."""
import collections
import re
import subprocess

CONSTANTS = re.compile(r"\.(?:rodata|srodata|sdata2|data\.rel\.ro)")
CODE = re.compile(r"\.text")
# Read-only once the program runs: tables of pointers, written by the loader or linker.
RELOCATED = re.compile(r"\.data\.rel\.ro|\.got2?$")
SECTION = re.compile(r"^ +\d+ (\S+) +([0-9a-f]+) .*\n +(.*)$", re.MULTILINE)


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


class Archive:
    """tools: what the names of nm and objdump begin with, such as arm-none-eabi-."""

    def __init__(self, path, tools):
        self.path = path
        members = output_of(f"{tools}ar", "t", path).split()
        if len(set(members)) < len(members):
            raise ValueError(f"{path} has two members of the same name: their sizes cannot be told apart")
        self.read_symbols(output_of(f"{tools}nm", "-P", "-A", "-g", path))
        self.sections = {member: [] for member in members}  # (name, bytes, is it writable)
        for block in re.split(r"\n(?=\S+: +file format )", output_of(f"{tools}objdump", "-h", path)):
            head = re.match(r"(\S+): +file format ", block)
            if head:
                self.sections[head.group(1)] += [section(*found) for found in SECTION.findall(block) if "ALLOC" in found[2]]

    def read_symbols(self, listing):
        self.defined = collections.defaultdict(set)  # member -> global names
        self.wanted = collections.defaultdict(set)
        self.common = set()  # variables that the linker puts into .bss: in no section yet
        for member, name, kind in re.findall(r"\[(\S+)\]: (\S+) (\S)", listing):
            (self.wanted if kind in "Uw" else self.defined)[member].add(name)
            if kind == "C":
                self.common.add(name)

    def home(self):
        return {name: member for member, names in self.defined.items() for name in names}

    def undefined(self):
        """Names that the library wants from elsewhere."""
        return set().union(*self.wanted.values()) - set(self.home())

    def members(self, names):
        """Members that a linker takes in for these functions."""
        home = self.home()
        taken, waiting = set(), [home[name] for name in names if name in home]
        while waiting:
            member = waiting.pop()
            if member not in taken:
                taken.add(member)
                waiting += [home[name] for name in self.wanted[member] if name in home]
        return taken

    def bytes_of(self, pattern, members=None):
        chosen = self.sections if members is None else members
        return sum(size for member in chosen for name, size, _ in self.sections[member] if pattern.match(name))

    def writable(self):
        """Names of what a program could change, each with its bytes where they are known."""
        found = [f"{size} bytes of {name} in {member}" for member, sections in self.sections.items()
                 for name, size, is_writable in sections if is_writable and size and not RELOCATED.match(name)]
        return found + [f"the variable {name}" for name in sorted(self.common)]


def section(name, size, flags):
    return name, int(size, 16), "READONLY" not in flags
