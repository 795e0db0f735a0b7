#include "tables.hpp"

#include <cstdio>

#include "roadpose/roadpose.h"

namespace benchmark {
namespace {

void print_errors(const char* format, const Errors& errors) {
    std::printf(format, errors.mean_absolute(), errors.mean(), errors.deviation(), errors.worst());
}

void print_accuracy_row(const std::string& name, const PoseErrors& errors) {
    std::printf("| %s | %d ", name.c_str(), errors.count());
    if (errors.count() == 0) {
        std::puts("| – | – | – |");
        return;
    }
    print_errors("| %.4f (%+.4f, %.4f, %.3f) ", errors.pitch);
    print_errors("| %.4f (%+.4f, %.4f, %.3f) ", errors.roll);
    print_errors("| %.2f (%+.2f, %.2f, %.1f) |\n", errors.height);
}

double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0; }

void print_ratio(double ours, double oracle) {
    if (oracle > 0) std::printf("| %.2f ", ours / oracle);
    else std::printf("| – ");
}

void print_status_counts(const char* name, const char* frames, const std::array<int, ROADPOSE_STATUS_COUNT>& counts,
                         int all) {
    if (all == 0) return;
    std::printf("| %s | %s | %d | %.1f %% ", name, frames, all, percent(counts[0], all));
    for (int status = 1; status < ROADPOSE_STATUS_COUNT; ++status) std::printf("| %d ", counts[status]);
    std::puts("|");
}

}  // namespace

void print_accuracy_table(const std::vector<Row>& rows, const std::vector<OracleRow>& oracles) {
    std::puts("Each cell: mean absolute error (mean, standard deviation, largest).\n");
    std::puts("| estimator | frames | pitch ° | roll ° | height mm |\n|---|---:|---|---|---|");
    for (const Row& row : rows) print_accuracy_row(row.name, row.score.errors);
    for (const OracleRow& oracle : oracles)
        if (oracle.errors.count() > 0) print_accuracy_row(oracle.name, oracle.errors);
    std::puts("| the paper reports | – | 0.20 | 0.38 | 12 |\n");
}

void print_ratio_table(const Row& first, const std::vector<OracleRow>& oracles) {
    if (oracles.empty() || oracles.front().errors.count() == 0) return;
    std::puts("| mean absolute error of the default, divided by that of | pitch | roll | height |\n|---|---:|---:|---:|");
    const PoseErrors& ours = first.score.errors;
    for (const OracleRow& oracle : oracles) {
        std::printf("| %s ", oracle.name.c_str());
        print_ratio(ours.pitch.mean_absolute(), oracle.errors.pitch.mean_absolute());
        print_ratio(ours.roll.mean_absolute(), oracle.errors.roll.mean_absolute());
        print_ratio(ours.height.mean_absolute(), oracle.errors.height.mean_absolute());
        std::puts("|");
    }
    std::puts("");
}

void print_stability_table(const std::vector<Row>& rows) {
    if (rows.front().score.spread.count() == 0) return;
    std::puts("No true pose is known. Each cell: mean, standard deviation; largest jump from frame to frame.\n");
    std::puts("| estimator | frames | pitch ° | roll ° | height mm |\n|---|---:|---|---|---|");
    for (const Row& row : rows) {
        const PoseErrors &spread = row.score.spread, &jumps = row.score.jumps;
        std::printf("| %s | %d ", row.name.c_str(), spread.count());
        std::printf("| %.4f, %.4f; %.3f ", spread.pitch.mean(), spread.pitch.deviation(), jumps.pitch.worst());
        std::printf("| %.4f, %.4f; %.3f ", spread.roll.mean(), spread.roll.deviation(), jumps.roll.worst());
        std::printf("| %.1f, %.2f; %.1f |\n", spread.height.mean(), spread.height.deviation(), jumps.height.worst());
    }
    std::puts("");
}

void print_status_table(const std::vector<Row>& rows) {
    std::printf("| recording | frames | number | accepted ");
    for (int status = 1; status < ROADPOSE_STATUS_COUNT; ++status)
        std::printf("| %s ", roadpose_status_word(static_cast<std::uint8_t>(status)));
    std::puts("|\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (const Row& row : rows) {
        print_status_counts(row.name.c_str(), "with road", row.score.road_status, row.score.road_frames());
        print_status_counts(row.name.c_str(), "without road", row.score.no_road_status, row.score.no_road_frames());
    }
    std::puts("");
}

}  // namespace benchmark
