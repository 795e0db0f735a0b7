// Writes one recording folder: rig.yml, disparity/NNNNNN.pgm, road/NNNNNN.pbm, truth.csv.
#pragma once
#include <opencv2/core.hpp>

#include <filesystem>
#include <fstream>
#include <string>

#include "rig.hpp"

namespace fixtures {

class RecordingWriter {
public:
    RecordingWriter(const std::filesystem::path& folder, const Rig& rig);

    // road: CV_8U, 1 = road; the mask is written only for frames with a road.
    void add_road_frame(const cv::Mat& disparity, const cv::Mat& road, const RoadPlane& truth, const std::string& scene);
    void add_frame_without_road(const cv::Mat& disparity, const std::string& scene);

private:
    void write_disparity(const cv::Mat& disparity);
    std::string frame_name(const char* extension) const;

    std::filesystem::path folder_;
    std::ofstream truth_;
    int frame_ = 0;
};

}  // namespace fixtures
