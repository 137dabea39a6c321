#include "shell/smoothness.h"

/* Component i of the jump of M over an inner edge. */
static double jump(const Shell *shell, const double *p, int edge, int i)
{
    const int *faces = shell->mesh->edge_faces[edge];
    return p[shell->magnetization + 3 * faces[0] + i] - p[shell->magnetization + 3 * faces[1] + i];
}

static void add_jump(const Shell *shell, double amount, int edge, int i, double *dp)
{
    const int *faces = shell->mesh->edge_faces[edge];
    dp[shell->magnetization + 3 * faces[0] + i] += amount;
    dp[shell->magnetization + 3 * faces[1] + i] -= amount;
}

static double smoothness_value(const void *self, double weight, const double *x, const double *p, double *dx,
                               double *dp)
{
    (void)x, (void)dx;
    const Shell *shell = self;
    double sum = 0;
    for (int k = 0; k < 3 * shell->mesh->edge_count; k++) {
        if (mesh_edge_is_boundary(shell->mesh, k / 3)) continue;
        double d = jump(shell, p, k / 3, k % 3);
        sum += d * d;
        if (dp) add_jump(shell, 2 * weight * d, k / 3, k % 3, dp);
    }
    return sum;
}

static void smoothness_product(const void *self, double weight, const double *x, const double *p,
                               const double *vx, const double *vp, double *hx, double *hp)
{
    (void)x, (void)p, (void)vx, (void)hx;
    const Shell *shell = self;
    for (int k = 0; k < 3 * shell->mesh->edge_count; k++)
        if (!mesh_edge_is_boundary(shell->mesh, k / 3))
            add_jump(shell, 2 * weight * jump(shell, vp, k / 3, k % 3), k / 3, k % 3, hp);
}

static const ObjectiveOps smoothness_ops = {
    .name = "magnetization_smoothness", .value = smoothness_value, .product = smoothness_product};

Objective shell_magnetization_smoothness(const Shell *shell, double weight)
{
    return (Objective){&smoothness_ops, (void *)shell, weight, 0, 0};
}
