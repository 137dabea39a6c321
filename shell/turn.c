#include "shell/turn.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "solve/sparse.h"
#include "surface/face.h"
#include <math.h>
#include <string.h>

struct Turn {
    const Shell *shell;
    int *unknown, free;  /* [3*vertex] number among the unknown positions, -1: as the straight step has it */
    Sparse *matrix;      /* sum of A b_i.b_j over the faces, for each axis; NULL until used */
    double (*hat)[3][2]; /* [face] gradients of the hat functions, 1/m */
    double *right, *shift; /* [free] */
};

/* Columns sum_i v_i b_i[k] of a field's gradient on a face. */
static void columns(const Turn *turn, int face, const double *v, Vec3 column[2])
{
    const int *corner = turn->shell->mesh->faces[face];
    for (int k = 0; k < 2; k++) {
        column[k] = vec3(0, 0, 0);
        for (int i = 0; i < 3; i++)
            column[k] = vec3_axpy(turn->hat[face][i][k], vec3_load(v + 3 * corner[i]), column[k]);
    }
}

/* v turned by the vector w [Rodrigues]. */
static Vec3 turned(Vec3 w, Vec3 v)
{
    double angle = vec3_length(w);
    double s = angle > 1e-8 ? sin(angle) / angle : 1, h = angle > 1e-8 ? sin(angle / 2) / (angle / 2) : 1;
    Vec3 once = vec3_cross(w, v);
    return vec3_axpy(h * h / 2, vec3_cross(w, once), vec3_axpy(s, once, v));
}

/* Angular velocity of a face with tangents f and their velocities e: the axis of the skew part of the velocity's gradient,
 * the normal's included. */
static Vec3 angular_velocity(const Vec3 f[2], const Vec3 e[2])
{
    Vec3 area = vec3_cross(f[0], f[1]);
    double square = vec3_dot(area, area);
    if (!(square > 0)) return vec3(0, 0, 0); /* a face without area: it has no normal to turn */
    Vec3 g0 = vec3_scale(1 / square, vec3_cross(f[1], area)),
         g1 = vec3_scale(1 / square, vec3_cross(area, f[0]));
    Vec3 n = vec3_scale(1 / sqrt(square), area);
    Vec3 dn = vec3_scale(-1, vec3_axpy(vec3_dot(e[0], n), g0, vec3_scale(vec3_dot(e[1], n), g1)));
    Vec3 twice = vec3_add(vec3_add(vec3_cross(g0, e[0]), vec3_cross(g1, e[1])), vec3_cross(n, dn));
    return vec3_scale(0.5, twice);
}

static void add_face(Turn *turn, int face, const double *x, const double *d, double a, const double *to)
{
    const Mesh *mesh = turn->shell->mesh;
    Vec3 f[2], e[2], now[2];
    columns(turn, face, x, f);
    columns(turn, face, d, e);
    columns(turn, face, to, now);
    Vec3 w = angular_velocity(f, e);
    for (int k = 0; k < 2; k++) {
        Vec3 stretched = vec3_axpy(a, vec3_sub(e[k], vec3_cross(w, f[k])), f[k]);
        Vec3 missing =
            vec3_scale(mesh->rest_area[face], vec3_sub(turned(vec3_scale(a, w), stretched), now[k]));
        double q[3] = {missing.x, missing.y, missing.z};
        for (int i = 0; i < 9; i++) {
            int unknown = turn->unknown[3 * mesh->faces[face][i / 3] + i % 3];
            if (unknown >= 0) turn->right[unknown] += turn->hat[face][i / 3][k] * q[i % 3];
        }
    }
}

/* Where the unknowns of a face's axis lie: element e is axis e % 3 of face e / 3. */
static void list_dofs(const Turn *turn, long *start, int *dofs)
{
    const Mesh *mesh = turn->shell->mesh;
    for (int e = 0; e < 3 * mesh->face_count; e++) {
        for (int i = 0; i < 3; i++) dofs[3 * e + i] = turn->unknown[3 * mesh->faces[e / 3][i] + e % 3];
        start[e + 1] = 3 * (e + 1L);
    }
}

static void assemble(const Turn *turn, const int *dofs)
{
    const Mesh *mesh = turn->shell->mesh;
    double *values = sparse_values(turn->matrix);
    for (int e = 0; e < 3 * mesh->face_count; e++)
        for (int k = 0; k < 9; k++) {
            const double *a = turn->hat[e / 3][k / 3], *b = turn->hat[e / 3][k % 3];
            int row = dofs[3 * e + k / 3], column = dofs[3 * e + k % 3];
            if (k / 3 < k % 3 || row < 0 || column < 0) continue;
            values[sparse_slot(turn->matrix, row, column)] +=
                mesh->rest_area[e / 3] * (a[0] * b[0] + a[1] * b[1]);
        }
}

static void build(Turn *turn)
{
    const Mesh *mesh = turn->shell->mesh;
    size_t elements = 3 * (size_t)mesh->face_count, free = (size_t)turn->free;
    long *start = mem_alloc(elements + 1, sizeof *start);
    int *dofs = mem_alloc(3 * elements, sizeof *dofs);
    turn->hat = mem_alloc((size_t)mesh->face_count, sizeof *turn->hat);
    for (int f = 0; f < mesh->face_count; f++) face_gradients(mesh->rest, mesh->faces[f], turn->hat[f]);
    list_dofs(turn, start, dofs);
    turn->matrix = sparse_create(turn->free, (Groups){(int)elements, start, dofs}, (SparseDef){0});
    assemble(turn, dofs);
    turn->right = mem_alloc(free, sizeof *turn->right);
    turn->shift = mem_alloc(free, sizeof *turn->shift);
    sparse_factor(turn->matrix, NULL);
    mem_free(start);
    mem_free(dofs);
}

void turn_follow(Turn *turn, const double *x, const double *d, double a, double *to)
{
    const Mesh *mesh = turn->shell->mesh;
    if (!turn->matrix) build(turn);
    memset(turn->right, 0, (size_t)turn->free * sizeof *turn->right);
    for (int f = 0; f < mesh->face_count; f++) add_face(turn, f, x, d, a, to);
    sparse_solve(turn->matrix, turn->right, turn->shift);
    for (int i = 0; i < 3 * mesh->vertex_count; i++)
        if (turn->unknown[i] >= 0) to[i] += turn->shift[turn->unknown[i]];
}

/* Gradients do not tell where a part is that nothing holds along an axis: its first vertex goes the straight way. */
static void pin_parts(Turn *turn)
{
    const Mesh *mesh = turn->shell->mesh;
    bool *known = mem_alloc(3 * (size_t)mesh->component_count, sizeof *known);
    for (int i = 0; i < 3 * mesh->vertex_count; i++)
        if (turn->shell->fixed[i]) known[3 * mesh->vertex_component[i / 3] + i % 3] = true;
    for (int i = 0; i < 3 * mesh->vertex_count; i++) {
        bool *part = &known[3 * mesh->vertex_component[i / 3] + i % 3];
        turn->unknown[i] = turn->shell->fixed[i] || !*part ? -1 : turn->free++;
        *part = true;
    }
    mem_free(known);
}

Turn *turn_create(const Shell *shell)
{
    Turn *turn = mem_alloc(1, sizeof *turn);
    turn->shell = shell;
    turn->unknown = mem_alloc(3 * (size_t)shell->mesh->vertex_count, sizeof *turn->unknown);
    pin_parts(turn);
    return turn;
}

void turn_destroy(Turn *turn)
{
    if (!turn) return;
    sparse_destroy(turn->matrix);
    mem_free(turn->unknown);
    mem_free(turn->hat);
    mem_free(turn->right);
    mem_free(turn->shift);
    mem_free(turn);
}
