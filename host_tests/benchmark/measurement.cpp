#include "measurement.hpp"

#include <stdexcept>

namespace benchmark {
namespace {

const std::vector<OracleOptions> oracle_options = {
    {"least squares, all true road", false, false},
    {"least squares, true road in the corridor", true, false},
    {"trimmed least squares, all true road", false, true},
    {"trimmed least squares, true road in the corridor", true, true},
};

bool counts(const Row& row, const recording_truth_t& truth) {
    return row.roll_limit_deg == 0 || (truth.known && truth.road && std::abs(truth.roll_deg) < row.roll_limit_deg);
}

void add_oracles(std::vector<OracleRow>& oracles, const Frame& frame) {
    for (std::size_t i = 0; i < oracles.size(); ++i) {
        const std::optional<Pose> pose = fit_true_road(frame, oracle_options[i]);
        if (pose) oracles[i].errors.add(*pose, {frame.truth.pitch_deg, frame.truth.roll_deg, frame.truth.height_m});
    }
}

void add_frame(Results& results, std::vector<Runner>& runners, const Frame& frame, bool with_oracles) {
    for (std::size_t i = 0; i < runners.size(); ++i) {
        if (!counts(results.rows[i], frame.truth)) continue;
        const roadpose_pose_t pose = runners[i].run(frame);
        results.rows[i].score.add(pose, frame.truth);
        if (i == 0 && with_oracles && pose.status == ROADPOSE_STATUS_OK) add_oracles(results.oracles, frame);
    }
}

}  // namespace

void Results::add(const Results& more) {
    if (rows.empty()) {
        *this = more;
        return;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].score.errors.add(more.rows[i].score.errors);
    for (std::size_t i = 0; i < oracles.size(); ++i) oracles[i].errors.add(more.oracles[i].errors);
}

OpenRecording::OpenRecording(const char* folder) {
    if (!recording_open(&recording, folder)) throw std::runtime_error("unreadable recording");
}

OpenRecording::~OpenRecording() { recording_close(&recording); }

Results measure(const recording_t& recording, const std::vector<Estimator>& estimators, bool with_oracles) {
    Results results;
    std::vector<Runner> runners;
    for (const Estimator& estimator : estimators) {
        runners.emplace_back(recording, estimator.settings);
        results.rows.push_back({estimator.name, {}, estimator.roll_limit_deg});
    }
    for (const OracleOptions& options : oracle_options) results.oracles.push_back({options.name, {}});
    for (int index = 0; index < recording.frames; ++index)
        add_frame(results, runners, load_frame(recording, index), with_oracles);
    return results;
}

bool has_true_poses(const recording_t& recording) {
    for (int i = 0; i < recording.frames; ++i)
        if (recording.truth[i].known && recording.truth[i].road) return true;
    return false;
}

}  // namespace benchmark
