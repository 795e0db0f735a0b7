// Estimators and oracles over a whole recording.
#pragma once
#include <vector>

#include "estimators.hpp"
#include "oracle.hpp"
#include "scores.hpp"

namespace benchmark {

// Opens a recording for as long as it lives. Throws std::runtime_error.
struct OpenRecording {
    recording_t recording;
    explicit OpenRecording(const char* folder);
    ~OpenRecording();
    OpenRecording(const OpenRecording&) = delete;
    OpenRecording& operator=(const OpenRecording&) = delete;
};

struct Row {
    std::string name;
    Score score;
    double roll_limit_deg = 0;  // counts only frames with less true roll; 0 = all
};

struct OracleRow {
    std::string name;
    PoseErrors errors;  // over the frames that the first estimator accepted
};

struct Results {
    std::vector<Row> rows;
    std::vector<OracleRow> oracles;
    void add(const Results& more);  // of the same estimators over another recording
};

enum OracleKind { least_squares, least_squares_corridor, trimmed, trimmed_corridor };

Results measure(const recording_t& recording, const std::vector<Estimator>& estimators, bool with_oracles);
bool has_true_poses(const recording_t& recording);

}  // namespace benchmark
