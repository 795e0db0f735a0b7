"""Figures 7 to 12: Method 2's two stages and clouds, the roll sweep, the virtual maps."""
import matplotlib.pyplot as plt
import numpy as np

from results import OURS
from studio import show_histogram, v_disparity

ROLLS = (1, 4)  # frames of the recording of one street under several rolls: 5 and 20 degrees
SWEEP = "roll-sweep"


def stages_of(data):
    """The pairs, the common slope of Method 2's result, and each pair's intercept with it."""
    a, b, c = data.plane("Method 2 alone")
    slope = -a / b
    own, u, v, disparity = data.cloud.T
    return own, v - slope * u, disparity, slope, (b, c)


def two_stages(studio):
    recording = studio.rolls()
    figure, rows = plt.subplots(len(ROLLS), 2, figsize=(9, 5.6), layout="constrained")
    for axes, frame in zip(rows, ROLLS):
        own, intercepts, disparity, slope, (b, c) = stages_of(studio.data(recording, frame))
        axes[0].plot(disparity, own, ".", markersize=3)
        axes[0].axhline(slope, linestyle="--", color="red")
        axes[0].set(ylim=(-1, 1), xlabel="disparity of the pair, px", ylabel="slope of the pair")
        axes[1].plot(disparity, intercepts, ".", markersize=3)
        levels = np.array([1, 90])
        axes[1].plot(levels, (levels - c) / b, "--", color="red")
        axes[1].set(xlim=(0, 90), ylim=(-80, 420), xlabel="disparity of the pair, px",
                    ylabel="intercept from the principal point, px")
        axes[0].set_title(f"roll {float(recording.truth[frame]['roll_deg']):.0f}°: stage 1, slope")
        axes[1].set_title("stage 2, intercept with the common slope")
    return studio.save(figure, "figure-07")


def clouds(studio):
    recording = studio.rolls()
    figure, panels = plt.subplots(1, len(ROLLS), figsize=(9, 3.4), layout="constrained")
    for axes, frame in zip(panels, ROLLS):
        own, intercepts, disparity, slope, _ = stages_of(studio.data(recording, frame))
        _, u, v, _ = studio.data(recording, frame).cloud.T
        points = axes.scatter(own, v - own * u, c=disparity, s=5, cmap="viridis", vmin=0, vmax=80)
        axes.axvline(slope, linestyle="--", color="red")
        axes.set(xlim=(-1, 1), ylim=(-150, 450), xlabel="slope", ylabel="intercept, px",
                 title=f"roll {float(recording.truth[frame]['roll_deg']):.0f}°")
    figure.colorbar(points, ax=panels, label="disparity, px")
    return studio.save(figure, "figure-08")


def values(rows, axis):
    return np.array([np.nan if row.pose[axis] is None else row.pose[axis] for row in rows])


def truths(rows, axis):
    return np.array([row.truth[axis] for row in rows])


def sweep_panels(results, curves, axes_shown):
    """Upper row: estimate and truth; lower row: the error; over the true roll."""
    labels = {1: ("roll, degrees", 1), 0: ("pitch, degrees", 1), 2: ("height, m", 1000)}
    figure, rows = plt.subplots(2, len(axes_shown), figsize=(3.6 * len(axes_shown), 4.6), layout="constrained")
    for column, axis in enumerate(axes_shown):
        label, scale = labels[axis]
        reference = results.of(SWEEP, OURS)
        rolls = truths(reference, 1)
        rows[0][column].plot(rolls, truths(reference, axis), color="black", linewidth=2.5, alpha=0.3, label="truth")
        for candidate, title, colour in curves:
            found = results.of(SWEEP, candidate)
            rows[0][column].plot(rolls, values(found, axis), ".", color=colour, markersize=4, label=title)
            rows[1][column].plot(rolls, scale * (values(found, axis) - truths(found, axis)), ".-", color=colour, linewidth=0.7)
        rows[0][column].set(ylabel=label)
        rows[1][column].axhline(0, color="black", linewidth=0.5)
        rows[0][column].set(xlim=(-21, 21))
        rows[1][column].set(xlim=(-21, 21), xlabel="true roll, degrees", ylabel="error, " + ("mm" if axis == 2 else "degrees"))
    handles, titles = rows[0][0].get_legend_handles_labels()
    figure.legend(handles, titles, frameon=False, loc="outside upper center", ncols=len(titles))
    return figure


def sweep_of_method_1(studio, results):
    curves = [("Method 1 alone, v-disparity, no corridor", "v-disparity", "tab:orange"),
              ("Method 1 alone, nothing refused", "v-disparity-free, nothing refused", "tab:gray"),
              ("Method 1 alone", "v-disparity-free, default", "tab:blue"),
              ("Method 1 + refinement", "then refined", "tab:green")]
    figure = sweep_panels(results, curves, (0, 2))
    for axes, linear, ticks in zip(figure.axes[2:], (0.05, 5), ((0.1, 1, 10), (10, 100, 1000))):
        axes.set_yscale("symlog", linthresh=linear)  # some errors are a hundred times others
        axes.set_yticks([*(-tick for tick in ticks), 0, *ticks], [*(f"−{tick}" for tick in ticks), "0", *map(str, ticks)])
    return studio.save(figure, "figure-09")


def sweep_of_method_2(studio, results):
    curves = [("Method 2 alone", "Method 2 alone", "tab:blue"), (OURS, "with refinement", "tab:green")]
    return studio.save(sweep_panels(results, curves, (1, 0, 2)), "figure-10")


def show_disparity(axes, disparity, title):
    axes.imshow(np.ma.masked_equal(disparity, 0), cmap="viridis", vmin=0, vmax=80)
    axes.set_title(title)
    axes.set_axis_off()


def virtual_map(studio):
    recording = studio.rolls()
    frame = ROLLS[-1]
    data, disparity = studio.data(recording, frame), recording.disparity(frame)
    maps = [(disparity, "disparity map, roll 20°"), (data.all_turned, "virtual disparity map"),
            (data.free_map, "free map, roll 20°"), (data.free_turned, "virtual free map")]
    figure, rows = plt.subplots(2, 4, figsize=(11, 4.4), layout="constrained")
    for column, (seen, title) in enumerate(maps):
        show_disparity(rows[0][column], seen, title)
        show_histogram(rows[1][column], v_disparity(seen))
        rows[1][column].set(xlabel="disparity, px", ylabel="v, px")
    return studio.save(figure, "figure-11")


def virtual_maps_compared(studio, results):
    curves = [("virtual disparity map", "virtual disparity map", "tab:orange"),
              ("virtual free map", "virtual free map", "tab:blue"), ("Method 2 alone", "Method 2 alone", "tab:red"),
              (OURS, "with refinement", "tab:green")]
    return studio.save(sweep_panels(results, curves, (1, 0, 2)), "figure-12")
