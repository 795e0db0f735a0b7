"""Reads recordings: rig.yml, 16-bit PGM disparities, truth.csv."""
import csv
from pathlib import Path

import numpy as np


class Recording:
    def __init__(self, folder):
        self.folder = Path(folder)
        self.name = self.folder.name
        self.rig = read_rig(self.folder / "rig.yml")
        self.files = sorted((self.folder / "disparity").glob("*.pgm"))
        self.truth = read_truth(self.folder / "truth.csv")

    def disparity(self, frame):
        """Pixels; 0 = no match."""
        samples = read_pgm(self.files[frame])
        disparity = samples / self.rig.get("disparity_scale", 256.0) + self.rig.get("disparity_offset_px", 0.0)
        return np.where(samples == self.rig.get("invalid", 0), 0.0, np.maximum(disparity, 0.0))

    def offsets(self):
        """Columns and rows counted from the principal point."""
        columns = np.arange(int(self.rig["width"])) - self.rig["cu_px"]
        rows = np.arange(int(self.rig["height"])) - self.rig["cv_px"]
        return np.meshgrid(columns, rows)


def read_rig(path):
    rig = {}
    for line in path.read_text().splitlines()[2:]:
        key, _, value = line.split("#")[0].partition(":")
        if value.strip():
            rig[key.strip()] = float(value)
    return rig


def read_truth(path):
    if not path.exists():
        return {}
    with path.open() as file:
        return {int(row["frame"]): row for row in csv.DictReader(file)}


def read_pgm(path):
    data = path.read_bytes()
    fields = data.split(maxsplit=4)[:4]
    width, height = int(fields[1]), int(fields[2])
    return np.frombuffer(data[-2 * width * height:], dtype=">u2").reshape(height, width).astype(np.float64)


def plane_of(pose, rig):
    """Disparity plane d = a x + b y + c of (pitch in degrees, roll in degrees, height in metres)."""
    pitch, roll = np.radians(pose[0]), np.radians(pose[1])
    normal = np.array([np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll), np.sin(pitch)])
    scale = rig["baseline_m"] / pose[2]
    return normal[0] * scale, normal[1] * scale, normal[2] * scale * rig["focal_px"]
