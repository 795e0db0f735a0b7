"""Results of roadpose-evaluate and its Open3D companion, and sums over them."""
import csv
from collections import namedtuple
from pathlib import Path

import numpy as np

Row = namedtuple("Row", "recording frame scene road truth candidate status pose time_us")
Score = namedtuple("Score", "frames accepted pitch roll height")  # mean absolute: degrees, degrees, millimetres

OURS = "roadpose"
PAPER_TABLE_1 = {50: (0.186, 0.336, 58), 25: (0.175, 0.360, 73), 10: (0.199, 0.379, 78), 5: (0.217, 0.377, 80),
                 1: (0.294, 0.389, 80)}
PAPER_TABLE_2 = {"Method 2": (0.38, 0.20, 12), "virtual disparity map": (0.36, 0.27, 18),
                 "virtual free map": (0.33, 0.28, 17)}  # roll, pitch, height


GROUPS = ("as one would use them", "helped by us")


def is_peer(candidate):
    return candidate.startswith(("Hough", "RANSAC plane", "Open3D"))


def group_of(peer):
    """Helped is who gets our crop or our sampling grid."""
    return GROUPS["cropped" in peer or "2 x 4 grid" in peer]


def number(text):
    return float(text) if text else None


def row_of(line):
    truth = tuple(number(line[key]) for key in ("true_pitch", "true_roll", "true_height"))
    pose = tuple(number(line[key]) for key in ("pitch", "roll", "height"))
    return Row(line["recording"], int(line["frame"]), line["scene"], int(line["road"]), truth, line["candidate"],
               line["status"], pose, float(line["time_us"]))


def read(paths):
    rows = []
    for path in paths:
        if Path(path).exists():
            with open(path) as file:
                rows += [row_of(line) for line in csv.DictReader(file)]
    return rows


def read_counts(path):
    """Instructions of one frame: {(recording, candidate): {frame: count}}."""
    counts = {}
    with open(path) as file:
        for line in csv.DictReader(file):
            of_frames = counts.setdefault((line["recording"], line["candidate"]), {})
            of_frames[int(line["frame"])] = int(line["instructions"])
    return counts


class Results:
    def __init__(self, rows, counts=None):
        self.rows = rows
        self.counts = counts or {}
        self.by_key = {}
        for row in rows:
            self.by_key.setdefault((row.recording, row.candidate), []).append(row)

    def of(self, recording, candidate):
        return self.by_key.get((recording, candidate), [])

    def recordings(self):
        return list(dict.fromkeys(row.recording for row in self.rows))

    def candidates(self):
        return list(dict.fromkeys(row.candidate for row in self.rows))


def errors(rows, axis):
    """Estimate minus truth of the frames that have both; axis 0 pitch, 1 roll, 2 height (millimetres)."""
    scale = 1000 if axis == 2 else 1
    return np.array([scale * (row.pose[axis] - row.truth[axis]) for row in rows
                     if row.pose[axis] is not None and row.truth[axis] is not None])


def mean_absolute(rows, axis):
    values = errors(rows, axis)
    return float(np.mean(np.abs(values))) if len(values) else None


def absolute_by_frame(rows, axis):
    """{frame: mean absolute error}: some candidates are tried several times a frame."""
    found = {}
    for row in rows:
        found.setdefault(row.frame, []).append(row)
    return {frame: mean_absolute(same, axis) for frame, same in found.items() if len(errors(same, axis))}


def lead(results, recording, peer, axis):
    """How much further off the peer is than ours, mean over the frames that both have, and the standard error of that mean."""
    ours, theirs = (absolute_by_frame(results.of(recording, name), axis) for name in (OURS, peer))
    found = np.array([theirs[frame] - ours[frame] for frame in ours if frame in theirs])
    return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(len(found)))


def score(rows):
    accepted = sum(row.status == "ok" for row in rows)
    return Score(len(rows), accepted, *(mean_absolute(rows, axis) for axis in range(3)))


def worst(rows):
    """The accepted frame that is furthest off: errors in units of 0.05 degrees, 0.05 degrees, 5 mm."""
    def badness(row):
        return max(abs(row.pose[0] - row.truth[0]) / 0.05, abs(row.pose[1] - row.truth[1]) / 0.05,
                   abs(row.pose[2] - row.truth[2]) / 0.005)
    judged = [row for row in rows if row.status == "ok" and None not in row.pose + row.truth]
    return max(judged, key=badness) if judged else None


def time_ratio(results, recording, candidate):
    """Median over the frames of the candidate's time divided by ours on the same frame."""
    ours = {row.frame: row.time_us for row in results.of(recording, OURS)}
    ratios = [row.time_us / ours[row.frame] for row in results.of(recording, candidate) if row.frame in ours]
    return float(np.median(ratios)) if ratios else None


def instructions(results, recording, candidate):
    """Mean over the frames that were counted; None where none were."""
    found = results.counts.get((recording, candidate))
    return float(np.mean(list(found.values()))) if found else None


def instruction_ratio(results, recording, candidate):
    """As time_ratio(), of instructions: whoever else uses the machine does not change it."""
    ours, found = (results.counts.get((recording, name)) for name in (OURS, candidate))
    return float(np.median([count / ours[frame] for frame, count in found.items()])) if found else None
