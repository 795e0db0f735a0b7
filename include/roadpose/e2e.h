/* roadpose: AUTOSAR E2E protection of 8-byte CAN frames, profiles 1, 2 and 5, sender's and receiver's side.
 *
 * | profile | CRC                                      | CRC at    | counter                    | data identifier     |
 * |---------|------------------------------------------|-----------|----------------------------|---------------------|
 * | 1       | CRC-8, 0x1D, start 0x00, xor 0x00        | byte 0    | byte 1, low nibble, 0...14 | 16 bit, low byte    |
 * |         | (effective values)                       |           |                            | first, before data  |
 * | 2       | CRC-8H2F, 0x2F, start 0xFF, xor 0xFF     | byte 0    | byte 1, low nibble, 0...15 | 16-entry list,      |
 * |         |                                          |           |                            | entry [counter],    |
 * |         |                                          |           |                            | after the data      |
 * | 5       | CRC-16, 0x1021, start 0xFFFF, xor 0,     | bytes 0-1 | byte 2, 0...255            | 16 bit, low byte    |
 * |         | low byte first                           |           |                            | first, after data   |
 * The data identifier is part of the CRC and is never sent. Profile 1 is the variant "both bytes" of AUTOSAR.
 *
 * Every function is re-entrant and takes constant time: at most 9 bytes through a bitwise CRC, no tables.
 */
#ifndef ROADPOSE_E2E_H
#define ROADPOSE_E2E_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ROADPOSE_E2E_BYTES 8u         /* protected frames have this length, always */
#define ROADPOSE_E2E_HEADER_BYTES 3u  /* of the largest header, profile 5: the payload begins here in all profiles */
#define ROADPOSE_E2E_LIST_ENTRIES 16u /* data identifiers of a profile 2 list */

/* Counter of the very first frame after start. Stacks differ: some send 0 first, others count up before the first
 * frame and send 1. A receiver does not care: its first frame is ROADPOSE_E2E_INITIAL with any counter. */
#ifndef ROADPOSE_E2E_FIRST_COUNTER
#define ROADPOSE_E2E_FIRST_COUNTER 0u
#endif
#if ROADPOSE_E2E_FIRST_COUNTER < 0 || ROADPOSE_E2E_FIRST_COUNTER > 14
#error "roadpose: set ROADPOSE_E2E_FIRST_COUNTER to 0...14: profile 1 has no other counters"
#endif

typedef enum {
    ROADPOSE_E2E_PROFILE_1 = 1,
    ROADPOSE_E2E_PROFILE_2 = 2,
    ROADPOSE_E2E_PROFILE_5 = 5
} roadpose_e2e_profile_t;

/* Protection of one message. Sender and receiver must have the same profile and identifiers. */
typedef struct {
    uint8_t profile;   /* roadpose_e2e_profile_t */
    uint8_t max_delta; /* receiver: largest step of the counter that still counts as "some lost", 1...14. AUTOSAR's
                          MaxDeltaCounterInit of profiles 1 and 2 is one less, its MaxDeltaCounter of 5 is this */
    uint16_t data_id;  /* profiles 1 and 5: unique among the messages of the network */
    uint8_t data_id_list[ROADPOSE_E2E_LIST_ENTRIES]; /* profile 2 */
} roadpose_e2e_config_t;

/* True when the profile is known and max_delta in range. False on NULL. */
bool roadpose_e2e_config_valid(const roadpose_e2e_config_t *config);

/* The counter that follows: 14 -> 0, 15 -> 0, 255 -> 0 for profiles 1, 2, 5. A counter that the profile does not have
 * gives 0. */
uint8_t roadpose_e2e_next_counter(uint8_t profile, uint8_t counter);

/* Writes counter and CRC into data[0...2] as the profile says and leaves every other bit as it is. counter: 0...14,
 * 15 or 255 by profile. Returns false, with data unchanged, on NULL, an unknown profile or a counter out of range. */
bool roadpose_e2e_protect(const roadpose_e2e_config_t *config, uint8_t counter, uint8_t data[8]);

/* What a receiver learns about one cycle of one message. */
typedef enum {
    ROADPOSE_E2E_OK = 0,        /* the counter is the next one: use the data */
    ROADPOSE_E2E_SOME_LOST = 1, /* CRC right, frames before it are missing, within the allowance: use the data */
    ROADPOSE_E2E_INITIAL = 2,   /* CRC right, first frame since start: nothing to compare its counter with */
    ROADPOSE_E2E_REPEATED = 3,  /* CRC right, the counter did not move: sender stuck or frame doubled; do not use */
    ROADPOSE_E2E_WRONG_SEQUENCE =
        4,                       /* CRC right, the counter jumped too far; do not use. The next is compared with it */
    ROADPOSE_E2E_CRC_ERROR = 5,  /* CRC, counter range or length wrong: not this message, or damaged; do not use */
    ROADPOSE_E2E_NO_NEW_DATA = 6 /* nothing arrived in this cycle */
} roadpose_e2e_status_t;

/* Receiver's memory of one message; the caller's, private members. Zeroed is the start state. */
typedef struct {
    bool seen;       /* a frame with a right CRC has arrived */
    uint8_t counter; /* of that frame */
    uint8_t missed;  /* cycles without a usable frame since then, saturating at 255: widens the allowance */
} roadpose_e2e_receiver_t;

/* Judges what arrived in this cycle. data: the 8 bytes, or NULL when nothing arrived. Call it once for each frame that
 * arrived, and once with NULL for each cycle in which none did: every cycle without a frame, and every frame that is
 * damaged or repeated, widens the allowance max_delta by one, so an outage that the receiver has seen is SOME_LOST and
 * not WRONG_SEQUENCE; the allowance never grows beyond the counter's range less one. config or receiver NULL, or a
 * profile that is unknown: CRC_ERROR. A frame is usable when roadpose_e2e_usable() says so. */
roadpose_e2e_status_t roadpose_e2e_check(const roadpose_e2e_config_t *config, roadpose_e2e_receiver_t *receiver,
                                         const uint8_t *data);

/* OK, SOME_LOST and INITIAL may be used; nothing else. */
bool roadpose_e2e_usable(roadpose_e2e_status_t status);

/* "ok", "some_lost", "initial", "repeated", "wrong_sequence", "crc_error", "no_new_data"; "unknown" for anything else.
 * Never NULL; static storage. */
const char *roadpose_e2e_status_word(roadpose_e2e_status_t status);

#ifdef __cplusplus
}
#endif

#endif
