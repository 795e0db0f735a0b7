#include "scratch.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unity.h"

static char root[SCRATCH_PATH_BYTES / 2];

void scratch_make(void) {
    const char *parent = getenv("TMPDIR");

    (void)snprintf(root, sizeof root, "%s/roadpose-test-XXXXXX", parent != NULL ? parent : "/tmp");
    TEST_ASSERT_NOT_NULL_MESSAGE(mkdtemp(root), "cannot make a scratch folder");
}

void scratch_end(bool keep) {
    const pid_t child = keep ? -1 : fork();

    if (keep)
        (void)printf("\nkept for a look: %s\n", root);
    if (child == 0) {
        (void)execlp("rm", "rm", "-rf", "--", root, (char *)NULL);
        _exit(127);
    }
    if (child > 0)
        (void)waitpid(child, NULL, 0);
}

const char *scratch_path(const char *name) {
    static char paths[4][SCRATCH_PATH_BYTES];
    static unsigned next;
    char *path = paths[next++ % 4];

    (void)snprintf(path, SCRATCH_PATH_BYTES, "%s%s%s", root, *name != '\0' ? "/" : "", name);
    return path;
}

void scratch_make_folder(const char *name) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, mkdir(scratch_path(name), 0777), name);
}

void scratch_remove(const char *name) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, remove(scratch_path(name)), name);
}

void scratch_write(const char *name, const void *bytes, size_t count) {
    FILE *file = fopen(scratch_path(name), "wb");

    TEST_ASSERT_NOT_NULL_MESSAGE(file, name);
    TEST_ASSERT_TRUE_MESSAGE(fwrite(bytes, 1, count, file) == count, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, fclose(file), name);
}

void scratch_write_text(const char *name, const char *text) {
    scratch_write(name, text, strlen(text));
}
