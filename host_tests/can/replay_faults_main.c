/* roadpose-replay on the fake kernel, as the environment says: ROADPOSE_REFUSED="FROM TO ERRNO" (calls of send that fail),
 * ROADPOSE_BUS_OFF="FROM TO" (calls of recv that read of it and of its end), ROADPOSE_NO_CAN (a kernel without CAN). */
#include <stdio.h>
#include <stdlib.h>

#include "fake_kernel.h"

int replay_main(int count, char *arguments[]); /* main() of port/replay */

int main(int count, char *arguments[]) {
    const char *const refused = getenv("ROADPOSE_REFUSED");
    const char *const bus_off = getenv("ROADPOSE_BUS_OFF");
    fake_kernel_init();
    kernel.has_can = getenv("ROADPOSE_NO_CAN") == NULL;
    if (refused != NULL &&
        sscanf(refused, "%d %d %d", &kernel.refused.from, &kernel.refused.to, &kernel.refused_errno) != 3)
        return 99;
    if (bus_off != NULL && sscanf(bus_off, "%d %d", &kernel.bus_off.from, &kernel.bus_off.to) != 2)
        return 99;
    return replay_main(count, arguments);
}
