"""The machines that the component is tested on: how each is built and run."""
import dataclasses
import itertools
import pathlib
import shutil
import subprocess

LEVELS = ["-O0", "-Os", "-O2", "-O3"]
QEMU = ["-display", "none", "-monitor", "none", "-serial", "none", "-chardev", "stdio,id=console"]
COUNTING = ["-icount", "shift=0,sleep=off"]  # one instruction is one nanosecond of the machine's time


@dataclasses.dataclass(frozen=True)
class Machine:
    name: str
    toolchain: str  # file in cmake/, empty: the host's own
    compiler: str
    emulator: tuple  # command; empty: runs by itself
    semihosting: bool

    @property
    def tools(self):
        """How the names of nm, size and objdump begin."""
        return self.compiler[:-len("gcc")] if self.compiler.endswith("-gcc") else ""


def board(name, machine):
    return Machine(name, name, "arm-none-eabi-gcc", ("qemu-system-arm", "-M", machine), True)


MACHINES = [
    board("cortex-m3", "mps2-an385"),
    board("cortex-m4", "mps2-an386"),
    board("cortex-m7", "mps2-an500"),
    board("cortex-m33", "mps2-an505"),
    Machine("riscv32", "riscv32", "riscv64-unknown-elf-gcc", ("qemu-system-riscv32", "-M", "virt", "-bios", "none"), True),
    Machine("powerpc", "powerpc", "powerpc-linux-gnu-gcc", ("qemu-ppc-static",), False),
    Machine("host64-gcc", "", "gcc", (), False),
    Machine("host64-clang", "", "clang-19", (), False),
    Machine("host32-gcc", "host32", "gcc", (), False),
    Machine("host32-clang", "host32", "clang-19", (), False),
]


@dataclasses.dataclass(frozen=True)
class Target:
    """A machine at one level of optimisation."""
    machine: Machine
    level: str

    @property
    def name(self):
        return f"{self.machine.name} {self.level}"


def all_targets():
    return [Target(machine, level) for machine, level in itertools.product(MACHINES, LEVELS)]


class Failure(Exception):
    pass


def run(command, **options):
    """Runs a command; its output if it succeeds, a Failure that shows the command if not."""
    done = subprocess.run([str(word) for word in command], capture_output=True, timeout=600, check=False, **options)
    if done.returncode:
        text = (done.stdout + done.stderr).decode(errors="replace")[-1500:]
        raise Failure(f"exit status {done.returncode} from: {' '.join(map(str, command))}\n{text}")
    return done


def build(target, source, folder, programs):
    """Configures and builds in a folder of its own, which is kept: a second run builds only what changed."""
    machine = target.machine
    flags = "" if "clang" in machine.compiler else " -fcallgraph-info=su"  # for budgets.py, in the same folders
    if not shutil.which(machine.compiler):
        raise Failure(f"{machine.compiler} is missing")
    where = pathlib.Path(folder, target.name.replace(" ", ""))
    command = ["cmake", "-S", source, "-B", where, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
               f"-DCMAKE_C_FLAGS_RELEASE={target.level}{flags}", f"-DCMAKE_C_COMPILER={machine.compiler}"]
    if machine.toolchain:
        command.append(f"-DCMAKE_TOOLCHAIN_FILE={source}/cmake/{machine.toolchain}.cmake")
    run(command)
    run(["cmake", "--build", where, "-j", "1", "--target", *programs])
    return where


def command_line(target, where, program, arguments, counting=False):
    """The command that runs a program of a build folder with arguments."""
    machine = target.machine
    if not machine.semihosting:
        return [*machine.emulator, where / "port/firmware" / program, *arguments]
    words = ",".join(f"arg={word}" for word in [program, *arguments])
    return [*machine.emulator, *QEMU, *(COUNTING if counting else []),
            "-semihosting-config", f"enable=on,target=native,chardev=console,{words}",
            "-kernel", where / "port/firmware" / f"{program}.elf"]
