#include "shell/hinge.h"

/* The wing beside the edge whose outer corner is p away from a; normal = e x p for the own face. */
static Wing wing(Pack3 along, Pack length, Pack3 p, Pack3 normal)
{
    Pack size = pack_sqrt(pack3_dot(normal, normal));
    Pack3 n = pack3_scale(1 / size, normal);
    return (Wing){.normal = n, .height = size / length, .foot = pack3_dot(p, along) / length};
}

Dihedral dihedral_angle(Pack3 a, Pack3 b, Pack3 o, Pack3 y)
{
    Dihedral d;
    Pack3 e = pack3_sub(b, a), p = pack3_sub(o, a), r = pack3_sub(y, a);
    d.length = pack_sqrt(pack3_dot(e, e));
    d.along = pack3_scale(1 / d.length, e);
    d.own = wing(d.along, d.length, p, pack3_cross(e, p));
    d.flap = wing(d.along, d.length, r, pack3_cross(r, e));
    d.own.inward = pack3_cross(d.own.normal, d.along);
    d.flap.inward = pack3_cross(d.along, d.flap.normal);
    d.angle = pack_atan2(-pack3_dot(d.own.inward, d.flap.normal), pack3_dot(d.own.normal, d.flap.normal));
    return d;
}

DihedralGradient dihedral_gradient(const Dihedral *d)
{
    DihedralGradient g;
    g.o = pack3_scale(-1 / d->own.height, d->own.normal);
    g.y = pack3_scale(-1 / d->flap.height, d->flap.normal);
    g.b = pack3_neg(pack3_add(pack3_scale(d->own.foot, g.o), pack3_scale(d->flap.foot, g.y)));
    g.a = pack3_neg(pack3_add(g.b, pack3_add(g.o, g.y)));
    return g;
}

/* One wing's blocks: corner and corner, corner and b, and its part of b and b. */
static void wing_hessian(const Wing *w, Pack3 along, Pack length, PackMat *corner, PackMat *mixed,
                         PackMat *end)
{
    Pack inverse = 1 / w->height, over = inverse / length;
    PackMat M = pack_mat_symmetric(pack3_scale(inverse * inverse, w->normal), w->inward);
    PackMat turn = pack_mat_outer(pack3_scale(over, along), w->normal);
    *corner = M;
    *mixed = pack_mat_add(pack_mat_scale(-w->foot, M), turn);
    *end = pack_mat_add(pack_mat_scale(w->foot * w->foot, M),
                        pack_mat_scale(-w->foot, pack_mat_add(turn, pack_mat_transpose(turn))));
    *end = pack_mat_add(*end, pack_mat_outer(pack3_scale(1 / (length * length), w->normal), w->inward));
}

static PackMat minus_sum(PackMat a, PackMat b, PackMat c)
{
    return pack_mat_neg(pack_mat_add(a, pack_mat_add(b, c)));
}

DihedralHessian dihedral_hessian(const Dihedral *d)
{
    DihedralHessian H;
    PackMat zero = {0}, ob, yb, own, flap;
    wing_hessian(&d->own, d->along, d->length, &H.oo, &ob, &own);
    wing_hessian(&d->flap, d->along, d->length, &H.yy, &yb, &flap);
    H.bb = pack_mat_add(own, flap);
    H.bo = pack_mat_transpose(ob);
    H.by = pack_mat_transpose(yb);
    H.ao = minus_sum(H.bo, H.oo, zero);
    H.ay = minus_sum(H.by, H.yy, zero);
    H.ab = minus_sum(H.bb, ob, yb);
    H.aa = minus_sum(pack_mat_transpose(H.ab), pack_mat_transpose(H.ao), pack_mat_transpose(H.ay));
    return H;
}
