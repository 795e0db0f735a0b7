"""page.py --programs DIR --work DIR --full DIR --fixtures DIR --out DIR: tables and figures from the results in WORK."""
import argparse
from pathlib import Path

import figures_method2
import figures_own
import figures_profile
import real_drives
import tables
import texts
import verdict
from markdown import Page
from recording import Recording
from results import Results, read, read_counts
from studio import Studio

PEERS_ELSEWHERE = ["roadpose", "RANSAC plane: every pixel, whole map", "RANSAC plane: every pixel, cropped",
                   "RANSAC plane: 2 x 4 grid, cropped", "Open3D: every pixel, cropped"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("programs", "work", "full", "fixtures", "out"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    return parser.parse_args()


def level_frame_of(results, recording):
    """A frame that Method 1 accepts, from the middle of those."""
    frames = [row.frame for row in results.of(recording, "Method 1 alone") if row.status == "ok"]
    return frames[len(frames) // 2]


def section(page, heading):
    print(f"  {heading}", flush=True)
    page.heading(heading)


def paper_tables(page, studio, results, place):
    section(page, "Table 1: share of the points")
    share = place["share"]
    tables.table_1(page, results, share)
    for text in texts.TABLE_1.split("\n\n"):
        page.text(text.format(points=share.points, least=share.points / 100, pixels=share.pixels, same=share.pixels / 100,
                              percent=share.percent))
    section(page, "Table 2: Method 2 and the virtual maps")
    tables.table_2(page, results)
    page.text(texts.TABLE_2)


def paper_figures(page, studio, results, place):
    section(page, "The paper's figures, on our scenes")
    recordings, profile, method2 = place["recordings"], figures_profile, figures_method2
    tracks = Recording(place["fixtures"] / "yaw-left")
    page.figure(profile.tracks_and_intersections(studio, tracks, 20), texts.FIGURE_2)
    scenes = [(recordings[name], level_frame_of(results, name)) for name in ("level", "traffic", "crown")]
    page.figure(profile.road_profiles(studio, scenes), texts.FIGURE_3)
    page.figure(profile.along_a_drive(studio, results, "level", "figure-04"), texts.FIGURE_4)
    refined = [("roadpose", "Method 2, refined", "tab:green")]
    page.figure(profile.along_a_drive(studio, results, "speed-bump", "figure-05", refined), texts.FIGURE_5)
    page.figure(profile.what_roll_does(studio), texts.FIGURE_6)
    page.figure(method2.two_stages(studio), texts.FIGURE_7)
    page.figure(method2.clouds(studio), texts.FIGURE_8)
    page.figure(method2.sweep_of_method_1(studio, results), texts.FIGURE_9)
    page.figure(method2.sweep_of_method_2(studio, results), texts.FIGURE_10)
    page.figure(method2.virtual_map(studio), texts.FIGURE_11)
    page.figure(method2.virtual_maps_compared(studio, results), texts.FIGURE_12)


def real(page, studio, results, place):
    section(page, "Figures 13 and 14: real drives")
    drives = Results(read([place["work"] / name for name in ("drives.csv", "open3d-drives.csv")]))
    rows = real_drives.update(drives, place["out"] / "real-drives.csv", place["work"] / "real-drives")
    page.text(texts.REAL_DRIVES)
    if rows:
        tables.drives(page, rows)


def peers(page, studio, results, _):
    section(page, "Peers on the same frames")
    page.text(texts.PEERS)
    page.items(texts.PEER_SETTINGS)
    page.text("Roll sweep, mean absolute errors:")
    tables.peers(page, results, "roll-sweep")
    page.figure(figures_own.peers(studio, results), texts.PEER_FIGURE)
    page.text("The drive on the level street, where roll is 0 and the Hough line is at home:")
    tables.peers(page, results, "level")
    page.text(texts.ELSEWHERE)
    tables.peers_elsewhere(page, results, [name for name in PEERS_ELSEWHERE if name in results.candidates()])
    page.text(texts.FALSE_ROADS)
    tables.false_roads(page, results)


def own(page, studio, results, place):
    section(page, "Errors against the double-precision oracle")
    page.text(texts.ORACLE)
    tables.against_oracle(page, results)
    page.figure(figures_own.error_histograms(studio, results), texts.HISTOGRAMS)
    section(page, "Accepted and refused")
    tables.accepted_and_refused(page, results)
    page.figure(figures_own.worst_frames(studio, results, place["recordings"]), texts.WORST)
    section(page, "Sensitivity")
    page.figure(figures_own.sensitivity(studio, place["work"] / "sensitivity.csv"), texts.SENSITIVITY)
    page.table(["what is off", "by", "accepted", "pitch °", "roll °", "height mm"],
               figures_own.sensitivity_rows(place["work"] / "sensitivity.csv"))


def recordings_in(folder):
    return {path.parent.name: Recording(path.parent) for path in sorted(folder.glob("*/rig.yml"))}


def main():
    options = arguments()
    studio = Studio(options.programs, options.work, options.out / "figures")
    results = Results(read([options.work / name for name in ("results.csv", "results-large.csv", "open3d.csv")]),
                      read_counts(options.work / "instructions.csv"))
    share = verdict.Share(options.work / "share.csv")
    place = {"share": share, "recordings": recordings_in(options.full), "fixtures": options.fixtures, "work": options.work,
             "out": options.out}
    page = Page("Evaluation: the paper's tables and figures, and the peers")
    page.text(texts.INTRODUCTION)
    page.code(texts.COMMAND)
    page.text(texts.READING)
    page.heading("What was to be reached")
    page.table(["target", "measured", ""], verdict.rows(results, share))
    for text in verdict.words(results):
        page.text(text)
    for part in (paper_tables, paper_figures, real, peers, own):
        part(page, studio, results, place)
    page.heading("Look at your own recording")
    page.text(texts.VIEWER)
    page.code(texts.VIEWER_COMMAND)
    page.write(options.out)


if __name__ == "__main__":
    main()
