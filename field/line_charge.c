#include "field/line_charge.h"
#include <stdbool.h>

/* One end of a line: z of it, from the point. */
typedef struct End {
    Pack sign, far; /* of the point above it, |Z| */
    Pack inverse;   /* 1/R                        */
    Pack a;         /* 1/(R (R + |Z|)): |Z|/R = 1 - D^2 a */
} End;

static End end_at(Pack square, Pack z)
{
    End end = {.sign = pack_select(z > 0, pack_set(-1), pack_set(1)), .far = pack_abs(z)};
    Pack R = pack_sqrt(square + z * z);
    end.inverse = 1 / R;
    end.a = end.inverse / (R + end.far);
    return end;
}

/* Integrals of 1/r^3, 1/r^5, 1/r^7 along a line. With s = Z/R = sign (1 - D^2 a) an end has
 *     s/D^2, (s - s^3/3)/D^4, (s - 2 s^3/3 + s^5/5)/D^6 = sign (c/D^n + f(a)),
 * and the parts with D^n cancel where the point is beyond one of the ends. */
typedef struct Integrals {
    Pack i3, i5, i7;
} Integrals;

static Integrals integrals(Pack square, const End *low, const End *high, bool ends_alone)
{
    PackMask beside = low->sign != high->sign;
    Pack inverse = ends_alone ? (Pack){0} : pack_select(beside, 1 / square, (Pack){0}), a = low->a,
         b = high->a;
    Pack whole = (low->sign - high->sign) * inverse;
    Pack f5a = a * a * (square * a / 3 - 1), f5b = b * b * (square * b / 3 - 1);
    Pack f7a = -a * a * a * (4.0 / 3 - square * a * (1 - square * a / 5)),
         f7b = -b * b * b * (4.0 / 3 - square * b * (1 - square * b / 5));
    return (Integrals){.i3 = whole - low->sign * a + high->sign * b,
                       .i5 = 2.0 / 3 * whole * inverse + low->sign * f5a - high->sign * f5b,
                       .i7 = 8.0 / 15 * whole * inverse * inverse + low->sign * f7a - high->sign * f7b};
}

static inline LineField field_of(Pack x, Pack y, Pack low, Pack high, bool ends_alone)
{
    Pack square = x * x + y * y;
    End ends[2] = {end_at(square, low), end_at(square, high)};
    Integrals I = integrals(square, &ends[0], &ends[1], ends_alone);
    Pack f = I.i3, f1 = -3 * I.i5, f2 = 15 * I.i7; /* derivatives of f of D^2/2 */
    LineField o = {{{0}}};
    Pack zz = {0}, xzz = {0}, zzz = {0};
    for (int k = 0; k < 2; k++) { /* F_z = [1/R], the high end's less the low end's */
        Pack sign = pack_set(k ? 1 : -1), z = k ? high : low, i = ends[k].inverse, i2 = i * i,
             i3 = sign * i * i2;
        o.f[2] += sign * i;
        zz += i3 * z; /* of the point's own z, from -z */
        xzz += -3 * i3 * i2 * z;
        zzz += i3 * (3 * z * z * i2 - 1);
    }
    Pack low3 = -ends[0].inverse * ends[0].inverse * ends[0].inverse,
         high3 = ends[1].inverse * ends[1].inverse * ends[1].inverse, sum3 = low3 + high3,
         sum5 = low3 * ends[0].inverse * ends[0].inverse + high3 * ends[1].inverse * ends[1].inverse;
    o.f[0] = x * f, o.f[1] = y * f;
    o.f[3] = f + x * x * f1, o.f[4] = x * y * f1, o.f[5] = -x * sum3;
    o.f[6] = f + y * y * f1, o.f[7] = -y * sum3, o.f[8] = zz;
    o.f[9] = x * (3 * f1 + x * x * f2), o.f[10] = y * (f1 + x * x * f2), o.f[11] = 3 * x * x * sum5 - sum3;
    o.f[12] = x * (f1 + y * y * f2), o.f[13] = 3 * x * y * sum5, o.f[14] = x * xzz;
    o.f[15] = y * (3 * f1 + y * y * f2), o.f[16] = 3 * y * y * sum5 - sum3, o.f[17] = y * xzz;
    o.f[18] = zzz;
    return o;
}

LineField line_field(Pack x, Pack y, Pack low, Pack high)
{
    return field_of(x, y, low, high, false);
}

LineField line_ends(Pack x, Pack y, Pack low, Pack high)
{
    return field_of(x, y, low, high, true);
}

static Pack pack_log(Pack a)
{
    Pack r = {0};
    for (int l = 0; l < PACK_LANES; l++) r[l] = log(a[l]);
    return r;
}

/* log (R + |Z|) of the ends, whose difference it is beyond them. */
Pack line_potential(Pack x, Pack y, Pack low, Pack high)
{
    Pack square = x * x + y * y;
    End a = end_at(square, low), b = end_at(square, high);
    Pack sum_a = 1 / a.inverse + a.far, sum_b = 1 / b.inverse + b.far;
    PackMask beside = a.sign != b.sign;
    Pack ratio = pack_select(beside, sum_a * sum_b / square, sum_a / sum_b);
    return a.sign * pack_log(ratio);
}

LineField point_field(Pack3 r)
{
    Pack i2 = 1 / pack3_dot(r, r), i1 = pack_sqrt(i2), f = i1 * i2, f1 = -3 * f * i2, f2 = -5 * f1 * i2;
    Pack v[3] = {r.x, r.y, r.z};
    LineField o;
    Pack *second = o.f + LINE_FIRST, *third = second + LINE_SECOND;
    for (int i = 0; i < 3; i++) {
        o.f[i] = v[i] * f;
        for (int j = i; j < 3; j++) {
            *second++ = v[i] * v[j] * f1 + (i == j) * f;
            for (int k = j; k < 3; k++)
                *third++ =
                    v[i] * v[j] * v[k] * f2 + ((i == j) * v[k] + (j == k) * v[i] + (i == k) * v[j]) * f1;
        }
    }
    return o;
}
