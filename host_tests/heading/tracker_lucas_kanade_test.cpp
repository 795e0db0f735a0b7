// Yaw from our tracker beside yaw from OpenCV's pyramidal Lucas-Kanade tracks of the same rendered frames.
// tracker_lucas_kanade_test FIXTURES
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "drive_simulation.h"
#include "roadpose/heading.h"
#include "roadpose/tracker.h"

namespace {

constexpr int frames = 21;
const simulated_rig_t rig{320, 240, 250, 159.5, 119.5, 0.30};
const simulated_mount_t mount{radians_of(2), radians_of(3), radians_of(2), 1.5};

struct Score {
    double error = 0, worst = 0, tracks = 0, distance = 0;
    int accepted = 0;
};

using Tracks = std::vector<roadpose_track_t>;

cv::Mat left_image(const std::string& folder, int frame) {
    char name[64];
    std::snprintf(name, sizeof name, "/yaw-images/left/%06d.pgm", frame);
    return cv::imread(folder + name, cv::IMREAD_GRAYSCALE);
}

roadpose_grey_t grey(const cv::Mat& image) {
    return {image.data, static_cast<std::uint32_t>(image.step), static_cast<std::uint16_t>(image.cols),
            static_cast<std::uint16_t>(image.rows)};
}

Tracks ours(const cv::Mat& previous, const cv::Mat& present) {
    static roadpose_tracker_t tracker;
    Tracks tracks(ROADPOSE_TRACKER_CELLS);
    std::size_t count = 0;
    const roadpose_grey_t before = grey(previous), now = grey(present);
    if (roadpose_tracker_init(&tracker, nullptr) != ROADPOSE_OK ||
        roadpose_tracker_track(&tracker, &before, &now, tracks.data(), tracks.size(), &count) != ROADPOSE_OK)
        std::puts("the tracker refuses the images");
    tracks.resize(count);
    return tracks;
}

// Forward and backward, kept where that comes back within half a pixel.
Tracks theirs(const cv::Mat& previous, const cv::Mat& present) {
    std::vector<cv::Point2f> before, now, back;
    std::vector<std::uint8_t> found, found_back;
    std::vector<float> error;
    cv::goodFeaturesToTrack(previous, before, ROADPOSE_TRACKER_CELLS, 0.005, 8);
    cv::calcOpticalFlowPyrLK(previous, present, before, now, found, error);
    cv::calcOpticalFlowPyrLK(present, previous, now, back, found_back, error);
    Tracks tracks;
    for (std::size_t i = 0; i < before.size(); ++i)
        if (found[i] && found_back[i] && std::hypot(back[i].x - before[i].x, back[i].y - before[i].y) < 0.5)
            tracks.push_back({cvRound(256 * before[i].x), cvRound(256 * before[i].y), cvRound(256 * now[i].x),
                              cvRound(256 * now[i].y)});
    return tracks;
}

void add(Score& score, const Tracks& tracks) {
    static roadpose_heading_t heading;
    const roadpose_rig_t library = library_rig(&rig);
    std::int32_t normal[3];
    roadpose_motion_t motion{};
    roadpose_yaw_t yaw;
    motion.interval_us = 100000;
    motion.has_yaw_rate = true;
    mount_normal_q30(&mount, normal);
    roadpose_heading_init(&heading, &library, nullptr);
    roadpose_heading_process(&heading, tracks.data(), tracks.size(), &motion, normal, &yaw);
    score.tracks += static_cast<double>(tracks.size()) / (frames - 1);
    if (yaw.status != ROADPOSE_YAW_OK) return;
    const double error = std::fabs(degrees_of(1e-6 * yaw.yaw_urad - mount.yaw));
    ++score.accepted;
    score.error += error;
    score.worst = std::max(score.worst, error);
}

void print(const char* name, const Score& score) {
    std::printf("| %s | %.0f | %d of %d | %.3f | %.3f |\n", name, score.tracks, score.accepted, frames - 1,
                score.error / score.accepted, score.worst);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    Score own, other;
    for (int i = 1; i < frames; ++i) {
        const cv::Mat previous = left_image(argv[1], i - 1), present = left_image(argv[1], i);
        if (previous.empty() || present.empty()) {
            std::printf("FAIL: %s/yaw-images/left has no frame %d\n", argv[1], i);
            return 1;
        }
        add(own, ours(previous, present));
        add(other, theirs(previous, present));
    }
    std::puts("| tracks by | mean number | accepted | mean error, degrees | worst |\n|---|---|---|---|---|");
    print("our tracker", own);
    print("OpenCV, pyramidal Lucas-Kanade", other);
    const bool good = own.accepted >= (frames - 1) / 2 && other.accepted > 0 &&
                      own.error / own.accepted <= 1.5 * other.error / other.accepted;
    std::puts(good ? "OK" : "FAIL: over 1.5 times the error of OpenCV's tracks, or too few frames");
    return good ? 0 : 1;
}
