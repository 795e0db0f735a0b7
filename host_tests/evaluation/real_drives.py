"""Figures 13 and 14: two real drives. They are not ours to pass on, so their pictures go into the build folder only; the
error figures go into docs/evaluation/real-drives.csv and are kept where the drives are not at hand."""
import csv

import matplotlib.pyplot as plt
import numpy as np

from results import OURS, errors

DRIVES = {"street-lidar": "figure-13", "straight-motion": "figure-14"}
SHOWN = (OURS, "Method 2 alone", "virtual free map", "RANSAC plane: every pixel, whole map",
         "RANSAC plane: every pixel, cropped", "RANSAC plane: 2 x 4 grid, cropped",
         "Hough: 1 px, 1 degree, then least squares, cropped", "Open3D: every pixel, cropped")


def mean_and_deviation(found, digits):
    if not len(found):
        return ["–", "–"]
    return [f"{np.mean(found):+.{digits}f}", f"{np.std(found):.{digits}f}"]


def deviation_only(rows, axis, digits):
    """Where no truth is known: how steady it is."""
    scale = 1000 if axis == 2 else 1
    found = [scale * row.pose[axis] for row in rows if row.pose[axis] is not None]
    return ["–", f"{np.std(found):.{digits}f}" if found else "–"]


def summary_row(results, drive, candidate):
    rows = results.of(drive, candidate)
    accepted = sum(row.status == "ok" for row in rows)
    line = [drive, candidate, len(rows), accepted]
    for axis, digits in ((0, 3), (1, 3), (2, 1)):
        known = errors(rows, axis)
        has_truth = any(row.truth[axis] is not None for row in rows)
        line += mean_and_deviation(known, digits) if has_truth else deviation_only(rows, axis, digits)
    return line


def summary(results):
    return [summary_row(results, drive, candidate) for drive in DRIVES for candidate in SHOWN
            if results.of(drive, candidate)]


def draw(results, drive, path):
    figure, panels = plt.subplots(1, 3, figsize=(12, 3), layout="constrained")
    for axes, axis, label in zip(panels, (0, 1, 2), ("pitch, degrees", "roll, degrees", "height, m")):
        rows = results.of(drive, OURS)
        if rows[0].truth[axis] is not None:
            axes.plot([row.truth[axis] for row in rows], color="black", linewidth=2.5, alpha=0.35, label="lidar")
        for candidate in SHOWN[:3]:
            found = [np.nan if row.pose[axis] is None else row.pose[axis] for row in results.of(drive, candidate)]
            axes.plot(found, ".-", label=candidate)
        axes.set(xlabel="frame", ylabel=label)
    panels[0].legend(frameon=False)
    figure.savefig(path)
    plt.close(figure)


def update(results, table, folder):
    """Writes table and figures where the drives were evaluated; returns the table's lines in any case."""
    rows = summary(results)
    if rows:
        folder.mkdir(parents=True, exist_ok=True)
        for drive, name in DRIVES.items():
            if results.of(drive, OURS):
                draw(results, drive, folder / f"{name}.png")
        with table.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    if not table.exists():
        return []
    with table.open() as file:
        return list(csv.reader(file))
