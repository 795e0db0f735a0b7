"""Open3D's segment_plane on every frame of some recordings, in the columns of roadpose-evaluate, on standard output.

    open3d_peer.py [--cropped] RECORDING...

Open3D gets the points in metres. Variants: all points, or those within 3 m sideways and 25 m ahead (with --cropped only
these); every pixel or one in 2 x 4. A plane outside the mounting limits is put aside and the next one is tried, up to
five. Only segment_plane is timed, on one core, in processor time; making the points is not. The whole map takes seconds a frame,
so it is only tried on the first recording, once a frame. The others are tried five times, one line each: the same seed does not
make Open3D answer the same, and its mean error over the roll sweep moves by a tenth from run to run."""
import csv
import os
import sys
import time

os.environ["OMP_NUM_THREADS"] = "1"  # before the import: one core, as everyone else

import numpy as np
import open3d

from recording import Recording

HEADER = ["recording", "frame", "scene", "road", "true_pitch", "true_roll", "true_height", "candidate", "status", "pitch", "roll",
          "height", "time_us"]
BAND_M = 0.03  # the best of 1, 2, 3, 5 and 10 cm on the committed roll sweep
HYPOTHESES = 1000
PLANES = 5
REPEATS = 5
CROPPED = [(True, False), (True, True)]  # cropped, sparse
VARIANTS = [(False, False), (False, True)] + CROPPED


def name_of(cropped, sparse):
    return "Open3D: " + ("2 x 4 grid" if sparse else "every pixel") + (", cropped" if cropped else ", whole map")


def points_of(recording, frame, cropped, sparse):
    disparity, (x, y), rig = recording.disparity(frame), recording.offsets(), recording.rig
    keep = disparity > 0
    if sparse:
        grid = np.zeros_like(keep)
        grid[::2, ::4] = True
        keep &= grid
    if cropped:
        keep &= (np.abs(x) * rig["baseline_m"] <= 3 * disparity) & (rig["focal_px"] * rig["baseline_m"] <= 25 * disparity)
    depth = rig["focal_px"] * rig["baseline_m"] / disparity[keep]
    return np.column_stack([x[keep] * depth / rig["focal_px"], y[keep] * depth / rig["focal_px"], depth])


def pose_of(plane):
    """ISO 8855 pitch and roll in degrees, height in metres; the normal is turned to point into the road."""
    normal, offset = np.array(plane[:3]), plane[3]
    if offset > 0:
        normal, offset = -normal, -offset
    length = np.linalg.norm(normal)
    normal, height = normal / length, -offset / length
    return np.degrees(np.arcsin(normal[2])), np.degrees(np.arctan2(normal[0], normal[1])), height


def is_within_limits(pose):
    return -10 <= pose[0] <= 15 and abs(pose[1]) <= 25 and 0.3 <= pose[2] <= 4


def road_of(cloud):
    """Pose of the first plane within the mounting limits, or None."""
    for _ in range(PLANES):
        if len(cloud.points) < 100:
            return None
        plane, inliers = cloud.segment_plane(BAND_M, 3, HYPOTHESES)
        pose = pose_of(plane)
        if is_within_limits(pose):
            return pose
        cloud = cloud.select_by_index(inliers, invert=True)
    return None


def timed(points, seed):
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    open3d.utility.random.seed(seed)
    start = time.process_time()
    pose = road_of(cloud)
    return pose, 1e6 * (time.process_time() - start)


def rows_of(recording, frame, variants):
    truth = recording.truth.get(frame, {})
    known = [truth.get(key, "") for key in ("pitch_deg", "roll_deg", "height_m")]
    for cropped, sparse, seed in ((*variant, seed) for variant in variants for seed in range(REPEATS if variant[0] else 1)):
        pose, time_us = timed(points_of(recording, frame, cropped, sparse), 1 + seed)
        found = [f"{value:.6f}" for value in pose] if pose else ["", "", ""]
        yield [recording.name, frame, truth.get("scene", ""), truth.get("road", -1), *known, name_of(cropped, sparse),
               "ok" if pose else "no_road", *found, f"{time_us:.1f}"]


def main():
    writer = csv.writer(sys.stdout)
    only_cropped = sys.argv[1:2] == ["--cropped"]
    writer.writerow(HEADER)
    for place, folder in enumerate(sys.argv[1 + only_cropped:]):
        recording = Recording(folder)
        for frame in range(len(recording.files)):
            writer.writerows(rows_of(recording, frame, VARIANTS if place == 0 and not only_cropped else CROPPED))
            print(f"\r  {recording.name}: frame {frame + 1} of {len(recording.files)} ", end="", file=sys.stderr)
        print(file=sys.stderr)


if __name__ == "__main__":
    main()
