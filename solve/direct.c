#include "solve/direct.h"
#include "base/memory.h"
#include "solve/dense.h"
#include "solve/direct_row.h"

static const DirectRow *const rows[DIRECT_KINDS] = {
    [DIRECT_CHOLMOD] = &direct_cholmod, [DIRECT_MUMPS] = &direct_mumps};

struct Direct {
    int shares, n;
    const DirectRow *row;
    void *analysis;
    int *rank;
};

struct Factor {
    int shares;
    Direct *direct;
    void *numbers;
};

const char *direct_version(DirectKind kind)
{
    return rows[kind]->version;
}

bool direct_is_spread(DirectKind kind)
{
    return rows[kind]->spread;
}

bool direct_is_ready(DirectKind kind, Error *err)
{
    return !rows[kind]->ready || rows[kind]->ready(err);
}

Direct *direct_analyse(DirectKind kind, const Pattern *pattern, const int *rank, int negative)
{
    Direct *direct = mem_alloc(1, sizeof *direct);
    direct->shares = 1;
    direct->n = pattern->n;
    direct->row = rows[kind];
    direct->rank = mem_copy(rank, (size_t)pattern->n, sizeof *rank);
    direct->analysis = direct->row->analyse(pattern, negative);
    return direct;
}

Direct *direct_share(Direct *direct)
{
    direct->shares++;
    return direct;
}

void direct_release(Direct *direct)
{
    if (!direct || --direct->shares > 0) return;
    direct->row->forget(direct->analysis);
    mem_free(direct->rank);
    mem_free(direct);
}

const int *direct_rank(const Direct *direct)
{
    return direct->rank;
}

DirectCost direct_cost(const Direct *direct)
{
    return direct->row->cost(direct->analysis);
}

/* Takes the place of an old factor (NULL: of none), and its memory where nobody else has it. Its numbers are still to come. */
static Factor *replace(Factor *old, Direct *direct)
{
    bool takes = old && old->shares == 1 && old->direct->row == direct->row;
    Factor *factor = mem_alloc(1, sizeof *factor);
    *factor = (Factor){.shares = 1, .direct = direct_share(direct)};
    if (takes) {
        factor->numbers = direct->row->make_room(direct->analysis, old->direct->analysis, old->numbers);
        old->numbers = NULL;
    }
    factor_release(old);
    if (!takes) factor->numbers = direct->row->make_room(direct->analysis, NULL, NULL);
    return factor;
}

bool direct_factor(Direct *direct, const Pattern *pattern, double *values, Factor **factor, Workers *workers)
{
    if (!*factor || (*factor)->shares > 1 || (*factor)->direct != direct) *factor = replace(*factor, direct);
    return dense_is_finite(pattern->start[pattern->n], values) &&
           direct->row->factor(direct->analysis, pattern, values, (*factor)->numbers, workers);
}

Factor *factor_share(Factor *factor)
{
    if (factor) factor->shares++;
    return factor;
}

void factor_release(Factor *factor)
{
    if (!factor || --factor->shares > 0) return;
    if (factor->numbers) factor->direct->row->drop(factor->direct->analysis, factor->numbers);
    direct_release(factor->direct);
    mem_free(factor);
}

int factor_size(const Factor *factor)
{
    return factor->direct->n;
}

const int *factor_rank(const Factor *factor)
{
    return factor->direct->rank;
}

const double *factor_solve(const Factor *factor, const double *b, Workers *workers)
{
    return factor->direct->row->solve(factor->direct->analysis, factor->numbers, b, workers);
}
