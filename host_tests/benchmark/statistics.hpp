// Signed errors of one axis over many frames.
#pragma once
#include <algorithm>
#include <cmath>

namespace benchmark {

class Errors {
public:
    void add(double error) {
        count_ += 1, sum_ += error, squares_ += error * error, absolute_ += std::abs(error);
        worst_ = std::max(worst_, std::abs(error));
    }
    void add(const Errors& more) {
        count_ += more.count_, sum_ += more.sum_, squares_ += more.squares_, absolute_ += more.absolute_;
        worst_ = std::max(worst_, more.worst_);
    }
    int count() const { return count_; }
    double mean() const { return count_ ? sum_ / count_ : 0; }
    double mean_absolute() const { return count_ ? absolute_ / count_ : 0; }
    double deviation() const { return count_ ? std::sqrt(std::max(0.0, squares_ / count_ - mean() * mean())) : 0; }
    double worst() const { return worst_; }

private:
    int count_ = 0;
    double sum_ = 0, squares_ = 0, absolute_ = 0, worst_ = 0;
};

}  // namespace benchmark
