// Damage done to a finished disparity map: what transmission, dirt, fog and bad matches do in the field.
#pragma once
#include <opencv2/core.hpp>

#include "hashing.hpp"

namespace fixtures {

// Every function works in place on CV_16U samples (disparity × 256, 0 = no match).
void lose_everything(cv::Mat& disparity);
void lose_row_bands(cv::Mat& disparity, int bands, int tallest, Lcg& random);
void lose_regions(cv::Mat& disparity, int regions, Lcg& random);
void lose_at_random(cv::Mat& disparity, double share, Lcg& random);
void add_salt(cv::Mat& disparity, double share, double largest_px, Lcg& random);
void replace_by_noise(cv::Mat& disparity, double largest_px, Lcg& random);
// Fog: nothing but scattered matches; a few blobs of one noisy disparity each, and single stray pixels.
void replace_by_fog(cv::Mat& disparity, double largest_px, Lcg& random);

}  // namespace fixtures
