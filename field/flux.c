#include "field/flux.h"
#include <string.h>

FluxBlocks flux_blocks_add(Params *params, const FluxFields *fields, int uniform)
{
    FluxBlocks blocks = {.uniform = uniform};
    int count = fields->count;
    blocks.scale = params_add(params, "field_scale", "", count, 1, true);
    blocks.strength = params_add(params, "source_strength", "", count, 1, false);
    blocks.move = params_add(params, "source_move", "m", count, 3, false);
    blocks.turn = params_add(params, "source_turn", "rad", count, 3, false);
    return blocks;
}

void flux_blocks_default(const FluxFields *fields, const FluxBlocks *blocks, double *p)
{
    for (int k = 0; k < fields->count; k++) p[blocks->scale + k] = p[blocks->strength + k] = 1;
}

Flux flux_uniform(const double *B)
{
    return (Flux){.B = pack3(pack_set(B[0]), pack_set(B[1]), pack_set(B[2]))};
}

static FluxPlace place_of(FluxSum sum, int field)
{
    const FluxBlocks *blocks = &sum.blocks;
    return (FluxPlace){sum.time, sum.p + blocks->move + 3 * field, sum.p + blocks->turn + 3 * field};
}

/* One field's part at x, before its factors. */
static Flux flux_of_field(FluxSum sum, int k, Pack3 x)
{
    FluxPlace place = place_of(sum, k);
    double numbers[39][PACK_LANES];
    for (int l = 0; l < PACK_LANES; l++) {
        FluxSample sample;
        flux_field_eval(sum.fields->items[k], (double[]){x.x[l], x.y[l], x.z[l]}, place, &sample);
        for (int i = 0; i < 3; i++) numbers[i][l] = sample.flux[i];
        for (int i = 0; i < 9; i++) numbers[3 + i][l] = sample.gradient[i / 3][i % 3];
        for (int i = 0; i < 27; i++) numbers[12 + i][l] = sample.curvature[i / 9][i / 3 % 3][i % 3];
    }
    Pack3 rows[13];
    memcpy(rows, numbers, sizeof rows);
    Flux flux = {.B = rows[0], .gradient = {rows[1], rows[2], rows[3]}};
    for (int i = 0; i < 3; i++)
        flux.curvature[i] = (PackMat){rows[4 + 3 * i], rows[5 + 3 * i], rows[6 + 3 * i]};
    return flux;
}

/* a + scale b */
static Flux add(Flux a, double scale, const Flux *b)
{
    Pack s = pack_set(scale);
    a.B = pack3_axpy(s, b->B, a.B);
    a.gradient = pack_mat_add(a.gradient, pack_mat_scale(s, b->gradient));
    for (int k = 0; k < 3; k++)
        a.curvature[k] = pack_mat_add(a.curvature[k], pack_mat_scale(s, b->curvature[k]));
    return a;
}

static double factor_of(FluxSum sum, int field)
{
    return sum.p[sum.blocks.scale + field] * sum.p[sum.blocks.strength + field];
}

Flux flux_at(FluxSum sum, Pack3 x)
{
    Flux flux = flux_uniform(sum.p + sum.blocks.uniform);
    for (int k = 0; k < sum.fields->count; k++) {
        double factor = factor_of(sum, k);
        if (factor == 0) continue;
        Flux field = flux_of_field(sum, k, x);
        flux = add(flux, factor, &field);
    }
    return flux;
}

/* ---- Derivatives with respect to p ---- */

enum { MOVES = 6 }; /* of a field: along and about x, y, z */

/* A field that moves with a velocity v(x) = e_i, or e_i x (x - middle), of which it is carried along: B' = w x B - G v,
 * G' = w x G - curvature v - G dv/dx, w = 0 or e_i. */
static Flux moving(const Flux *field, Pack3 r, int i, bool turns)
{
    Pack3 unit = pack3(pack_set(i == 0), pack_set(i == 1), pack_set(i == 2));
    Pack3 v = turns ? pack3_cross(unit, r) : unit;
    Flux rate = {.B = pack3_neg(pack_mat_times(field->gradient, v))};
    for (int k = 0; k < 3; k++) {
        Pack3 row = pack3_neg(pack_mat_times(field->curvature[k], v));
        if (k == 0) rate.gradient.r0 = row;
        if (k == 1) rate.gradient.r1 = row;
        if (k == 2) rate.gradient.r2 = row;
    }
    if (!turns) return rate;
    PackMat across = pack_mat_cross(unit); /* v = across r */
    rate.B = pack3_add(rate.B, pack3_cross(unit, field->B));
    rate.gradient = pack_mat_add(rate.gradient, pack_mat_product(across, field->gradient));
    rate.gradient = pack_mat_add(rate.gradient, pack_mat_neg(pack_mat_product(field->gradient, across)));
    return rate;
}

/* rate[MOVES]: of its place, and of its turn as p has it: a turn's vector w changes the rotation by J(w) dw. */
static void moving_all(FluxSum sum, int k, const Flux *field, Pack3 x, Flux *rate)
{
    FluxPlace place = place_of(sum, k);
    double middle[3], J[3][3];
    flux_field_middle(sum.fields->items[k], place, middle);
    rigid_turn_rates(place.turn, J);
    Pack3 r = pack3_sub(x, pack3(pack_set(middle[0]), pack_set(middle[1]), pack_set(middle[2])));
    Flux spin[3];
    for (int i = 0; i < 3; i++) {
        rate[i] = moving(field, r, i, false);
        spin[i] = moving(field, r, i, true);
        rate[3 + i] = (Flux){0};
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) rate[3 + i] = add(rate[3 + i], J[j][i], &spin[j]);
}

/* Entry in p of one of a field's moves. */
static int entry(const FluxBlocks *blocks, int field, int move)
{
    return (move < 3 ? blocks->move : blocks->turn) + 3 * field + move % 3;
}

Flux flux_change(FluxSum sum, const double *dp, Pack3 x)
{
    const FluxBlocks *blocks = &sum.blocks;
    Flux change = flux_uniform(dp + blocks->uniform), rate[MOVES];
    for (int k = 0; k < sum.fields->count; k++) {
        double scale = sum.p[blocks->scale + k], strength = sum.p[blocks->strength + k];
        Flux field = flux_of_field(sum, k, x);
        change = add(change, dp[blocks->scale + k] * strength + scale * dp[blocks->strength + k], &field);
        if (scale * strength == 0) continue;
        moving_all(sum, k, &field, x, rate);
        for (int m = 0; m < MOVES; m++)
            change = add(change, scale * strength * dp[entry(blocks, k, m)], &rate[m]);
    }
    return change;
}

static double work_of(const FluxWork *work, const Flux *flux, int lanes)
{
    Pack3 pull = pack_mat_times(flux->gradient, work->b);
    return pack_sum(work->weight * (pack3_dot(work->a, flux->B) + pack3_dot(work->Q, pull)), lanes);
}

void flux_add_param(FluxSum sum, const FluxWork *work, int lanes, double *dp)
{
    const FluxBlocks *blocks = &sum.blocks;
    double *uniform = dp + blocks->uniform;
    for (int l = 0; l < lanes; l++) {
        uniform[0] += work->weight[l] * work->a.x[l];
        uniform[1] += work->weight[l] * work->a.y[l];
        uniform[2] += work->weight[l] * work->a.z[l];
    }
    for (int k = 0; k < sum.fields->count; k++) {
        double scale = sum.p[blocks->scale + k], strength = sum.p[blocks->strength + k];
        Flux field = flux_of_field(sum, k, work->x), rate[MOVES];
        double value = work_of(work, &field, lanes);
        dp[blocks->scale + k] += strength * value;
        dp[blocks->strength + k] += scale * value;
        if (scale * strength == 0) continue;
        moving_all(sum, k, &field, work->x, rate);
        for (int m = 0; m < MOVES; m++)
            dp[entry(blocks, k, m)] += scale * strength * work_of(work, &rate[m], lanes);
    }
}

void flux_value(FluxSum sum, const double x[3], double flux[3])
{
    memcpy(flux, sum.p + sum.blocks.uniform, 3 * sizeof *flux);
    for (int k = 0; k < sum.fields->count; k++) {
        double factor = factor_of(sum, k), value[3];
        if (factor == 0) continue;
        flux_field_value(sum.fields->items[k], x, place_of(sum, k), value);
        for (int i = 0; i < 3; i++) flux[i] += factor * value[i];
    }
}
