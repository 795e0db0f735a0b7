#include "decimal.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define EXPONENT_LIMIT 100000

/* mantissa * 10^exponent, mantissa <= DECIMAL_LIMIT */
typedef struct {
    int64_t mantissa;
    int exponent;
    bool is_exact;
} scientific_t;

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Digits that no longer fit move the exponent only. */
static void add_digit(scientific_t *number, char digit, bool is_fraction) {
    if (number->mantissa <= (DECIMAL_LIMIT - 9) / 10) {
        number->mantissa = number->mantissa * 10 + (digit - '0');
        number->exponent -= is_fraction ? 1 : 0;
    } else {
        number->is_exact = number->is_exact && digit == '0';
        number->exponent += is_fraction ? 0 : 1;
    }
}

static const char *read_digits(const char *text, scientific_t *number, bool is_fraction) {
    for (; is_digit(*text); text++)
        add_digit(number, *text, is_fraction);
    return text;
}

/* Digits with at most one point among them, at least one digit. NULL if there is none. */
static const char *read_mantissa(const char *text, scientific_t *number) {
    const char *whole_end = read_digits(text, number, false);
    const char *end = whole_end;

    if (*end == '.')
        end = read_digits(end + 1, number, true);
    return end - text > (*whole_end == '.' ? 1 : 0) ? end : NULL;
}

/* NULL if there is no digit. The value is limited, which only matters for numbers that saturate anyway. */
static const char *read_exponent(const char *text, scientific_t *number) {
    const bool is_negative = *text == '-';
    const char *digit = text + (*text == '-' || *text == '+' ? 1 : 0);
    int exponent = 0;

    if (!is_digit(*digit))
        return NULL;
    for (; is_digit(*digit); digit++)
        exponent = exponent < EXPONENT_LIMIT ? exponent * 10 + (*digit - '0') : exponent;
    number->exponent += is_negative ? -exponent : exponent;
    return digit;
}

static void scale_up(scientific_t *number) {
    for (; number->exponent > 0 && number->mantissa != 0 && number->mantissa < DECIMAL_LIMIT; number->exponent--)
        number->mantissa = number->mantissa > DECIMAL_LIMIT / 10 ? DECIMAL_LIMIT : number->mantissa * 10;
}

/* Only the last digit to go decides the rounding: half up of the magnitude. */
static void scale_down(scientific_t *number) {
    for (; number->exponent < 0 && number->mantissa != 0; number->exponent++) {
        const int64_t last = number->mantissa % 10;

        number->is_exact = number->is_exact && last == 0;
        number->mantissa = number->mantissa / 10 + (number->exponent == -1 && last >= 5 ? 1 : 0);
    }
}

bool decimal_parse(const char *text, int places, decimal_t *number) {
    scientific_t read = {0, 0, true};
    const bool is_negative = *text == '-';
    const char *end = read_mantissa(text + (*text == '-' || *text == '+' ? 1 : 0), &read);

    if (end != NULL && (*end == 'e' || *end == 'E'))
        end = read_exponent(end + 1, &read);
    if (end == NULL || *end != '\0')
        return false;
    read.exponent += places;
    scale_up(&read);
    scale_down(&read);
    number->scaled = is_negative ? -read.mantissa : read.mantissa;
    number->is_exact = read.is_exact;
    return true;
}

void decimal_print(char text[DECIMAL_TEXT_BYTES], int64_t scaled, int places) {
    const uint64_t magnitude = scaled < 0 ? 0u - (uint64_t)scaled : (uint64_t)scaled;
    const char *sign = scaled < 0 ? "-" : "";
    uint64_t one = 1;
    int place;

    for (place = 0; place < places; place++)
        one *= 10;
    if (places == 0)
        (void)snprintf(text, DECIMAL_TEXT_BYTES, "%s%" PRIu64, sign, magnitude);
    else
        (void)snprintf(text, DECIMAL_TEXT_BYTES, "%s%" PRIu64 ".%0*" PRIu64, sign, magnitude / one, places,
                       magnitude % one);
}

void decimal_print_short(char text[DECIMAL_TEXT_BYTES], int64_t scaled, int places) {
    char *last;

    decimal_print(text, scaled, places);
    if (strchr(text, '.') == NULL)
        return;
    for (last = text + strlen(text) - 1; *last == '0'; last--)
        *last = '\0';
    if (*last == '.')
        *last = '\0';
}
