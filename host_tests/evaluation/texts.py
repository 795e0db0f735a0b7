"""The words of the page."""

INTRODUCTION = """What roadpose reaches on rendered streets with exact truth, beside the figures of *the paper* (Musleh, Martín,
Armingol, de la Escalera, "Pose Self-Calibration of Stereo Vision Systems for Autonomous Vehicle Applications", Sensors
2016, 16, 1492) and beside what a project would otherwise use. This page is written by one command, which installs what
only it needs in an environment of its own:"""

COMMAND = "sh host_tests/evaluation/run.sh     # half an hour on two cores; the head of the file lists what can be set"

READING = """Errors are mean absolute errors, estimate minus truth, over the frames that got a pose, unless it says otherwise. The frames
are the *full* fixture set of [fixtures/README.md](../../fixtures/README.md): other seeds than the committed one, on which settings were
tuned; but for the share of stray points that makes a road uneven (docs/design.md), which was set with both in view (any from a third to 1/32 does as well
on this sweep). The paper's scenes were rendered too, but by others: its figures are not from our frames. The paper's errors include
those of its matcher, as ours do. Poses are the same in every run but Open3D's. Times are not, so only ratios within one run are given: processor time on one core, `-O2`, median over the frames."""

VERDICT = [
    """**The peers, in two groups.** *As one would use them*: the whole map; Hough lines coarse and fine, a RANSAC plane and Open3D
    on every pixel. *Helped by us*: they get our crop, or our sampling grid of one pixel in eight, or both, which are part of what
    this library is.""",
    """**Speed.** As one would write it first, a RANSAC plane of the whole map takes {plain} times our time, Open3D {open3d} times.
    Thinning is not our idea alone: on one pixel in eight of the whole map the RANSAC plane takes {thinned} times our time. The fastest
    Hough line takes {used[time]} times our time and is {used[pitch]}° off in pitch on this sweep, because it cannot see roll; on the level
    street, where there is none, it is in the table below. The fastest of all has both our grid and our crop ({helped[peer]}):
    {helped[time]} times our time. It is what is left of our pipeline without histograms, free map, Method 2 and judgement of the result:
    it believes {helped[believed]} of {helped[no_road]} frames that show no road; over the speed bump it is up to {helped[bump]}° off in
    pitch where we refuse the frame, and {helped[bump_factor]} times as far off as we are where we do not.""",
    """**Why not 20 times.** Counted instructions of one frame, mean over the sweep: roadpose {ours} million; a plain v-disparity pass
    over every pixel, with which every Hough line begins, {bare} million ({bare_a_pixel} a pixel, {bare_ratio} of our whole frame);
    {used[peer]}: {used[count]} million, {used[ratio]} times ours; {helped[peer]}: {helped[count]} million, {helped[ratio]} times ours. To be
    20 times below the former leaves {used[left]} million for a frame, {used[left_a_sample]} for each sample of a grid of one in eight;
    below the latter {helped[left]} million, {helped[left_a_sample]} a sample. That same bare pass over the grid alone takes {bare_grid}
    million: next to nothing, or nothing at all, is left to find a road with.""",
    """**Accuracy.** A lead is the mean over the frames of how much further off the peer is, with the standard error of that mean. On
    flat streets least squares over the right pixels is all there is to gain, and peers that are told where to look (our crop) gain it
    too: where a lead is smaller than two standard errors, call them alike.""",
    """**Pitch.** Nearly all of our {pitch}° is the matcher's constant +0.03 px, which every fit in disparity space takes over; see
    the oracle, which knows the true road. A fit in metres weighs near points more and suffers less from it.""",
    """What the peers lack is in the tables below: weak texture, crown, bump, and frames without a road.""",
]

TABLE_1 = """Roll sweep, ±20°. The time is that of the whole frame, decoding and histograms included, against 100 % of the points. It
hardly falls: Method 2 here draws at most 512 pairs whatever the share, so the share only makes sorting cheaper, and the passes over the
samples, the free map and the refinement do not depend on it. With the refinement the share hardly matters: Method 2 only has to start it.

What the share is of: our 100 % are at most {points:.0f} points, because only one pixel in eight of the corridor's box is looked at and that is
thinned; 1 % of them are {least:.0f} points. We take the paper's share to be one of the pixels of its free map. The free map of these frames
has {pixels:.0f} pixels on average (the whole map's, by the comparator below); 1 % of those are {same:.0f} points, {percent:.0f} % of ours. The last line is Method 2
alone with that many, frame by frame; the shares above it would be more than all that we keep, or nearly."""

TABLE_2 = """*Method 2 alone* is the paper's method as roadpose implements it, with the ±2 m corridor. The virtual maps are comparators,
written for this page only, and **this is our reading of them**: the roll is taken from the slope of the lines of constant disparity (RANSAC over
4096 pairs of pixels of one level, then least squares); the map, all pixels or those of the free map, is re-seen by a virtual camera turned back by
that roll (nearest neighbour, always from the original map); repeated until less than 0.005° is left; then Method 1 on it (RANSAC and
least squares of the v-disparity's line). They see the whole image, as in the paper: pavements raised by 15 cm are a second plane to them."""

FIGURE_2 = """Figure 2. Tracks of a drive straight ahead and the intersections of their lines. Left: tracks from the previous to this frame,
with noise and a share that follows other motions. Right: intersections of 3000 random pairs. Red: the true focus of expansion."""
FIGURE_3 = """Figure 3. Left image, u-disparity, v-disparity, v-disparity-free. The rows are a level street, heavy traffic, a crowned
road. Dashed red: the road profile of Method 1. The v-disparity-free is the library's own, obstacles removed and within its corridor; the others are
of every pixel. Grey levels are logarithmic."""
FIGURE_4 = """Figure 4. Pitch and height along the level drive by Method 1, from the v-disparity of the whole map and from the
v-disparity-free, no corridor for either. Without obstacles it is nearer to the truth."""
FIGURE_5 = """Figure 5. Pitch and height along the drive over the speed bump. The truth is the plane of the flat road, so the pitch swings as the
axles climb. Method 1 of the whole map and of the free map, and the default, which refuses the frames (gaps) where the bump fills the near road."""
FIGURE_6 = """Figure 6. What roll does to a v-disparity. One and the same street: with roll 0 the road is a line, with roll it smears into a wedge,
and Method 1 has nothing to fit."""
FIGURE_7 = """Figure 7. The two stages of Method 2 on that street under two rolls. Left: slopes of pairs of one disparity level; they gather
at the same slope at all levels (dashed: the result). Right: intercepts of the pairs with that slope lie on a line over the disparity
(dashed: the result)."""
FIGURE_8 = """Figure 8. The cloud of slopes and intercepts of the same pairs, each with its own slope. Colour: disparity. Dashed: the common slope
that was found."""
FIGURE_9 = """Figure 9. Roll sweep by Method 1, which takes roll as 0: pitch and height, and their errors (linear up to 0.05° and
5 mm, logarithmic beyond). By default it has an answer near 0 only,
from the whole map (orange) or the free map (blue), and refuses the frame at other rolls; grey is what it says when it is told to refuse as little as
possible. The refinement (green) brings its answer home where it is near enough to start from."""
FIGURE_10 = "Figure 10. Roll sweep by Method 2, alone and with refinement: roll, pitch and height against the truth, and the errors below."
FIGURE_11 = """Figure 11. The virtual maps at a roll of 20°. Above: disparity (colour) as seen, turned back, and both with the free map's pixels only.
Below: their v-disparities. Turned back, the road is a line again."""
FIGURE_12 = "Figure 12. Roll sweep by the virtual maps and by Method 2, alone and with refinement: estimates, and the errors below."

REAL_DRIVES = """Pictures of real drives are not ours to pass on: the command writes Figures 13 and 14 into its build folder where
`ROADPOSE_RECORDINGS` names the drives, and this table, which it leaves as it is where they are not at hand. `street-lidar`: a residential street
with a crowned road, truth from a laser scanner, good to 0.15° and 3 cm, constant over the drive; the deviation is the fairer figure.
`straight-motion`: no truth, the deviation contains what the car really did."""

PEERS = """What one would use instead. All see the same frames in one run on one core, and one rule holds for all that are written in C++: each starts
from the raw 16-bit samples in the machine's byte order and ends with a pose, and all of that is timed and counted; what depends on the rig only is
made before the first frame. Each reads only the pixels that it needs. Open3D alone is helped further: its points in metres are made in NumPy, which is
not charged. A pose outside the mounting limits (pitch −10…+15°, roll ±25°, height 0.3…4 m) is passed over and the next best is taken: they are
the same for all."""
PEER_SETTINGS = [
    """**Hough**: v-disparity in one integer pass, cells above 2 % of the width, OpenCV's `HoughLines` over the slopes that the mounting limits
    allow, the strongest line within them; *then least squares*: of the histogram within 1.5 levels of it. It cannot see roll: at home on the
    level street only.""",
    """**RANSAC plane**: double precision, in disparity space, three points a hypothesis, band 0.6 px, stops when 99.9 % sure or after 1000,
    then three rounds of least squares on the inliers.""",
    """**Open3D** 0.20 `segment_plane` in metres: band 3 cm (the best of 1, 2, 3, 5 and 10 cm on the committed roll sweep), 3 points, 1000 hypotheses.
    Cropped, each frame five times, because its answers differ from run to run
    in spite of a seed; the whole map only on the roll sweep and once, because it takes a second a frame.""",
    """*Cropped*: only what lies within 3 m sideways and 25 m ahead, the box that our free map cuts out. *2 x 4 grid*: one pixel in
    eight, those that our library looks at. Whoever gets one of these is in the group *helped by us*.""",
    """*instructions / ours*: counted with callgrind on every fourth frame, median of the ratios. Open3D is not counted.""",
]
PEER_FIGURE = """Accuracy and time on the roll sweep, both logarithmic. Down and to the left is better. Green: roadpose; orange: Hough lines; blue: RANSAC plane;
red: Open3D. Filled: as one would use them; hollow: helped by us."""
FALSE_ROADS = "Frames without any road: walls, fences, the back of a lorry, a ceiling, fog, noise, nothing."

ELSEWHERE = """All sets; *largest* is the largest pitch error of a frame that got a pose. On `speed-bump` the errors of the peers hold frames
that we refuse."""
ORACLE = """The oracle is a double-precision least-squares plane on the *true* road pixels of the same disparities, fitted again twice
without what is further than 0.6 px off: what a perfect choice of pixels reaches. Its own error is the matcher's. On the frames that we accepted. *Apart* is the mean absolute difference
between our pose and the oracle's in the corridor. On `dirt` it trips over the salt, on `crown` *all road* is no plane."""
HISTOGRAMS = "Errors of all accepted frames of all sets, default settings. Errors beyond the axis are counted in its last bar."
WORST = """The worst accepted frame of each set (errors in its title). Green: disparity within 0.6 px of the plane that was found; red: nearer
than the plane; blue: farther, up to 2.5 px; dashed yellow: the horizon that was found. In `no-road` no
frame was accepted."""
SENSITIVITY = """Mean absolute errors on `roll-sweep` and `level` while one thing is wrong: a constant added to every disparity, independent noise on top
of the matcher's, a wrong focal length, a wrong baseline. The bias adds to the matcher's own +0.03 px, so −0.05 px is better than 0.
With 1 px of added noise every frame is refused (`poor_fit`): less than half of the points are then within the band of 0.6 px, the setting
`noise_millipx`."""

VIEWER = """A build with OpenCV has one option more than `roadpose-replay`: `--pictures DIR` writes, for each frame of a recording, the left
image (or the disparity map where there is none) with the free map (green on the plane that was found, yellow off it), the corridor with a bar every
5 m, and the horizon, and beside it the v-disparity-free with the road profile."""
VIEWER_COMMAND = """cmake -S host_tests/evaluation -B build-evaluation
cmake --build build-evaluation --target roadpose-replay-pictures
build-evaluation/roadpose-replay-pictures --pictures pictures fixtures/yaw-images"""
