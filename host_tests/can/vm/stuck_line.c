/* A CAN interface on a serial line that nobody reads: its queue fills up and stays full.
 *   stuck-line FILE     prints the name of the interface; on SIGUSR1 begins to read the line, and writes what the
 *                       interface sent, a line a frame as SLCAN has it, into FILE, until it is killed.
 * Needs the kernel's slcan and the right to configure the network. The line is a pseudoterminal, filled up beforehand. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#define SLCAN_DISCIPLINE 17
#define INTERFACE_NAME 0x8910 /* SIOCGIFNAME, of a line's interface */
#define FILL '\n'             /* an empty line: no frame */
#define TRIES 20              /* of 10 ms: the kernel moves what was written onwards now and then */

static int open_line(int *master) {
    struct termios raw;
    int slave;
    *master = posix_openpt(O_RDWR | O_NOCTTY);
    if (*master < 0 || grantpt(*master) != 0 || unlockpt(*master) != 0)
        return -1;
    slave = open(ptsname(*master), O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (slave < 0 || tcgetattr(slave, &raw) != 0)
        return -1;
    cfmakeraw(&raw);
    return tcsetattr(slave, TCSANOW, &raw) == 0 ? slave : -1;
}

static void fill(int slave) {
    const char filling = FILL;
    for (int tries = 0; tries < TRIES; tries++) {
        while (write(slave, &filling, 1) == 1)
            tries = 0;
        (void)usleep(10000);
    }
}

static int attach(int slave, char name[16]) {
    const int discipline = SLCAN_DISCIPLINE;
    return ioctl(slave, TIOCSETD, &discipline) == 0 && ioctl(slave, INTERFACE_NAME, name) == 0;
}

static void copy(int master, const char *path) {
    FILE *const file = fopen(path, "w");
    char bytes[256];
    ssize_t count;
    while (file != NULL && (count = read(master, bytes, sizeof bytes)) > 0) {
        for (ssize_t i = 0; i < count; i++)
            if (bytes[i] != FILL)
                (void)fputc(bytes[i] == '\r' ? '\n' : bytes[i], file);
        (void)fflush(file);
    }
}

int main(int count, char *arguments[]) {
    char name[16] = "";
    sigset_t begin;
    int master, slave, caught;
    if (count != 2)
        return 2;
    (void)sigemptyset(&begin);
    (void)sigaddset(&begin, SIGUSR1);
    (void)sigprocmask(SIG_BLOCK, &begin, NULL);
    slave = open_line(&master);
    if (slave < 0)
        return perror("stuck-line"), 1;
    fill(slave);
    if (!attach(slave, name))
        return perror("stuck-line: slcan"), 1;
    puts(name);
    (void)fflush(stdout);
    (void)sigwait(&begin, &caught);
    copy(master, arguments[1]);
    return 0;
}
