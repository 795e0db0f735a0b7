"""What is in a static library of any machine, and what of it a program takes in that calls some functions."""
import collections
import re
import subprocess

CONSTANTS = re.compile(r"\.(?:rodata|srodata|sdata2|data\.rel\.ro)")
WRITABLE = re.compile(r"\.(?:data|bss|sdata|sbss|tdata|tbss)(?!\.rel\.ro)")
CODE = re.compile(r"\.text")


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


class Archive:
    """tools: what the names of nm and size begin with, such as arm-none-eabi-."""

    def __init__(self, path, tools):
        self.path = path
        self.defined = collections.defaultdict(set)  # member -> global names
        self.wanted = collections.defaultdict(set)
        for member, name, kind in re.findall(r"^\S*\[(\S+)\]: (\S+) (\S)", output_of(f"{tools}nm", "-P", "-A", "-g", path),
                                             re.MULTILINE):
            (self.wanted if kind in "Uw" else self.defined)[member].add(name)
        self.sections = collections.defaultdict(list)
        for block in re.split(r"\n\n+", output_of(f"{tools}size", "-A", path)):
            head = re.match(r"\s*(\S+)\s+\(ex ", block)
            if head:
                self.sections[head.group(1)] = [(name, int(size)) for name, size in
                                                re.findall(r"^(\.\S+)\s+(\d+)", block, re.MULTILINE)]

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
        return sum(size for member in chosen for name, size in self.sections[member] if pattern.match(name))
