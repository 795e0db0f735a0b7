"""What was to be reached, what is, and why not what is not: figures and the words around them."""
import csv

import numpy as np

import texts
from results import (GROUPS, OURS, PAPER_TABLE_1, PAPER_TABLE_2, errors, instruction_ratio, instructions, lead,
                     mean_absolute, score, time_ratio)
from tables import SWEEP, best_peer, fastest_peer, times

BARE_PASS = "v-disparity of every pixel"
PIXELS, GRID_STEP = 640 * 480, 2 * 4
MILLION = 1e6
CHANCE = 2  # standard errors that a lead must have


def yes(reached):
    return "reached" if reached else "**not reached**"


def table_2_factor(results):
    mine = score(results.of(SWEEP, OURS))
    smallest = min(min(paper[0] / mine.roll, paper[1] / mine.pitch, paper[2] / mine.height) for paper in PAPER_TABLE_2.values())
    return ["Table 2: each of the paper's figures, its virtual maps' too, beaten by at least 4 times",
            f"smallest factor {smallest:.1f}", yes(smallest >= 4)]


def table_1_line(title, pitch, roll):
    return [f"Table 1: below 0.05° pitch and roll down to 1 % of the points, {title}",
            f"at most {pitch:.3f}° pitch, {roll:.3f}° roll",
            yes(pitch < 0.05 and roll < 0.05)]


def table_1_errors(results, suffix, title):
    scores = [score(results.of(SWEEP, f"points {share}{suffix}")) for share in PAPER_TABLE_1]
    return table_1_line(title, max(one.pitch for one in scores), max(one.roll for one in scores))


class Share:
    """Method 2 alone on as many points as 1 % of the free map's pixels: roadpose-share's frames."""

    def __init__(self, path):
        with open(path) as file:
            self.lines = list(csv.DictReader(file))
        self.accepted = [line for line in self.lines if line["status"] == "ok"]
        self.pitch, self.roll, self.height = (self.error(key) for key in ("pitch", "roll", "height"))
        self.pixels, self.points, self.percent = (self.mean(key) for key in ("pixels", "points", "percent"))

    def error(self, key):
        return float(np.mean([abs(float(line[key])) for line in self.accepted]))

    def mean(self, key):
        return float(np.mean([float(line[key]) for line in self.lines]))


def ahead_of_peers(results, axis, name, digits, unit, group):
    mine = mean_absolute(results.of(SWEEP, OURS), axis)
    best, peer = best_peer(results, axis, group)
    ahead, chance = lead(results, SWEEP, peer, axis)
    measured = (f"ours {mine:.{digits}f}{unit}, best peer {best:.{digits}f}{unit} ({peer}); "
                f"lead {ahead:.{digits}f} ± {chance:.{digits}f}{unit}")
    doubt = ", but within chance" if abs(ahead) < CHANCE * chance else ""
    return [f"Ahead of every peer on the roll sweep, {name}: peers {group}", measured, yes(mine < best) + doubt]


def faster(results, group, sees_roll, title):
    ratio, peer = fastest_peer(results, group, sees_roll)
    return [f"At least 20 times faster than the fastest peer: {title}", f"{times(ratio)} times ({peer})", yes(ratio >= 20)]


def rows(results, share):
    found = [table_2_factor(results), table_1_errors(results, " refined", "with refinement"),
             table_1_errors(results, "", "Method 2 alone, share of our points"),
             table_1_line("Method 2 alone, share of the free map's pixels", share.pitch, share.roll)]
    for group in GROUPS:
        found += [ahead_of_peers(results, 0, "pitch", 4, "°", group), ahead_of_peers(results, 1, "roll", 4, "°", group),
                  ahead_of_peers(results, 2, "height", 2, " mm", group)]
    used, helped = GROUPS
    return found + [faster(results, used, True, f"those {used} that see roll"),
                    faster(results, used, False, f"all {used}, Hough lines too"), faster(results, helped, False, helped)]


def over_the_bump(results, peer):
    """Largest pitch error where we refuse the frame, and how much further off the peer is than we are where we do not."""
    accepted = {row.frame for row in results.of("speed-bump", OURS) if row.status == "ok"}
    both = [row for row in results.of("speed-bump", peer) if row.frame in accepted]
    refused = errors([row for row in results.of("speed-bump", peer) if row.frame not in accepted], 0)
    factor = mean_absolute(both, 0) / mean_absolute(results.of("speed-bump", OURS), 0)
    return {"bump": f"{np.abs(refused).max(initial=0):.1f}", "bump_factor": f"{factor:.1f}"}


def budget(results, group):
    """What the fastest peer of a group executes, and what 20 times less would leave; both also a sample of our grid."""
    _, peer = fastest_peer(results, group)
    count, no_road = instructions(results, SWEEP, peer), results.of("no-road", peer)
    return {"peer": peer, "pitch": f"{mean_absolute(results.of(SWEEP, peer), 0):.1f}", **over_the_bump(results, peer),
            "believed": sum(row.status == "ok" for row in no_road),
            "no_road": len(no_road), "count": f"{count / MILLION:.1f}", "ratio": times(instruction_ratio(results, SWEEP, peer)),
            "time": times(time_ratio(results, SWEEP, peer)), "left": f"{count / 20 / MILLION:.2f}",
            "left_a_sample": f"{count / 20 / (PIXELS / GRID_STEP):.0f}"}


def words(results):
    """The paragraphs below the table: their figures are those of this run."""
    bare, ours = instructions(results, SWEEP, BARE_PASS), instructions(results, SWEEP, OURS)
    used, helped = (budget(results, group) for group in GROUPS)
    plain, thinned, open3d = ("RANSAC plane: every pixel, whole map", "RANSAC plane: 2 x 4 grid, whole map",
                              "Open3D: every pixel, whole map")
    figures = {"ours": f"{ours / MILLION:.1f}", "bare": f"{bare / MILLION:.1f}", "bare_a_pixel": f"{bare / PIXELS:.0f}",
               "bare_ratio": f"{bare / ours:.2f}", "bare_grid": f"{bare / GRID_STEP / MILLION:.2f}",
               "plain": times(time_ratio(results, SWEEP, plain)), "thinned": times(time_ratio(results, SWEEP, thinned)),
               "open3d": times(time_ratio(results, SWEEP, open3d)), "used": used, "helped": helped,
               "pitch": f"{mean_absolute(results.of(SWEEP, OURS), 0):.3f}"}
    return [text.format(**figures) for text in texts.VERDICT]
