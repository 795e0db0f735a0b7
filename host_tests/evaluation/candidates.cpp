#include "candidates.hpp"

#include <cmath>

#include "hough_peer.hpp"
#include "oracle.hpp"
#include "ours.hpp"
#include "plane_peer.hpp"
#include "virtual_map.hpp"

namespace evaluation {
namespace {

Answer oracle(const Input& input, bool corridor) {
    const benchmark::OracleOptions options{"", corridor, true};
    const std::optional<Pose> pose = benchmark::fit_true_road(input.frame, options);
    return pose ? Answer{"ok", true, *pose} : no_road();
}

void add_oracles(std::vector<Candidate>& all) {
    all.push_back({"oracle: true road", [](const Input& input) { return oracle(input, false); }});
    all.push_back({"oracle: true road in the corridor", [](const Input& input) { return oracle(input, true); }});
}

void add_comparators(std::vector<Candidate>& all) {
    all.push_back({"virtual disparity map", [](const Input& input) { return virtual_map_pose(input, MapPixels::all); }});
    all.push_back({"virtual free map", [](const Input& input) { return virtual_map_pose(input, MapPixels::free); }});
}

std::string name_of(const std::string& peer, bool cropped) { return peer + (cropped ? ", cropped" : ", whole map"); }

void add_hough(std::vector<Candidate>& all, const Samples& samples, bool cropped) {
    const auto add = [&](const std::string& name, const HoughOptions& options) {
        all.push_back({name_of("Hough: " + name, cropped),
                       [samples, options](const Input& input) { return hough_pose(input, samples, options); }});
    };
    if (!cropped) add("1 px, 1 degree", {1.0, 1.0, false});
    add("1 px, 1 degree, then least squares", {1.0, 1.0, true});
    add("0.5 px, 0.1 degree, then least squares", {0.5, 0.1, true});
}

void add_plane_ransac(std::vector<Candidate>& all, const Samples& samples, bool cropped) {
    for (const bool sparse : {false, true})
        all.push_back({name_of(std::string("RANSAC plane: ") + (sparse ? "2 x 4 grid" : "every pixel"), cropped),
                       [samples, sparse](const Input& input) { return plane_ransac_pose(input, samples, {sparse, 0.6}); }});
}

}  // namespace

bool is_within_limits(const Pose& pose) {
    return pose.pitch_deg >= -10 && pose.pitch_deg <= 15 && std::abs(pose.roll_deg) <= 25 && pose.height_m >= 0.3 &&
           pose.height_m <= 4;
}

Answer no_road() { return {"no_road", false, {}}; }

Answer answer_of(const DisparityPlane& plane, const recording_rig_t& rig) {
    const Pose pose = benchmark::pose_of(plane, rig);
    return is_within_limits(pose) ? Answer{"ok", true, pose} : no_road();
}

std::vector<Candidate> peer_candidates(const recording_t& recording) {
    std::vector<Candidate> all;
    for (const bool cropped : {false, true}) {
        const Samples samples(recording.rig, cropped);
        add_hough(all, samples, cropped);
        add_plane_ransac(all, samples, cropped);
    }
    return all;
}

std::vector<Candidate> all_candidates(const recording_t& recording) {
    std::vector<Candidate> all = our_candidates(recording);
    add_comparators(all);
    for (Candidate& peer : peer_candidates(recording)) all.push_back(std::move(peer));
    add_oracles(all);
    return all;
}

}  // namespace evaluation
