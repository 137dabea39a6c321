#include "shell/smoothness.h"
#include "base/memory.h"
#include <math.h>

typedef struct Smoothness {
    int pair_count;
    int (*pairs)[2]; /* rows of the block */
    int first, width;
    bool ratios; /* of the logarithm */
} Smoothness;

/* Where in p the two values of jump k = width*pair + component are. */
static void entries(const Smoothness *s, int k, int at[2])
{
    for (int i = 0; i < 2; i++) at[i] = s->first + s->width * s->pairs[k / s->width][i] + k % s->width;
}

static double jump(const Smoothness *s, const double *p, const int at[2])
{
    return s->ratios ? log(p[at[0]] / p[at[1]]) : p[at[0]] - p[at[1]];
}

/* Of the jump by the number, but for its sign. */
static double slope(const Smoothness *s, const double *p, int at)
{
    return s->ratios ? 1 / p[at] : 1;
}

static void add_jump(const Smoothness *s, const double *p, double amount, const int at[2], double *dp)
{
    dp[at[0]] += amount * slope(s, p, at[0]);
    dp[at[1]] -= amount * slope(s, p, at[1]);
}

static double smoothness_value(const void *self, double weight, const double *x, const double *p, double *dx,
                               double *dp)
{
    (void)x, (void)dx;
    const Smoothness *s = self;
    double sum = 0;
    for (int k = 0; k < s->width * s->pair_count; k++) {
        int at[2];
        entries(s, k, at);
        double d = jump(s, p, at);
        sum += d * d;
        if (dp) add_jump(s, p, 2 * weight * d, at, dp);
    }
    return sum;
}

static void smoothness_product(const void *self, double weight, const double *x, const double *p,
                               const double *vx, const double *vp, double *hx, double *hp)
{
    (void)x, (void)vx, (void)hx;
    const Smoothness *s = self;
    for (int k = 0; k < s->width * s->pair_count; k++) {
        int at[2];
        entries(s, k, at);
        double d = slope(s, p, at[0]) * vp[at[0]] - slope(s, p, at[1]) * vp[at[1]];
        add_jump(s, p, 2 * weight * d, at, hp);
    }
}

static void smoothness_destroy(void *self)
{
    mem_free(((Smoothness *)self)->pairs);
    mem_free(self);
}

static const ObjectiveOps smoothness_ops = {.name = "smoothness",
                                            .value = smoothness_value,
                                            .product = smoothness_product,
                                            .destroy = smoothness_destroy};

static void pair_faces(const Mesh *mesh, Smoothness *s)
{
    s->pairs = mem_alloc((size_t)mesh->edge_count, sizeof *s->pairs);
    for (int e = 0; e < mesh->edge_count; e++) {
        if (mesh_edge_is_boundary(mesh, e)) continue;
        for (int i = 0; i < 2; i++) s->pairs[s->pair_count][i] = mesh->edge_faces[e][i];
        s->pair_count++;
    }
}

static void pair_edges(const Mesh *mesh, Smoothness *s)
{
    s->pair_count = 3 * mesh->face_count;
    s->pairs = mem_alloc((size_t)s->pair_count, sizeof *s->pairs);
    for (int k = 0; k < s->pair_count; k++)
        for (int i = 0; i < 2; i++) s->pairs[k][i] = mesh->face_edges[k / 3][(k + i) % 3];
}

Objective shell_smoothness(const Shell *shell, const ParamBlock *block, double weight)
{
    Smoothness *s = mem_alloc(1, sizeof *s);
    *s = (Smoothness){.first = block->offset,
                      .width = block->width,
                      .ratios = block->offset == shell->young || block->offset == shell->face_thickness};
    (block->offset == shell->fold ? pair_edges : pair_faces)(shell->mesh, s);
    return (Objective){&smoothness_ops, s, weight, 0, 0};
}
