// roadpose-benchmark RECORDING...: accuracy of the estimators on recordings, as Markdown tables on standard output.
#include <cstdio>
#include <exception>

#include "measurement.hpp"
#include "tables.hpp"

namespace benchmark {
namespace {

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
