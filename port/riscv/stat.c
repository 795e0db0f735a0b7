/* What the C library for RISC-V leaves to its user: whether a file or folder of the debugger's host exists. */
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int stat(const char *restrict path, struct stat *restrict status) {
    const int file = open(path, O_RDONLY);

    if (file < 0)
        return -1;
    memset(status, 0, sizeof *status); /* nobody asks for more */
    return close(file);
}
