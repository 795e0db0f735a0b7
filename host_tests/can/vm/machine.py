"""A virtual machine that runs drive.sh: Debian's kernel, an initramfs of our own, QEMU without any help of the host."""
import io
import pathlib
import re
import shutil
import subprocess
import tarfile

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 240


def libraries(program):
    """Shared libraries of a program, the loader included."""
    listing = subprocess.run(["ldd", program], capture_output=True, text=True, check=False).stdout
    return sorted(set(re.findall(r"(/\S+)", listing)))


def make_root(parts, replay, line, recording, root):
    """Lays out the initramfs in the folder root."""
    (root / "modules").mkdir(parents=True)
    for module in sorted((parts / "modules").iterdir()):
        shutil.copy(module, root / "modules")
    for program in (parts / "busybox", parts / "candump", replay, line):
        shutil.copy(program, root)
        for library in libraries(program):
            target = root / library.lstrip("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(library, target)
    shutil.copy(HERE / "init.sh", root / "init")
    shutil.copy(HERE / "drive.sh", root)
    (root / "init").chmod(0o755)
    copy_recording(recording, root / "drive")


def copy_recording(recording, target):
    """Copies each file once; frames that repeat become links, which a ramdisk has for nothing."""
    (target / "disparity").mkdir(parents=True)
    shutil.copy(recording / "rig.yml", target)
    first = {}
    for frame in sorted((recording / "disparity").iterdir()):
        source = frame.resolve()
        place = target / "disparity" / frame.name
        if source in first:
            place.symlink_to(first[source])
        else:
            shutil.copy(source, place)
            first[source] = frame.name


def pack(root, image):
    names = "\n".join(str(path.relative_to(root)) for path in sorted(root.rglob("*")))
    with open(image, "wb") as file:
        subprocess.run(["cpio", "--quiet", "-o", "-H", "newc"], input=names.encode(), stdout=file, cwd=root, check=True)


def boot(parts, image, console, results):
    """Runs the machine until it powers off; returns what it wrote on its second serial port."""
    command = ["qemu-system-x86_64", "-M", "pc,accel=tcg", "-m", "512", "-nodefaults", "-display", "none", "-no-reboot",
               "-kernel", parts / "vmlinuz", "-initrd", image,
               "-append", "console=ttyS0 quiet panic=-1", "-serial", f"file:{console}", "-serial", f"file:{results}"]
    subprocess.run(list(map(str, command)), timeout=SECONDS, check=True, stdin=subprocess.DEVNULL)
    return pathlib.Path(results).read_bytes()


def drive(parts, replay, line, recording, work, output):
    """Everything: the files that drive.sh wrote are in output afterwards. Raises with the console when there are none."""
    parts, work = pathlib.Path(parts), pathlib.Path(work)
    make_root(parts, pathlib.Path(replay), pathlib.Path(line), pathlib.Path(recording), work / "root")
    pack(work / "root", work / "image")
    archive = boot(parts, work / "image", work / "console.txt", work / "results.tar")
    try:
        with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
            tar.extractall(output)
    except tarfile.TarError as error:
        raise RuntimeError(f"{error}\n{(work / 'console.txt').read_text(errors='replace')}") from error
