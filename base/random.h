/* random.h - small, seeded, deterministic random numbers: the same seed gives the same numbers on every
 * machine. [O'Neill 2014, PCG XSH-RR 64/32] */
#pragma once
#include <stdint.h>

typedef struct Random {
    uint64_t state;
} Random;

Random random_seed(uint64_t seed);

/* Uniform in [0, 1). */
double random_uniform(Random *random);

/* Uniform in [-1, 1). */
double random_signed(Random *random);
