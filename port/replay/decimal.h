/* Decimal numbers as scaled integers: no floating point, so that every compiler reads and prints the same digits. */
#ifndef REPLAY_DECIMAL_H
#define REPLAY_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

#define DECIMAL_LIMIT INT64_C(100000000000000000) /* values saturate here: 1e17 */
#define DECIMAL_TEXT_BYTES 32                     /* enough for any int64_t with sign, point and up to 9 places */

typedef struct {
    int64_t scaled; /* the number times 10^places, rounded half away from zero, saturated at +-DECIMAL_LIMIT */
    bool is_exact;  /* nothing was rounded off */
} decimal_t;

/* Reads the whole of text as [sign] digits [. digits] [e exponent]. False, with *number unchanged, if it is not that.
 */
bool decimal_parse(const char *text, int places, decimal_t *number);

/* Prints scaled / 10^places with exactly that many places (0...9); zero never has a sign. */
void decimal_print(char text[DECIMAL_TEXT_BYTES], int64_t scaled, int places);

/* The same without trailing zeros. */
void decimal_print_short(char text[DECIMAL_TEXT_BYTES], int64_t scaled, int places);

#endif
