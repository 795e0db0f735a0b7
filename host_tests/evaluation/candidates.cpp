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

void add_hough(std::vector<Candidate>& all, const std::string& name, HoughOptions options) {
    all.push_back({"Hough: " + name, [options](const Input& input) { return hough_pose(input, options); }});
}

void add_plane_ransac(std::vector<Candidate>& all, const std::string& name, PlaneRansacOptions options) {
    all.push_back({"RANSAC plane: " + name, [options](const Input& input) { return plane_ransac_pose(input, options); }});
}

void add_peers(std::vector<Candidate>& all) {
    add_hough(all, "1 px, 1 degree", {1.0, 1.0, false, false});
    add_hough(all, "1 px, 1 degree, then least squares, cropped", {1.0, 1.0, true, true});
    add_hough(all, "0.5 px, 0.1 degree, then least squares", {0.5, 0.1, true, false});
    add_hough(all, "0.5 px, 0.1 degree, then least squares, cropped", {0.5, 0.1, true, true});
    for (const bool cropped : {false, true})
        for (const bool sparse : {false, true})
            add_plane_ransac(all, std::string(cropped ? "cropped" : "whole map") + (sparse ? ", 2 x 4 grid" : ", every pixel"),
                             {cropped, sparse, 0.6});
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

std::vector<Candidate> all_candidates(const recording_t& recording) {
    std::vector<Candidate> all = our_candidates(recording);
    add_comparators(all);
    add_peers(all);
    add_oracles(all);
    return all;
}

}  // namespace evaluation
