// Markdown tables of the scores.
#pragma once
#include <vector>

#include "measurement.hpp"

namespace benchmark {

void print_accuracy_table(const std::vector<Row>& rows, const std::vector<OracleRow>& oracles);
void print_ratio_table(const Row& first, const std::vector<OracleRow>& oracles);
void print_stability_table(const std::vector<Row>& rows);
void print_status_table(const std::vector<Row>& rows);

}  // namespace benchmark
