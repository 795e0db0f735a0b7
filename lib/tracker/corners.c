#include "tracker/corners.h"

#include "fixed_point/fixed_point.h"
#include "tracker/grey.h"

#if ROADPOSE_TRACKER

#define HALF 2       /* of the 5 x 5 window */
#define PLACES 10    /* looked at along each side of a cell */

typedef struct {
    int32_t u_first, u_last, v_first, v_last;
} cell_t;

/* det / trace: |difference| <= 255, 25 of them squared: below 2^21; the determinant below 2^42. */
static int32_t strength(const roadpose_grey_t *image, int32_t u, int32_t v) {
    int32_t uu = 0;
    int32_t uv = 0;
    int32_t vv = 0;
    for (int32_t y = v - HALF; y <= v + HALF; y++) {
        const uint8_t *above = roadpose_grey_at(image, u - HALF, y - 1);
        const uint8_t *at = roadpose_grey_at(image, u - HALF, y);
        const uint8_t *below = roadpose_grey_at(image, u - HALF, y + 1);
        for (int32_t x = 0; x <= 2 * HALF; x++) {
            const int32_t du = (int32_t)at[x + 1] - (int32_t)at[x - 1];
            const int32_t dv = (int32_t)below[x] - (int32_t)above[x];
            uu += du * du;
            uv += du * dv;
            vv += dv * dv;
        }
    }
    const int64_t determinant = (int64_t)uu * vv - (int64_t)uv * uv;
    return (uu + vv == 0) ? 0 : (int32_t)(determinant / (uu + vv));
}

static cell_t cell_of(const roadpose_grey_t *image, unsigned column, unsigned row) {
    const int32_t width = image->width_px - 2 * ROADPOSE_TRACKER_MARGIN;
    const int32_t height = image->height_px - 2 * ROADPOSE_TRACKER_MARGIN;
    const int32_t c = (int32_t)column;
    const int32_t r = (int32_t)row;
    return (cell_t){
        ROADPOSE_TRACKER_MARGIN + width * c / ROADPOSE_TRACKER_COLUMNS,
        ROADPOSE_TRACKER_MARGIN + width * (c + 1) / ROADPOSE_TRACKER_COLUMNS - 1,
        ROADPOSE_TRACKER_MARGIN + height * r / ROADPOSE_TRACKER_ROWS,
        ROADPOSE_TRACKER_MARGIN + height * (r + 1) / ROADPOSE_TRACKER_ROWS - 1,
    };
}

/* Strongest place of a lattice over the area. */
static int32_t strongest(const roadpose_grey_t *image, const cell_t *area, int32_t step_u, int32_t step_v,
                         roadpose_corner_t *corner) {
    int32_t best = -1;
    for (int32_t v = area->v_first; v <= area->v_last; v += step_v) {
        for (int32_t u = area->u_first; u <= area->u_last; u += step_u) {
            const int32_t here = strength(image, u, v);
            if (here > best) {
                best = here;
                corner->u = u;
                corner->v = v;
            }
        }
    }
    return best;
}

static int32_t larger(int32_t a, int32_t b) {
    return (a > b) ? a : b;
}

static int32_t smaller(int32_t a, int32_t b) {
    return (a < b) ? a : b;
}

bool roadpose_corner_of_cell(const roadpose_grey_t *image, unsigned column, unsigned row, uint16_t corner_min,
                             roadpose_corner_t *corner) {
    const cell_t cell = cell_of(image, column, row);
    const int32_t step_u = (cell.u_last - cell.u_first) / PLACES + 1;
    const int32_t step_v = (cell.v_last - cell.v_first) / PLACES + 1;
    if (strongest(image, &cell, step_u, step_v, corner) < 0) {
        return false; /* an image so small that the cell is empty */
    }
    const cell_t near = {larger(corner->u - 1, cell.u_first), smaller(corner->u + 1, cell.u_last),
                         larger(corner->v - 1, cell.v_first), smaller(corner->v + 1, cell.v_last)};
    return strongest(image, &near, 1, 1, corner) >= corner_min;
}

#endif
