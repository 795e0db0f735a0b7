"""Our own figures: error histograms, worst frames, sensitivity, peers."""
import csv

import matplotlib.pyplot as plt
import numpy as np

from results import GROUPS, OURS, errors, group_of, mean_absolute, time_ratio, worst
from studio import horizon_row
from tables import SWEEP, cell, peers_of

AXES = (("pitch error, degrees", 0, 0.15), ("roll error, degrees", 1, 0.1), ("height error, mm", 2, 8))


def error_histograms(studio, results):
    rows = [row for recording in results.recordings() for row in results.of(recording, OURS)]
    figure, panels = plt.subplots(1, 3, figsize=(10, 2.8), layout="constrained")
    for axes, (label, axis, limit) in zip(panels, AXES):
        found = errors(rows, axis)
        axes.hist(np.clip(found, -limit, limit), bins=np.linspace(-limit, limit, 61), color="tab:blue")
        axes.axvline(0, color="black", linewidth=0.7)
        axes.set(xlabel=label, ylabel="frames", title=f"{len(found)} frames, largest {np.abs(found).max():.3g}")
    return studio.save(figure, "own-histograms")


def paint_road(image, recording, frame, plane):
    """Green: disparity on the plane; red: nearer than the plane; blue: farther."""
    disparity, (x, y) = recording.disparity(frame), recording.offsets()
    expected = plane[0] * x + plane[1] * y + plane[2]
    painted = np.repeat(image[:, :, None].astype(float), 3, axis=2)
    seen = (disparity > 0) & (expected > 0)
    residual = disparity - expected
    for mask, channel in ((np.abs(residual) <= 0.6, 1), (residual > 0.6, 0), (residual < -0.6, 2)):
        chosen = seen & mask & (np.abs(residual) < 2.5)
        painted[chosen] *= 0.55
        painted[chosen, channel] += 90
    return painted.clip(0, 255).astype(np.uint8)


def worst_panel(axes, studio, recordings, row):
    recording = recordings[row.recording]
    plane, rig = studio.data(recording, row.frame).plane(), recording.rig
    axes.imshow(paint_road(studio.left(recording, row.frame), recording, row.frame, plane))
    columns = np.array([0, rig["width"] - 1])
    axes.plot(columns, [horizon_row(plane, rig, column) for column in columns], "--", color="yellow")
    axes.set(xlim=(0, rig["width"]), ylim=(rig["height"], 0))
    axes.set_axis_off()
    off = [found - true for found, true in zip(row.pose, row.truth)]
    axes.set_title(f"{row.recording} {row.frame}: pitch {off[0]:+.3f}°, roll {off[1]:+.3f}°, {1000 * off[2]:+.1f} mm",
                   fontsize=7.5)


def worst_frames(studio, results, recordings):
    rows = [worst(results.of(recording, OURS)) for recording in results.recordings()]
    rows = [row for row in rows if row is not None]
    figure, panels = plt.subplots(-(-len(rows) // 3), 3, figsize=(11, 2.9 * -(-len(rows) // 3)), layout="constrained")
    for axes in panels.flat:
        axes.set_axis_off()
    for axes, row in zip(panels.flat, rows):
        worst_panel(axes, studio, recordings, row)
    return studio.save(figure, "own-worst")


def read_sensitivity(path):
    curves = {}
    with open(path) as file:
        for line in csv.DictReader(file):
            curves.setdefault(line["kind"], {}).setdefault(float(line["amount"]), []).append(line)
    return curves


def sensitivity_of(lines, key, scale):
    found = [abs(float(line[key])) * scale for line in lines if line["status"] == "ok"]
    return np.mean(found) if found else np.nan


KINDS = (("bias", "matcher bias, px"), ("noise", "added noise (1 sigma), px"), ("focal", "focal length told, % off"),
         ("baseline", "baseline told, % off"))


def sensitivity(studio, path):
    curves = read_sensitivity(path)
    figure, panels = plt.subplots(1, 4, figsize=(12, 2.9), layout="constrained")
    for axes, (kind, label) in zip(panels, KINDS):
        amounts = sorted(curves[kind])
        for key, title, scale, colour in (("pitch", "pitch, °", 1, "tab:blue"), ("roll", "roll, °", 1, "tab:orange"),
                                          ("height", "height, dm", 10, "tab:green")):
            found = [sensitivity_of(curves[kind][amount], key, scale) for amount in amounts]
            axes.plot(amounts, found, ".-", color=colour, label=title)
        axes.set(xlabel=label, yscale="log", ylim=(1e-3, 1))
    panels[0].set_ylabel("mean absolute error")
    panels[0].legend(frameon=False)
    return studio.save(figure, "own-sensitivity")


def sensitivity_rows(path):
    """One line for each kind and amount: accepted, and the mean absolute errors."""
    rows = []
    for kind, label in KINDS:
        for amount, lines in sorted(read_sensitivity(path)[kind].items()):
            accepted = sum(line["status"] == "ok" for line in lines)
            numbers = [cell(sensitivity_of(lines, *axis) if accepted else None, digits)
                       for axis, digits in ((("pitch", 1), 4), (("roll", 1), 4), (("height", 1000), 2))]
            rows.append([label, f"{amount:+g}", f"{accepted} of {len(lines)}", *numbers])
    return rows


def peers(studio, results):
    figure, panels = plt.subplots(1, 2, figsize=(10.5, 4), layout="constrained", sharey=True)
    shown = [OURS] + [name for group in GROUPS for name in peers_of(results, SWEEP, group)]
    for axes, (axis, label) in zip(panels, ((0, "pitch, degrees"), (1, "roll, degrees"))):
        for place, name in enumerate(shown):
            error, ratio = mean_absolute(results.of(SWEEP, name), axis), time_ratio(results, SWEEP, name)
            if error is None:
                continue
            colour = "tab:green" if name == OURS else {"H": "tab:orange", "R": "tab:blue", "O": "tab:red"}[name[0]]
            filled = name == OURS or group_of(name) == GROUPS[0]
            axes.loglog(error, ratio, "o", color=colour, markerfacecolor=colour if filled else "white",
                        label=f"{place}  {name}" if axis == 0 else None)
            beside = (5, 3) if place % 2 else (5, -9) if place else (-9, 3)  # neighbours in the list may lie on each other
            axes.annotate(str(place), (error, ratio), xytext=beside, textcoords="offset points")
        axes.set(xlabel="mean absolute error, " + label)
        axes.margins(0.15)
    panels[0].set_ylabel("time / ours")
    figure.legend(frameon=False, loc="outside right center", handlelength=1)
    return studio.save(figure, "own-peers")
