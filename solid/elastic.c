/* Hyperelastic tetrahedra: E = sum over points of w psi(F), F = sum_a x_a grad N_a^T, with psi linear in Young's modulus
 * (law.h). Linear tetrahedra have one point, quadratic ones four: no more zero modes than the six of rigid motions. */
#include "base/memory.h"
#include "solid/law.h"
#include "solid/terms.h"
#include "solve/element.h"
#include "surface/face.h"

typedef struct Elastic {
    const Solid *solid;
    const Law *law;
    Lame lame;
    TetPack *packs;
} Elastic;

static int elastic_count(const void *self)
{
    return ((const Elastic *)self)->solid->tets->count;
}

static int elastic_size(const void *self)
{
    return 3 * ((const Elastic *)self)->solid->tets->each;
}

static void elastic_dofs(const void *self, int tet, int *dof)
{
    tet_dofs(((const Elastic *)self)->solid->tets, tet, dof);
}

static Pack young_of(const Elastic *elastic, int pack, const double *values)
{
    return pack_param(elastic->solid->tets->count, pack, values + elastic->solid->young, 1, 0);
}

/* The points of a pack at x, with weights for Young's modulus; their number. */
static int set_points(const Elastic *elastic, int pack, Pack young, const Pack *x,
                      LawPoint points[TET_MAX_POINTS])
{
    const Tets *tets = elastic->solid->tets;
    const TetPack *tet = &elastic->packs[pack];
    int count = tet_point_count(tets);
    for (int q = 0; q < count; q++) {
        LawPoint *at = &points[q];
        at->weight = young * tet->volume / count;
        tet_gradients(tets, tet, tet_point(tets, q), at->gradient);
        at->F = tet_field_gradient(tets->each, at->gradient, x);
        at->cofactor = tet_cofactor(&at->F);
        at->J = pack3_dot(at->F.r0, at->cofactor.r0);
    }
    return count;
}

/* dE/dx_a = sum of w P grad N_a. Returns E. */
static Pack forces(const Elastic *elastic, const LawPoint *points, int count, Pack *g)
{
    int nodes = elastic->solid->tets->each;
    Pack energy = {0};
    for (int i = 0; g && i < 3 * nodes; i++) g[i] = (Pack){0};
    for (int q = 0; q < count; q++) {
        PackMat P;
        energy += points[q].weight * elastic->law->stress(elastic->lame, &points[q], g ? &P : NULL);
        if (g) P = pack_mat_scale(points[q].weight, P);
        for (int a = 0; g && a < nodes; a++)
            pack3_store(g + 3 * a,
                        pack3_add(pack3_load(g + 3 * a), pack_mat_times(P, points[q].gradient[a])));
    }
    return energy;
}

static Pack elastic_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Elastic *elastic = self;
    LawPoint points[TET_MAX_POINTS];
    int count = set_points(elastic, pack, young_of(elastic, pack, at->p), x, points);
    Pack energy = forces(elastic, points, count, g);
    if (!H) return energy;
    element_clear(H, elastic_size(self));
    int nodes = elastic->solid->tets->each;
    if (at->tangled)
        law_clamped_stiffness(elastic->law, elastic->lame, points, count, nodes, H);
    else
        elastic->law->stiffness(elastic->lame, points, count, nodes, H);
    return energy;
}

/* Inside out or flat somewhere: there are equilibria there, too, and steps by the Hessian find them. */
static bool elastic_tangles(const void *self, const Point *at)
{
    return solid_is_tangled(solid_least_jacobian(((const Elastic *)self)->solid, at->x, NULL));
}

/* The force is linear in Young's modulus. */
static void elastic_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    (void)at;
    const Elastic *elastic = self;
    LawPoint points[TET_MAX_POINTS];
    int count = set_points(elastic, pack, pack_set(1), x, points);
    Pack g[TERM_MAX_DOF], sum = {0};
    forces(elastic, points, count, g);
    for (int i = 0; i < elastic_size(self); i++) sum += w[i] * g[i];
    for (int l = 0; l < lanes; l++)
        dp[elastic->solid->young + pack_element(elastic_count(self), pack, l)] += sum[l];
}

static void elastic_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    (void)at;
    const Elastic *elastic = self;
    LawPoint points[TET_MAX_POINTS];
    int count = set_points(elastic, pack, young_of(elastic, pack, dp), x, points);
    forces(elastic, points, count, r);
}

static void elastic_destroy(void *self)
{
    mem_free(((Elastic *)self)->packs);
    mem_free(self);
}

static const TermOps elastic_ops = {
    .name = "elastic",
    .count = elastic_count,
    .size = elastic_size,
    .dofs = elastic_dofs,
    .eval = elastic_eval,
    .tangles = elastic_tangles,
    .param = elastic_param,
    .param_forward = elastic_param_forward,
    .destroy = elastic_destroy,
};

Term solid_elastic_term(const Solid *solid)
{
    Elastic *elastic = mem_alloc(1, sizeof *elastic);
    *elastic = (Elastic){.solid = solid,
                         .law = law_of(solid->material),
                         .lame = lame_of(solid->poisson),
                         .packs = tet_packs(solid->tets)};
    elastic->lame.lambda *= 1 - solid->averaging; /* the rest: mean_dilation.c */
    return (Term){&elastic_ops, elastic};
}
