#!/usr/bin/env python3
"""drive_odometry.py DRIVE [OTHER]: yaw of a real drive by several ways, in double precision, and why they differ.

Not a test: it makes the table of docs/heading.md, section "Real drives". DRIVE needs left/ (every fifth image will do),
disparity/ and tracks/. Two sets of points: the tracks of the recording, one frame (about 1.2 m) apart, and SIFT points
matched here between the images of left/, five frames apart. Two ways to the direction of travel: the focus of expansion,
which uses the direction of the flow alone, and stereo odometry, which needs the disparities as well. Then an error of the
disparities that depends on the place in the image (six terms) is estimated from the SIFT points of DRIVE and of OTHER, with
all motions free, and odometry is repeated with it. Needs numpy and OpenCV.

Yaw is counted about the camera's own vertical; the road's pitch and roll of about one degree change it by under 0.005.
"""
import pathlib
import sys

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "evaluation"))
from recording import Recording  # noqa: E402

PIXEL_NOISE, DISPARITY_NOISE = 0.25, 0.2
TUKEY = 4.685
STEPS = 25


class Points:
    """Matches of one pair of frames: pin-hole coordinates before and after, disparity before."""

    def __init__(self, before, after, disparity, metres):
        self.before, self.after, self.disparity, self.metres = before, after, disparity, metres

    def part(self, keep):
        return Points(self.before[keep], self.after[keep], self.disparity[keep], self.metres)

    def with_depth(self, rig):
        """Those with a disparity, and not so near that the car passes them."""
        scale = rig["focal_px"] * rig["baseline_m"]
        return self.part(self.disparity * 1.3 * self.metres < scale)

    def corrected(self, field):
        return Points(self.before, self.after, self.disparity + terms(self.before) @ field, self.metres)


def terms(x):
    """Disparity error in pixels at x = (u - u0) / f, y = (v - v0) / f."""
    return np.c_[np.ones(len(x)), x, x[:, :1] ** 2, x[:, :1] * x[:, 1:], x[:, 1:] ** 2]


def disparity_at(image, pixels):
    """Between four valid samples that agree within 1 px; else not a number."""
    corner = np.clip(np.floor(pixels).astype(int), 0, np.array(image.shape[::-1]) - 2)
    u, v = corner.T
    p, q = (pixels - corner).T
    four = np.stack([image[v, u], image[v, u + 1], image[v + 1, u], image[v + 1, u + 1]])
    found = (np.stack([(1 - p) * (1 - q), p * (1 - q), (1 - p) * q, p * q]) * four).sum(0)
    return np.where((four > 0.5).all(0) & (np.ptp(four, axis=0) < 1), found, np.nan)


def points_of(drive, first, matches, metres):
    rig = drive.rig
    inside = ((matches >= 0) & (matches < [rig["width"] - 1, rig["height"] - 1] * 2)).all(1)
    moved = np.hypot(*(matches[:, 2:] - matches[:, :2]).T)
    matches = matches[inside & (moved > 2) & (moved < rig["focal_px"] / 2)]
    centre = np.array([rig["cu_px"], rig["cv_px"]])
    before, after = ((matches[:, k:k + 2] - centre) / rig["focal_px"] for k in (0, 2))
    return Points(before, after, disparity_at(drive.disparity(first), matches[:, :2]), metres)


def metres_of(drive, first, last):
    """Only a first guess of the fits."""
    speed = np.genfromtxt(drive.folder / "vehicle.csv", delimiter=",", names=True)["speed_m_s"]
    return speed[first:last].sum() / drive.rig.get("rate_hz", 10.0)


def given_tracks(drive):
    files = sorted((drive.folder / "tracks").glob("*.csv"))
    frames = [int(file.stem) for file in files]
    return [points_of(drive, frame - 1, np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2), metres_of(drive, frame - 1, frame))
            for frame, file in zip(frames, files)]


def sift_matches(before, after, camera):
    """Mutual nearest neighbours by the root of SIFT, cleared by RANSAC on the essential matrix."""
    matcher = cv2.BFMatcher()
    back = {m.queryIdx: m.trainIdx for m in matcher.match(after[1], before[1])}
    good = [m for m, second in matcher.knnMatch(before[1], after[1], 2)
            if m.distance < 0.85 * second.distance and back[m.trainIdx] == m.queryIdx]
    found = np.array([before[0][m.queryIdx].pt + after[0][m.trainIdx].pt for m in good])
    found = found[np.hypot(*(found[:, 2:] - found[:, :2]).T) > 2]
    _, agree = cv2.findEssentialMat(found[:, :2], found[:, 2:], camera, cv2.RANSAC, 0.9999, 1.0)
    return found[agree.ravel() > 0]


def sift_points(drive):
    rig, features = drive.rig, {}
    camera = np.array([[rig["focal_px"], 0, rig["cu_px"]], [0, rig["focal_px"], rig["cv_px"]], [0, 0, 1]])
    finder = cv2.SIFT_create(4000, contrastThreshold=0.02)
    for file in sorted((drive.folder / "left").glob("*.p[gn][gm]")):
        if int(file.stem) % 5 == 0:
            keys, described = finder.detectAndCompute(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE), None)
            features[int(file.stem)] = keys, np.sqrt(described / described.sum(1, keepdims=True))
    frames = sorted(features)
    return [points_of(drive, a, sift_matches(features[a], features[b], camera), metres_of(drive, a, b))
            for a, b in zip(frames, frames[1:])]


def rotation(vector):
    return cv2.Rodrigues(np.asarray(vector, float))[0]


def spread(values):
    return 1.4826 * np.median(np.abs(values))


def biweight(ratio):
    return np.where(np.abs(ratio) < 1, (1 - ratio ** 2) ** 2, 0.0)


def derivative(function, at, step=1e-6):
    here = function(at)
    return here, np.stack([(function(at + step * unit) - here) / step for unit in np.eye(len(at))], -1)


def turned(points, turn):
    return np.c_[points.before, np.ones(len(points.before))] @ rotation(turn).T


def across_flow(points, unknown, focal):
    """Pixels by which each flow misses the focus; unknown = focus, rotation."""
    rays = turned(points, unknown[2:])
    start = rays[:, :2] / rays[:, 2:]
    flow, arm = points.after - start, (points.after + start) / 2 - unknown[:2]
    return focal * (arm[:, 0] * flow[:, 1] - arm[:, 1] * flow[:, 0]) / np.maximum(np.hypot(*arm.T), 1e-6)


def focus_of(points, rig):
    """Yaw and rotation, degrees; the disparities are not used."""
    at = np.zeros(5)
    for step in range(STEPS):
        error, slope = derivative(lambda x: across_flow(points, x, rig["focal_px"]), at)
        weight = biweight(error / (TUKEY * max(spread(error), 1 / (step + 1) if step < 5 else 0.05)))
        at = at - np.linalg.solve(slope.T @ (weight[:, None] * slope), slope.T @ (weight * error))
    return halfway(np.r_[at[:2], 1], at[2:])


def halfway(travel, turn):
    """Direction of travel in the axes of the second frame -> yaw in the middle of the two, and the rotation; degrees."""
    travel = rotation(-np.asarray(turn) / 2) @ travel
    return np.degrees(np.r_[np.arctan2(travel[0], travel[2]), turn])


def miss(points, unknown, rig):
    """Pixels between the points where odometry expects them and where they are; unknown = translation, rotation."""
    moved = turned(points, unknown[3:6]) * (rig["focal_px"] * rig["baseline_m"] / points.disparity)[:, None] + unknown[:3]
    return rig["focal_px"] * (moved[:, :2] / moved[:, 2:] - points.after)


def weighted_miss(points, unknown, rig, noise, floor, free_field):
    """Normal equations of one pair: pixel noise, and disparity noise along the flow it causes; Tukey's biweight."""
    def misses(x):
        return miss(points.corrected(x[6:]) if free_field else points, x, rig)
    error, slope = derivative(misses, unknown)
    nearer = Points(points.before, points.after, points.disparity + 0.01, points.metres)
    shift = noise * (miss(nearer, unknown, rig) - miss(points, unknown, rig)) / 0.01
    inverse = np.linalg.inv(PIXEL_NOISE ** 2 * np.eye(2) + shift[:, :, None] * shift[:, None, :])
    square = np.einsum("ni,nij,nj->n", error, inverse, error)
    weight = biweight(np.sqrt(square) / (1.2 * TUKEY * max(np.sqrt(np.median(square) / 1.386), floor)))
    pulled = np.einsum("n,nij,njk->nik", weight, inverse, slope)
    return np.einsum("nij,nik->jk", slope, pulled), np.einsum("nik,ni->k", pulled, error)


def settle(step):
    return 8 / (step + 1) ** 1.5 if step < 6 else 0.0


def odometry(points, rig, noise=0.0):
    """Yaw and rotation, degrees. Without noise: plain reprojection error, as most odometry has it."""
    points, at = points.with_depth(rig), np.r_[0, 0, -points.metres, 0, 0, 0]
    for step in range(STEPS):
        normal, side = weighted_miss(points, at, rig, noise, settle(step), False)
        at = at - np.linalg.solve(normal, side)
    return halfway(-at[:3], at[3:])


def field_of(pairs, rig):
    """The six terms that all pairs share; six more of each pair are its motion, eliminated one pair at a time."""
    pairs, field = [pair.with_depth(rig) for pair in pairs], np.zeros(6)
    motions = [np.r_[0, 0, -pair.metres, 0, 0, 0] for pair in pairs]
    for step in range(STEPS):
        left, right, parts = np.zeros((6, 6)), np.zeros(6), []
        for pair, at in zip(pairs, motions):
            normal, side = weighted_miss(pair, np.r_[at, field], rig, DISPARITY_NOISE, settle(step), True)
            gain = normal[6:, :6] @ np.linalg.inv(normal[:6, :6])
            left, right = left + normal[6:, 6:] - gain @ normal[:6, 6:], right + side[6:] - gain @ side[:6]
            parts.append((normal, side))
        change = -np.linalg.solve(left, right) if step > 6 else np.zeros(6)
        field = field + change
        motions = [at - np.linalg.solve(normal[:6, :6], side[:6] + normal[:6, 6:] @ change)
                   for at, (normal, side) in zip(motions, parts)]
    return field


def row(name, found):
    found = np.array(found)
    yaw, turn = found[:, 0], found[:, 1:].sum(0)
    print(f"| {name} | {yaw.mean():+.3f} | {yaw.std() / np.sqrt(len(yaw)):.3f} | {turn[1]:+.2f} | {turn[2]:+.2f} |")


def halves(pairs):
    return {"left half": [pair.part(pair.before[:, 0] < 0) for pair in pairs],
            "right half": [pair.part(pair.before[:, 0] > 0) for pair in pairs]}


def table(drive, other):
    rig, tracks, sift = drive.rig, given_tracks(drive), sift_points(drive)
    fields = {"": np.zeros(6), ", disparities corrected": field_of(sift, rig)}
    if other:
        fields[f", corrected as on {other.name}"] = field_of(sift_points(other), other.rig)
    print(f"{drive.name}\n| way | yaw | standard error | turn to the left, sum | about the axis, sum |\n|---|---|---|---|---|")
    for name, pairs in {"tracks": tracks, "SIFT": sift}.items():
        parts = {name: pairs, **{f"{name}, {half}": part for half, part in halves(pairs).items()}}
        for part, chosen in parts.items():
            row(f"{part}: focus", [focus_of(pair, rig) for pair in chosen])
        for what, field in fields.items():
            for part, chosen in parts.items():
                row(f"{part}: odometry{what}", [odometry(pair.corrected(field), rig) for pair in chosen])
        row(f"{name}: odometry, disparity noise allowed for", [odometry(pair, rig, DISPARITY_NOISE) for pair in pairs])
    for what, field in list(fields.items())[1:]:
        print(f"correction{what}, px: " + " ".join(f"{value:+.2f}" for value in field))


def main(arguments):
    if len(arguments) not in (1, 2):
        print(__doc__, file=sys.stderr)
        return 2
    cv2.setRNGSeed(1)
    drives = [Recording(folder) for folder in arguments]
    table(drives[0], drives[1] if len(drives) > 1 else None)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
