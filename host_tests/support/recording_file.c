#include "recording_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static FILE *open_file(const recording_t *recording, const char *name) {
    char path[1200];
    snprintf(path, sizeof path, "%s/%s", recording->folder, name);
    return fopen(path, "rb");
}

static FILE *open_frame(const recording_t *recording, const char *kind, int frame, const char *extension) {
    char name[64];
    snprintf(name, sizeof name, "%s/%06d.%s", kind, frame, extension);
    return open_file(recording, name);
}

static bool complain(const recording_t *recording, const char *what) {
    fprintf(stderr, "%s: %s\n", recording->folder, what);
    return false;
}

static void take_rig_value(recording_rig_t *rig, const char *key, double value) {
    if (strcmp(key, "width") == 0) rig->width = (int)value;
    if (strcmp(key, "height") == 0) rig->height = (int)value;
    if (strcmp(key, "focal_px") == 0) rig->focal_px = value;
    if (strcmp(key, "cu_px") == 0) rig->cu_px = value;
    if (strcmp(key, "cv_px") == 0) rig->cv_px = value;
    if (strcmp(key, "baseline_m") == 0) rig->baseline_m = value;
    if (strcmp(key, "disparity_scale") == 0) rig->disparity_scale = value;
    if (strcmp(key, "invalid") == 0) rig->invalid = value;
    if (strcmp(key, "disparity_offset_px") == 0) rig->disparity_offset_px = value;
}

static bool read_rig(recording_t *recording) {
    FILE *file = open_file(recording, "rig.yml");
    char line[256], key[64];
    double value;
    if (!file) return false;
    recording->rig.disparity_scale = 256;
    while (fgets(line, sizeof line, file))
        if (sscanf(line, " %63[a-z_] : %lf", key, &value) == 2) take_rig_value(&recording->rig, key, value);
    fclose(file);
    return recording->rig.width > 0 && recording->rig.height > 0 && recording->rig.focal_px > 0;
}

static int count_frames(const recording_t *recording) {
    int frames = 0;
    for (FILE *file; (file = open_frame(recording, "disparity", frames, "pgm")) != NULL; frames++) fclose(file);
    return frames;
}

static void take_truth_line(recording_t *recording, const char *line) {
    int frame, road;
    recording_truth_t truth = {0};
    int fields = sscanf(line, "%d,%d,%lf,%lf,%lf,%39[^,\r\n]", &frame, &road, &truth.pitch_deg, &truth.roll_deg,
                        &truth.height_m, truth.scene);
    if (fields < 2 || frame < 0 || frame >= recording->frames) return;
    if (fields == 2) (void)sscanf(line, "%*d,%*d,,,,%39[^,\r\n]", truth.scene);
    truth.known = road == 0 || fields >= 5;
    truth.road = road != 0;
    recording->truth[frame] = truth;
}

static void read_truth(recording_t *recording) {
    FILE *file = open_file(recording, "truth.csv");
    char line[512];
    if (!file) return;
    while (fgets(line, sizeof line, file)) take_truth_line(recording, line);
    fclose(file);
}

static void set_folder(recording_t *recording, const char *folder) {
    memset(recording, 0, sizeof *recording);
    snprintf(recording->folder, sizeof recording->folder, "%s", folder);
    for (size_t n = strlen(recording->folder); n > 1 && recording->folder[n - 1] == '/'; n--)
        recording->folder[n - 1] = '\0';
    const char *slash = strrchr(recording->folder, '/');
    snprintf(recording->name, sizeof recording->name, "%.127s", slash ? slash + 1 : recording->folder);
}

bool recording_open(recording_t *recording, const char *folder) {
    set_folder(recording, folder);
    if (!read_rig(recording)) return complain(recording, "no readable rig.yml");
    recording->frames = count_frames(recording);
    if (recording->frames == 0) return complain(recording, "no disparity/000000.pgm");
    recording->truth = calloc((size_t)recording->frames, sizeof *recording->truth);
    if (!recording->truth) return complain(recording, "out of memory");
    read_truth(recording);
    return true;
}

void recording_close(recording_t *recording) {
    free(recording->truth);
    recording->truth = NULL;
}

bool recording_read_disparity(const recording_t *recording, int frame, uint8_t *samples) {
    FILE *file = open_frame(recording, "disparity", frame, "pgm");
    int width = 0, height = 0, top = 0;
    size_t bytes = 2u * (size_t)recording->rig.width * (size_t)recording->rig.height;
    if (!file) return complain(recording, "a frame cannot be opened");
    bool ok = fscanf(file, "P5 %d %d %d", &width, &height, &top) == 3 && fgetc(file) != EOF &&
              width == recording->rig.width && height == recording->rig.height && top == 65535 &&
              fread(samples, 1, bytes, file) == bytes;
    fclose(file);
    return ok ? true : complain(recording, "a frame is malformed");
}

static bool read_mask_rows(const recording_t *recording, FILE *file, uint8_t *mask) {
    uint8_t line[512];
    const size_t width = (size_t)recording->rig.width, bytes = (width + 7) / 8;
    if (bytes > sizeof line) return false;
    for (int row = 0; row < recording->rig.height; row++) {
        if (fread(line, 1, bytes, file) != bytes) return false;
        for (size_t u = 0; u < width; u++) *mask++ = (uint8_t)(line[u / 8] >> (7 - u % 8) & 1);
    }
    return true;
}

bool recording_read_road(const recording_t *recording, int frame, uint8_t *mask) {
    FILE *file = open_frame(recording, "road", frame, "pbm");
    int width = 0, height = 0;
    if (!file) return false;
    bool ok = fscanf(file, "P4 %d %d", &width, &height) == 2 && fgetc(file) != EOF && width == recording->rig.width &&
              height == recording->rig.height && read_mask_rows(recording, file, mask);
    fclose(file);
    return ok ? true : complain(recording, "a road mask is malformed");
}

bool recording_describe(const recording_t *recording, roadpose_rig_t *rig, roadpose_disparity_format_t *format) {
    const recording_rig_t *from = &recording->rig;
    uint8_t bits = 0;
    while (bits < 15 && ldexp(1, bits) < from->disparity_scale) bits++;
    memset(rig, 0, sizeof *rig);
    rig->width_px = (uint16_t)from->width;
    rig->height_px = (uint16_t)from->height;
    rig->focal_millipx = (int32_t)lround(from->focal_px * 1000);
    rig->cu_millipx = (int32_t)lround(from->cu_px * 1000);
    rig->cv_millipx = (int32_t)lround(from->cv_px * 1000);
    rig->baseline_um = (int32_t)lround(from->baseline_m * 1e6);
    if (!roadpose_format_preset(format, ROADPOSE_FORMAT_U16_Q8)) return false;
    format->byte_order = ROADPOSE_BYTES_BIG;
    format->fraction_bits = bits;
    format->invalid_first = format->invalid_last = (uint16_t)(int32_t)from->invalid;
    format->offset_millipx = (int32_t)lround(from->disparity_offset_px * 1000);
    return ldexp(1, bits) == from->disparity_scale;
}
