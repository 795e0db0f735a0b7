"""The tables of the page."""
from collections import Counter

import numpy as np

from results import (GROUPS, OURS, PAPER_TABLE_1, PAPER_TABLE_2, errors, group_of, instruction_ratio, is_peer, mean_absolute,
                     score, time_ratio)

SWEEP = "roll-sweep"


def cell(value, digits):
    return "–" if value is None else f"{value:.{digits}f}"


def triple(a_score):
    return [cell(a_score.pitch, 4), cell(a_score.roll, 4), cell(a_score.height, 2)]


def time_saved(results, share, suffix):
    """Percent of the time that all points take; of the whole frame, decoding and histograms included."""
    whole = results.of(SWEEP, "roadpose" if suffix else "Method 2 alone")
    part = results.of(SWEEP, f"points {share}{suffix}")
    ratios = [after.time_us / before.time_us for before, after in zip(whole, part)]
    return 100 * (1 - float(np.median(ratios)))


def change(percent):
    return f"{percent:+.0f} %".replace("-", "−")


def table_1(page, results, of_pixels):
    rows = []
    for share, (pitch, roll, saved) in PAPER_TABLE_1.items():
        alone, refined = (score(results.of(SWEEP, f"points {share}{suffix}")) for suffix in ("", " refined"))
        rows.append([f"{share} %", cell(pitch, 3), cell(roll, 3), f"−{saved} %", cell(alone.pitch, 3),
                     cell(alone.roll, 3), change(-time_saved(results, share, "")), cell(refined.pitch, 3),
                     cell(refined.roll, 3), change(-time_saved(results, share, " refined"))])
    rows.append(["1 % of the pixels", "", "", "", cell(of_pixels.pitch, 3), cell(of_pixels.roll, 3), "", "", "", ""])
    page.table(["points", "paper: pitch °", "roll °", "time", "Method 2 alone: pitch °", "roll °", "time",
                "with refinement: pitch °", "roll °", "time"], rows)


TABLE_2 = [("Method 2 with refinement (default)", OURS, "Method 2"), ("Method 2 alone", "Method 2 alone", "Method 2"),
           ("virtual disparity map", "virtual disparity map", "virtual disparity map"),
           ("virtual free map", "virtual free map", "virtual free map")]


def ratio(paper, ours):
    return "–" if not ours else f"{paper / ours:.1f}"


def table_2(page, results):
    rows = []
    for name, candidate, paper_name in TABLE_2:
        paper, mine = PAPER_TABLE_2[paper_name], score(results.of(SWEEP, candidate))
        rows.append([name, cell(mine.roll, 4), cell(mine.pitch, 4), cell(mine.height, 2), f"{paper[0]:.2f}",
                     f"{paper[1]:.2f}", paper[2],
                     ratio(paper[0], mine.roll), ratio(paper[1], mine.pitch), ratio(paper[2], mine.height),
                     f"{mine.accepted} of {mine.frames}"])
    page.table(["", "ours: roll °", "pitch °", "height mm", "paper: roll °", "pitch °", "height mm",
                "paper / ours: roll", "pitch", "height", "accepted"], rows)


def times(value):
    return cell(value, 1 if value is not None and value < 100 else 0)


def peer_row(results, recording, candidate):
    mine = score(results.of(recording, candidate))
    return [candidate, *triple(mine), f"{mine.accepted} of {mine.frames}", times(time_ratio(results, recording, candidate)),
            times(instruction_ratio(results, recording, candidate))]


def peers_of(results, recording, group):
    return [name for name in results.candidates()
            if is_peer(name) and group_of(name) == group and results.of(recording, name)]


def grouped(results, recording, row_of, columns):
    """A line for ours, then the two groups of peers under their names."""
    rows = [row_of(OURS)]
    for group in GROUPS:
        rows.append([f"*{group}*"] + [""] * columns)
        rows += [row_of(name) for name in peers_of(results, recording, group)]
    return rows


def peers(page, results, recording):
    page.table(["", "pitch °", "roll °", "height mm", "accepted", "time / ours", "instructions / ours"],
               grouped(results, recording, lambda name: peer_row(results, recording, name), 6))


def peers_elsewhere(page, results, names):
    rows = []
    for recording in results.recordings():
        shown = [name for name in names if results.of(recording, name)] if recording != "no-road" else []
        for name in shown:
            found = results.of(recording, name)
            mine = score(found)
            rows.append([f"`{recording}`" if name == shown[0] else "", name, cell(mine.pitch, 3), largest(found),
                         cell(mine.roll, 3), cell(mine.height, 1), f"{mine.accepted} of {mine.frames}"])
    page.table(["recording", "estimator", "pitch °", "largest", "roll °", "height mm", "accepted"], rows)


def largest(rows):
    values = np.abs(errors(rows, 0))
    return cell(float(values.max()) if len(values) else None, 2)


def false_roads(page, results):
    def row_of(name):
        found = results.of("no-road", name)
        return [name, sum(row.status == "ok" for row in found), len(found)]
    page.table(["", "frames without a road that got a pose", "of"], grouped(results, "no-road", row_of, 2))


ORACLE = "oracle: true road in the corridor"


def apart(results, recording):
    """Mean absolute difference between our poses and the oracle's."""
    theirs = {row.frame: row.pose for row in results.of(recording, ORACLE)}
    pairs = [(row.pose, theirs[row.frame]) for row in results.of(recording, OURS) if row.status == "ok"]
    differences = np.abs(np.array([np.subtract(*pair) for pair in pairs if None not in pair[1]]))
    return [cell(float(value), digits) for value, digits in zip(differences.mean(axis=0) * (1, 1, 1000), (4, 4, 2))]


def against_oracle(page, results):
    rows = []
    for recording in results.recordings():
        if recording == "no-road":
            continue
        accepted = {row.frame for row in results.of(recording, OURS) if row.status == "ok"}
        line = [f"`{recording}`"]
        for name in (OURS, ORACLE, "oracle: true road"):
            line += triple(score([row for row in results.of(recording, name) if row.frame in accepted]))
        rows.append(line + apart(results, recording))
    page.table(["recording", "ours: pitch °", "roll °", "height mm", "oracle in the corridor: pitch °", "roll °", "height mm",
                "oracle, all road: pitch °", "roll °", "height mm", "apart: pitch °", "roll °", "height mm"], rows)


STATUSES = ["ok", "no_disparity", "no_road", "little_support", "short_range", "poor_fit", "outside_limits"]


def accepted_and_refused(page, results):
    rows = []
    for recording in results.recordings():
        counts = Counter(row.status for row in results.of(recording, OURS))
        rows.append([f"`{recording}`", sum(counts.values()), *(counts.get(status, 0) or "" for status in STATUSES)])
    page.table(["recording", "frames", *(f"`{status}`" for status in STATUSES)], rows)


def drives(page, rows):
    page.table(["drive", "estimator", "frames", "accepted", "pitch error °: mean", "deviation", "roll error °: mean",
                "deviation", "height error mm: mean", "deviation"], rows)


def fastest_peer(results, group, sees_roll=False):
    names = [name for name in peers_of(results, SWEEP, group) if not (sees_roll and name.startswith("Hough"))]
    return min((time_ratio(results, SWEEP, name), name) for name in names)


def best_peer(results, axis, group):
    known = [(mean_absolute(results.of(SWEEP, name), axis), name) for name in peers_of(results, SWEEP, group)]
    return min(pair for pair in known if pair[0] is not None)
