/* Binary PGM: 16 bits (P5, maxval 65535, big-endian samples), or 8 bits (P5, maxval 255). */
#ifndef REPLAY_PGM_H
#define REPLAY_PGM_H

#include <stdbool.h>
#include <stdint.h>

/* Reads exactly one image of the given size; samples: width * height * 2 bytes, as in the file. Reports the first
 * fault and returns false; the samples may then be partly overwritten. */
bool pgm_read(uint8_t *samples, uint16_t width_px, uint16_t height_px, const char *path);

/* The same for 8 bits: width * height bytes. */
bool pgm_read_grey(uint8_t *samples, uint16_t width_px, uint16_t height_px, const char *path);

#endif
