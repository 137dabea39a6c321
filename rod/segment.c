#include "rod/segment.h"

enum { SERIES = 15 };

static const double SERIES_LIMIT = 0.1; /* u up to which the series is used: 26 degrees per half element */

static PackQuat multiply(PackQuat a, PackQuat b)
{
    Pack3 v = pack3_add(pack3_scale(a.w, b.v), pack3_add(pack3_scale(b.w, a.v), pack3_cross(a.v, b.v)));
    return (PackQuat){a.w * b.w - pack3_dot(a.v, b.v), v};
}

/* q (1, turn/2)/|..| */
static PackQuat turned(PackQuat q, Pack3 turn)
{
    Pack scale = 1 / pack_sqrt(1 + pack3_dot(turn, turn) / 4);
    PackQuat r = multiply(q, (PackQuat){pack_set(1), pack3_scale(pack_set(0.5), turn)});
    return (PackQuat){scale * r.w, pack3_scale(scale, r.v)};
}

/* acos(w)/sqrt(1 - w^2) = sum a_n u^n with a_0 = 1, a_n = a_(n-1) n/(2n + 1); r = (that - 1)/u and
 * derivatives in u. */
static void series(Pack u, Pack r[3])
{
    double a[SERIES + 1] = {1};
    for (int n = 1; n <= SERIES; n++) a[n] = a[n - 1] * n / (2 * n + 1);
    r[0] = r[1] = r[2] = pack_set(0);
    for (int n = SERIES; n >= 1; n--) {
        r[2] = r[2] * u + 2 * r[1];
        r[1] = r[1] * u + r[0];
        r[0] = r[0] * u + a[n];
    }
}

/* The same from the closed form, for turns that are not small. */
static void closed(Pack u, Pack w, Pack r[3])
{
    Pack s2 = u * (1 + w), s = pack_sqrt(s2), g = pack_atan2(s, w) / s;
    Pack g1 = (w * g - 1) / s2, g2 = (g + 3 * w * g1) / s2;
    r[0] = (g - 1) / u;
    r[1] = (-g1 - r[0]) / u;
    r[2] = (g2 - 2 * r[1]) / u;
}

static Radial radial_of(PackQuat p)
{
    Pack w = p.w, u = pack3_dot(p.v, p.v) / (1 + w), r[3], far[3];
    PackMask large = u > SERIES_LIMIT;
    bool any = false;
    for (int l = 0; l < PACK_LANES; l++) any = any || large[l];
    series(u, r);
    if (any) {
        closed(pack_select(large, u, pack_set(0.5)), pack_select(large, w, pack_set(0.5)), far);
        for (int k = 0; k < 3; k++) r[k] = pack_select(large, far[k], r[k]);
    }
    Radial o = {.g = 1 + u * r[0], .g1 = -(r[0] + u * r[1]), .g2 = 2 * r[1] + u * r[2]};
    o.f = 1 / o.g;
    o.f1 = -o.g1 * o.f * o.f;
    o.f2 = (2 * o.g1 * o.g1 * o.f - o.g2) * o.f * o.f;
    Pack z = 1 / (1 + w), one = 1 + r[0]; /* b = f (g - w)/(1 - w^2) = f (1 + r)/(1 + w) */
    Pack e = one * z, e1 = -r[1] * z - one * z * z, e2 = z * (r[2] + 2 * z * (r[1] + one * z));
    o.b = e * o.f;
    o.b1 = e1 * o.f + e * o.f1;
    o.b2 = e2 * o.f + 2 * e1 * o.f1 + e * o.f2;
    return o;
}

static PackQuat gather_reference(const RodLayout *layout, int pack, int offset, const double *x)
{
    Pack q[4];
    for (int l = 0; l < PACK_LANES; l++) {
        int node = rod_element_node(layout, segment_lane(layout, pack, l)) + offset;
        const double *from = x + layout->reference + 4 * node;
        for (int k = 0; k < 4; k++) q[k][l] = from[k];
    }
    return (PackQuat){q[0], {q[1], q[2], q[3]}};
}

Segment segment_at(const RodLayout *layout, int pack, const double *x, const Pack *turns)
{
    Segment s = {.turn_a = pack3_load(turns), .turn_b = pack3_load(turns + 3)};
    s.qa = turned(gather_reference(layout, pack, 0, x), s.turn_a);
    PackQuat qb = turned(gather_reference(layout, pack, 1, x), s.turn_b);
    s.p = multiply((PackQuat){s.qa.w, pack3_neg(s.qa.v)}, qb);
    Pack sign = pack_select(s.p.w < 0, pack_set(-1), pack_set(1)); /* the shorter way round */
    s.p = (PackQuat){sign * s.p.w, pack3_scale(sign, s.p.v)};
    s.radial = radial_of(s.p);
    return s;
}

/* v x e_x */
static Pack3 cross_tangent(Pack3 v)
{
    return pack3(pack_set(0), v.z, -v.y);
}

Pack3 segment_chord(const Segment *s)
{
    const Radial *r = &s->radial;
    Pack3 v = s->p.v, c = pack3_axpy(r->b * v.x, v, pack3_scale(r->f, cross_tangent(v)));
    c.x += s->p.w * r->f;
    return c;
}

static Pack3 rotate(PackQuat q, Pack3 x)
{
    Pack3 twice = pack3_scale(pack_set(2), pack3_cross(q.v, x));
    return pack3_add(x, pack3_axpy(q.w, twice, pack3_cross(q.v, twice)));
}

Pack3 segment_to_body(const Segment *s, Pack3 v)
{
    return rotate((PackQuat){s->qa.w, pack3_neg(s->qa.v)}, v);
}

Pack3 segment_to_world(const Segment *s, Pack3 v)
{
    return rotate(s->qa, v);
}

Pack3 segment_to_body_b(const Segment *s, Pack3 v)
{
    return rotate((PackQuat){s->p.w, pack3_neg(s->p.v)}, segment_to_body(s, v));
}

Pack3 segment_to_world_b(const Segment *s, Pack3 v)
{
    return segment_to_world(s, rotate(s->p, v));
}

PackQuat segment_rate(const Segment *s, Pack3 a, Pack3 b)
{
    Pack3 apart = pack3_sub(b, a), sum = pack3_add(a, b);
    Pack3 v = pack3_axpy(s->p.w, apart, pack3_cross(s->p.v, sum));
    return (PackQuat){-pack3_dot(s->p.v, apart) / 2, pack3_scale(pack_set(0.5), v)};
}

Pack3 segment_theta_rate(const Segment *s, PackQuat dp)
{
    const Radial *r = &s->radial;
    return pack3_add(pack3_scale(2 * r->g, dp.v), pack3_scale(2 * r->g1 * dp.w, s->p.v));
}

Pack3 segment_chord_rate(const Segment *s, PackQuat dp)
{
    const Radial *r = &s->radial;
    Pack3 v = s->p.v;
    Pack3 c = pack3_add(pack3_scale(r->b1 * dp.w * v.x + r->b * dp.v.x, v), pack3_scale(r->b * v.x, dp.v));
    c = pack3_add(
        c, pack3_add(pack3_scale(r->f1 * dp.w, cross_tangent(v)), pack3_scale(r->f, cross_tangent(dp.v))));
    c.x += (r->f + s->p.w * r->f1) * dp.w;
    return c;
}

Jet segment_theta_jet(const Segment *s, Pack3 m, bool second)
{
    const Radial *r = &s->radial;
    Pack along = pack3_dot(m, s->p.v);
    Jet jet = {.w = 2 * r->g1 * along, .v = pack3_scale(2 * r->g, m)};
    if (second) jet.ww = 2 * r->g2 * along, jet.wv = pack3_scale(2 * r->g1, m);
    return jet;
}

Jet segment_chord_jet(const Segment *s, Pack3 F, bool second)
{
    const Radial *r = &s->radial;
    Pack w = s->p.w, zero = {0};
    Pack3 v = s->p.v, y = pack3(zero, -F.z, F.y); /* e_x x F */
    Pack along = pack3_dot(F, v), side = pack3_dot(v, y), both = v.x * along;
    Pack3 both_v = pack3_axpy(v.x, F, pack3(along, zero, zero)); /* d both/dv */
    Jet jet = {.w = (r->f + w * r->f1) * F.x + r->b1 * both + r->f1 * side,
               .v = pack3_axpy(r->b, both_v, pack3_scale(r->f, y))};
    if (!second) return jet;
    jet.ww = (2 * r->f1 + w * r->f2) * F.x + r->b2 * both + r->f2 * side;
    jet.wv = pack3_axpy(r->b1, both_v, pack3_scale(r->f1, y));
    jet.vv = pack_mat_scale(r->b, pack_mat_symmetric(pack3(pack_set(1), zero, zero), F));
    return jet;
}

void segment_pull_gradient(const Segment *s, const Jet *jet, Pack *g)
{
    Pack3 apart = pack3_sub(pack3_scale(jet->w, s->p.v), pack3_scale(s->p.w, jet->v));
    Pack3 both = pack3_cross(s->p.v, jet->v);
    pack3_store(g, pack3_add(pack3_load(g), pack3_scale(pack_set(0.5), pack3_sub(apart, both))));
    pack3_store(g + 3, pack3_sub(pack3_load(g + 3), pack3_scale(pack_set(0.5), pack3_add(apart, both))));
}

/* ww u_i u_j + u_i z_j + z_i u_j + V_i^T vv V_j for one pair of turns; z = V^T wv. */
static PackMat pair(const Jet *jet, Pack3 ui, Pack3 uj, PackMat Vi, PackMat vvVj, Pack3 zi, Pack3 zj)
{
    PackMat m = pack_mat_product(pack_mat_transpose(Vi), vvVj);
    m = pack_mat_add(m, pack_mat_outer(ui, pack3_axpy(jet->ww, uj, zj)));
    return pack_mat_add(m, pack_mat_outer(zi, uj));
}

void segment_pull_hessian(const Segment *s, const Jet *jet, PackMat block[3])
{
    Pack w = s->p.w, half = pack_set(0.5);
    Pack3 v = s->p.v, ua = pack3_scale(half, v), ub = pack3_neg(ua);
    PackMat cross = pack_mat_scale(half, pack_mat_cross(v)), turn = pack_mat_diagonal(w / 2);
    PackMat Va = pack_mat_add(cross, pack_mat_neg(turn)), Vb = pack_mat_add(cross, turn);
    PackMat vvVa = pack_mat_product(jet->vv, Va), vvVb = pack_mat_product(jet->vv, Vb);
    Pack3 za = pack_mat_left(jet->wv, Va), zb = pack_mat_left(jet->wv, Vb);
    Pack along = pack3_dot(jet->v, v), quarter = pack_set(-0.25);
    PackMat own = pack_mat_diagonal(quarter * (along + w * jet->w));
    block[0] = pack_mat_add(own, pair(jet, ua, ua, Va, vvVa, za, za));
    block[2] = pack_mat_add(own, pair(jet, ub, ub, Vb, vvVb, zb, zb));
    PackMat cross2 = pack_mat_cross(pack3_axpy(jet->w, v, pack3_scale(w, jet->v)));
    PackMat mixed = pack_mat_add(pack_mat_diagonal(along - w * jet->w),
                                 pack_mat_neg(pack_mat_add(pack_mat_symmetric(v, jet->v), cross2)));
    block[1] = pack_mat_add(pack_mat_scale(quarter, mixed), pair(jet, ua, ub, Va, vvVb, za, zb));
}

Pack3 segment_turned(Pack3 turn, Pack3 gradient)
{
    Pack scale = 1 / (1 + pack3_dot(turn, turn) / 4);
    return pack3_scale(scale, pack3_sub(gradient, pack3_scale(pack_set(0.5), pack3_cross(gradient, turn))));
}
