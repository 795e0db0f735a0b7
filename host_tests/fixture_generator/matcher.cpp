#include "matcher.hpp"

#include <opencv2/calib3d.hpp>

#include <cstdint>

#include "disparity_samples.hpp"

namespace fixtures {
namespace {

constexpr int samples_per_opencv_step = disparity_scale / cv::StereoMatcher::DISP_SCALE;

cv::Ptr<cv::StereoMatcher> make_semi_global(int disparity_range) {
    constexpr int block = 5;
    auto matcher = cv::StereoSGBM::create(0, disparity_range, block);
    matcher->setP1(2 * block * block);  // a quarter of the usual: a high price on slopes flattens the road
    matcher->setP2(32 * block * block);
    matcher->setDisp12MaxDiff(1);
    matcher->setPreFilterCap(63);
    matcher->setUniquenessRatio(10);
    matcher->setSpeckleWindowSize(100);
    matcher->setSpeckleRange(2);
    matcher->setMode(cv::StereoSGBM::MODE_HH);  // the least biased of its modes on slanted ground
    return matcher;
}

// Strict on purpose: it keeps the sure matches only and so leaves a sparse map.
cv::Ptr<cv::StereoMatcher> make_block(int disparity_range) {
    auto matcher = cv::StereoBM::create(disparity_range, 9);
    matcher->setPreFilterCap(31);
    matcher->setTextureThreshold(500);
    matcher->setUniquenessRatio(25);
    matcher->setDisp12MaxDiff(1);
    matcher->setSpeckleWindowSize(50);
    matcher->setSpeckleRange(2);
    return matcher;
}

// OpenCV: signed, 4 fraction bits, negative = no match. A match at exactly 0 (infinitely far) cannot be told from
// "none" and is lost.
std::uint16_t to_sample(std::int16_t opencv_value) {
    return opencv_value > 0 ? static_cast<std::uint16_t>(opencv_value * samples_per_opencv_step) : 0;
}

}  // namespace

const char* matcher_name(Matcher matcher) { return matcher == Matcher::block ? "StereoBM" : "StereoSGBM MODE_HH"; }

cv::Mat match(const StereoPair& pair, const Rig& rig, Matcher matcher) {
    const auto engine = matcher == Matcher::block ? make_block(rig.disparity_range) : make_semi_global(rig.disparity_range);
    cv::Mat raw;
    engine->compute(pair.left, pair.right, raw);
    cv::Mat samples(rig.height, rig.width, CV_16U);
    for (int row = 0; row < rig.height; ++row)
        for (int column = 0; column < rig.width; ++column)
            samples.at<std::uint16_t>(row, column) = to_sample(raw.at<std::int16_t>(row, column + pair.padding));
    return samples;
}

}  // namespace fixtures
