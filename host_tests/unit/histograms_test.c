/* u-disparity, free map, v-disparity-free and points against their definitions, computed plainly. */
#include <string.h>

#include "disparity/u_disparity.h"
#include "disparity/v_disparity.h"
#include "lsb.h"
#include "random_numbers.h"
#include "roadpose/roadpose.h"
#include "rows.h"

enum { COLUMNS = 150, ROWS = 200, LEVELS = ROADPOSE_MAX_DISPARITY };

static random_numbers_t numbers;
static uint16_t image[ROWS][COLUMNS]; /* Q8 disparities, 0 = none */
static roadpose_u_disparity_t u_disparity;
static roadpose_v_disparity_t v_disparity;
static roadpose_free_map_t free_map;
static roadpose_points_t points;
static roadpose_grid_t grid;
static roadpose_settings_t settings;

/* Something like a street: a road below the horizon, walls, and single errors. */
static uint16_t paint(int row, int column) {
    const double road = (row - 60) * 0.35 + 0.02 * column;
    double d = road > 0 ? road : 0;
    if (column > 20 && column < 50 && row > 40 && d < 22) d = 22.4;
    if (column > 120 && row > 30 && d < 7) d = 7.9;
    if (random_between(&numbers, 0, 19) == 0) d = random_double(&numbers, 0, LEVELS - 0.01);
    if (random_between(&numbers, 0, 5) == 0 || d >= LEVELS) d = 0;
    return (uint16_t)(256 * d);
}

void setUp(void) {
    numbers = random_numbers("histograms");
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) image[row][column] = paint(row, column);
    memset(&u_disparity, 0, sizeof u_disparity);
    memset(&v_disparity, 0x77, sizeof v_disparity); /* rows are replaced, not added to */
    memset(&free_map, 0x77, sizeof free_map);
    const roadpose_grid_t street = {COLUMNS, ROWS, 75, 60, 500, -500, 500000, 300000};
    grid = street;
    roadpose_settings_default(&settings);
}

void tearDown(void) {}

static int counted(int column, int row, int level) { /* column or row -1: all of them */
    int count = 0;
    for (int j = row < 0 ? 0 : row; j < (row < 0 ? ROWS : row + 1); j++)
        for (int i = column < 0 ? 0 : column; i < (column < 0 ? COLUMNS : column + 1); i++)
            count += image[j][i] != 0 && image[j][i] / 256 == level;
    return count;
}

static uint32_t fill_u_disparity(void) {
    uint32_t valid = 0;
    for (int row = 0; row < ROWS; row++) {
        const roadpose_row_t samples = row_of_q8(image[row]);
        valid += roadpose_u_disparity_add_row(&u_disparity, &samples, COLUMNS);
    }
    return valid;
}

static void test_u_disparity(void) {
    uint32_t expected = 0;
    const uint32_t valid = fill_u_disparity();
    for (int column = 0; column < COLUMNS; column++)
        for (int level = 0; level < LEVELS; level++) {
            TEST_ASSERT_EQUAL_UINT(counted(column, -1, level), u_disparity.count[column][level]);
            expected += u_disparity.count[column][level];
        }
    TEST_ASSERT_EQUAL_UINT32(expected, valid);
}

/* A column of one level in all rows that the limits allow: the cell must not run over. */
static void test_u_disparity_holds_every_row(void) {
    static uint16_t row[ROADPOSE_MAX_GRID_COLUMNS];
    for (int i = 0; i < ROADPOSE_MAX_GRID_COLUMNS; i++) row[i] = 5 * 256;
    const roadpose_row_t samples = row_of_q8(row);
    for (int j = 0; j < ROADPOSE_MAX_GRID_ROWS; j++)
        (void)roadpose_u_disparity_add_row(&u_disparity, &samples, ROADPOSE_MAX_GRID_COLUMNS);
    for (int i = 0; i < ROADPOSE_MAX_GRID_COLUMNS; i++)
        TEST_ASSERT_EQUAL_UINT(ROADPOSE_MAX_GRID_ROWS, u_disparity.count[i][5]);
}

static uint32_t make_free_map(void) {
    roadpose_free_rule_t rule;
    uint32_t samples = 0;
    (void)fill_u_disparity();
    roadpose_free_rule(&rule, &grid, &settings);
    for (int16_t i = 0; i < COLUMNS; i++) samples += roadpose_free_map_column(&free_map, &u_disparity, &rule, &grid, i);
    return samples;
}

static bool is_free(int column, int level) { return roadpose_cell_is_free(&free_map, (unsigned)column, (unsigned)level); }

/* Without limits every cell that has samples is free, and the map loses none. */
static void test_free_map_without_limits(void) {
    settings.obstacle_height_mm = 0;
    settings.corridor_half_width_mm = 0;
    settings.corridor_range_mm = 0;
    const uint32_t samples = make_free_map();
    uint32_t expected = 0;
    for (int column = 0; column < COLUMNS; column++)
        for (int level = 0; level < LEVELS; level++) {
            TEST_ASSERT_EQUAL(u_disparity.count[column][level] > 0, is_free(column, level));
            expected += u_disparity.count[column][level];
        }
    TEST_ASSERT_EQUAL_UINT32(expected, samples);
}

/* The corridor: a cell with its whole level further out than 1.5 times the half width is not free; one that lies
 * within the half width is. Between them the map may decide. The same for the range. */
static void test_free_map_corridor(void) {
    settings.obstacle_height_mm = 0;
    (void)make_free_map();
    const double half = settings.corridor_half_width_mm / 1000.0, range = settings.corridor_range_mm / 1000.0;
    for (int column = 0; column < COLUMNS; column++)
        for (int level = 0; level < LEVELS; level++) {
            if (u_disparity.count[column][level] == 0) continue;
            const double lateral = fabs((column - 75.0) * ROADPOSE_COLUMN_STEP * 0.3);
            const double near_edge = lateral / (level + 1), far_edge = level > 0 ? lateral / level : 1e9;
            const double ahead_near = 500 * 0.3 / (level + 1), ahead_far = level > 0 ? 500 * 0.3 / level : 1e9;
            const bool inside = far_edge <= half && ahead_far <= range;
            TEST_ASSERT_TRUE(!inside || is_free(column, level));
            const bool outside = near_edge > 1.5 * half + 0.01 || ahead_near > 2 * range;
            TEST_ASSERT_FALSE(outside && is_free(column, level));
        }
}

/* An obstacle of H metres shows H * d / B pixel rows of one disparity. A wall of 1.5 m is none of the road's, one of
 * 10 cm is below the setting of 40 cm, whatever the distance. */
static void test_free_map_obstacles(void) {
    settings.corridor_half_width_mm = 0;
    for (int level = 8; level < 100; level += 7) {
        const int tall = (int)(1.5 * level / 0.3 / ROADPOSE_ROW_STEP), low = (int)(0.1 * level / 0.3 / ROADPOSE_ROW_STEP);
        memset(image, 0, sizeof image);
        memset(&u_disparity, 0, sizeof u_disparity);
        for (int row = 0; row < ROWS; row++) {
            if (row < tall) image[row][10] = (uint16_t)(256 * level + 77);
            if (row < low) image[row][20] = (uint16_t)(256 * level + 77);
        }
        (void)make_free_map();
        /* the road itself may fill as many rows as the highest rig sees in a level, 4 m / 0.3 m, in two of them */
        const double road = 2 * 1.2 * (4 / 0.3) / ROADPOSE_ROW_STEP, allowed = 0.4 * level / 0.3 / ROADPOSE_ROW_STEP;
        TEST_ASSERT_FALSE(tall > road + allowed + 2 && tall <= ROWS && is_free(10, level));
        TEST_ASSERT_TRUE(low == 0 || is_free(20, level));
    }
}

static void keep_every_fifth(void) {
    for (int row = 0; row < ROWS; row++)
        for (int i = 0; i < COLUMNS; i++)
            if ((row + i) % 5) image[row][i] = 0;
}

static void test_v_disparity_free(void) {
    roadpose_thinning_t thinning;
    keep_every_fifth();
    const uint32_t total = make_free_map();
    TEST_ASSERT_TRUE(total > 500 && total <= ROADPOSE_MAX_POINTS); /* none is thinned out */
    roadpose_thinning_begin(&thinning, total, total);
    roadpose_points_clear(&points);
    for (int16_t row = 0; row < ROWS; row++) {
        const roadpose_row_t samples = row_of_q8(image[row]);
        roadpose_v_disparity_row(&v_disparity, &points, &free_map, &samples, COLUMNS, row, &thinning);
        int expected[LEVELS] = {0};
        unsigned point = points.row_start[row];
        for (int i = 0; i < COLUMNS; i++) {
            if (!image[row][i] || !is_free(i, image[row][i] / 256)) continue;
            TEST_ASSERT_EQUAL(i, points.column[point]);
            TEST_ASSERT_EQUAL_UINT16(image[row][i], points.disparity_q8[point]);
            expected[image[row][i] / 256]++;
            point++;
        }
        TEST_ASSERT_EQUAL_UINT(point, points.row_start[row + 1]);
        for (int level = 0; level < LEVELS; level++) TEST_ASSERT_EQUAL_UINT(expected[level], v_disparity.count[row][level]);
    }
    TEST_ASSERT_EQUAL_UINT32(total, points.count);
}

static uint32_t fill_points(uint32_t total) {
    roadpose_thinning_t thinning;
    roadpose_thinning_begin(&thinning, total < ROADPOSE_MAX_POINTS ? total : ROADPOSE_MAX_POINTS, total);
    roadpose_points_clear(&points);
    for (int16_t row = 0; row < ROWS; row++) add_points(&points, image[row], COLUMNS, row, &thinning);
    return points.count;
}

static void check_point_order(void) {
    int last = -1;
    for (int row = 0; row < ROWS; row++) {
        TEST_ASSERT_TRUE(points.row_start[row] <= points.row_start[row + 1]);
        for (unsigned k = points.row_start[row]; k < points.row_start[row + 1]; k++) {
            const int column = roadpose_point_column(points.column[k]);
            TEST_ASSERT_EQUAL_UINT16(image[row][column], points.disparity_q8[k]);
            TEST_ASSERT_TRUE(row * COLUMNS + column > last); /* none twice, in reading order */
            last = row * COLUMNS + column;
            TEST_ASSERT_EQUAL(row, roadpose_points_row(&points, ROWS, (uint16_t)k));
        }
    }
}

static uint32_t samples_in_image(void) {
    uint32_t total = 0;
    for (int row = 0; row < ROWS; row++)
        for (int i = 0; i < COLUMNS; i++) total += image[row][i] != 0;
    return total;
}

static void test_points_without_thinning(void) {
    keep_every_fifth();
    const uint32_t total = samples_in_image();
    TEST_ASSERT_TRUE(total > 1000 && total < ROADPOSE_MAX_POINTS);
    TEST_ASSERT_EQUAL_UINT32(total, fill_points(total));
    check_point_order();
}

/* More samples than memory: filled to the last place, and evenly: no row gets more than its share by one. */
static void test_points_with_thinning(void) {
    const uint32_t total = samples_in_image();
    TEST_ASSERT_TRUE(total > ROADPOSE_MAX_POINTS);
    TEST_ASSERT_EQUAL_UINT32(ROADPOSE_MAX_POINTS, fill_points(total));
    check_point_order();
    for (int row = 0; row < ROWS; row++) {
        int in_row = 0;
        for (int i = 0; i < COLUMNS; i++) in_row += image[row][i] != 0;
        const double share = (double)in_row * ROADPOSE_MAX_POINTS / total;
        ASSERT_LSB(1, share, points.row_start[row + 1] - points.row_start[row], "points of a row");
    }
}

/* A buffer that grew between the passes must not write beyond the points. */
static void test_points_when_the_total_was_wrong(void) {
    TEST_ASSERT_TRUE(fill_points(100) <= ROADPOSE_MAX_POINTS);
    check_point_order();
}

static void test_thinning_is_exact(void) {
    for (uint32_t total = 1; total < 400; total += 7)
        for (uint32_t keep = 0; keep <= total; keep++) {
            roadpose_thinning_t thinning;
            uint32_t kept = 0;
            roadpose_thinning_begin(&thinning, keep, total);
            for (uint32_t i = 0; i < total; i++) kept += roadpose_thin(&thinning);
            TEST_ASSERT_EQUAL_UINT32(keep, kept);
        }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_u_disparity);
    RUN_TEST(test_u_disparity_holds_every_row);
    RUN_TEST(test_free_map_without_limits);
    RUN_TEST(test_free_map_corridor);
    RUN_TEST(test_free_map_obstacles);
    RUN_TEST(test_v_disparity_free);
    RUN_TEST(test_points_without_thinning);
    RUN_TEST(test_points_with_thinning);
    RUN_TEST(test_points_when_the_total_was_wrong);
    RUN_TEST(test_thinning_is_exact);
    return UNITY_END();
}
