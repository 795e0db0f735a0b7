#include "tracker/sub_pixel.h"

#include "fixed_point/fixed_point.h"
#include "tracker/grey.h"

#if ROADPOSE_TRACKER

#define SIDE ROADPOSE_TRACKER_PATCH
#define HALF (SIDE / 2)
#define PIXELS (SIDE * SIDE)
#define ROUNDS 10
#define SETTLED_Q8 1    /* a step this short ends the search */
#define STEP_MAX_Q8 512
#define STRAY_MAX_Q8 768 /* block matching is right to two pixels or not at all */

/* Gradients' second moments about their mean. |gradient| <= 255 (twice the slope): 121 squares below 2^23. */
typedef struct {
    int32_t u, v;
    int64_t uu, uv, vv;
} moments_t;

/* What one placement shows: sums over the patch of the difference d (q6) and of d times the gradients.
 * |d| <= 2^14: sums below 2^21, with gradients below 2^29. */
typedef struct {
    int32_t d, du, dv;
} mismatch_t;

static moments_t take_patch(roadpose_tracker_t *tracker, const roadpose_grey_t *image, const roadpose_corner_t *corner) {
    moments_t m = {0, 0, 0, 0, 0};
    for (int32_t j = 0; j < SIDE; j++) {
        const int32_t v = corner->v + j - HALF;
        const uint8_t *at = roadpose_grey_at(image, corner->u - HALF, v);
        const uint8_t *above = roadpose_grey_at(image, corner->u - HALF, v - 1);
        const uint8_t *below = roadpose_grey_at(image, corner->u - HALF, v + 1);
        for (int32_t i = 0; i < SIDE; i++) {
            const int32_t gu = (int32_t)at[i + 1] - (int32_t)at[i - 1];
            const int32_t gv = (int32_t)below[i] - (int32_t)above[i];
            tracker->patch[j][i] = at[i];
            tracker->gradient_u[j][i] = (int16_t)gu;
            tracker->gradient_v[j][i] = (int16_t)gv;
            m.u += gu;
            m.v += gv;
            m.uu += gu * gu;
            m.uv += gu * gv;
            m.vv += gv * gv;
        }
    }
    m.uu -= (int64_t)m.u * m.u / PIXELS;
    m.uv -= (int64_t)m.u * m.v / PIXELS;
    m.vv -= (int64_t)m.v * m.v / PIXELS;
    return m;
}

/* Patch and one pixel more to the right and below within the image. */
static bool patch_inside(const roadpose_grey_t *image, int32_t u_q8, int32_t v_q8) {
    return u_q8 >= HALF * 256 && u_q8 < (image->width_px - HALF - 1) * 256 && v_q8 >= HALF * 256 &&
           v_q8 < (image->height_px - HALF - 1) * 256;
}

/* Bilinear weights of the four pixels around a fraction; they add up to 2^16. */
typedef struct {
    uint32_t at, right, below, across;
} weights_t;

static weights_t weights_of(int32_t u_q8, int32_t v_q8) {
    const uint32_t x = (uint32_t)u_q8 & 255u;
    const uint32_t y = (uint32_t)v_q8 & 255u;
    return (weights_t){(256u - x) * (256u - y), x * (256u - y), (256u - x) * y, x * y};
}

/* Grey level in q6: at most 255 * 2^16 >> 10 = 16320. */
static int32_t grey_q6(const uint8_t *pixel, const uint8_t *below, const weights_t *w) {
    return (int32_t)((w->at * pixel[0] + w->right * pixel[1] + w->below * below[0] + w->across * below[1] + 512u) >> 10);
}

static mismatch_t compare(const roadpose_tracker_t *tracker, const roadpose_grey_t *image, int32_t u_q8, int32_t v_q8) {
    const weights_t w = weights_of(u_q8, v_q8);
    mismatch_t sum = {0, 0, 0};
    for (int32_t j = 0; j < SIDE; j++) {
        const uint8_t *pixel = roadpose_grey_at(image, u_q8 / 256 - HALF, v_q8 / 256 - HALF + j);
        const uint8_t *below = pixel + image->stride_bytes;
        for (int32_t i = 0; i < SIDE; i++) {
            const int32_t d = grey_q6(pixel + i, below + i, &w) - tracker->patch[j][i] * 64;
            sum.d += d;
            sum.du += d * tracker->gradient_u[j][i];
            sum.dv += d * tracker->gradient_v[j][i];
        }
    }
    return sum;
}

/* One step of Lucas and Kanade, brightness offset free: H step = -b. Gradients are twice the slope and d is in q6, so the
 * step in q8 is 256 * b / 64 / 2 * 4 / H = 8 b / H. H < 2^23, b < 2^30: H b < 2^53, sums and times 8: below 2^57. */
static bool step(const moments_t *m, const mismatch_t *sum, int32_t *du_q8, int32_t *dv_q8) {
    const int64_t bu = (int64_t)sum->du - (int64_t)sum->d * m->u / PIXELS;
    const int64_t bv = (int64_t)sum->dv - (int64_t)sum->d * m->v / PIXELS;
    const int64_t determinant = m->uu * m->vv - m->uv * m->uv;
    if (determinant <= 0) {
        return false;
    }
    *du_q8 = (int32_t)roadpose_clamp(-8 * (m->vv * bu - m->uv * bv) / determinant, -STEP_MAX_Q8, STEP_MAX_Q8);
    *dv_q8 = (int32_t)roadpose_clamp(-8 * (m->uu * bv - m->uv * bu) / determinant, -STEP_MAX_Q8, STEP_MAX_Q8);
    return true;
}

/* Mean difference of the patches against the mean deviation of the patch from its mean. Sums below 2^21. */
static bool alike(const roadpose_tracker_t *tracker, const roadpose_grey_t *image, const roadpose_track_t *track,
                  int32_t offset_q6) {
    const weights_t w = weights_of(track->u1_q8, track->v1_q8);
    int32_t mean_q6 = 0;
    int32_t contrast = 0;
    int32_t mismatch = 0;
    for (int32_t k = 0; k < PIXELS; k++) {
        mean_q6 += tracker->patch[k / SIDE][k % SIDE] * 64;
    }
    mean_q6 /= PIXELS;
    for (int32_t j = 0; j < SIDE; j++) {
        const uint8_t *pixel = roadpose_grey_at(image, track->u1_q8 / 256 - HALF, track->v1_q8 / 256 - HALF + j);
        for (int32_t i = 0; i < SIDE; i++) {
            const int32_t own = tracker->patch[j][i] * 64;
            const int32_t d = grey_q6(pixel + i, pixel + image->stride_bytes + i, &w) - own - offset_q6;
            mismatch += (d < 0) ? -d : d;
            contrast += (own < mean_q6) ? (mean_q6 - own) : (own - mean_q6);
        }
    }
    return mismatch * 100 <= contrast * tracker->settings.mismatch_max_percent;
}

static bool settled(int32_t du_q8, int32_t dv_q8) {
    return roadpose_abs(du_q8) <= SETTLED_Q8 && roadpose_abs(dv_q8) <= SETTLED_Q8;
}

static bool strayed(const roadpose_track_t *track, const roadpose_corner_t *start) {
    return roadpose_abs((int64_t)track->u1_q8 - start->u * 256) > STRAY_MAX_Q8 ||
           roadpose_abs((int64_t)track->v1_q8 - start->v * 256) > STRAY_MAX_Q8;
}

bool roadpose_sub_pixel(roadpose_tracker_t *tracker, const roadpose_grey_t *previous, const roadpose_grey_t *present,
                        const roadpose_corner_t *corner, const roadpose_corner_t *start, roadpose_track_t *track) {
    const moments_t moments = take_patch(tracker, previous, corner);
    mismatch_t sum = {0, 0, 0};
    int32_t du_q8 = STEP_MAX_Q8;
    int32_t dv_q8 = STEP_MAX_Q8;
    *track = (roadpose_track_t){corner->u * 256, corner->v * 256, start->u * 256, start->v * 256};
    for (unsigned round = 0; round < ROUNDS && !settled(du_q8, dv_q8); round++) {
        if (!patch_inside(present, track->u1_q8, track->v1_q8)) {
            return false;
        }
        sum = compare(tracker, present, track->u1_q8, track->v1_q8);
        if (!step(&moments, &sum, &du_q8, &dv_q8)) {
            return false;
        }
        track->u1_q8 += du_q8;
        track->v1_q8 += dv_q8;
    }
    return settled(du_q8, dv_q8) && !strayed(track, start) && patch_inside(present, track->u1_q8, track->v1_q8) &&
           alike(tracker, present, track, sum.d / PIXELS);
}

#endif
