/* Results of fixed-point functions against a double-precision reference, judged in units of the last place. */
#ifndef ROADPOSE_TEST_LSB_H
#define ROADPOSE_TEST_LSB_H

#include <math.h>
#include <stdio.h>

#include "unity.h"

/* Fails, with the numbers, unless |actual - expected| <= tolerance; expected is the reference scaled to LSB. */
#define ASSERT_LSB(tolerance, expected, actual, what) assert_lsb(tolerance, expected, (double)(actual), what, __LINE__)

static inline void assert_lsb(double tolerance, double expected, double actual, const char *what, int line) {
    char text[200];
    if (fabs(actual - expected) <= tolerance) return;
    snprintf(text, sizeof text, "%s: %.3f, should be %.3f, within %.3f LSB", what, actual, expected, tolerance);
    UNITY_TEST_FAIL((UNITY_LINE_TYPE)line, text);
}

#endif
