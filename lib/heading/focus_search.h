/* First focus of expansion by RANSAC over intersections of track lines. */
#ifndef ROADPOSE_HEADING_FOCUS_SEARCH_H
#define ROADPOSE_HEADING_FOCUS_SEARCH_H

#include "heading/expansion.h"
#include "roadpose/heading.h"

/* Chooses the voters among the moving flows. */
void roadpose_voters_choose(roadpose_heading_t *instance);

/* Best focus under the rotation best->turn_q24, from `hypotheses` pairs of voters. Returns its score, 0: none; then
 * *best is unchanged. *random is the generator's state. */
uint32_t roadpose_focus_search(roadpose_heading_t *instance, unsigned hypotheses, uint32_t *random,
                               roadpose_expansion_t *best);

/* The same for rotations of up to 1.5 degrees to either side of best->turn_q24, in steps of 0.3 degrees. */
uint32_t roadpose_focus_search_turning(roadpose_heading_t *instance, unsigned hypotheses, uint32_t *random,
                                       roadpose_expansion_t *best);

#endif
