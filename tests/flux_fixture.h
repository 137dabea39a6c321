/* flux_fixture.h - fields that are stronger, moved and turned at random, so that derivatives by all of that are looked at. */
#pragma once
#include "base/random.h"
#include "field/flux.h"

static inline void disturb_fields(const FluxFields *fields, const FluxBlocks *blocks, double way,
                                  Random *random, double *p)
{
    for (int k = 0; k < fields->count; k++) p[blocks->strength + k] = 1 + 0.5 * random_signed(random);
    for (int i = 0; i < 3 * fields->count; i++) {
        p[blocks->move + i] = way * random_signed(random);
        p[blocks->turn + i] = random_signed(random);
    }
}
