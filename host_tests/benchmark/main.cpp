// roadpose-benchmark RECORDING...: accuracy of the estimators on recordings, as Markdown tables on standard output.
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>

#include "estimators.hpp"
#include "oracle.hpp"
#include "tables.hpp"

namespace benchmark {
namespace {

const std::vector<OracleOptions> oracle_options = {
    {"least squares, all true road", false, false},
    {"least squares, true road in the corridor", true, false},
    {"trimmed least squares, all true road", false, true},
    {"trimmed least squares, true road in the corridor", true, true},
};

struct OpenRecording {
    recording_t recording;
    explicit OpenRecording(const char* folder) {
        if (!recording_open(&recording, folder)) throw std::runtime_error("unreadable recording");
    }
    ~OpenRecording() { recording_close(&recording); }
    OpenRecording(const OpenRecording&) = delete;
    OpenRecording& operator=(const OpenRecording&) = delete;
};

struct Results {
    std::vector<Row> rows;
    std::vector<OracleRow> oracles;
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

Results measure(const recording_t& recording, const std::vector<Estimator>& estimators, bool with_oracles) {
    Results results;
    std::vector<Runner> runners;
    for (const Estimator& estimator : estimators) {
        runners.emplace_back(recording, estimator.settings);
        results.rows.push_back({estimator.name, {}, estimator.roll_limit_deg});
    }
    for (const OracleOptions& options : oracle_options) results.oracles.push_back({options.name, {}});
    for (int index = 0; index < recording.frames; ++index) {
        const Frame frame = load_frame(recording, index);
        for (std::size_t i = 0; i < runners.size(); ++i) {
            if (!counts(results.rows[i], frame.truth)) continue;
            const roadpose_pose_t pose = runners[i].run(frame);
            results.rows[i].score.add(pose, frame.truth);
            if (i == 0 && with_oracles && pose.status == ROADPOSE_STATUS_OK) add_oracles(results.oracles, frame);
        }
    }
    return results;
}

bool has_true_poses(const recording_t& recording) {
    for (int i = 0; i < recording.frames; ++i)
        if (recording.truth[i].known && recording.truth[i].road) return true;
    return false;
}

Row report_recording(const char* folder) {
    const OpenRecording open(folder);
    const Results results = measure(open.recording, compared_estimators(), true);
    std::printf("## %s (%d frames)\n\n", open.recording.name, open.recording.frames);
    if (has_true_poses(open.recording)) {
        print_accuracy_table(results.rows, results.oracles);
        print_ratio_table(results.rows.front(), results.oracles);
    }
    print_stability_table(results.rows);
    print_status_table(results.rows);
    std::fflush(stdout);
    return {open.recording.name, results.rows.front().score, 0};
}

void report_shares(const char* folder) {
    const OpenRecording open(folder);
    if (!has_true_poses(open.recording)) return;
    std::printf("## %s: share of the points that Method 2 pairs\n\n", open.recording.name);
    print_accuracy_table(measure(open.recording, shares_of_points(), false).rows, {});
}

void report(int count, char** folders) {
    std::vector<Row> summary;
    for (int i = 0; i < count; ++i) summary.push_back(report_recording(folders[i]));
    if (count > 0) report_shares(folders[0]);
    std::puts("## All recordings, default settings\n");
    print_accuracy_table(summary, {});
    print_status_table(summary);
    std::printf("Memory of one instance: %zu bytes with this program's limits (%d x %d, %d px).\n",
                roadpose_state_bytes(), ROADPOSE_MAX_WIDTH, ROADPOSE_MAX_HEIGHT, ROADPOSE_MAX_DISPARITY);
}

}  // namespace
}  // namespace benchmark

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: roadpose-benchmark RECORDING...\n");
        return 2;
    }
    try {
        benchmark::report(argc - 1, argv + 1);
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "roadpose-benchmark: %s\n", problem.what());
        return 3;
    }
    return 0;
}
