"""A drive for the bus: frames of all committed fixtures in a row, which share one rig, as one recording."""
import pathlib
import shutil

FRAMES = 60


def make(fixtures, folder, count=FRAMES, rate_hz="10.0"):
    """Writes the recording; frames are links to those of the fixtures. Repeats them until there are enough."""
    rigs = sorted(pathlib.Path(fixtures).glob("*/rig.yml"))
    rig = rigs[0].read_text(encoding="ascii")
    sources = [frame for path in rigs if path.read_text(encoding="ascii") == rig
               for frame in sorted(path.parent.glob("disparity/*.pgm"))]
    target = pathlib.Path(folder)
    shutil.rmtree(target, ignore_errors=True)
    (target / "disparity").mkdir(parents=True)
    (target / "rig.yml").write_text(rig.replace("rate_hz: 10.0", f"rate_hz: {rate_hz}"), encoding="ascii")
    for number in range(count):
        (target / "disparity" / f"{number:06}.pgm").symlink_to(sources[number % len(sources)].resolve())
    return target
