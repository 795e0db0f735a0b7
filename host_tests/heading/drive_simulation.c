#include "drive_simulation.h"

#include <math.h>

#define ROAD_USERS 3
#define TRIES 100000

const simulated_rig_t SIMULATED_RIG = {640, 480, 500, 319.5, 239.5, 0.30};

/* Columns: the camera's axes in vehicle axes; yaw, then pitch, then roll, each about the axis already turned. */
typedef struct {
    double in_vehicle[3][3];
} axes_t;

static axes_t camera_axes(const simulated_mount_t *m) {
    axes_t a;
    const double cy = cos(m->yaw), sy = sin(m->yaw), cp = cos(m->pitch), sp = sin(m->pitch);
    const double cr = cos(m->roll), sr = sin(m->roll);
    const double body[3][3] = {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                               {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
                               {-sp, cp * sr, cp * cr}};
    for (int i = 0; i < 3; i++) {
        a.in_vehicle[i][0] = -body[i][1];
        a.in_vehicle[i][1] = -body[i][2];
        a.in_vehicle[i][2] = body[i][0];
    }
    return a;
}

void mount_normal(const simulated_mount_t *mount, double normal[3]) {
    const axes_t a = camera_axes(mount);
    for (int i = 0; i < 3; i++) normal[i] = -a.in_vehicle[2][i];
}

void mount_normal_q30(const simulated_mount_t *mount, int32_t normal_q30[3]) {
    double normal[3];
    mount_normal(mount, normal);
    for (int i = 0; i < 3; i++) normal_q30[i] = (int32_t)lround(ldexp(normal[i], 30));
}

void mount_focus(const simulated_mount_t *mount, double focal_px, double focus[2]) {
    const axes_t a = camera_axes(mount);
    focus[0] = focal_px * a.in_vehicle[0][0] / a.in_vehicle[0][2];
    focus[1] = focal_px * a.in_vehicle[0][1] / a.in_vehicle[0][2];
}

double yaw_of_focus(const double focus[2], double focal_px, const double n[3]) {
    const double t[3] = {focus[0], focus[1], focal_px};
    const double along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
    return atan2(n[1] * t[0] - n[0] * t[1], t[2] - along * n[2]);
}

typedef struct {
    double x, y; /* place of a road user, and how it moves between the frames */
    double dx, dy;
} road_user_t;

static road_user_t any_road_user(random_numbers_t *random, double moved_m) {
    const double x = random_double(random, 6, 25), y = random_double(random, -6, 6);
    const double dx = random_double(random, -1.5, 1.5), dy = random_double(random, -1.5, 1.5);
    const double along[3] = {moved_m * random_double(random, 0.3, 1.2), -moved_m, 0};
    return (road_user_t){x, y, dx + along[random_between(random, 0, 2)], dy};
}

/* A point of the street in vehicle axes: on the road, or on what stands beside it; near ones as often as far ones. */
static void any_still_point(random_numbers_t *random, double point[3]) {
    const bool road = random_double(random, 0, 1) < 0.35;
    point[0] = 1 / random_double(random, road ? 1.0 / 60 : 1.0 / 120, road ? 1.0 / 4 : 1.0 / 5);
    if (road) {
        point[1] = random_double(random, -6, 6);
        point[2] = 0;
        return;
    }
    point[1] = random_double(random, 5, 12) * (random_bits(random) & 1 ? 1 : -1);
    point[2] = random_double(random, 0, 8);
}

static bool project(const axes_t *axes, const simulated_rig_t *rig, const double from[3], double *u, double *v) {
    const double(*a)[3] = axes->in_vehicle;
    const double x = a[0][0] * from[0] + a[1][0] * from[1] + a[2][0] * from[2];
    const double y = a[0][1] * from[0] + a[1][1] * from[1] + a[2][1] * from[2];
    const double z = a[0][2] * from[0] + a[1][2] * from[1] + a[2][2] * from[2];
    *u = rig->focal_px * x / z;
    *v = rig->focal_px * y / z;
    return z > 2;
}

static bool in_image(const simulated_rig_t *rig, double u, double v) {
    return u + rig->cu_px >= 0 && u + rig->cu_px <= rig->width - 1 && v + rig->cv_px >= 0 && v + rig->cv_px <= rig->height - 1;
}

/* Where a point that moved by (dx, dy) is seen from after the vehicle's arc. */
static void see_later(const simulated_step_t *step, const road_user_t *user, const double point[3], double later[3]) {
    const double x = point[0] + user->dx - step->moved_m * cos(step->turn / 2);
    const double y = point[1] + user->dy - step->moved_m * sin(step->turn / 2);
    later[0] = x * cos(step->turn) + y * sin(step->turn);
    later[1] = -x * sin(step->turn) + y * cos(step->turn);
    later[2] = point[2];
}

static bool point_track(const axes_t *a, const simulated_rig_t *rig, const simulated_mount_t *mount,
                        const simulated_step_t *step, const road_user_t *user, const double point[3],
                        simulated_track_t *track) {
    double later[3];
    const double before[3] = {point[0], point[1], point[2] - mount->height_m};
    see_later(step, user, point, later);
    later[2] -= mount->height_m;
    return project(a, rig, before, &track->u0, &track->v0) & project(a, rig, later, &track->u1, &track->v1);
}

static bool make_track(const axes_t *a, const simulated_rig_t *rig, const simulated_mount_t *mount,
                       const simulated_step_t *step, const road_user_t *user, random_numbers_t *random,
                       simulated_track_t *track) {
    static const road_user_t NOBODY = {0, 0, 0, 0};
    double point[3];
    if (user) {
        point[0] = user->x + random_double(random, -1, 2);
        point[1] = user->y + random_double(random, -1, 1);
        point[2] = random_double(random, 0, 1.6);
    } else {
        any_still_point(random, point);
    }
    if (!point_track(a, rig, mount, step, user ? user : &NOBODY, point, track)) return false;
    double *const ends[4] = {&track->u0, &track->v0, &track->u1, &track->v1};
    for (int i = 0; i < 4; i++) *ends[i] += step->noise_px * random_normal(random);
    return in_image(rig, track->u0, track->v0) && in_image(rig, track->u1, track->v1);
}

static bool false_match(const simulated_rig_t *rig, random_numbers_t *random, simulated_track_t *track) {
    track->u0 = random_double(random, 0, rig->width) - rig->cu_px;
    track->v0 = random_double(random, 0, rig->height) - rig->cv_px;
    track->u1 = track->u0 + random_double(random, -30, 30);
    track->v1 = track->v0 + random_double(random, -30, 30);
    return in_image(rig, track->u0, track->v0) && in_image(rig, track->u1, track->v1);
}

static void shuffle(simulated_tracks_t *tracks, random_numbers_t *random) {
    for (int i = tracks->count - 1; i > 0; i--) {
        const int k = (int)random_between(random, 0, i);
        const simulated_track_t other = tracks->track[i];
        tracks->track[i] = tracks->track[k];
        tracks->track[k] = other;
    }
}

void simulate_tracks(simulated_tracks_t *tracks, const simulated_rig_t *rig, const simulated_mount_t *mount,
                     const simulated_step_t *step, random_numbers_t *random) {
    const int outliers = (int)lround(step->outlier_share * step->tracks), moving = outliers / 2;
    const axes_t a = camera_axes(mount);
    road_user_t users[ROAD_USERS];
    for (int i = 0; i < ROAD_USERS; i++) users[i] = any_road_user(random, step->moved_m);
    tracks->count = 0;
    for (int tries = 0; tracks->count < step->tracks && tries < TRIES; tries++) {
        const int i = tracks->count;
        simulated_track_t *track = &tracks->track[i];
        road_user_t *user = i < moving ? &users[i % ROAD_USERS] : NULL;
        if (user && tries % 100 == 99) *user = any_road_user(random, step->moved_m); /* that one was out of sight */
        track->still = i >= outliers;
        tracks->count += (i >= moving && i < outliers) ? false_match(rig, random, track)
                                                       : make_track(&a, rig, mount, step, user, random, track);
    }
    shuffle(tracks, random);
}

/* Line of a track: normal (-dy, dx) / L; its distance from the focus has the deviation sigma sqrt(2) r / L. */
static void add_line(const simulated_track_t *t, const double focus[2], double h[3], double g[2]) {
    const double dx = t->u1 - t->u0, dy = t->v1 - t->v0, mx = (t->u0 + t->u1) / 2, my = (t->v0 + t->v1) / 2;
    const double r2 = (mx - focus[0]) * (mx - focus[0]) + (my - focus[1]) * (my - focus[1]) + 1e-12;
    const double along = -dy * mx + dx * my;
    h[0] += dy * dy / r2;
    h[1] -= dx * dy / r2;
    h[2] += dx * dx / r2;
    g[0] -= dy * along / r2;
    g[1] += dx * along / r2;
}

void reference_focus(const simulated_tracks_t *tracks, const double true_focus[2], double focus[2]) {
    focus[0] = true_focus[0];
    focus[1] = true_focus[1];
    for (int round = 0; round < 5; round++) {
        double h[3] = {0, 0, 0}, g[2] = {0, 0};
        for (int i = 0; i < tracks->count; i++)
            if (tracks->track[i].still) add_line(&tracks->track[i], focus, h, g);
        const double determinant = h[0] * h[2] - h[1] * h[1];
        focus[0] = (h[2] * g[0] - h[1] * g[1]) / determinant;
        focus[1] = (h[0] * g[1] - h[1] * g[0]) / determinant;
    }
}

void library_tracks(const simulated_tracks_t *tracks, const simulated_rig_t *rig, roadpose_track_t *out) {
    for (int i = 0; i < tracks->count; i++) {
        const simulated_track_t *t = &tracks->track[i];
        out[i].u0_q8 = (int32_t)lround(256 * (t->u0 + rig->cu_px));
        out[i].v0_q8 = (int32_t)lround(256 * (t->v0 + rig->cv_px));
        out[i].u1_q8 = (int32_t)lround(256 * (t->u1 + rig->cu_px));
        out[i].v1_q8 = (int32_t)lround(256 * (t->v1 + rig->cv_px));
    }
}

roadpose_rig_t library_rig(const simulated_rig_t *rig) {
    return (roadpose_rig_t){(uint16_t)rig->width, (uint16_t)rig->height, (int32_t)lround(1000 * rig->focal_px),
                            (int32_t)lround(1000 * rig->cu_px), (int32_t)lround(1000 * rig->cv_px),
                            (int32_t)lround(1e6 * rig->baseline_m)};
}
