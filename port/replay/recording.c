#include "recording.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define EXTENSION ".pgm"
#define NUMBER_DIGITS 9 /* fits a uint32_t whatever the digits are */

static size_t stem_length(const char *name) {
    return strlen(name) - strlen(EXTENSION);
}

static bool is_frame_name(const char *name) {
    return name[0] != '.' && strlen(name) > strlen(EXTENSION) && strcmp(name + stem_length(name), EXTENSION) == 0;
}

static bool is_number_name(const char *name) {
    const size_t digits = strspn(name, "0123456789");

    return digits == stem_length(name) && digits <= NUMBER_DIGITS;
}

static bool add_name(recording_t *recording, const char *name) {
    const size_t bytes = strlen(name) + 1;
    char *copy = malloc(bytes);
    char **names = realloc(recording->names, (recording->count + 1) * sizeof *names);

    recording->names = names != NULL ? names : recording->names;
    if (copy == NULL || names == NULL) {
        free(copy);
        return fault(recording->folder, "has more frames than memory for their names");
    }
    memcpy(copy, name, bytes);
    names[recording->count++] = copy;
    recording->is_numbered = recording->is_numbered && is_number_name(name);
    return true;
}

static bool add_names(recording_t *recording, DIR *folder) {
    const struct dirent *entry;

    errno = 0; /* readdir() returns NULL at the end as well as on an error */
    for (entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        if (is_frame_name(entry->d_name) && !add_name(recording, entry->d_name))
            return false;
        errno = 0;
    }
    return errno == 0 || fault(recording->folder, "cannot be read: %s", strerror(errno));
}

static int compare_names(const void *left, const void *right) {
    return strcmp(*(char *const *)left, *(char *const *)right);
}

bool recording_open(recording_t *recording, const char *path) {
    DIR *folder;
    bool is_read;

    recording->names = NULL;
    recording->count = 0;
    recording->is_numbered = true;
    if (!join_path(recording->folder, path, "disparity"))
        return false;
    folder = opendir(recording->folder);
    if (folder == NULL)
        return fault(recording->folder, "cannot be read: %s", strerror(errno));
    is_read = add_names(recording, folder);
    (void)closedir(folder);
    if (is_read && recording->count == 0)
        return fault(recording->folder, "has no frames (*" EXTENSION ")");
    if (is_read)
        qsort(recording->names, recording->count, sizeof *recording->names, compare_names);
    return is_read;
}

void recording_close(recording_t *recording) {
    while (recording->count > 0)
        free(recording->names[--recording->count]);
    free(recording->names);
    recording->names = NULL;
}

uint32_t recording_frame_number(const recording_t *recording, size_t index) {
    return recording->is_numbered ? (uint32_t)strtoul(recording->names[index], NULL, 10) : (uint32_t)index;
}

bool recording_frame_path(const recording_t *recording, size_t index, char path[PATH_BYTES]) {
    return join_path(path, recording->folder, recording->names[index]);
}
