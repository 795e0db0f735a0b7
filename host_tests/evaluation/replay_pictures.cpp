// roadpose-replay --pictures DIR: for each frame the free map, the corridor, the horizon and the road profile.
//   green: in the free map and on the plane; yellow: in the free map, off the plane; cyan lines: the corridor with a bar
//   every 5 m; white dashes: horizon; right: v-disparity-free with the road profile of the middle column in red.
#include "pictures.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "road_view.hpp"

extern "C" {
#include "fault.h"
}

namespace evaluation {
namespace {

namespace fs = std::filesystem;

const cv::Scalar green(60, 200, 60), yellow(40, 220, 230), cyan(230, 200, 40), white(255, 255, 255), red(40, 40, 235);
constexpr double on_plane_px = 0.6;
constexpr int panel_scale = 2, panel_levels = 128;  // of the v-disparity

// Pixels; 0 = no match. The samples of a recording have their disparity from bit 0 on.
double decode(const picture_t& picture, int u, int v) {
    const std::size_t at = 2 * (static_cast<std::size_t>(v) * picture.rig->width_px + u);
    const unsigned sample = picture.samples[at] << 8 | picture.samples[at + 1];
    const roadpose_disparity_format_t& format = *picture.format;
    if (format.has_invalid && sample >= format.invalid_first && sample <= format.invalid_last) return 0;
    return std::max(0.0, std::ldexp(sample, -format.fraction_bits) + format.offset_millipx / 1e3);
}

cv::Mat disparity_as_grey(const picture_t& picture) {
    cv::Mat1b grey(picture.rig->height_px, picture.rig->width_px);
    for (int v = 0; v < grey.rows; ++v)
        for (int u = 0; u < grey.cols; ++u) grey(v, u) = cv::saturate_cast<uchar>(3 * decode(picture, u, v));
    return grey;
}

// The recording's left image of this frame, or the disparity map as grey levels.
cv::Mat3b background(const picture_t& picture) {
    const fs::path stem = fs::path(picture.disparity_path).stem();
    cv::Mat grey;
    for (const char* extension : {".png", ".pgm", ".jpg"}) {
        const fs::path left = fs::path(picture.recording) / "left" / (stem.string() + extension);
        if (fs::exists(left)) grey = cv::imread(left.string(), cv::IMREAD_GRAYSCALE);
    }
    if (grey.rows != picture.rig->height_px || grey.cols != picture.rig->width_px) grey = disparity_as_grey(picture);
    cv::Mat3b image;
    cv::cvtColor(grey, image, cv::COLOR_GRAY2BGR);
    return image;
}

void tint(cv::Mat3b& image, const cv::Rect& cell, const cv::Scalar& colour) {
    cv::Mat part = image(cell & cv::Rect(0, 0, image.cols, image.rows));
    cv::addWeighted(part, 0.65, cv::Mat(part.size(), part.type(), colour), 0.35, 0, part);
}

// One cell for each sample of the library's grid.
void draw_free_map(cv::Mat3b& image, const picture_t& picture, const RoadView* road) {
    for (int v = 0; v < image.rows; v += ROADPOSE_ROW_STEP)
        for (int u = 0; u < image.cols; u += ROADPOSE_COLUMN_STEP) {
            const double disparity = decode(picture, u, v);
            if (disparity == 0 || !roadpose_is_free(picture.estimator, static_cast<std::uint16_t>(u / ROADPOSE_COLUMN_STEP),
                                                    static_cast<std::uint16_t>(disparity)))
                continue;
            const bool on_plane = road && std::abs(disparity - road->disparity(u, v)) <= on_plane_px;
            tint(image, {u, v, ROADPOSE_COLUMN_STEP, ROADPOSE_ROW_STEP}, on_plane ? green : yellow);
        }
}

void draw_line(cv::Mat3b& image, const std::optional<cv::Point2d>& from, const std::optional<cv::Point2d>& to) {
    if (from && to) cv::line(image, *from, *to, cyan, 1, cv::LINE_AA);
}

void draw_corridor(cv::Mat3b& image, const RoadView& road, const roadpose_settings_t& settings) {
    const double half = settings.corridor_half_width_mm > 0 ? settings.corridor_half_width_mm / 1e3 : 10;
    const double range = settings.corridor_range_mm > 0 ? settings.corridor_range_mm / 1e3 : 50;
    for (const double aside : {-half, half})
        for (double ahead = 0.5; ahead < range; ahead += 0.5)
            draw_line(image, road.at(ahead, aside), road.at(std::min(ahead + 0.5, range), aside));
    for (double ahead = 5; ahead <= range; ahead += 5) draw_line(image, road.at(ahead, -half), road.at(ahead, half));
}

void draw_horizon(cv::Mat3b& image, const RoadView& road) {
    for (int u = 0; u < image.cols; u += 16)
        cv::line(image, cv::Point2d(u, road.horizon_row(u)), cv::Point2d(u + 8, road.horizon_row(u + 8)), white, 1, cv::LINE_AA);
}

void write_words(cv::Mat3b& image, const picture_t& picture, const roadpose_pose_t& pose) {
    const auto degrees = [](std::int32_t urad) { return urad * 1e-6 * 180 / CV_PI; };
    const std::string status = roadpose_status_word(pose.status);
    std::string text = fs::path(picture.disparity_path).stem().string() + "  " + status;
    if (pose.status == ROADPOSE_STATUS_OK)
        text += cv::format("  pitch %+.2f  roll %+.2f  height %.3f m", degrees(pose.pitch_urad), degrees(pose.roll_urad),
                           pose.height_um * 1e-6);
    const double width = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, nullptr).width;
    const double size = 0.5 * std::min(1.0, (image.cols - 16) / width);  // so that all of it fits in a narrow image
    cv::putText(image, text, {8, 20}, cv::FONT_HERSHEY_SIMPLEX, size, {0, 0, 0}, 3, cv::LINE_AA);
    cv::putText(image, text, {8, 20}, cv::FONT_HERSHEY_SIMPLEX, size, white, 1, cv::LINE_AA);
}

// White on black; columns are disparities, rows those of the image.
cv::Mat3b profile_panel(const picture_t& picture, const RoadView* road) {
    cv::Mat3b panel(picture.rig->height_px, panel_levels * panel_scale, cv::Vec3b(0, 0, 0));
    for (int v = 0; v < panel.rows; ++v)
        for (int x = 0; x < panel.cols; ++x) {
            const int count = roadpose_v_disparity_free(picture.estimator, static_cast<std::uint16_t>(v / ROADPOSE_ROW_STEP),
                                                        static_cast<std::uint16_t>(x / panel_scale));
            panel(v, x) = cv::Vec3b::all(cv::saturate_cast<uchar>(count ? 60 + 50 * std::log(count) : 0));
        }
    const double middle = picture.rig->cu_millipx / 1e3;
    for (int d = 0; road && d < panel_levels; d += 4)
        cv::line(panel, cv::Point2d(panel_scale * d, road->row_of(middle, d)),
                 cv::Point2d(panel_scale * (d + 2), road->row_of(middle, d + 2)), red, 1, cv::LINE_AA);
    return panel;
}

cv::Mat3b draw(const picture_t& picture, const roadpose_pose_t& pose) {
    std::optional<RoadView> road;
    if (pose.status == ROADPOSE_STATUS_OK) road.emplace(*picture.rig, pose);
    cv::Mat3b image = background(picture), both;
    draw_free_map(image, picture, road ? &*road : nullptr);
    if (road) {
        draw_corridor(image, *road, picture.estimator->settings);
        draw_horizon(image, *road);
    }
    write_words(image, picture, pose);
    cv::hconcat(image, profile_panel(picture, road ? &*road : nullptr), both);
    return both;
}

}  // namespace
}  // namespace evaluation

bool pictures_open(const char* folder) {
    if (!folder) return true;
    cv::setNumThreads(1);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    return !error || fault(folder, "cannot be made: %s", error.message().c_str());
}

bool pictures_draw(const picture_t* picture) {
    roadpose_pose_t pose;
    if (roadpose_frame_pose(picture->estimator, &pose) != ROADPOSE_OK)
        return fault(picture->disparity_path, "has no result to draw");
    const std::filesystem::path stem = std::filesystem::path(picture->disparity_path).stem();
    const std::string path = (std::filesystem::path(picture->folder) / (stem.string() + ".png")).string();
    try {
        if (cv::imwrite(path, evaluation::draw(*picture, pose))) return true;
    } catch (const cv::Exception& error) {
        return fault(path.c_str(), "cannot be written: %s", error.what());
    }
    return fault(path.c_str(), "cannot be written");
}
