"""Where figures get their data, and how they are saved."""
import subprocess
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from recording import Recording

plt.rcParams.update({"font.size": 8, "axes.grid": False, "figure.dpi": 100, "savefig.dpi": 100, "lines.linewidth": 1.1})


class Studio:
    """programs: build folder of the C++ programs; work: folder for what is made on the way."""

    def __init__(self, programs, work, pictures):
        self.programs, self.work, self.pictures = Path(programs), Path(work), Path(pictures)
        for folder in (self.work / "left", self.work / "data", self.pictures):
            folder.mkdir(parents=True, exist_ok=True)

    def run(self, program, *arguments):
        subprocess.run([str(self.programs / program), *map(str, arguments)], check=True)

    def left(self, recording, frame):
        """Left image of a frame of the full fixture set, rendered again from its seeds."""
        path = self.work / "left" / f"{recording.name}-{frame}.png"
        if not path.exists():
            self.run("roadpose-figure-scenes", "left", path.parent, recording.name, frame)
        return np.asarray(Image.open(path))

    def rolls(self):
        """One and the same street under several rolls."""
        folder = self.work / "rolls"
        if not (folder / "left-4.png").exists():
            self.run("roadpose-figure-scenes", "rolls", folder)
        return Recording(folder)

    def data(self, recording, frame):
        stem = self.work / "data" / f"{recording.name}-{frame}-"
        wide = "-large" if recording.rig["width"] > 640 else ""
        if not Path(f"{stem}virtual.bin").exists():
            self.run(f"roadpose-figure-data{wide}", stem.parent, recording.folder, frame)
        return FrameData(recording, frame, str(stem))

    def save(self, figure, name):
        """PNG with a palette: a third of the size. Few colours are lines, few pixels each: all must get their share."""
        path = self.pictures / f"{name}.png"
        figure.savefig(path, bbox_inches="tight")
        plt.close(figure)
        Image.open(path).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE).save(path, optimize=True)
        return path


class FrameData:
    """What roadpose-figure-data wrote about one frame."""

    def __init__(self, recording, frame, stem):
        self.recording, self.frame = recording, frame
        self.v_free = np.loadtxt(stem + "v_free.txt")
        self.free = np.loadtxt(stem + "free.txt")
        self.cloud = np.loadtxt(stem + "cloud.txt", ndmin=2)  # slope, u, v, disparity
        self.planes = read_planes(stem + "pose.txt")
        size = int(recording.rig["height"]), int(recording.rig["width"])
        maps = np.fromfile(stem + "virtual.bin", dtype=np.float32).reshape(3, *size)
        self.free_map, self.free_turned, self.all_turned = maps

    def plane(self, candidate="roadpose"):
        return self.planes.get(candidate)


def read_planes(path):
    """Disparity plane of each candidate that has a pose."""
    planes = {}
    for line in Path(path).read_text().splitlines():
        name, status, _, *plane = line.split(";")
        if status == "ok":
            planes[name] = tuple(map(float, plane))
    return planes


def u_disparity(disparity, levels=128):
    histogram = np.zeros((levels, disparity.shape[1]))
    for column in range(disparity.shape[1]):
        valid = disparity[:, column]
        valid = valid[(valid > 0) & (valid < levels)]
        histogram[:, column] = np.bincount(valid.astype(int), minlength=levels)
    return histogram


def v_disparity(disparity, levels=128):
    return u_disparity(disparity.T, levels).T


def show_histogram(axes, histogram, extent=None):
    """Dark is many; the logarithm shows the thin far road too."""
    axes.imshow(np.log1p(histogram), cmap="gray_r", aspect="auto", extent=extent, interpolation="nearest")


def horizon_row(plane, rig, column):
    """Image row where the plane's disparity is 0."""
    return rig["cv_px"] - (plane[2] + plane[0] * (column - rig["cu_px"])) / plane[1]
