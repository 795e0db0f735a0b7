#include "tracker/block_match.h"

#include "tracker/grey.h"

#if ROADPOSE_TRACKER

#define BLOCK ROADPOSE_TRACKER_BLOCK
#define HALF_BLOCK (BLOCK / 2)
#define COARSE 4
#define FINE 2
#define COARSE_REACH (ROADPOSE_TRACKER_RANGE / COARSE)
#define FINE_REACH 2

/* Sum of size x size pixels: at most 16 * 255 = 4080. */
static uint16_t pixel_sum(const roadpose_grey_t *image, int32_t u, int32_t v, int32_t size) {
    uint32_t sum = 0;
    for (int32_t y = 0; y < size; y++) {
        const uint8_t *pixel = roadpose_grey_at(image, u, v + y);
        for (int32_t x = 0; x < size; x++) {
            sum += pixel[x];
        }
    }
    return (uint16_t)sum;
}

/* First pixel of cell i of a lattice of cells centred on a corner. */
static int32_t cell_start(int32_t centre, int32_t i, int32_t size) {
    return centre + i * size - size / 2;
}

static bool cell_inside(int32_t start, int32_t size, int32_t limit) {
    return start >= 0 && start + size <= limit;
}

static void take_block(roadpose_tracker_t *tracker, const roadpose_grey_t *image, const roadpose_corner_t *corner,
                       int32_t size) {
    for (int32_t j = 0; j < BLOCK; j++) {
        for (int32_t i = 0; i < BLOCK; i++) {
            tracker->block[j][i] = pixel_sum(image, cell_start(corner->u, i - HALF_BLOCK, size),
                                             cell_start(corner->v, j - HALF_BLOCK, size), size);
        }
    }
}

/* Cells that lie outside the image are 0; places that need them are not looked at. */
static void take_window(roadpose_tracker_t *tracker, const roadpose_grey_t *image, const roadpose_corner_t *centre,
                        int32_t size, int32_t reach) {
    const int32_t side = BLOCK + 2 * reach;
    for (int32_t j = 0; j < side; j++) {
        const int32_t v = cell_start(centre->v, j - HALF_BLOCK - reach, size);
        for (int32_t i = 0; i < side; i++) {
            const int32_t u = cell_start(centre->u, i - HALF_BLOCK - reach, size);
            const bool inside = cell_inside(u, size, image->width_px) && cell_inside(v, size, image->height_px);
            tracker->window[j][i] = inside ? pixel_sum(image, u, v, size) : 0;
        }
    }
}

/* Sum of absolute differences after taking out `brighter`, the difference of the means: exposure may change between the
 * images. At most 49 * 2 * 4080 < 2^19. */
static uint32_t difference(const roadpose_tracker_t *tracker, int32_t left, int32_t top, int32_t brighter) {
    uint32_t sum = 0;
    for (int32_t j = 0; j < BLOCK; j++) {
        const uint16_t *window = &tracker->window[top + j][left];
        for (int32_t i = 0; i < BLOCK; i++) {
            const int32_t d = (int32_t)window[i] - (int32_t)tracker->block[j][i] - brighter;
            sum += (uint32_t)((d < 0) ? -d : d);
        }
    }
    return sum;
}

/* Sum of the window's cells in one column of a place: at most 7 * 4080. */
static int32_t column_sum(const roadpose_tracker_t *tracker, int32_t column, int32_t top) {
    int32_t sum = 0;
    for (int32_t j = 0; j < BLOCK; j++) {
        sum += tracker->window[top + j][column];
    }
    return sum;
}

/* At most 49 * 4080 < 2^18. */
static int32_t block_sum(const roadpose_tracker_t *tracker) {
    int32_t sum = 0;
    for (int32_t j = 0; j < BLOCK; j++) {
        for (int32_t i = 0; i < BLOCK; i++) {
            sum += tracker->block[j][i];
        }
    }
    return sum;
}

static bool place_inside(const roadpose_grey_t *image, const roadpose_corner_t *place, int32_t size) {
    const int32_t first = cell_start(0, -HALF_BLOCK, size);
    const int32_t end = cell_start(0, HALF_BLOCK, size) + size;
    return place->u + first >= 0 && place->u + end <= image->width_px && place->v + first >= 0 &&
           place->v + end <= image->height_px;
}

typedef struct {
    uint32_t difference;
    roadpose_corner_t place;
} best_t;

/* Places of one row of the window; the sum of a place slides from one to the next. */
static void search_row(const roadpose_tracker_t *tracker, const roadpose_grey_t *image, int32_t size, int32_t reach,
                       const roadpose_corner_t *start, int32_t row, best_t *best) {
    const int32_t own = block_sum(tracker);
    int32_t sum = 0;
    for (int32_t i = 0; i < BLOCK - 1; i++) {
        sum += column_sum(tracker, i, row);
    }
    for (int32_t i = 0; i <= 2 * reach; i++) {
        const roadpose_corner_t place = {start->u + (i - reach) * size, start->v + (row - reach) * size};
        sum += column_sum(tracker, i + BLOCK - 1, row);
        if (place_inside(image, &place, size)) {
            const uint32_t here = difference(tracker, i, row, (sum - own) / (BLOCK * BLOCK));
            if (here < best->difference) {
                *best = (best_t){here, place};
            }
        }
        sum -= column_sum(tracker, i, row);
    }
}

/* Best place of the block within reach of *centre, which it becomes. False: no place lies within the image. */
static bool search(roadpose_tracker_t *tracker, const roadpose_grey_t *image, int32_t size, int32_t reach,
                   roadpose_corner_t *centre) {
    best_t best = {UINT32_MAX, *centre};
    take_window(tracker, image, centre, size, reach);
    for (int32_t row = 0; row <= 2 * reach; row++) {
        search_row(tracker, image, size, reach, centre, row, &best);
    }
    *centre = best.place;
    return best.difference != UINT32_MAX;
}

bool roadpose_block_match(roadpose_tracker_t *tracker, const roadpose_grey_t *previous, const roadpose_grey_t *present,
                          const roadpose_corner_t *corner, roadpose_corner_t *found) {
    *found = *corner;
    take_block(tracker, previous, corner, COARSE);
    if (!search(tracker, present, COARSE, COARSE_REACH, found)) {
        return false;
    }
    take_block(tracker, previous, corner, FINE);
    return search(tracker, present, FINE, FINE_REACH, found);
}

#endif
