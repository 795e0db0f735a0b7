// roadpose-figure-data OUT RECORDING FRAME...: what the library has in its hands for these frames, as text that a plot
// can read: OUT/RECORDING-FRAME-{v_free,free,cloud,pose}.txt.
#include <cstdio>
#include <exception>
#include <fstream>

#include "measurement.hpp"
#include "ours.hpp"
#include "virtual_map.hpp"

namespace evaluation {
namespace {

using Path = std::string;

// On the sampling grid: one row of the histogram a line.
void write_v_disparity_free(const roadpose_t& instance, const Path& path) {
    std::ofstream file(path);
    for (std::uint16_t row = 0; row < instance.grid.rows; ++row)
        for (std::uint16_t level = 0; level < 128; ++level)
            file << roadpose_v_disparity_free(&instance, row, level) << (level == 127 ? '\n' : ' ');
}

// 1 = the sample has a disparity and lies in the free map and the widened corridor.
void write_free(const roadpose_t& instance, const Input& input, const Path& path) {
    std::ofstream file(path);
    for (int row = 0; row < instance.grid.rows; ++row)
        for (int column = 0; column < instance.grid.columns; ++column) {
            const float disparity = input.disparity(row * ROADPOSE_ROW_STEP, column * ROADPOSE_COLUMN_STEP);
            const bool is_free = disparity > 0 && roadpose_is_free(&instance, static_cast<std::uint16_t>(column),
                                                                  static_cast<std::uint16_t>(disparity));
            file << is_free << (column + 1 == instance.grid.columns ? '\n' : ' ');
        }
}

// Method 2's pairs as they are drawn, before its first stage keeps the agreeing ones: own slope, middle from the principal
// point, disparity; pixels.
void write_cloud(const roadpose_t& instance, const Path& path) {
    std::ofstream file(path);
    const roadpose_cloud_t& cloud = instance.work.cloud;
    for (int i = 0; i < cloud.pairs; ++i) {
        const double du = cloud.dx[i] * ROADPOSE_COLUMN_STEP, dv = cloud.dy[i] * ROADPOSE_ROW_STEP;
        const double u = cloud.x_sum[i] * ROADPOSE_COLUMN_STEP / 2.0 + instance.grid.du_millipx / 1000.0;
        const double v = cloud.y_sum[i] * ROADPOSE_ROW_STEP / 2.0 + instance.grid.dv_millipx / 1000.0;
        file << dv / du << ' ' << u << ' ' << v << ' ' << cloud.level_q8[i] / 256.0 << '\n';
    }
}

// Status and disparity plane of several candidates, so that Python need not know how they are made.
void write_poses(const recording_t& recording, const Input& input, const Path& path) {
    std::ofstream file(path);
    for (const Candidate& candidate : our_candidates(recording)) {
        const Answer answer = candidate.estimate(input);
        const DisparityPlane plane = benchmark::plane_of(answer.pose, input.rig());
        file << candidate.name << ';' << answer.status << ';' << answer.has_roll;
        if (answer.status == "ok") file << ';' << plane.a << ';' << plane.b << ';' << plane.c;
        file << '\n';
    }
}

void write_virtual(const Input& input, const Path& path) {
    const Answer answer = virtual_map_pose(input, MapPixels::free);
    const cv::Mat1f free = free_pixels(input.disparity, input.rig());
    const cv::Mat1f turned = turned_back(free, input.rig(), answer.pose.roll_deg * std::acos(-1.0) / 180);
    const cv::Mat1f turned_all = turned_back(input.disparity, input.rig(), answer.pose.roll_deg * std::acos(-1.0) / 180);
    std::ofstream file(path, std::ios::binary);  // three maps of 32-bit floats: free, free turned, all turned
    for (const cv::Mat1f& map : {free, turned, turned_all})
        file.write(reinterpret_cast<const char*>(map.data), static_cast<std::streamsize>(map.total() * sizeof(float)));
}

void write_all(const Path& out, const recording_t& recording, int index) {
    const Input input = load_input(recording, index);
    const Path stem = out + "/" + recording.name + "-" + std::to_string(index) + "-";
    Ours default_settings(recording, settings_of(2, true, 100)), method_2(recording, settings_of(2, false, 100));
    default_settings.process(input.native);
    method_2.draw_pairs(input.native);
    write_v_disparity_free(default_settings.instance(), stem + "v_free.txt");
    write_free(default_settings.instance(), input, stem + "free.txt");
    write_cloud(method_2.instance(), stem + "cloud.txt");
    write_poses(recording, input, stem + "pose.txt");
    write_virtual(input, stem + "virtual.bin");
}

}  // namespace
}  // namespace evaluation

int main(int argc, char** argv) {
    if (argc < 4) return std::fputs("usage: roadpose-figure-data OUT RECORDING FRAME...\n", stderr), 2;
    try {
        const benchmark::OpenRecording open(argv[2]);
        for (int i = 3; i < argc; ++i) evaluation::write_all(argv[1], open.recording, std::stoi(argv[i]));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-figure-data: %s\n", error.what());
        return 3;
    }
    return 0;
}
