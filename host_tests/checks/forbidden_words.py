#!/usr/bin/env python3
"""forbidden_words.py FOLDER...: no floating point, heap, I/O, clocks, jumps or compiler extensions in the core."""
import re
import sys

import c_source

WORDS = """float double _Complex _Imaginary goto alloca setjmp longjmp jmp_buf asm __asm __asm__ __attribute__ __extension__
__int128 typeof __typeof__ va_list va_start va_arg errno FILE stdin stdout stderr time_t clock_t thread_local _Thread_local
__thread malloc calloc realloc aligned_alloc""".split()
CALLS = """free strdup printf fprintf sprintf snprintf vprintf vfprintf vsprintf vsnprintf puts fputs putchar putc fputc perror
scanf sscanf fscanf fopen fclose fread fwrite getenv system exit _Exit quick_exit abort atexit assert signal raise qsort bsearch
time clock difftime gettimeofday clock_gettime rand srand random srandom strtol strtoul strtod atoi atol atof div ldiv lldiv
sqrt sqrtf cbrt pow exp log log2 log10 sin cos tan asin acos atan atan2 fabs floor ceil round lround fmod hypot""".split()
HEADERS = {"<stdint.h>", "<stddef.h>", "<stdbool.h>", "<limits.h>", "<string.h>"}

RULES = [
    (re.compile(r"\b(?:%s)\b" % "|".join(WORDS)), "forbidden word"),
    (re.compile(r"\b(?:%s)(?=\s*\()" % "|".join(CALLS)), "forbidden call"),
    (re.compile(r"\b__(?!cplusplus\b)\w+"), "compiler extension"),
    (re.compile(r"\b_(?:Float|Decimal|Fract|Accum|Sat|BitInt|Generic|Alignas|Atomic|Noreturn)\w*"), "forbidden word"),
    (re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?[fFlL]?|(?<![\w.])\d+[eE][+-]?\d+"
                r"|0[xX][\da-fA-F]*\.?[\da-fA-F]*[pP][+-]?\d+"), "floating constant"),
    (re.compile(r"\?\s*:"), "compiler extension"),
]


def complaints_of(text):
    code = c_source.without_comments_and_literals(text)
    found = [(c_source.line_of(code, hit.start()), f"{what}: {hit.group(0)}")
             for rule, what in RULES for hit in rule.finditer(code)]
    found += [(line, f"forbidden header: {header}") for line, header in c_source.includes(text)
              if header.startswith("<") and header not in HEADERS]
    return sorted(found)


def check(folders):
    return [f"{path}:{line}: {what}" for path in c_source.sources(*folders)
            for line, what in complaints_of(path.read_text(encoding="utf-8"))]


if __name__ == "__main__":
    complaints = check(sys.argv[1:])
    print("\n".join(complaints) or "no forbidden word, call or header")
    sys.exit(1 if complaints else 0)
