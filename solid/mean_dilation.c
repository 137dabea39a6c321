/* What of the neo-Hookean energy depends on mean volumes, against locking: a part a (Solid.averaging) of its lambda/2 (J - 1)^2
 * with the mean J' over a patch of tetrahedra in place of J [mean dilatation: Nagtegaal, Parks, Rice 1974]. mu's parts stay
 * pointwise: without mu/2 (J - 1)^2 they are indefinite at rest.
 *
 * With w a point's volume, J' = sum w J/sum w and L = a lambda sum w Y, E = L/2 (J' - 1)^2; with y_i = dJ'/dx_i,
 *     dE/dx_i = L (J' - 1) y_i,   d2E/dx_i dx_j = L (y_i y_j^T + (J' - 1) d2J'/dx_i dx_j). */
#include "base/memory.h"
#include "solid/law.h"
#include "solid/terms.h"
#include "solid/tet_patches.h"
#include "solve/element.h"
#include "surface/face.h"

typedef struct MeanPack {
    Pack volume;                             /* m^3 of the patch                               */
    Pack part[PATCH_TETS];                   /* w/volume                                       */
    Pack3 gradient[PATCH_TETS][PATCH_NODES]; /* of the nodes' shape functions at the points, 1/m */
    int tet[PATCH_TETS][PACK_LANES];         /* whose Young's modulus counts                   */
} MeanPack;

typedef struct Mean {
    const Solid *solid;
    double factor;            /* a lambda, of Young's modulus 1                                */
    int count, points, nodes; /* patches; of each                                              */
    TetPatch *patches;
    MeanPack *packs;
} Mean;

static int mean_count(const void *self)
{
    return ((const Mean *)self)->count;
}

static int mean_size(const void *self)
{
    return 3 * ((const Mean *)self)->nodes;
}

/* What a patch lacks of nodes the first one stands for: nothing depends on these. */
static void mean_dofs(const void *self, int e, int *dof)
{
    const Mean *mean = self;
    const TetPatch *patch = &mean->patches[e];
    for (int i = 0; i < 3 * mean->nodes; i++)
        dof[i] = 3 * patch->nodes[i / 3 < patch->node_count ? i / 3 : 0] + i % 3;
}

/* sum w Y of the pack, Young's moduli from values that are laid out as p, times a lambda. */
static Pack stiffness_of(const Mean *mean, const MeanPack *at, const double *values)
{
    Pack sum = {0};
    for (int q = 0; q < mean->points; q++)
        for (int l = 0; l < PACK_LANES; l++)
            sum[l] += at->part[q][l] * values[mean->solid->young + at->tet[q][l]];
    return mean->factor * at->volume * sum;
}

/* J' - 1, and y_i = sum of w/volume cof F grad N_i, y NULL or [nodes]. */
static Pack dilation(const Mean *mean, const MeanPack *at, const Pack *x, Pack3 *y)
{
    Pack change = {0};
    for (int i = 0; y && i < mean->nodes; i++) y[i] = (Pack3){{0}, {0}, {0}};
    for (int q = 0; q < mean->points; q++) {
        PackMat F = tet_field_gradient(mean->nodes, at->gradient[q], x), cofactor = tet_cofactor(&F);
        /* a point that is not there has F = 0 and no part */
        change += at->part[q] * (pack3_dot(F.r0, cofactor.r0) - 1);
        cofactor = pack_mat_scale(at->part[q], cofactor);
        for (int i = 0; y && i < mean->nodes; i++)
            y[i] = pack3_add(y[i], pack_mat_times(cofactor, at->gradient[q][i]));
    }
    return change;
}

static Pack forces(const Mean *mean, const MeanPack *at, Pack stiffness, const Pack *x, Pack *g)
{
    Pack3 y[PATCH_NODES];
    Pack change = dilation(mean, at, x, g ? y : NULL);
    for (int i = 0; g && i < mean->nodes; i++) pack3_store(g + 3 * i, pack3_scale(stiffness * change, y[i]));
    return 0.5 * stiffness * change * change;
}

/* convex: without the part of curvature that has no sign. */
static void add_blocks(const Mean *mean, const MeanPack *at, Pack stiffness, bool convex, const Pack *x,
                       Pack *H)
{
    Pack3 y[PATCH_NODES];
    Pack turn = (convex ? 0 : -1) * stiffness * dilation(mean, at, x, y);
    PackMat F[PATCH_TETS];
    for (int q = 0; q < mean->points; q++) F[q] = tet_field_gradient(mean->nodes, at->gradient[q], x);
    for (int i = 0; i < mean->nodes; i++) {
        element_add_diagonal(H, i, pack_mat_outer(pack3_scale(stiffness, y[i]), y[i]));
        for (int j = 0; j < i; j++) {
            Pack3 c = {{0}, {0}, {0}};
            for (int q = 0; q < mean->points; q++) {
                Pack3 across = pack3_cross(at->gradient[q][i], at->gradient[q][j]);
                c = pack3_axpy(turn * at->part[q], pack_mat_times(F[q], across), c);
            }
            PackMat block = pack_mat_outer(pack3_scale(stiffness, y[i]), y[j]);
            element_add_block(H, i, j, pack_mat_add(block, pack_mat_cross(c)));
        }
    }
}

static Pack mean_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Mean *mean = self;
    const MeanPack *own = &mean->packs[pack];
    Pack stiffness = stiffness_of(mean, own, at->p);
    if (H) element_clear(H, mean_size(self));
    if (H) add_blocks(mean, own, stiffness, at->tangled, x, H);
    return forces(mean, own, stiffness, x, g);
}

/* The force is linear in Young's moduli, each with its point's part. */
static void mean_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                       double *dp)
{
    (void)at;
    const Mean *mean = self;
    const MeanPack *own = &mean->packs[pack];
    Pack g[TERM_MAX_DOF], sum = {0};
    forces(mean, own, mean->factor * own->volume, x, g);
    for (int i = 0; i < mean_size(self); i++) sum += w[i] * g[i];
    for (int q = 0; q < mean->points; q++)
        for (int l = 0; l < lanes; l++) dp[mean->solid->young + own->tet[q][l]] += own->part[q][l] * sum[l];
}

static void mean_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                               Pack *r)
{
    (void)at;
    const Mean *mean = self;
    const MeanPack *own = &mean->packs[pack];
    forces(mean, own, stiffness_of(mean, own, dp), x, r);
}

static void mean_destroy(void *self)
{
    mem_free(((Mean *)self)->patches);
    mem_free(((Mean *)self)->packs);
    mem_free(self);
}

static const TermOps mean_ops = {
    .name = "mean_dilation",
    .count = mean_count,
    .size = mean_size,
    .dofs = mean_dofs,
    .eval = mean_eval,
    .param = mean_param,
    .param_forward = mean_param_forward,
    .destroy = mean_destroy,
};

/* The gradients of the pack's tetrahedra (a lane each) at a point, in the places of their patches' nodes. */
static void set_gradients(const Tets *tets, const TetPatch *patch, int lane, int q, MeanPack *to)
{
    int tet = patch->tets[tets->order == TET_QUADRATIC ? 0 : q];
    TetPack own = tet_pack(tets, tet / PACK_LANES);
    int from = tet % PACK_LANES;
    Pack3 gradient[TET_MAX_NODES];
    tet_gradients(tets, &own, tet_point(tets, tets->order == TET_QUADRATIC ? q : 0), gradient);
    for (int a = 0; a < tets->each; a++) {
        int i = 0;
        while (patch->nodes[i] != tets->nodes[tet * tets->each + a]) i++;
        Pack3 *g = &to->gradient[q][i];
        g->x[lane] = gradient[a].x[from], g->y[lane] = gradient[a].y[from], g->z[lane] = gradient[a].z[from];
    }
    to->tet[q][lane] = tet;
    to->part[q][lane] = tets->volume[tet] / tet_point_count(tets); /* over the patch's later */
}

static void set_lane(const Mean *mean, const TetPatch *patch, int lane, MeanPack *to)
{
    const Tets *tets = mean->solid->tets;
    int points = patch->tet_count * tet_point_count(tets);
    for (int q = 0; q < points; q++) {
        set_gradients(tets, patch, lane, q, to);
        to->volume[lane] += to->part[q][lane];
    }
    for (int q = 0; q < points; q++) to->part[q][lane] /= to->volume[lane];
}

Term solid_mean_dilation_term(const Solid *solid)
{
    const Tets *tets = solid->tets;
    bool quadratic = tets->order == TET_QUADRATIC;
    Mean *mean = mem_alloc(1, sizeof *mean);
    *mean = (Mean){.solid = solid,
                   .factor = solid->averaging * lame_of(solid->poisson).lambda,
                   .points = quadratic ? TET_MAX_POINTS : PATCH_TETS,
                   .nodes = quadratic ? PATCH_NODES : PATCH_LINEAR_NODES};
    if (solid->averaging > 0) mean->patches = tet_patches(tets, &mean->count);
    int packs = pack_count(mean->count);
    mean->packs = mem_alloc((size_t)packs, sizeof *mean->packs);
    for (int k = 0; k < packs * PACK_LANES; k++)
        set_lane(mean, &mean->patches[pack_element(mean->count, k / PACK_LANES, k % PACK_LANES)],
                 k % PACK_LANES, &mean->packs[k / PACK_LANES]);
    return (Term){&mean_ops, mean};
}

/* dE/dF of a point is its volume times L/V (J' - 1) cof F, with L/V the mean of a lambda Y. */
void solid_mean_tensions(const Term *term, const Point *at, double *tension)
{
    const Mean *mean = term->self;
    for (int k = 0; k < pack_count(mean->count); k++) {
        const MeanPack *own = &mean->packs[k];
        Pack x[TERM_MAX_DOF];
        for (int l = 0; l < PACK_LANES; l++) {
            int dof[TERM_MAX_DOF];
            mean_dofs(mean, pack_element(mean->count, k, l), dof);
            for (int i = 0; i < mean_size(mean); i++) x[i][l] = at->x[dof[i]];
        }
        Pack value = stiffness_of(mean, own, at->p) / own->volume * dilation(mean, own, x, NULL);
        for (int q = 0; q < mean->points; q++)
            for (int l = 0; l < PACK_LANES; l++)
                if (own->part[q][l] > 0) tension[own->tet[q][l]] = value[l];
    }
}
