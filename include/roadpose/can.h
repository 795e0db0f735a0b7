/* roadpose: the pose on a classic CAN bus. Three messages of 8 bytes each, sent every cycle, also when there is no
 * pose, which they then say; AUTOSAR E2E protection; and the same for a receiver. port/can/roadpose.dbc describes them
 * to every other tool, docs/can.md to people.
 *
 * Bytes 0-2 of a message belong to the E2E header of whatever profile is set, bytes 3-7 are 40 bits of signals, Intel
 * byte order. So there is one layout for all profiles. All ones in a signal is its invalid code: the signal was not
 * observed, or does not fit. A value that does not fit is never wrapped and never clamped to the end of the range.
 *
 * | message | signal                | bits  | code 0   | step     | last valid | field below                      |
 * |---------|-----------------------|-------|----------|----------|------------|----------------------------------|
 * | pose    | pitch                 | 24|14 | -40.96   | 0.005    | 40.95 deg  | pitch_urad, + = nose down        |
 * | pose    | roll                  | 38|14 | -40.96   | 0.005    | 40.95 deg  | roll_urad, + = right side down   |
 * | pose    | height                | 52|12 | 0.2      | 0.00125  | 5.3175 m   | height_um                        |
 * | quality | yaw                   | 24|12 | -40.96   | 0.02     | 40.92 deg  | yaw_urad, + = looks to the left  |
 * | quality | support               | 36|7  | 0        | 1        | 100 %      | support_permille                 |
 * | quality | residual              | 43|7  | 0        | 0.025    | 3.15 px    | residual_millipx                 |
 * | quality | nearest road          | 50|6  | 0        | 0.5      | 31 m       | range_near_mm                    |
 * | quality | farthest road         | 56|8  | 0        | 1        | 254 m      | range_far_mm                     |
 * | status  | pose status           | 24|4  |          |          | 14         | pose_status                      |
 * | status  | yaw status            | 28|4  |          |          | 14         | yaw_status                       |
 * | status  | frame count           | 32|8  | 0        | 1        | 254        | frame_count, modulo 255          |
 * | status  | refused count         | 40|8  | 0        | 1        | 254        | refused_count, modulo 255        |
 * | status  | overwritten count     | 48|8  | 0        | 1        | 254        | overwritten_count, modulo 255    |
 * | status  | dropped count         | 56|8  | 0        | 1        | 254        | dropped_count, modulo 255        |
 *
 * Every function is re-entrant; one transmitter or receiver must not be used by two tasks at a time, so publishing, cycle
 * and poll belong to one task, or need the platform's lock. No heap, no floating point, no clock. Numbers are rounded to
 * the nearest code.
 */
#ifndef ROADPOSE_CAN_H
#define ROADPOSE_CAN_H

#include <stdbool.h>
#include <stdint.h>

#include "roadpose/can_port.h"
#include "roadpose/e2e.h"
#include "roadpose/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---------------------------------------------------------------------------------------------------- messages */

typedef enum {
    ROADPOSE_CAN_MESSAGE_POSE = 0,
    ROADPOSE_CAN_MESSAGE_QUALITY = 1,
    ROADPOSE_CAN_MESSAGE_STATUS = 2,
    ROADPOSE_CAN_MESSAGE_NONE = 3 /* a frame of somebody else */
} roadpose_can_message_t;
#define ROADPOSE_CAN_MESSAGES 3u

/* Codes of pose_status on the bus: those of roadpose_status_t, and these. */
#define ROADPOSE_CAN_STATUS_BAD_FRAME 13u /* the last frame could not be processed: wrong size, format or order */
#define ROADPOSE_CAN_STATUS_NO_FRAME 14u  /* no frame yet, or the last one is older than max_age_us */
#define ROADPOSE_CAN_STATUS_INVALID 15u   /* all ones: not known */

/* Bits of valid. */
#define ROADPOSE_CAN_PITCH 1u
#define ROADPOSE_CAN_ROLL 2u
#define ROADPOSE_CAN_HEIGHT 4u
#define ROADPOSE_CAN_YAW 1u
#define ROADPOSE_CAN_SUPPORT 2u
#define ROADPOSE_CAN_RESIDUAL 4u
#define ROADPOSE_CAN_RANGE_NEAR 8u
#define ROADPOSE_CAN_RANGE_FAR 16u
#define ROADPOSE_CAN_FRAME_COUNT 1u
#define ROADPOSE_CAN_REFUSED_COUNT 2u
#define ROADPOSE_CAN_OVERWRITTEN_COUNT 4u
#define ROADPOSE_CAN_DROPPED_COUNT 8u

/* A field whose bit is not set in valid is 0 when unpacked and ignored when packed. */
typedef struct {
    uint8_t valid;      /* ROADPOSE_CAN_PITCH, _ROLL, _HEIGHT */
    int32_t pitch_urad; /* ISO 8855, + = nose down */
    int32_t roll_urad;  /* ISO 8855, + = right side down */
    int32_t height_um;  /* left camera over the road plane */
} roadpose_can_pose_t;

typedef struct {
    uint8_t valid;             /* ROADPOSE_CAN_YAW, _SUPPORT, _RESIDUAL, _RANGE_NEAR, _RANGE_FAR */
    int32_t yaw_urad;          /* ISO 8855, + = camera looks to the left */
    uint16_t support_permille; /* 0...1000 */
    uint16_t residual_millipx; /* root mean square */
    uint32_t range_near_mm;
    uint32_t range_far_mm;
} roadpose_can_quality_t;

/* Counts run over: on the bus they are modulo 255, so that 255 stays the invalid code; a listener takes differences
 * modulo 255. */
typedef struct {
    uint8_t valid;              /* ROADPOSE_CAN_FRAME_COUNT, _REFUSED_COUNT, _OVERWRITTEN_COUNT, _DROPPED_COUNT */
    uint8_t pose_status;        /* roadpose_status_t or ROADPOSE_CAN_STATUS_...; above 15: sent as 15 */
    uint8_t yaw_status;         /* roadpose_yaw_status_t; 15: not known, or the rig estimates no yaw */
    uint32_t frame_count;       /* of the frame that the pose belongs to */
    uint32_t refused_count;     /* frames without a pose */
    uint32_t overwritten_count; /* frames that the camera delivered and a newer one replaced unseen */
    uint32_t dropped_count;     /* CAN frames that were not sent: the queue stayed full, or the bus was down */
} roadpose_can_status_t;

/* Pack one message: all 8 bytes are written, the E2E header as zero. message NULL: every signal invalid. data must be
 * given. Constant time. */
void roadpose_can_pack_pose(const roadpose_can_pose_t *message, uint8_t data[8]);
void roadpose_can_pack_quality(const roadpose_can_quality_t *message, uint8_t data[8]);
void roadpose_can_pack_status(const roadpose_can_status_t *message, uint8_t data[8]);

/* Unpack one message; the E2E header is not looked at. Any 8 bytes give a message: an invalid code, or one beyond the
 * last valid, gives a field of 0 with its bit not set. Counts come back modulo 255. What was unpacked packs to the same
 * codes. Both pointers must be given. Constant time. */
void roadpose_can_unpack_pose(const uint8_t data[8], roadpose_can_pose_t *message);
void roadpose_can_unpack_quality(const uint8_t data[8], roadpose_can_quality_t *message);
void roadpose_can_unpack_status(const uint8_t data[8], roadpose_can_status_t *message);

/* A word for a pose status on the bus: that of roadpose_status_word(), and "bad_frame", "no_frame", "invalid",
 * "reserved". Never NULL; static storage. */
const char *roadpose_can_status_word(uint8_t pose_status);

/* ---------------------------------------------------------------------------------------------------- settings */

/* Settings of sender and receiver: equal on both sides. */
typedef struct {
    uint32_t id[ROADPOSE_CAN_MESSAGES]; /* CAN identifiers (can_port.h), all different. Default 0x3D0, 0x3D1, 0x3D2 */
    roadpose_e2e_config_t e2e[ROADPOSE_CAN_MESSAGES]; /* default: profile 1, data_id 0x5250, 0x5251, 0x5252,
                                                         max_delta 3, lists as in docs/can.md */
    uint32_t cycle_us;   /* from one cycle to the next, 1000...10 000 000. Default 100 000 */
    uint32_t max_age_us; /* sender: an estimate older than this is no longer sent, 0...600 000 000. Default 250 000 */
    uint8_t timeout_cycles; /* receiver: cycles without a usable frame until its signals are invalid, 1...255.
                               Default 3 */
} roadpose_can_settings_t;

/* Fills *settings with the defaults and the given profile for all three messages. Returns false, with *settings
 * unchanged, on NULL or an unknown profile. Constant time. */
bool roadpose_can_settings_default(roadpose_can_settings_t *settings, roadpose_e2e_profile_t profile);

/* True when every field is in its range, the identifiers differ, and the data identifiers of messages with the same
 * profile differ (of profile 2 at every counter). False on NULL. Constant time. */
bool roadpose_can_settings_valid(const roadpose_can_settings_t *settings);

/* ------------------------------------------------------------------------------------------------------ sender */

/* What one camera frame came to, as the sender wants it. */
typedef struct {
    roadpose_can_pose_t pose;
    roadpose_can_quality_t quality;
    uint8_t pose_status; /* as in roadpose_can_status_t */
    uint8_t yaw_status;
} roadpose_can_estimate_t;

/* Fills *estimate from the core's result. pose NULL: the frame could not be processed (BAD_FRAME). The yaw is left
 * invalid, its status not known. The support figures of a refused frame are valid as far as the work came, that is
 * where they are not 0. Does nothing when estimate is NULL. Constant time. */
void roadpose_can_estimate(roadpose_can_estimate_t *estimate, const roadpose_pose_t *pose);

/* Adds the yaw. yaw_status 0: yaw_urad is valid; else yaw_urad is ignored and yaw_status says why. Does nothing when
 * estimate is NULL. */
void roadpose_can_estimate_yaw(roadpose_can_estimate_t *estimate, int32_t yaw_urad, uint8_t yaw_status);

/* What the sender has counted since it was initialised; all run over at 2^32. */
typedef struct {
    uint32_t estimates;   /* published */
    uint32_t refused;     /* of those, without a pose */
    uint32_t overwritten; /* as the caller reports it */
    uint32_t cycles;
    uint32_t sent;      /* CAN frames that the port took */
    uint32_t full;      /* times that the port answered FULL */
    uint32_t dropped;   /* CAN frames given up: never taken, and replaced by the next cycle's */
    uint32_t down;      /* times that the bus went down, bus-off included */
    uint32_t bus_off;   /* times that it became bus-off, from up or from down */
    uint32_t recovered; /* times that the bus was there again: it took a frame, or had no room for one */
} roadpose_can_counts_t;

/* One frame that waits for the port. Private members. */
typedef struct {
    uint8_t data[ROADPOSE_CAN_BYTES];
    uint8_t counter; /* E2E counter of this frame, or of the next one when nothing waits */
    uint16_t sent;   /* counter of the last frame that was taken; 0xFFFF: none yet */
    bool waits;
} roadpose_can_slot_t;

/* The sender's memory; the caller's, private members. */
typedef struct {
    roadpose_can_settings_t settings;
    roadpose_can_port_t port;
    roadpose_can_estimate_t newest;
    uint64_t newest_us;
    uint64_t start_us; /* of the cycle */
    bool has_estimate;
    bool bus_down; /* last answer of can_send */
    bool bus_off;  /* likewise */
    roadpose_can_slot_t slot[ROADPOSE_CAN_MESSAGES];
    roadpose_can_counts_t counts;
} roadpose_can_transmit_t;

/* Where the sender stands after a call. */
typedef enum {
    ROADPOSE_CAN_DONE = 0,           /* all frames of this cycle were taken, or are past their deadline */
    ROADPOSE_CAN_WAITING = 1,        /* the port was full: poll again before the cycle ends */
    ROADPOSE_CAN_NO_BUS = 2,         /* interface down or bus-off: recovery is asked for at the next cycle */
    ROADPOSE_CAN_ERROR_NULL = -1,    /* a pointer that must be given is NULL */
    ROADPOSE_CAN_ERROR_SETTINGS = -2 /* a setting is out of range */
} roadpose_can_result_t;

/* Makes *transmit ready; copies settings and port. settings NULL: the defaults with profile 1. Returns
 * ROADPOSE_CAN_DONE, or ROADPOSE_CAN_ERROR_NULL (transmit, port or can_send), _SETTINGS, with *transmit unchanged.
 * Constant time; the port is not called. */
roadpose_can_result_t roadpose_can_transmit_init(roadpose_can_transmit_t *transmit,
                                                 const roadpose_can_settings_t *settings,
                                                 const roadpose_can_port_t *port);

/* Hands over the newest estimate, which is copied, and how many camera frames were overwritten so far
 * (roadpose_can_counts_t.overwritten is set to it). Replaces the one before, sent or not. time_us: from when on its age
 * counts, on the clock of roadpose_can_transmit_cycle(): the exposure where the camera is stamped by that clock, else
 * when the pose became known. Dated more than cycle_us ahead of the cycle that would send it, its age cannot be told,
 * and it is treated as too old. Nothing is sent: the next cycle does. Does nothing on NULL. Constant time. */
void roadpose_can_transmit_publish(roadpose_can_transmit_t *transmit, const roadpose_can_estimate_t *estimate,
                                   uint32_t overwritten, uint64_t time_us);

/* Begins a cycle: gives up what still waits from the last one, packs the newest estimate, protects, and offers the
 * three frames. Call it every cycle_us, also when there is no new estimate; max_age_us then says for how long the last
 * one still counts. Returns DONE, WAITING or NO_BUS, or ERROR_NULL.
 *
 * E2E counters: a frame that found no room for the whole cycle was never sent, so its replacement takes over its
 * counter; counters have no gap however long a queue is full. While the bus is down, counters go on with every cycle,
 * so that the receivers see from the gap how much they missed; only the value of the last frame that was sent is left
 * out, because a receiver would take the first frame after the outage for a repetition.
 * Cost: three CRCs of 9 bytes, one call of can_recover at most, three of can_send at most. */
roadpose_can_result_t roadpose_can_transmit_cycle(roadpose_can_transmit_t *transmit, uint64_t now_us);

/* Offers again what waits. Call it as often as the platform likes (from the transmit-complete event's task, or every
 * millisecond); it gives up at the end of the cycle. Same answers as cycle. Cost: three calls of can_send at most. */
roadpose_can_result_t roadpose_can_transmit_poll(roadpose_can_transmit_t *transmit, uint64_t now_us);

/* The counts; NULL on NULL. The pointer is good as long as *transmit is. */
const roadpose_can_counts_t *roadpose_can_transmit_counts(const roadpose_can_transmit_t *transmit);

/* ---------------------------------------------------------------------------------------------------- receiver */

/* What a listener knows. */
typedef struct {
    roadpose_can_pose_t pose;
    roadpose_can_quality_t quality;
    roadpose_can_status_t status;
    uint8_t e2e[ROADPOSE_CAN_MESSAGES];         /* roadpose_e2e_status_t of the last frame, or of the last cycle */
    uint32_t not_usable[ROADPOSE_CAN_MESSAGES]; /* frames that came and were refused: CRC, sequence, repetition */
} roadpose_can_view_t;

/* The receiver's memory; the caller's. All members but view are private. */
typedef struct {
    roadpose_can_settings_t settings;
    roadpose_e2e_receiver_t receiver[ROADPOSE_CAN_MESSAGES];
    bool arrived[ROADPOSE_CAN_MESSAGES];   /* a frame in this cycle */
    uint16_t missed[ROADPOSE_CAN_MESSAGES]; /* cycles since the last usable frame; wider than timeout_cycles */
    roadpose_can_view_t view;
} roadpose_can_receive_t;

/* Makes *receive ready: nothing is known, every signal invalid. settings NULL: the defaults with profile 1. Returns
 * ROADPOSE_CAN_DONE, ROADPOSE_CAN_ERROR_NULL or ROADPOSE_CAN_ERROR_SETTINGS, with *receive unchanged. */
roadpose_can_result_t roadpose_can_receive_init(roadpose_can_receive_t *receive,
                                                const roadpose_can_settings_t *settings);

/* Takes one data frame from the bus (no remote frame). Returns which message it was, NONE for an identifier that is not
 * ours or on NULL; receive->view.e2e[message] tells whether it could be used; only then were its signals taken over. A
 * frame of ours whose length is not 8 counts as a CRC error. Constant time. */
roadpose_can_message_t roadpose_can_receive_frame(roadpose_can_receive_t *receive, uint32_t id, const uint8_t *data,
                                                  uint8_t length);

/* Ends a cycle of the receiver: a message that did not come since the last call is NO_NEW_DATA, and after
 * timeout_cycles without a usable frame its signals are invalid. Call it every cycle_us. Does nothing on NULL. */
void roadpose_can_receive_cycle(roadpose_can_receive_t *receive);

#ifdef __cplusplus
}
#endif

#endif
