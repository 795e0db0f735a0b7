// The histograms and the free map on every frame of the fixtures, against cv::calcHist.
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core_beside_opencv.hpp"

extern "C" {
#include "disparity/u_disparity.h"
#include "recording_file.h"
#include "unity.h"
}

extern "C" void setUp() {}
extern "C" void tearDown() {}

namespace {

std::string fixtures;

std::vector<std::string> frames_of_fixtures() {
    std::vector<std::string> all, names;
    cv::glob(fixtures + "/*.pgm", all, true);
    std::copy_if(all.begin(), all.end(), std::back_inserter(names),
                 [](const std::string& name) { return name.find("/disparity/") != std::string::npos; });
    const auto is_grey = [](const std::string& name) { return name.find("/disparity/") == std::string::npos; };
    names.erase(std::remove_if(names.begin(), names.end(), is_grey), names.end());  // left/ holds grey images
    TEST_ASSERT_TRUE_MESSAGE(!names.empty(), "no frames in the fixtures");
    return names;
}

roadpose_disparity_format_t native_q8() { return preset(ROADPOSE_FORMAT_U16_Q8); }  // what cv::imread returns

// Columns or rows of a disparity image (CV_32F) by whole disparity: one line a column or row.
cv::Mat histograms(const cv::Mat& lines) {
    cv::Mat all;
    const int channel = 0, bins = ROADPOSE_MAX_DISPARITY;
    const float range[] = {0, ROADPOSE_MAX_DISPARITY};
    const float* ranges = range;
    for (int i = 0; i < lines.rows; ++i) {
        const cv::Mat line = lines.row(i);
        cv::Mat histogram;
        cv::calcHist(&line, 1, &channel, cv::Mat(line > 0), histogram, 1, &bins, &ranges);
        all.push_back(cv::Mat(histogram.t()));
    }
    return all;
}

bool fits(const cv::Mat& image) { return image.cols <= ROADPOSE_MAX_WIDTH && image.rows <= ROADPOSE_MAX_HEIGHT; }

cv::Mat disparity_of(const cv::Mat& samples) {
    cv::Mat disparity;
    samples.convertTo(disparity, CV_32F, 1.0 / 256);
    return on_grid(within_limits(disparity));
}

void test_v_disparity_and_free_map() {
    int compared = 0;
    for (const std::string& name : frames_of_fixtures()) {
        const cv::Mat samples = cv::imread(name, cv::IMREAD_UNCHANGED);
        if (!fits(samples)) continue;
        WholeImage image(samples.size(), native_q8());
        const roadpose_pose_t pose = image.process(samples);
        const cv::Mat disparity = disparity_of(samples);
        TEST_ASSERT_EQUAL_MESSAGE(cv::countNonZero(disparity), pose.valid_samples, name.c_str());
        if (pose.status == ROADPOSE_STATUS_NO_DISPARITY) continue;  // then there is no second pass
        const cv::Mat columns = histograms(disparity.t());
        TEST_ASSERT_EQUAL_MESSAGE(0, cv::norm(histograms(disparity), image.v_disparity(), cv::NORM_L1), name.c_str());
        TEST_ASSERT_EQUAL_MESSAGE(0, cv::countNonZero((columns > 0) != image.free_map()), name.c_str());
        ++compared;
    }
    TEST_ASSERT_TRUE(compared >= 10);
}

void test_u_disparity() {
    static roadpose_u_disparity_t histogram;
    for (const std::string& name : frames_of_fixtures()) {
        const cv::Mat samples = cv::imread(name, cv::IMREAD_UNCHANGED);
        if (!fits(samples)) continue;
        const cv::Mat disparity = disparity_of(samples), expected = histograms(disparity.t());
        cv::Mat q8;
        disparity.convertTo(q8, CV_16U, 256);
        histogram = roadpose_u_disparity_t{};
        for (int row = 0; row < q8.rows; ++row) {
            const roadpose_row_t reader{q8.ptr(row), 2, false, 1, UINT16_MAX - 1, 256, 0};
            roadpose_u_disparity_add_row(&histogram, &reader, static_cast<std::int16_t>(q8.cols));
        }
        const cv::Mat counts(ROADPOSE_MAX_GRID_COLUMNS, ROADPOSE_MAX_DISPARITY,
                             sizeof(roadpose_count_t) == 1 ? CV_8U : CV_16U, &histogram);
        cv::Mat as_float;
        counts.rowRange(0, expected.rows).convertTo(as_float, CV_32F);
        TEST_ASSERT_EQUAL_MESSAGE(0, cv::norm(expected, as_float, cv::NORM_L1), name.c_str());
    }
}

// The reader of the tests and OpenCV's read the same from a 16-bit PGM.
void test_reader_of_the_tests() {
    for (const std::string& name : frames_of_fixtures()) {
        const std::string folder = name.substr(0, name.find("/disparity/"));
        auto recording = std::make_unique<recording_t>();
        TEST_ASSERT_TRUE(recording_open(recording.get(), folder.c_str()));
        const cv::Mat samples = cv::imread(name, cv::IMREAD_UNCHANGED);
        const int frame = std::stoi(name.substr(name.size() - 10, 6));
        std::vector<std::uint8_t> bytes(2 * samples.total());
        TEST_ASSERT_TRUE(recording_read_disparity(recording.get(), frame, bytes.data()));
        for (std::size_t i = 0; i < samples.total(); ++i)
            if (samples.ptr<std::uint16_t>()[i] != (bytes[2 * i] << 8 | bytes[2 * i + 1])) TEST_FAIL_MESSAGE(name.c_str());
        recording_close(recording.get());
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    fixtures = argv[1];
    UNITY_BEGIN();
    RUN_TEST(test_v_disparity_and_free_map);
    RUN_TEST(test_u_disparity);
    RUN_TEST(test_reader_of_the_tests);
    return UNITY_END();
}
