#include "base/random.h"

static uint32_t next(Random *random)
{
    uint64_t old = random->state;
    random->state = old * 6364136223846793005u + 1442695040888963407u;
    uint32_t shifted = (uint32_t)(((old >> 18) ^ old) >> 27);
    uint32_t turn = (uint32_t)(old >> 59);
    return shifted >> turn | shifted << (-turn & 31);
}

Random random_seed(uint64_t seed)
{
    Random random = {seed + 1442695040888963407u};
    next(&random);
    return random;
}

double random_uniform(Random *random)
{
    uint64_t high = next(random) >> 5, low = next(random) >> 6; /* 27 + 26 = 53 bits */
    return (double)(high << 26 | low) * 0x1p-53;
}

double random_signed(Random *random)
{
    return 2 * random_uniform(random) - 1;
}
