// Markdown tables of the scores.
#pragma once
#include <string>
#include <vector>

#include "scores.hpp"

namespace benchmark {

struct Row {
    std::string name;
    Score score;
    double roll_limit_deg = 0;
};

struct OracleRow {
    std::string name;
    PoseErrors errors;  // over the frames that the default estimator accepted
};

void print_accuracy_table(const std::vector<Row>& rows, const std::vector<OracleRow>& oracles);
void print_ratio_table(const Row& first, const std::vector<OracleRow>& oracles);
void print_stability_table(const std::vector<Row>& rows);
void print_status_table(const std::vector<Row>& rows);

}  // namespace benchmark
