#include "recording.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "disparity_samples.hpp"

namespace fixtures {
namespace {

std::ofstream open_for_writing(const std::filesystem::path& path) {
    std::ofstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot write " + path.string());
    return file;
}

void write_pgm16(const std::filesystem::path& path, const cv::Mat& samples) {
    std::ofstream file = open_for_writing(path);
    file << "P5\n" << samples.cols << ' ' << samples.rows << "\n65535\n";
    std::vector<char> line(static_cast<std::size_t>(samples.cols) * 2);
    for (int row = 0; row < samples.rows; ++row) {
        for (int column = 0; column < samples.cols; ++column) {
            const std::uint16_t sample = samples.at<std::uint16_t>(row, column);
            line[2 * column] = static_cast<char>(sample >> 8);
            line[2 * column + 1] = static_cast<char>(sample & 255);
        }
        file.write(line.data(), static_cast<std::streamsize>(line.size()));
    }
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void write_pbm(const std::filesystem::path& path, const cv::Mat& mask) {
    std::ofstream file = open_for_writing(path);
    file << "P4\n" << mask.cols << ' ' << mask.rows << '\n';
    std::vector<char> line(static_cast<std::size_t>(mask.cols + 7) / 8);
    for (int row = 0; row < mask.rows; ++row) {
        std::fill(line.begin(), line.end(), char{0});
        for (int column = 0; column < mask.cols; ++column)
            if (mask.at<std::uint8_t>(row, column)) line[column / 8] |= static_cast<char>(128 >> (column % 8));
        file.write(line.data(), static_cast<std::streamsize>(line.size()));
    }
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void write_rig(const std::filesystem::path& path, const Rig& rig) {
    char text[400];
    std::snprintf(text, sizeof text,
                  "%%YAML:1.0\n---\nwidth: %d\nheight: %d\nfocal_px: %.1f\ncu_px: %.1f\ncv_px: %.1f\nbaseline_m: %.2f\n"
                  "disparity_scale: %d\ninvalid: 0\ndisparity_offset_px: 0.0\nrate_hz: 10.0\n",
                  rig.width, rig.height, rig.focal_px, rig.cu_px, rig.cv_px, rig.baseline_m, disparity_scale);
    open_for_writing(path) << text;
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& folder, const Rig& rig) : folder_(folder) {
    std::filesystem::remove_all(folder / "disparity");  // frames of an earlier, longer run must not survive
    std::filesystem::remove_all(folder / "road");
    std::filesystem::create_directories(folder / "disparity");
    write_rig(folder / "rig.yml", rig);
    truth_ = open_for_writing(folder / "truth.csv");
    truth_ << "frame,road,pitch_deg,roll_deg,height_m,scene\n";
}

void RecordingWriter::add_road_frame(const cv::Mat& disparity, const cv::Mat& road, const RoadPlane& truth,
                                     const std::string& scene) {
    std::filesystem::create_directories(folder_ / "road");
    write_pbm(folder_ / "road" / frame_name("pbm"), road);
    char numbers[100];
    std::snprintf(numbers, sizeof numbers, "%d,1,%.8f,%.8f,%.8f,", frame_, degrees(truth.pitch()), degrees(truth.roll()),
                  truth.height);
    truth_ << numbers << scene << '\n' << std::flush;
    write_disparity(disparity);
}

void RecordingWriter::add_frame_without_road(const cv::Mat& disparity, const std::string& scene) {
    truth_ << frame_ << ",0,,,," << scene << '\n' << std::flush;
    write_disparity(disparity);
}

void RecordingWriter::write_disparity(const cv::Mat& disparity) {
    write_pgm16(folder_ / "disparity" / frame_name("pgm"), disparity);
    ++frame_;
}

std::string RecordingWriter::frame_name(const char* extension) const {
    char name[32];
    std::snprintf(name, sizeof name, "%06d.%s", frame_, extension);
    return name;
}

}  // namespace fixtures
