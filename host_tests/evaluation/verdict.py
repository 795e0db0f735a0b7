"""What was to be reached, and what is."""
from results import OURS, PAPER_TABLE_1, PAPER_TABLE_2, mean_absolute, score
from tables import SWEEP, best_peer, fastest_peer


def yes(reached):
    return "reached" if reached else "**not reached**"


def table_2_factor(results):
    mine, paper = score(results.of(SWEEP, OURS)), PAPER_TABLE_2["Method 2"]
    smallest = min(paper[0] / mine.roll, paper[1] / mine.pitch, paper[2] / mine.height)
    return ["Table 2: each of the paper's figures beaten by at least 4 times", f"smallest factor {smallest:.1f}",
            yes(smallest >= 4)]


def table_1_errors(results, suffix, title):
    scores = [score(results.of(SWEEP, f"points {share}{suffix}")) for share in PAPER_TABLE_1]
    pitch, roll = max(one.pitch for one in scores), max(one.roll for one in scores)
    return [f"Table 1: below 0.05° pitch and roll down to 1 % of the points, {title}",
            f"largest {pitch:.3f}° pitch, {roll:.3f}° roll", yes(pitch < 0.05 and roll < 0.05)]


def ahead_of_peers(results, axis, name, digits, unit):
    mine = mean_absolute(results.of(SWEEP, OURS), axis)
    best, peer = best_peer(results, axis)
    return [f"Ahead of every peer on the roll sweep: {name}",
            f"ours {mine:.{digits}f}{unit}, best peer {best:.{digits}f}{unit} ({peer})", yes(mine < best)]


def faster(results):
    ratio, peer = fastest_peer(results)
    return ["At least 20 times faster than the fastest peer", f"{ratio:.1f} times ({peer})", yes(ratio >= 20)]


def rows(results):
    return [table_2_factor(results), table_1_errors(results, " refined", "with refinement"),
            table_1_errors(results, "", "Method 2 alone"), ahead_of_peers(results, 0, "pitch", 4, "°"),
            ahead_of_peers(results, 1, "roll", 4, "°"), ahead_of_peers(results, 2, "height", 2, " mm"), faster(results)]
