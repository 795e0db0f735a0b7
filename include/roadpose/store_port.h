/* roadpose: keeping a few bytes over power-off. Optional: the estimator of live poses needs none of it, and the library
 * calls neither function. It is the contract between the platform and an application that learns over a drive (a mount
 * pose, the running yaw): fill it in when there is memory for it, leave it out otherwise. A record has no checksum of
 * the library's: the platform answers for it being complete, the application for it being of its own version.
 */
#ifndef ROADPOSE_STORE_PORT_H
#define ROADPOSE_STORE_PORT_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whatever the platform's functions need. The platform defines the struct; its pointer is only passed on. */
typedef struct roadpose_store_context roadpose_store_context_t;

typedef struct {
    roadpose_store_context_t *context; /* handed to both functions; may be NULL if they do without */

    /* Takes a record of at most 256 bytes and returns true when it has been copied; it may reach the memory later. The
     * newest record that was written completely is the one that counts: power may fail at any moment. Called from the
     * task only. May not: block until the memory has been written, keep the pointer, call this library. */
    bool (*store)(roadpose_store_context_t *context, const void *bytes, size_t count);

    /* Gives the newest complete record: writes count bytes and returns true, or returns false with the bytes unchanged
     * when there is none of exactly this size. Called once, before the first frame. May not: return a record that was
     * only partly written. */
    bool (*recall)(roadpose_store_context_t *context, void *bytes, size_t count);
} roadpose_store_port_t;

#ifdef __cplusplus
}
#endif

#endif
