// roadpose-make-yaw-fixtures OUT_DIR: writes the recordings yaw-*: tracks of simulated drives, and a rendered drive for
// the tracker. The road of each is one exact plane that does not change, so all its disparity frames are links to one.
#include <opencv2/core.hpp>

#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "drive_simulation.h"
#include "renderer.hpp"
#include "street.hpp"

namespace {

namespace files = std::filesystem;


struct Drive {
    std::string name;
    simulated_rig_t rig;
    simulated_mount_t mount;
    bool has_vehicle;
    std::vector<simulated_step_t> steps;  // to each frame from the one before; the first is not used
};

std::ofstream open_for_writing(const files::path& path) {
    std::ofstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot write " + path.string());
    return file;
}

template <typename... Values>
std::string text(const char* format, Values... values) {
    char line[400];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

std::string frame_name(std::size_t frame, const char* ending) { return text("%06zu.%s", frame, ending); }

void write_rig(const files::path& path, const simulated_rig_t& rig) {
    open_for_writing(path) << text("%%YAML:1.0\n---\n# exact planes, written by roadpose-make-yaw-fixtures\nwidth: %.0f\n"
                                   "height: %.0f\nfocal_px: %.1f\ncu_px: %.1f\ncv_px: %.1f\nbaseline_m: %.2f\n"
                                   "disparity_scale: 256\ninvalid: 0\nrate_hz: 10.0\n",
                                   rig.width, rig.height, rig.focal_px, rig.cu_px, rig.cv_px, rig.baseline_m);
}

// Disparity of the road plane: B / h times normal times (u - cu, v - cv, f).
void write_plane(const files::path& path, const simulated_rig_t& rig, const simulated_mount_t& mount) {
    double normal[3];
    mount_normal(&mount, normal);
    std::ofstream file = open_for_writing(path);
    file << text("P5\n%.0f %.0f\n65535\n", rig.width, rig.height);
    for (int v = 0; v < rig.height; ++v)
        for (int u = 0; u < rig.width; ++u) {
            const double d = rig.baseline_m / mount.height_m *
                             (normal[0] * (u - rig.cu_px) + normal[1] * (v - rig.cv_px) + normal[2] * rig.focal_px);
            const long sample = d > 0 && d < 128 ? std::lround(256 * d) : 0;
            file.put(static_cast<char>(sample >> 8)).put(static_cast<char>(sample & 255));
        }
}

void write_disparity(const files::path& folder, const Drive& drive) {
    files::create_directories(folder);
    write_plane(folder / frame_name(0, "pgm"), drive.rig, drive.mount);
    for (std::size_t i = 1; i < drive.steps.size(); ++i)
        files::create_symlink(frame_name(0, "pgm"), folder / frame_name(i, "pgm"));
}

void write_truth(const files::path& path, const Drive& drive) {
    double normal[3];
    mount_normal(&drive.mount, normal);
    std::ofstream file = open_for_writing(path);
    file << "frame,road,pitch_deg,roll_deg,height_m,yaw_deg,moved_m,yaw_rate_deg_s,noise_px,outlier_share\n";
    for (std::size_t i = 0; i < drive.steps.size(); ++i) {
        const simulated_step_t& step = drive.steps[i];
        file << text("%zu,1,%.6f,%.6f,%.6f,%.6f,%.4f,%.4f,%.2f,%.2f\n", i, degrees_of(drive.mount.pitch),
                     degrees_of(drive.mount.roll), drive.mount.height_m, degrees_of(drive.mount.yaw), step.moved_m,
                     degrees_of(step.turn) * 10, step.noise_px, step.outlier_share);
    }
}

// The mean of two frames must be what happened between them, so speeds and yaw rates change slowly.
void write_vehicle(const files::path& path, const Drive& drive) {
    std::ofstream file = open_for_writing(path);
    file << "frame,time_s,speed_m_s,yaw_rate_deg_s\n";
    for (std::size_t i = 0; i < drive.steps.size(); ++i)
        file << text("%zu,%.1f,%.3f,%.4f\n", i, 0.1 * static_cast<double>(i), drive.steps[i].moved_m * 10,
                     degrees_of(drive.steps[i].turn) * 10);
}

// still/: 1 for the tracks that are true matches on something that stands still.
void write_tracks(const files::path& folder, const Drive& drive, random_numbers_t* random) {
    files::create_directories(folder / "tracks");
    files::create_directories(folder / "still");
    for (std::size_t i = 1; i < drive.steps.size(); ++i) {
        simulated_tracks_t tracks;
        simulate_tracks(&tracks, &drive.rig, &drive.mount, &drive.steps[i], random);
        std::ofstream file = open_for_writing(folder / "tracks" / frame_name(i, "csv"));
        std::ofstream still = open_for_writing(folder / "still" / frame_name(i, "csv"));
        file << "u0,v0,u1,v1\n";
        still << "still\n";
        for (int k = 0; k < tracks.count; ++k) {
            const simulated_track_t& t = tracks.track[k];
            file << text("%.3f,%.3f,%.3f,%.3f\n", t.u0 + drive.rig.cu_px, t.v0 + drive.rig.cv_px, t.u1 + drive.rig.cu_px,
                         t.v1 + drive.rig.cv_px);
            still << t.still << '\n';
        }
    }
}

void write_left(const files::path& folder, const Drive& drive) {
    files::create_directories(folder);
    fixtures::Lcg random(20240807);
    fixtures::StreetStyle style;
    style.vehicle_ahead_share = 0;
    const fixtures::Scene scene = fixtures::street(style, random);
    fixtures::Rig rig;
    rig.width = static_cast<int>(drive.rig.width);
    rig.height = static_cast<int>(drive.rig.height);
    rig.focal_px = drive.rig.focal_px;
    rig.cu_px = drive.rig.cu_px;
    rig.cv_px = drive.rig.cv_px;
    rig.baseline_m = drive.rig.baseline_m;
    rig.disparity_range = 16;
    fixtures::Pose pose{drive.mount.pitch, drive.mount.roll, drive.mount.yaw, {0, 0, drive.mount.height_m}};
    for (std::size_t i = 0; i < drive.steps.size(); ++i) {
        pose.position[0] += i == 0 ? 0 : drive.steps[i].moved_m;
        const fixtures::StereoPair pair = fixtures::render(scene, rig, pose, {1.2, 1.0, i + 1});
        std::ofstream file = open_for_writing(folder / frame_name(i, "pgm"));
        file << text("P5\n%d %d\n255\n", rig.width, rig.height);
        for (int row = 0; row < rig.height; ++row)
            file.write(reinterpret_cast<const char*>(pair.left.ptr(row) + pair.padding), rig.width);
    }
}

void write_recording(const files::path& out, const Drive& drive, bool images, std::uint64_t seed) {
    const files::path folder = out / drive.name;
    random_numbers_t random{seed};
    files::remove_all(folder);
    files::create_directories(folder);
    write_rig(folder / "rig.yml", drive.rig);
    write_disparity(folder / "disparity", drive);
    write_truth(folder / "truth.csv", drive);
    if (drive.has_vehicle) write_vehicle(folder / "vehicle.csv", drive);
    if (images) write_left(folder / "left", drive);
    else write_tracks(folder, drive, &random);
    std::printf("%s: %zu frames\n", drive.name.c_str(), drive.steps.size());
}

simulated_mount_t mount(double pitch, double roll, double yaw, double height) {
    return {radians_of(pitch), radians_of(roll), radians_of(yaw), height};
}

// Every noise of 0.1 ... 0.5 px with every share of outliers of 0 ... 50 %.
std::vector<simulated_step_t> mixed_steps(double moved) {
    static const double shares[] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.45, 0.25};
    std::vector<simulated_step_t> steps{{moved, 0, 0.3, 0.2, 0}};
    for (int i = 0; i < 40; ++i) steps.push_back({moved + 0.15 * std::sin(0.2 * i), 0, 0.1 + 0.1 * (i % 5), shares[i / 5], 150});
    return steps;
}

// Straight, a bend to the left, straight, a bend to the right, straight; in the bends 5.5 ... 13 degrees a second.
std::vector<simulated_step_t> winding_steps() {
    std::vector<simulated_step_t> steps;
    for (int i = 0; i <= 50; ++i) {
        const double bend = std::sin(2 * 3.14159265358979 * i / 50), sharp = std::fabs(bend) - 0.7;
        const double rate = sharp < 0 ? 0 : (5.5 + 25 * sharp) * (bend > 0 ? 1 : -1);
        steps.push_back({1.1, radians_of(rate / 10), 0.2, 0.2, 150});
    }
    return steps;
}

void write_all(const files::path& out) {
    const simulated_rig_t small{320, 240, 250, 159.5, 119.5, 0.30};
    const std::vector<simulated_step_t> even(21, {1.0, 0, 0, 0, 0});
    write_recording(out, {"yaw-left", SIMULATED_RIG, mount(3, -4, 5, 1.4), true, mixed_steps(1.2)}, false, 11);
    write_recording(out, {"yaw-right", SIMULATED_RIG, mount(-2, 6, -5, 1.6), false, mixed_steps(0.95)}, false, 12);
    write_recording(out, {"yaw-winding", SIMULATED_RIG, mount(1, 2, 1.5, 1.5), false, winding_steps()}, false, 13);
    write_recording(out, {"yaw-images", small, mount(2, 3, 2, 1.5), true, even}, true, 14);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: roadpose-make-yaw-fixtures OUT_DIR\n");
        return 2;
    }
    try {
        write_all(argv[1]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "roadpose-make-yaw-fixtures: %s\n", error.what());
        return 1;
    }
}
