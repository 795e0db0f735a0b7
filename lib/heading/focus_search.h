/* First focus of expansion by RANSAC over intersections of track lines. */
#ifndef ROADPOSE_HEADING_FOCUS_SEARCH_H
#define ROADPOSE_HEADING_FOCUS_SEARCH_H

#include "heading/expansion.h"
#include "roadpose/heading.h"

/* Chooses the voters among the moving flows and takes the rotation turn_q24 out of their flow. */
void roadpose_voters_choose(roadpose_heading_t *instance, const int32_t *turn_q24);

/* Best focus from `pairs` pairs of voters into best->focus_q24. Returns its score, 0: none. *random is the
 * generator's state. */
uint32_t roadpose_focus_search(roadpose_heading_t *instance, unsigned pairs, uint32_t *random,
                               roadpose_expansion_t *best);

/* The same for further rotations about y of up to 1.5 degrees to either side, in steps of 0.3 degrees, `pairs` pairs
 * for each; the best one is added to best->turn_q24. */
uint32_t roadpose_focus_search_turning(roadpose_heading_t *instance, unsigned pairs, uint32_t *random,
                                       roadpose_expansion_t *best);

#endif
