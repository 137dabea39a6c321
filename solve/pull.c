#include "solve/pull.h"
#include "base/memory.h"

enum { RANGE = 4096 };

static int range_end(const Pull *pull, int range)
{
    int end = (range + 1) * RANGE;
    return end < pull->targets ? end : pull->targets;
}

/* Where each target's further places begin, were they all listed by target: from their counts. */
static int *count_further(const Pull *pull, int places, const int *target)
{
    int *next = mem_alloc((size_t)pull->targets + 1, sizeof *next);
    for (int k = 0; k < places; k++)
        if (target[k] >= 0 && k != pull->first[target[k]]) next[target[k] + 1]++;
    for (int i = 0; i < pull->targets; i++) next[i + 1] += next[i];
    return next;
}

Pull pull_create(int targets, int places, const int *target)
{
    Pull pull = {.targets = targets, .ranges = targets / RANGE + (targets % RANGE > 0)};
    pull.first = mem_alloc((size_t)targets, sizeof(int));
    for (int k = places - 1; k > 0; k--)
        if (target[k] >= 0) pull.first[target[k]] = k;
    int *next = count_further(&pull, places, target), further = next[targets];
    pull.start = mem_alloc((size_t)pull.ranges + 1, sizeof(int));
    pull.to = mem_alloc((size_t)further, sizeof(int));
    pull.from = mem_alloc((size_t)further, sizeof(int));
    for (int r = 0; r < pull.ranges; r++) pull.start[r + 1] = next[range_end(&pull, r)];
    for (int k = 0; k < places; k++)
        if (target[k] >= 0 && k != pull.first[target[k]]) {
            int at = next[target[k]]++;
            pull.to[at] = target[k], pull.from[at] = k;
        }
    mem_free(next);
    return pull;
}

void pull_destroy(Pull *pull)
{
    mem_free(pull->first);
    mem_free(pull->start);
    mem_free(pull->to);
    mem_free(pull->from);
    *pull = (Pull){0};
}

void pull_sum(const Pull *pull, int range, const double *values, const int *where, double *sums)
{
    int begin = range * RANGE, end = range_end(pull, range), last = pull->start[range + 1];
    if (!where) {
        for (int i = begin; i < end; i++) sums[i] = values[pull->first[i]];
        for (int k = pull->start[range]; k < last; k++) sums[pull->to[k]] += values[pull->from[k]];
        return;
    }
    for (int i = begin; i < end; i++) sums[where[i]] = values[pull->first[i]];
    for (int k = pull->start[range]; k < last; k++) sums[where[pull->to[k]]] += values[pull->from[k]];
}
