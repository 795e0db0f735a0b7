#include "random_numbers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

random_numbers_t random_numbers(const char *test) {
    const char *text = getenv("ROADPOSE_TEST_SEED");
    random_numbers_t numbers = {text && *text ? strtoull(text, NULL, 10) : 1492};
    printf("%s: seed %llu; to run it again: ROADPOSE_TEST_SEED=%llu\n", test, (unsigned long long)numbers.state,
           (unsigned long long)numbers.state);
    fflush(stdout);
    return numbers;
}

uint64_t random_bits(random_numbers_t *numbers) { /* splitmix64 */
    uint64_t z = numbers->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return z ^ z >> 31;
}

int64_t random_between(random_numbers_t *numbers, int64_t low, int64_t high) {
    const uint64_t count = (uint64_t)high - (uint64_t)low + 1;
    return count == 0 ? (int64_t)random_bits(numbers) : (int64_t)((uint64_t)low + random_bits(numbers) % count);
}

double random_double(random_numbers_t *numbers, double low, double high) {
    return low + (high - low) * (double)(random_bits(numbers) >> 11) / 9007199254740992.0;
}

double random_normal(random_numbers_t *numbers) {
    const double radius = sqrt(-2 * log(random_double(numbers, 1e-300, 1)));
    return radius * cos(6.28318530717958647692 * random_double(numbers, 0, 1));
}

uint64_t random_any_magnitude(random_numbers_t *numbers, unsigned max_bits) {
    const uint64_t bits = random_bits(numbers);
    const unsigned count = (unsigned)(random_bits(numbers) % (max_bits + 1));
    return count == 0 ? 0 : bits >> (64 - count);
}

void random_bytes(random_numbers_t *numbers, void *bytes, size_t count) {
    unsigned char *out = bytes;
    for (size_t i = 0; i < count; i++) out[i] = (unsigned char)(random_bits(numbers) >> 32);
}
