/* A scratch folder of its own for each test: removed when the test passed, kept for a look when it failed. */
#ifndef ROADPOSE_TEST_SCRATCH_H
#define ROADPOSE_TEST_SCRATCH_H

#include <stdbool.h>
#include <stddef.h>

#define SCRATCH_PATH_BYTES 512

/* Make it in setUp(), end it in tearDown() with whether to keep it. */
void scratch_make(void);
void scratch_end(bool keep);

/* Path of something in it; "" is the folder itself. Four answers stay valid at a time. */
const char *scratch_path(const char *name);

void scratch_make_folder(const char *name);
void scratch_remove(const char *name); /* a file or an empty folder */
void scratch_write(const char *name, const void *bytes, size_t count);
void scratch_write_text(const char *name, const char *text);

#endif
