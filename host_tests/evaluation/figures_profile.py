"""Figures 2 to 6: tracks, histograms and road profile, the drives, what roll does."""
import matplotlib.pyplot as plt
import numpy as np

from studio import show_histogram, u_disparity, v_disparity

NO_CORRIDOR = "Method 1 alone, v-disparity, no corridor"
FREE = "Method 1 alone, v-disparity-free, no corridor"
SHOWN_PX = 70  # of disparity; there is nothing beyond


def focus_of_expansion(truth, rig):
    """Image of the direction of travel: X of the vehicle in camera axes."""
    yaw, pitch, roll = (np.radians(float(truth[key])) for key in ("yaw_deg", "pitch_deg", "roll_deg"))
    turn_yaw = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    turn_pitch = np.array([[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]])
    turn_roll = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    camera_in_vehicle = np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    travel = (turn_yaw @ turn_pitch @ turn_roll @ camera_in_vehicle).T @ np.array([1, 0, 0])
    return rig["cu_px"] + rig["focal_px"] * travel[0] / travel[2], rig["cv_px"] + rig["focal_px"] * travel[1] / travel[2]


def intersections(tracks, count):
    """Of the lines of random pairs of tracks."""
    random = np.random.default_rng(1)
    points = []
    lines = np.cross(np.column_stack([tracks[:, :2], np.ones(len(tracks))]),
                     np.column_stack([tracks[:, 2:], np.ones(len(tracks))]))
    for _ in range(count):
        one, other = lines[random.integers(len(lines), size=2)]
        point = np.cross(one, other)
        if abs(point[2]) > 1e-9:
            points.append(point[:2] / point[2])
    return np.array(points)


def tracks_and_intersections(studio, recording, frame):
    tracks = np.loadtxt(recording.folder / "tracks" / f"{frame:06d}.csv", delimiter=",", skiprows=1)
    crossings, focus = intersections(tracks, 3000), focus_of_expansion(recording.truth[frame], recording.rig)
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.5))
    for u0, v0, u1, v1 in tracks:
        left.plot([u0, u1], [v0, v1], color="tab:blue", linewidth=0.8)
    left.plot(tracks[:, 2], tracks[:, 3], ".", color="tab:blue", markersize=2)
    right.plot(crossings[:, 0], crossings[:, 1], ".", color="tab:gray", markersize=1.5)
    for axes in (left, right):
        axes.plot(*focus, "+", color="red", markersize=14, markeredgewidth=2)
        axes.set(xlim=(0, recording.rig["width"]), ylim=(recording.rig["height"], 0), aspect="equal", xlabel="u, px",
                 ylabel="v, px")
    return studio.save(figure, "figure-02")


def profile_row(axes, studio, recording, frame):
    data, disparity = studio.data(recording, frame), recording.disparity(frame)
    plane, rig = data.plane("Method 1 alone") or data.plane(), recording.rig
    axes[0].imshow(studio.left(recording, frame), cmap="gray", vmin=0, vmax=255)
    show_histogram(axes[1], u_disparity(disparity))
    show_histogram(axes[2], v_disparity(disparity))
    show_histogram(axes[3], data.v_free, extent=(0, 128, rig["height"], 0))
    rows = np.arange(rig["height"])
    profile = plane[1] * (rows - rig["cv_px"]) + plane[2]
    shown = (profile > 0) & (profile < 128)
    axes[3].plot(profile[shown], rows[shown], "--", color="red", linewidth=2)
    axes[1].set_ylim(SHOWN_PX, 0)
    axes[0].set(xticks=[], yticks=[], ylabel=f"{recording.name}, frame {frame}")
    axes[1].set(ylabel="disparity, px", xlabel="u, px")
    for place in (2, 3):
        axes[place].set(xlim=(0, SHOWN_PX), xlabel="disparity, px", ylabel="v, px")


def road_profiles(studio, scenes):
    figure, rows = plt.subplots(len(scenes), 4, figsize=(11, 2.4 * len(scenes)), layout="constrained")
    for axes, (recording, frame) in zip(rows, scenes):
        profile_row(axes, studio, recording, frame)
    for axes, title in zip(rows[0], ("left image", "u-disparity", "v-disparity", "v-disparity-free, profile")):
        axes.set_title(title)
    return studio.save(figure, "figure-03")


def line_of(rows, axis):
    return [row.frame for row in rows], [np.nan if row.pose[axis] is None else row.pose[axis] for row in rows]


def along_a_drive(studio, results, recording, name, more=()):
    """Pitch and height over the frames of a drive, against the truth."""
    curves = [(NO_CORRIDOR, "v-disparity", "tab:orange"), (FREE, "v-disparity-free", "tab:blue"), *more]
    figure, panels = plt.subplots(1, 2, figsize=(10, 3.2), layout="constrained")
    for axes, axis, label in zip(panels, (0, 2), ("pitch, degrees", "height, m")):
        truth = [row.truth[axis] for row in results.of(recording, "roadpose")]
        axes.plot(truth, color="black", linewidth=2.5, alpha=0.35, label="truth")
        for candidate, title, colour in curves:
            axes.plot(*line_of(results.of(recording, candidate), axis), ".-", color=colour, label=title)
        axes.set(xlabel="frame", ylabel=label)
        axes.xaxis.get_major_locator().set_params(integer=True)
    panels[0].legend(frameon=False)
    return studio.save(figure, name)


def what_roll_does(studio, frames=(0, 2, 4)):
    recording = studio.rolls()
    figure, rows = plt.subplots(2, len(frames), figsize=(9, 5), layout="constrained")
    for column, frame in enumerate(frames):
        rows[0][column].imshow(plt.imread(recording.folder / f"left-{frame}.png"), cmap="gray", vmin=0, vmax=1)
        rows[0][column].set_title(f"roll {float(recording.truth[frame]['roll_deg']):.0f}°")
        rows[0][column].set_axis_off()
        show_histogram(rows[1][column], v_disparity(recording.disparity(frame)))
        rows[1][column].set(xlabel="disparity, px", ylabel="v, px")
    return studio.save(figure, "figure-06")
