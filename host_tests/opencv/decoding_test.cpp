// Each source's format decoded by the library and by OpenCV's arithmetic: the same pixels must count, in the same levels.
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core_beside_opencv.hpp"

extern "C" {
#include "random_numbers.h"
#include "unity.h"
}

extern "C" void setUp() {}
extern "C" void tearDown() {}

namespace {

const cv::Size size(322, 241);

cv::Mat random_image(const char* test) {
    const random_numbers_t numbers = random_numbers(test);
    cv::RNG generator(numbers.state);
    cv::Mat image(size, CV_16U);
    generator.fill(image, cv::RNG::UNIFORM, 0, 65536);
    cv::Mat small(size, CV_16U), pick(size, CV_8U);
    generator.fill(small, cv::RNG::UNIFORM, 0, 4096);  // half of the samples where the disparities are
    generator.fill(pick, cv::RNG::UNIFORM, 0, 2);
    small.copyTo(image, pick);
    return image;
}

// What OpenCV makes of the histogram of every row. The bins are one pixel wide; 0 is no match.
cv::Mat row_histograms(const cv::Mat& disparity) {
    cv::Mat all;
    for (int row = 0; row < disparity.rows; ++row) {
        const cv::Mat line = disparity.row(row), valid = line > 0;
        const int channel = 0, bins = ROADPOSE_MAX_DISPARITY;
        const float range[] = {0, ROADPOSE_MAX_DISPARITY};
        const float* ranges = range;
        cv::Mat histogram;
        cv::calcHist(&line, 1, &channel, valid, histogram, 1, &bins, &ranges);
        all.push_back(cv::Mat(histogram.t()));
    }
    return all;
}

void compare(const roadpose_disparity_format_t& format, const cv::Mat& samples, const cv::Mat& disparity,
             const cv::Mat& confidence = cv::Mat()) {
    const cv::Mat expected = on_grid(within_limits(disparity));
    WholeImage image(samples.size(), format);
    const roadpose_pose_t pose = image.process(samples, confidence);
    TEST_ASSERT_EQUAL(cv::countNonZero(expected), pose.valid_samples);
    TEST_ASSERT_EQUAL(0, cv::norm(row_histograms(expected), image.v_disparity(), cv::NORM_L1));
}

cv::Mat swapped(const cv::Mat& image) {
    cv::Mat bytes(image.rows, image.cols, CV_8UC2, image.data, image.step), turned;
    const int order[] = {0, 1, 1, 0};
    turned.create(bytes.size(), bytes.type());
    cv::mixChannels(&bytes, 1, &turned, 1, order, 2);
    return cv::Mat(image.rows, image.cols, CV_16U, turned.data, turned.step).clone();
}

void test_u16_q8() {
    const cv::Mat samples = random_image("u16 q8");
    cv::Mat disparity;
    samples.convertTo(disparity, CV_32F, 1.0 / 256);
    compare(preset(ROADPOSE_FORMAT_U16_Q8), samples, disparity);
}

void test_opencv() {
    const cv::Mat bits = random_image("opencv");
    const cv::Mat samples(bits.size(), CV_16S, bits.data, bits.step);
    cv::Mat disparity;
    samples.convertTo(disparity, CV_32F, 1.0 / 16);
    compare(preset(ROADPOSE_FORMAT_OPENCV), samples, disparity);
}

void test_vpi() {
    const cv::Mat bits = random_image("vpi"), confidence = swapped(bits);
    const cv::Mat samples(bits.size(), CV_16S, bits.data, bits.step);
    cv::Mat disparity;
    samples.convertTo(disparity, CV_32F, 1.0 / 32);
    disparity.setTo(0, confidence < 32767);
    compare(preset(ROADPOSE_FORMAT_VPI), samples, disparity, confidence);
}

void test_ti_sde() {
    const cv::Mat samples = random_image("ti sde");
    cv::Mat sign, confidence, field, disparity;
    cv::bitwise_and(samples, cv::Scalar(0x8000), sign);
    cv::bitwise_and(samples, cv::Scalar(0x0007), confidence);
    cv::bitwise_and(samples, cv::Scalar(0x7FF8), field);
    field.convertTo(disparity, CV_32F, 1.0 / 128);  // [2:0] confidence, [6:3] fraction: the pixel is bit 7
    disparity.setTo(0, sign > 0);
    disparity.setTo(0, confidence < 1);
    compare(preset(ROADPOSE_FORMAT_TI_SDE), samples, disparity);
}

void test_libsgm() {
    const cv::Mat samples = random_image("libsgm");
    cv::Mat disparity;
    samples.convertTo(disparity, CV_32F, 1.0 / 16);
    disparity.setTo(0, samples == 0xFFFF);
    compare(preset(ROADPOSE_FORMAT_LIBSGM), samples, disparity);
}

void test_triclops() {
    const cv::Mat numbers = random_image("triclops");
    cv::Mat disparity;
    numbers.convertTo(disparity, CV_32F, 1.0 / 256);
    disparity.setTo(0, numbers >= 0xFF00);
    compare(preset(ROADPOSE_FORMAT_TRICLOPS), swapped(numbers), disparity);  // this machine is little-endian, the format is not
}

// Two views of one texture, the right one shifted more towards the bottom of the image.
void paint_stereo_pair(cv::Mat& left, cv::Mat& right) {
    cv::RNG generator(7);
    cv::Mat texture(240, 460, CV_8U);
    generator.fill(texture, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(texture, texture, cv::Size(3, 3), 0.8);
    cv::Mat columns(240, 320, CV_32F), rows(240, 320, CV_32F);
    for (int v = 0; v < 240; ++v)
        for (int u = 0; u < 320; ++u) {
            columns.at<float>(v, u) = static_cast<float>(u + 0.15 * v);
            rows.at<float>(v, u) = static_cast<float>(v);
        }
    left = texture(cv::Rect(0, 0, 320, 240)).clone();
    cv::remap(texture, right, columns, rows, cv::INTER_LINEAR);
}

// The matchers' own output, as it is: S16 with -16 for no match, and the Mat's own stride.
void compare_matcher(cv::StereoMatcher& matcher) {
    cv::Mat left, right, wide(240, 400, CV_16S, cv::Scalar(0x1234)), disparity;
    paint_stereo_pair(left, right);
    cv::Mat samples = wide(cv::Rect(40, 0, 320, 240));
    matcher.compute(left, right, disparity);
    disparity.copyTo(samples);
    cv::Mat pixels;
    samples.convertTo(pixels, CV_32F, 1.0 / 16);
    TEST_ASSERT_TRUE(cv::countNonZero(samples < 0) > 1000 && cv::countNonZero(samples > 0) > 20000);
    compare(preset(ROADPOSE_FORMAT_OPENCV), samples, pixels);
}

void test_output_of_stereo_bm() { compare_matcher(*cv::StereoBM::create(64, 15)); }
void test_output_of_stereo_sgbm() { compare_matcher(*cv::StereoSGBM::create(0, 64, 5, 200, 800)); }

}  // namespace

int main() {
    UNITY_BEGIN();
    RUN_TEST(test_u16_q8);
    RUN_TEST(test_opencv);
    RUN_TEST(test_vpi);
    RUN_TEST(test_ti_sde);
    RUN_TEST(test_libsgm);
    RUN_TEST(test_triclops);
    RUN_TEST(test_output_of_stereo_bm);
    RUN_TEST(test_output_of_stereo_sgbm);
    return UNITY_END();
}
