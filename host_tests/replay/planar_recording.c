#include "planar_recording.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scratch.h"

#define FOCAL_PX 250.0
#define CU_PX 159.5
#define CV_PX 119.5
#define BASELINE_M 0.30
#define RADIANS (3.14159265358979323846 / 180.0)

#define HEADER_BYTES 64

static char file_name[256];

static const char *frame_file(const char *recording, const char *name) {
    (void)snprintf(file_name, sizeof file_name, "%s/disparity/%s", recording, name);
    return file_name;
}

void planar_recording_begin(const char *recording, const char *rig) {
    scratch_make_folder(recording);
    (void)snprintf(file_name, sizeof file_name, "%s/disparity", recording);
    scratch_make_folder(file_name);
    (void)snprintf(file_name, sizeof file_name, "%s/rig.yml", recording);
    scratch_write_text(file_name, rig);
}

/* d(u, v) = a (u - u0) + b (v - v0) + c with the road's normal n: a = B n_x / h, b = B n_y / h, c = f B n_z / h. */
static double road_disparity(planar_pose_t pose, int column, int row) {
    const double pitch = pose.pitch_deg * RADIANS, roll = pose.roll_deg * RADIANS;
    const double n_x = cos(pitch) * sin(roll), n_y = cos(pitch) * cos(roll), n_z = sin(pitch);

    return BASELINE_M / pose.height_m * (n_x * (column - CU_PX) + n_y * (row - CV_PX) + n_z * FOCAL_PX);
}

static uint16_t sample_of(double disparity, planar_samples_t samples) {
    const double sample = floor((disparity + samples.offset_px) * samples.scale + 0.5);

    return disparity < 0.5 || sample > 65535.0 ? samples.invalid : (uint16_t)sample;
}

static void put_sample(uint8_t *bytes, uint16_t sample) {
    bytes[0] = (uint8_t)(sample >> 8);
    bytes[1] = (uint8_t)(sample & 255u);
}

void planar_recording_add(const char *recording, const char *name, planar_pose_t pose, planar_samples_t samples) {
    static uint8_t file[HEADER_BYTES + 2 * PLANAR_SAMPLES];
    const int header = snprintf((char *)file, HEADER_BYTES, "P5\n%d %d\n65535\n", PLANAR_WIDTH, PLANAR_HEIGHT);
    uint8_t *next = file + header;

    for (int row = 0; row < PLANAR_HEIGHT; row++)
        for (int column = 0; column < PLANAR_WIDTH; column++, next += 2)
            put_sample(next, sample_of(road_disparity(pose, column, row), samples));
    scratch_write(frame_file(recording, name), file, (size_t)(next - file));
}

void planar_recording_add_raw(const char *recording, const char *name, const char *header, uint16_t sample,
                              unsigned bytes) {
    static uint8_t file[HEADER_BYTES + 2 * 2048 * 1536 + 2];
    const size_t start = strlen(header);

    memcpy(file, header, start);
    for (unsigned i = 0; i < bytes; i += 2)
        put_sample(file + start + i, sample);
    scratch_write(frame_file(recording, name), file, start + bytes);
}
