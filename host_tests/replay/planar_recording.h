/* Recordings that the tests write themselves: exact planes seen from a known pose. Written into the scratch folder. */
#ifndef ROADPOSE_TEST_PLANAR_RECORDING_H
#define ROADPOSE_TEST_PLANAR_RECORDING_H

#include <stdint.h>

#define PLANAR_WIDTH 320
#define PLANAR_HEIGHT 240
#define PLANAR_SAMPLES (PLANAR_WIDTH * PLANAR_HEIGHT)

/* Lines of a rig.yml that fits the frames below; add what a test needs. */
#define PLANAR_RIG                                                                                                     \
    "%YAML:1.0\n---\nwidth: 320\nheight: 240\nfocal_px: 250.0\ncu_px: 159.5\ncv_px: 119.5\nbaseline_m: 0.30\n"

typedef struct {
    double pitch_deg; /* ISO 8855, + = nose down */
    double roll_deg;  /* + = right side down */
    double height_m;
} planar_pose_t;

/* How the disparity becomes a sample: round(disparity + offset_px) * scale), invalid where no road is to be seen. */
typedef struct {
    double scale;
    double offset_px;
    uint16_t invalid;
} planar_samples_t;

#define PLANAR_Q8 ((planar_samples_t){256.0, 0.0, 0})

/* Makes a recording with a rig.yml of the given text and an empty disparity/. */
void planar_recording_begin(const char *recording, const char *rig);

/* Adds a frame; name is that of the file. */
void planar_recording_add(const char *recording, const char *name, planar_pose_t pose, planar_samples_t samples);

/* Adds a frame of one sample value throughout, under a header of its own; bytes: of samples that are written. */
void planar_recording_add_raw(const char *recording, const char *name, const char *header, uint16_t sample,
                              unsigned bytes);

#endif
