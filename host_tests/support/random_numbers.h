/* Random numbers of a test, which can be run again with the same ones. */
#ifndef ROADPOSE_TEST_RANDOM_NUMBERS_H
#define ROADPOSE_TEST_RANDOM_NUMBERS_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint64_t state;
} random_numbers_t;

/* Seed from the environment variable ROADPOSE_TEST_SEED, else a fixed one; prints the command that sets it. */
random_numbers_t random_numbers(const char *test);

uint64_t random_bits(random_numbers_t *numbers);
int64_t random_between(random_numbers_t *numbers, int64_t low, int64_t high); /* both included */
double random_double(random_numbers_t *numbers, double low, double high);
double random_normal(random_numbers_t *numbers); /* mean 0, standard deviation 1 */

/* Any magnitude is as likely as any other: as many values of 3 bits as of 60. */
uint64_t random_any_magnitude(random_numbers_t *numbers, unsigned max_bits);
void random_bytes(random_numbers_t *numbers, void *bytes, size_t count);

#endif
