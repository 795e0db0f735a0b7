// Runs the library on a cv::Mat with every limit off, so that its map and histogram are those of the whole image.
#pragma once
#include <opencv2/core.hpp>

#include "roadpose/roadpose.h"

class WholeImage {
public:
    WholeImage(cv::Size size, const roadpose_disparity_format_t& format);
    roadpose_pose_t process(const cv::Mat& samples, const cv::Mat& confidence = cv::Mat());
    cv::Mat v_disparity() const;  // CV_32F, grid rows x levels
    cv::Mat free_map() const;     // CV_8U, grid columns x levels, 255 = free

private:
    roadpose_t instance_;
    cv::Size grid_;
};

roadpose_disparity_format_t preset(roadpose_format_preset_t name);

// The pixels that the library looks at.
cv::Mat on_grid(const cv::Mat& image);

// Disparities in pixels, CV_32F, 0 = none, to what the library must see in them: 0 beyond its limit.
cv::Mat within_limits(const cv::Mat& disparity);
