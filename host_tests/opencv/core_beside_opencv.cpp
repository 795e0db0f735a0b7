#include "core_beside_opencv.hpp"

extern "C" {
#include "unity.h"
}

WholeImage::WholeImage(cv::Size size, const roadpose_disparity_format_t& format)
    : instance_{}, grid_((size.width + ROADPOSE_COLUMN_STEP - 1) / ROADPOSE_COLUMN_STEP,
                         (size.height + ROADPOSE_ROW_STEP - 1) / ROADPOSE_ROW_STEP) {
    roadpose_rig_t rig{};
    rig.width_px = static_cast<std::uint16_t>(size.width);
    rig.height_px = static_cast<std::uint16_t>(size.height);
    rig.focal_millipx = 500000;
    rig.cu_millipx = 500 * (size.width - 1);
    rig.cv_millipx = 500 * (size.height - 1);
    rig.baseline_um = 300000;
    roadpose_settings_t settings;
    roadpose_settings_default(&settings);
    settings.obstacle_height_mm = settings.corridor_half_width_mm = settings.corridor_range_mm = 0;
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_init(&instance_, &rig, &format, &settings));
}

roadpose_pose_t WholeImage::process(const cv::Mat& samples, const cv::Mat& confidence) {
    roadpose_frame_t frame{};
    frame.samples = samples.data;
    frame.stride_bytes = static_cast<std::uint32_t>(samples.step);
    frame.width_px = static_cast<std::uint16_t>(samples.cols);
    frame.height_px = static_cast<std::uint16_t>(samples.rows);
    frame.confidence = confidence.empty() ? nullptr : confidence.data;
    frame.confidence_stride_bytes = static_cast<std::uint32_t>(confidence.empty() ? 0 : confidence.step[0]);
    roadpose_pose_t pose{};
    TEST_ASSERT_EQUAL(ROADPOSE_OK, roadpose_process(&instance_, &frame, &pose));
    return pose;
}

cv::Mat WholeImage::v_disparity() const {
    cv::Mat histogram(grid_.height, ROADPOSE_MAX_DISPARITY, CV_32F);
    for (int row = 0; row < histogram.rows; ++row)
        for (int level = 0; level < histogram.cols; ++level)
            histogram.at<float>(row, level) = roadpose_v_disparity_free(
                &instance_, static_cast<std::uint16_t>(row), static_cast<std::uint16_t>(level));
    return histogram;
}

cv::Mat WholeImage::free_map() const {
    cv::Mat map(grid_.width, ROADPOSE_MAX_DISPARITY, CV_8U);
    for (int column = 0; column < map.rows; ++column)
        for (int level = 0; level < map.cols; ++level)
            map.at<std::uint8_t>(column, level) =
                roadpose_is_free(&instance_, static_cast<std::uint16_t>(column), static_cast<std::uint16_t>(level)) ? 255 : 0;
    return map;
}

roadpose_disparity_format_t preset(roadpose_format_preset_t name) {
    roadpose_disparity_format_t format{};
    TEST_ASSERT_TRUE(roadpose_format_preset(&format, name));
    return format;
}

cv::Mat on_grid(const cv::Mat& image) {
    cv::Mat grid((image.rows + ROADPOSE_ROW_STEP - 1) / ROADPOSE_ROW_STEP,
                 (image.cols + ROADPOSE_COLUMN_STEP - 1) / ROADPOSE_COLUMN_STEP, image.type());
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.cols; ++column)
            image(cv::Rect(column * ROADPOSE_COLUMN_STEP, row * ROADPOSE_ROW_STEP, 1, 1))
                .copyTo(grid(cv::Rect(column, row, 1, 1)));
    return grid;
}

cv::Mat within_limits(const cv::Mat& disparity) {
    cv::Mat kept = disparity.clone();
    kept.setTo(0, disparity >= ROADPOSE_MAX_DISPARITY);
    kept.setTo(0, disparity <= 0);
    return kept;
}
